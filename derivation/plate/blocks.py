"""The plate's building blocks: the hyperbolic ones, and the shape of Hertz's pressure."""

import sympy as sp

from derivation.engine.rewrite.blocks import HYPERBOLIC, Definition, built
from derivation.engine.rewrite.form import Block

y = sp.Symbol("y", positive=True)

DEFINITIONS = (
    *HYPERBOLIC,
    Definition("hertz_shape", y, sp.sin(y) - y * sp.cos(y), 3, 2, "(sin y/y - cos y)"),
)


def blocks() -> dict[str, Block]:
    """Every building block of the plate by name."""
    return built(DEFINITIONS)
