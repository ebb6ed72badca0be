"""Formulas, derived and proved: the impact."""
