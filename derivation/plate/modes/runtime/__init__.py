"""Sums over the modes, copied into the generated package."""
