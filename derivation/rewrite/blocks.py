"""Building blocks: differences of near-equal terms over the power of T they vanish with.

Each is a function of one variable with an exact definition, finite and not
zero at the origin. Below its seam stands a Taylor section (exact rationals,
degree from a bound), above it a direct form whose terms cancel by less than a
factor of three.
"""

from functools import cache

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.formula.proof import prove
from derivation.rewrite.form import Block, Branch, Seam, Step, branches, undo
from derivation.rewrite.series import taylor_section

T, x, y = sp.symbols("T x y", positive=True)
_square = sp.Symbol("square", positive=True)


def _sectioned(
    name: str,
    variable: sp.Symbol,
    seam: sp.Rational,
    core: sp.Expr,
    factor: sp.Expr,
    direct: sp.Expr | None,
    summary: str,
) -> Block:
    """A block factor * core: core as a Taylor section below the seam, `direct` above it.

    Without a direct form the block ends at the seam.
    """
    section = taylor_section(core, variable, seam)
    series = factor * variable**section.lead * section.polynomial(_square)
    square = (Step(_square, variable**2),)
    truncation = f"series cut off at a relative error of {float(section.bound):.1e}"
    exact = factor * core
    if direct is None:
        domain = (f"0 <= {variable} <= {seam}",)
        return Block(name, (variable,), exact, domain, summary, square, series, truncation)
    below = Branch(square, series, {variable: seam})
    value = Seam(variable, seam, below, Branch((), direct, {variable: seam}))
    domain, truncation = (f"{variable} >= 0",), f"{truncation} for {variable} < {seam}"
    return Block(name, (variable,), exact, domain, summary, (), value, truncation)


@cache
def blocks() -> dict[str, Block]:
    """Every building block by name, its direct form proved equal to its definition.

    Raises
    ------
    ProofError
        Naming the block whose direct form is not its definition.
    """
    two, one = sp.Integer(2), sp.Integer(1)
    found = (
        _sectioned(
            "sinh_minus",
            T,
            two,
            sp.sinh(T) - T,
            2 * sp.exp(-T) / T**3,
            (-expm1(-2 * T) - 2 * T * sp.exp(-T)) / T**3,
            "2 e^(-T) (sinh T - T)/T^3, 1/3 at T = 0.",
        ),
        Block(
            "sinh_plus",
            (T,),
            2 * sp.exp(-T) * (sp.sinh(T) + T) / T,
            ("T > 0",),
            "2 e^(-T) (sinh T + T)/T, 4 at T = 0.",
            (),
            2 * sp.exp(-T) - expm1(-2 * T) / T,
        ),
        _sectioned(
            "cosh_gap",
            x,
            one,
            x * sp.cosh(x) - sp.sinh(x),
            2 * sp.exp(-x) / x**3,
            None,
            "2 e^(-x) (x cosh x - sinh x)/x^3, 2/3 at x = 0.",
        ),
        _sectioned(
            "hertz_shape",
            y,
            sp.Rational(8, 5),
            sp.sin(y) - y * sp.cos(y),
            3 / y**3,
            3 * (sp.sin(y) / y - sp.cos(y)) / y**2,
            "3 (sin y - y cos y)/y^3, the transform of Hertz pressure; 1 at y = 0.",
        ),
    )
    by_name = {block.name: block for block in found}
    for block in found:
        prove(
            f"Direct form of {block.name}",
            "The direct form equals the definition.",
            {
                label: undo(branch.value, branch.steps, by_name) - block.definition
                for label, branch in branches(block.value)
                if not branch.value.has(sp.Function("polynomial"))
            },
        )
    return by_name
