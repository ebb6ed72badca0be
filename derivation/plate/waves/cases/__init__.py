"""Hard cases, grids and switch points: the plate's waves."""

from derivation.plate.waves.cases.families import wave_families
from derivation.plate.waves.cases.laws import LAWS

__all__ = ["CASES", "LAWS"]

CASES = wave_families
