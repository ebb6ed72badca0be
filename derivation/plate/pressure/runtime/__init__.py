"""Algorithms of the non-Hertzian pressure, copied into the generated package."""
