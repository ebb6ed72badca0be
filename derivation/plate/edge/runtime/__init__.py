"""Algorithms for simply supported and clamped edges, copied into the generated package."""
