"""Algorithms of waves in the plate, copied into the generated package."""
