"""Algorithms of the yielding contact, copied into the generated package."""
