"""Algorithms of supported and clamped edges, copied into the generated package."""
