"""A stable form of one variable -> a NumPy module, as `platecontact rewrite` prints it."""

from importlib.metadata import version

import sympy as sp

from derivation.emit.kernels import lines, seam_text
from derivation.emit.printer import to_numpy
from derivation.emit.render import Module, fill
from derivation.emit.source import format_files
from derivation.rewrite.form import Seam
from derivation.rewrite.series import POLYNOMIAL
from derivation.rewrite.stabilise import Stable


def standalone(stable: Stable) -> str:
    """Source of a module with the form as a function `f`."""
    seam = seam_text(stable.value) if isinstance(stable.value, Seam) else None
    sides = (stable.value.below, stable.value.above) if isinstance(stable.value, Seam) else ()
    context = {
        "summary": f"A stable form by platecontact {version('platecontact')}.",
        "name": "f",
        "variable": str(stable.variable),
        "formula": sp.sstr(stable.expression),
        "worst": f"{stable.worst:.1f}",
        "polynomial": any(
            part.has(POLYNOMIAL)
            for side in sides
            for part in (side.value, *(step.expression for step in side.steps))
        ),
        "function": {
            "steps": lines(stable.steps),
            "seam": seam,
            "value": "" if seam else to_numpy(stable.value),
        },
    }
    return format_files({"f.py": fill(Module("f", "standalone", context))})["f.py"]
