"""Damping of the plate's modes."""
