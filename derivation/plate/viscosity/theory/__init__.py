"""Formulas, derived and proved: the viscous contact."""
