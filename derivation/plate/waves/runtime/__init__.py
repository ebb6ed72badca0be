"""Algorithms of the plate's waves, copied into the generated package."""
