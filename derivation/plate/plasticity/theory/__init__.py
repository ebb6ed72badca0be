"""Formulas, derived and proved: the contact that yields."""

from derivation.plate.plasticity.theory.contact import yielding

LINKS = (("plasticity", yielding),)
