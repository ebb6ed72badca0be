"""Algorithms of the impact, copied into the generated package."""
