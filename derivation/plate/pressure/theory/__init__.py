"""Formulas, derived and proved: the contact pressure."""
