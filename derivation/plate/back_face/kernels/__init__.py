"""Modules of the back face for the generated package."""

from pathlib import Path

from derivation.engine.emit.modules import Routines
from derivation.plate.back_face.kernels import stress
from derivation.plate.back_face.kernels.tables import numbers
from derivation.plate.modules import ComputedModule, RuntimeModule

RUNTIME = Path(__file__).parents[1] / "runtime"


def back_face_kernels() -> Routines:
    """Return the routines of the stress, printed from proved expressions."""
    imports = {
        "back_face_numbers": ("THIN",),
        "blocks": ("polynomial", "sinh_pair"),
        "edge_kernels": ("indentation_loss", "turn_of_clamp"),
        "ranges": ("times",),
    }
    title = "Stress on the back face of a plate: modal terms, series, and edge correction."
    return Routines("back_face_kernels", title, tuple(make() for make in stress.ROUTINES), imports)


MODULES = (
    ComputedModule("back_face_numbers", numbers),
    ComputedModule("back_face_kernels", back_face_kernels),
    RuntimeModule("back_face", RUNTIME / "back_face.py"),
)
