"""Modules of the edge for the generated package."""

from pathlib import Path

from derivation.engine.emit.modules import Routines
from derivation.plate.edge.kernels import clamped, supported
from derivation.plate.edge.kernels.tables import numbers
from derivation.plate.modules import ComputedModule, RuntimeModule

RUNTIME = Path(__file__).parents[1] / "runtime"


def edge_kernels() -> Routines:
    """Return the routines of supported and clamped edges, printed from proved expressions."""
    made = [make for part in (supported, clamped) for make in part.ROUTINES]
    imports = {
        "blocks": ("hertz_shape", "polynomial", "sinh_minus", "sinh_plus"),
        "edge_numbers": ("FIRST_SQUARE", "FIRST_THIRD"),
    }
    title = "Corrections of the law for supported and clamped edges, and their bounds."
    return Routines("edge_kernels", title, tuple(make() for make in made), imports)


MODULES = (
    ComputedModule("edge_numbers", numbers),
    ComputedModule("edge_kernels", edge_kernels),
    RuntimeModule("edge_sums", RUNTIME / "edge_sums.py"),
    RuntimeModule("edge", RUNTIME / "edge.py"),
    RuntimeModule("edge_curvature", RUNTIME / "edge_curvature.py"),
)
