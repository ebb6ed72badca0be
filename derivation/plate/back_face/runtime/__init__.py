"""Algorithms of the back face, copied into the generated package."""
