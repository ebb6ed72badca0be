"""Formulas, derived and proved: clamped and supported plates."""

from derivation.plate.edge_modes.theory.modes import thin_plate_modes
from derivation.plate.edge_modes.theory.waves import thick_plate_modes

STEPS = (("thin-plate modes", thin_plate_modes), ("thick-plate modes", thick_plate_modes))
