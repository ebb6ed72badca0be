"""Algorithms for modes of clamped and supported plates, copied into the generated package."""
