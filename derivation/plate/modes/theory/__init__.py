"""Formulas, derived and proved: the plate's modes."""
