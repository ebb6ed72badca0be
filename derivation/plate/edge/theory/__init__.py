"""Formulas, derived and proved: the edge."""
