"""Formulas, derived and proved: clamped and supported plates."""

from derivation.plate.edge_modes.theory.modes import held_modes
from derivation.plate.edge_modes.theory.waves import held_waves

LINKS = (("held modes", held_modes), ("held waves", held_waves))
