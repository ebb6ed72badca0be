"""Algorithms of the pressure, copied into the generated package."""
