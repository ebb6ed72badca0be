"""Building blocks: sums that cancel at 0, over the power of the variable they vanish with.

Each is a function of one variable with an exact definition, finite and not zero
at the origin. How it is computed is found by the rewriting rules.
"""

import sympy as sp

from derivation.files import cached
from derivation.formula.proof import prove
from derivation.rewrite.form import Block, Seam, branches, undo
from derivation.rewrite.series import POLYNOMIAL
from derivation.rewrite.stabilise import Stable, stabilise

T, x, y = sp.symbols("T x y", positive=True)
ENDS = (1e-150, 1e75)
"""Where blocks are held to the truth; beyond, the powers they are divided by overflow."""

DEFINITIONS: tuple[tuple[str, sp.Symbol, sp.Expr, str], ...] = (
    (
        "sinh_minus",
        T,
        2 * sp.exp(-T) * (sp.sinh(T) - T) / T**3,
        "2 e^(-T) (sinh T - T)/T^3, 1/3 at T = 0.",
    ),
    (
        "sinh_plus",
        T,
        2 * sp.exp(-T) * (sp.sinh(T) + T) / T,
        "2 e^(-T) (sinh T + T)/T, 4 at T = 0.",
    ),
    (
        "cosh_gap",
        x,
        2 * sp.exp(-x) * (x * sp.cosh(x) - sp.sinh(x)) / x**3,
        "2 e^(-x) (x cosh x - sinh x)/x^3, 2/3 at x = 0.",
    ),
    (
        "hertz_shape",
        y,
        3 * (sp.sin(y) - y * sp.cos(y)) / y**3,
        "3 (sin y - y cos y)/y^3, the transform of Hertz pressure; 1 at y = 0.",
    ),
)
"""Name, variable, exact definition and summary of every block."""


def blocks() -> dict[str, Block]:
    """Every building block by name, its direct form proved equal to its definition.

    Raises
    ------
    ProofError
        Naming the block whose direct form is not its definition.
    UnreachableError
        If the rules do not reach a block.
    """
    return cached("blocks", ("files.py", "formula", "rewrite"), _blocks)


def _blocks() -> dict[str, Block]:
    found = {row[0]: _block(*row) for row in DEFINITIONS}
    for block in found.values():
        prove(
            f"Direct form of {block.name}",
            "The direct form equals the definition.",
            {
                label: undo(branch.value, (*block.steps, *branch.steps), found) - block.definition
                for label, branch in branches(block.value)
                if not any(step.expression.has(POLYNOMIAL) for step in branch.steps)
            },
        )
    return found


def _block(name: str, variable: sp.Symbol, definition: sp.Expr, summary: str) -> Block:
    stable = stabilise(definition, variable, ENDS)
    truncation = _truncation(stable)
    bound = ">=" if truncation else ">"
    return Block(
        name,
        (variable,),
        definition,
        (f"{variable} {bound} 0",),
        summary,
        stable.steps,
        stable.value,
        truncation,
    )


def _truncation(stable: Stable) -> str:
    """What the section leaves out, in words; nothing without one."""
    if not isinstance(stable.value, Seam):
        return ""
    seam = stable.value
    return (
        f"series cut off at a relative error of {float(stable.truncation):.1e} "
        f"for {seam.variable} < {seam.at}"
    )
