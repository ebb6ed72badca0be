"""Formulas, derived and proved: the static contact."""
