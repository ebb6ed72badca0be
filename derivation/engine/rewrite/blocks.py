"""Building blocks: sums that cancel at 0, divided by the power of their leading term.

Each is a function of one variable with an exact definition, finite and nonzero at the origin. The
rewriting rules find its stable form.
"""

import hashlib
from dataclasses import replace
from typing import NamedTuple

import sympy as sp

from derivation.engine.cache import cached
from derivation.engine.formula.proof import prove
from derivation.engine.rewrite.form import Block, Branch, Step, Switch, branches, substitute_steps
from derivation.engine.rewrite.shape import decay
from derivation.engine.rewrite.stabilise import Stable, stabilise

T = sp.Symbol("T", positive=True)
ENDS = (1e-150, 1e75)
"""Range in which the forms are tested; above it, the powers in the denominators overflow."""


class Definition(NamedTuple):
    """Definition of a building block.

    Parameters
    ----------
    name, variable
        Name, and variable.
    total
        The sum that it represents.
    lead, constant_power
        The power of the leading term if the sum cancels at 0, and the part of this power that is
        constant above the switch point.
    reads
        Text of the sum for the docstring.
    """

    name: str
    variable: sp.Symbol
    total: sp.Expr
    lead: int
    constant_power: int
    reads: str


HYPERBOLIC = (
    Definition("sinh_minus", T, 2 * sp.exp(-T) * (sp.sinh(T) - T), 3, 3, "2 e^(-T) (sinh T - T)"),
    Definition("sinh_plus", T, 2 * sp.exp(-T) * (sp.sinh(T) + T), 0, 0, "2 e^(-T) (sinh T + T)"),
    Definition(
        "sinh_pair",
        T,
        2 * sp.exp(-2 * T) * (sp.cosh(2 * T) - 1 - 2 * T**2),
        4,
        4,
        "4 e^(-2T) (sinh^2 T - T^2)",
    ),
)
"""Building blocks for solids with two parallel faces."""


def build_blocks(definitions: tuple[Definition, ...]) -> dict[str, Block]:
    """Return building blocks by name; the direct form of each is proved equal to its definition.

    Raises
    ------
    ProofError
        Naming the block whose direct form differs from its definition.
    UnreachableError
        If the rules do not find a form of a block.
    """
    key = hashlib.sha256(repr(definitions).encode()).hexdigest()[:8]
    kinds = (Block, Step, Branch, Switch)
    rooms = ("engine/cache.py", "engine/formula", "engine/rewrite")
    return cached(f"blocks-{key}", rooms, lambda: _build_blocks(definitions), *kinds)


def _build_blocks(definitions: tuple[Definition, ...]) -> dict[str, Block]:
    return {row.name: _proved(_block(*row)) for row in definitions}


def block_of(name: str, stable: Stable, summary: str) -> Block:
    """Return a stable form that contains a series as a building block, the direct form proved.

    Raises
    ------
    ProofError
        If the direct form differs from the expression.
    """
    domain = (f"{stable.variable} > 0",) if stable.variable.is_positive else ()
    truncation = _truncation(stable)
    return _proved(
        Block(
            name, (stable.variable,), stable.expression, 0, 0, domain, summary,
            stable.steps, stable.value, truncation,
        )
    )  # fmt: skip


def _proved(block: Block) -> Block:
    """Return a block if its direct form, above the switch point, is equal to its definition."""
    _, side = branches(block.value)[-1]
    over = block.value.at**block.constant_power if isinstance(block.value, Switch) else 1
    direct = substitute_steps(side.value, (*block.steps, *side.steps), {})
    prove(
        f"Direct form of {block.name}",
        "The direct form, used above the switch point, equals the definition.",
        {"direct form": direct - block.divided / over},
    )
    return block


def _block(
    name: str, variable: sp.Symbol, total: sp.Expr, lead: int, held: int, reads: str
) -> Block:
    stable = stabilise(total / variable**lead, variable, ENDS, held)
    if isinstance(stable.value, Switch):
        above = _decay_once(stable.value.above)
        stable = replace(stable, value=replace(stable.value, above=above))
    summary = f"{reads}."
    if isinstance(stable.value, Switch):
        start = (total / variable**lead).series(variable, 0, 1).removeO()
        summary = (
            f"{reads} over min({variable}, {stable.value.at})^{held}, {start} at {variable} = 0."
        )
    truncation = _truncation(stable)
    bound = ">=" if truncation else ">"
    return Block(
        name,
        (variable,),
        total,
        lead,
        held,
        (f"{variable} {bound} 0",),
        summary,
        stable.steps,
        stable.value,
        truncation,
    )


def _decay_once(branch: Branch) -> Branch:
    """Return the branch with its exponentials as powers of the slowest one, computed once."""
    exponentials = sp.Tuple(branch.value, *(step.expression for step in branch.steps)).atoms(sp.exp)
    decays = sorted(exponentials, key=lambda slow: abs(slow.args[0].as_coeff_Mul()[0]))
    powers = {slow: slow.args[0] / decays[0].args[0] for slow in decays}
    if len(decays) < 2 or not all(power.is_Integer for power in powers.values()):
        return branch
    once = {slow: decay**power for slow, power in powers.items()}
    steps = (replace(step, expression=step.expression.xreplace(once)) for step in branch.steps)
    first = Step(decay, decays[0])
    return replace(branch, steps=(first, *steps), value=branch.value.xreplace(once))


def _truncation(stable: Stable) -> str:
    """Return the truncation error in words; empty if there is no series."""
    if not isinstance(stable.value, Switch):
        return ""
    switch = stable.value
    return (
        f"series truncated at a relative error of {float(stable.truncation):.1e} "
        f"for {switch.variable} < {switch.at}"
    )
