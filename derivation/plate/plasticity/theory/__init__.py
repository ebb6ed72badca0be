"""Formulas, derived and proved: the elastic-plastic contact."""

from derivation.plate.plasticity.theory.contact import yielding

STEPS = (("plasticity", yielding),)
