"""Formulas, derived and proved: plates with a held edge."""
