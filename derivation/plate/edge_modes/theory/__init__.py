"""Formulas, derived and proved: plates with a held edge."""

from derivation.plate.edge_modes.theory.modes import held_modes
from derivation.plate.edge_modes.theory.waves import held_waves

LINKS = (("held modes", held_modes), ("held waves", held_waves))
