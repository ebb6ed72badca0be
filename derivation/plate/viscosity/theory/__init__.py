"""Formulas, derived and proved: the viscoelastic contact."""
