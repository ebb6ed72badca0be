"""Which expressions become code, and the numbers that this code needs: plates with a held edge."""

from pathlib import Path

from derivation.plate.budgets import read_promises
from derivation.plate.edge_modes.kernels.wave_context import held_waves_context
from derivation.plate.modules import TemplateModule

MODULES = (
    TemplateModule(
        "edge_modes",
        Path(__file__).parents[1],
        lambda: held_waves_context(read_promises("edge_modes")),
    ),
)
