"""Building blocks of the plate's formulas: hyperbolic ones, and those of Hertz pressure."""

import sympy as sp

from derivation.engine.rewrite.blocks import HYPERBOLIC, Definition, build_blocks
from derivation.engine.rewrite.form import Block

y = sp.Symbol("y", positive=True)

DEFINITIONS = (
    *HYPERBOLIC,
    Definition("hertz_shape", y, sp.sin(y) - y * sp.cos(y), 3, 2, "(sin y/y - cos y)"),
)


def blocks() -> dict[str, Block]:
    """Return every building block of the plate by name."""
    return build_blocks(DEFINITIONS)
