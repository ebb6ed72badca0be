"""Step 2: the two ODEs -> general solution f_j, g_j, the paper's equation (2).

The ODEs have constant coefficients: on e^(s z) they become a 2x2 matrix whose
determinant's roots, with their multiplicities, are the solution space.
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import prove
from derivation.plate.modes.theory.equilibrium import equilibrium
from derivation.plate.vocabulary import C1, C2, C3, C4, Formula, f, g, phi, z

CONSTANTS = (C1, C2, C3, C4)


def characteristic_roots() -> dict[sp.Expr, int]:
    """Return the exponents s of the solutions e^(s z), with multiplicities."""
    s = sp.Symbol("s")
    rows = [[_operator(ode.expression, unknown, s) for unknown in (f, g)] for ode in equilibrium()]
    return dict(sp.roots(sp.Matrix(rows).det(), s))


def _operator(equation: sp.Expr, unknown: sp.Expr, s: sp.Symbol) -> sp.Expr:
    """Return the polynomial in s that one unknown's terms in an equation become on e^(s z)."""
    linear = sp.expand(equation)
    return sum(
        (linear.coeff(sp.diff(unknown, z, order)) * s**order for order in (1, 2)),
        linear.coeff(unknown),
    )


def real_basis(roots: dict[sp.Expr, int]) -> list[sp.Expr]:
    """Return combinations of z^k e^(s z) over the roots s and -s: z^k cosh, z^k sinh."""
    positive = [(s, count) for s, count in roots.items() if s.is_positive]
    return [
        z**power * shape(s * z)
        for s, count in positive
        for power in range(count)
        for shape in (sp.cosh, sp.sinh)
    ]


@cache
def general_solution() -> tuple[sp.Expr, sp.Expr]:
    """Return f and g with the four integration constants; g follows from f by both ODEs."""
    basis = real_basis(characteristic_roots())
    shape_f = sum((c * e for c, e in zip(CONSTANTS, basis, strict=True)), sp.Integer(0))
    unknown = sp.symbols("d1:5")
    shape_g = sum((d * e for d, e in zip(unknown, basis, strict=True)), sp.Integer(0))
    residuals = substitute(shape_f, shape_g)
    conditions = [part for residual in residuals for part in _independent_parts(residual)]
    (solution,) = sp.linsolve(conditions, *unknown)
    return shape_f, shape_g.subs(dict(zip(unknown, solution, strict=True)))


def substitute(shape_f: sp.Expr, shape_g: sp.Expr) -> list[sp.Expr]:
    """Return the residuals of the two ODEs for given f and g."""
    return [ode.expression.subs({f: shape_f, g: shape_g}).doit() for ode in equilibrium()]


def _independent_parts(residual: sp.Expr) -> list[sp.Expr]:
    """Return coefficients of the independent functions z^k cosh(phi z), z^k sinh(phi z)."""
    ch, sh = sp.Dummy(), sp.Dummy()
    flat = residual.subs({sp.cosh(phi * z): ch, sp.sinh(phi * z): sh})
    return list(sp.Poly(sp.expand(flat), z, ch, sh).coeffs())


def by_constants(expression: sp.Expr) -> sp.Expr:
    """Return an expression linear in C1 ... C4 with its coefficients collected as in the paper."""
    shapes = (sp.cosh(phi * z), sp.sinh(phi * z))
    linear = sp.expand(expression)
    total = sp.Integer(0)
    for constant in CONSTANTS:
        coefficient = linear.coeff(constant)
        total += constant * sp.Add(
            *(sp.factor(coefficient.coeff(shape)) * shape for shape in shapes)
        )
    return total


@cache
def mode_shapes() -> tuple[Formula, Formula]:
    """Return the paper's (2): f_j and g_j."""
    shape_f, shape_g = general_solution()
    shapes = shape_f, by_constants(shape_g)
    proof = prove(
        "General solution",
        "$f_j$ and $g_j$ are inserted into both ODEs; their four functions are independent.",
        lambda f, g: dict(zip(("radial ODE", "axial ODE"), substitute(f, g), strict=True)),
        *shapes,
    )
    return (
        Formula(
            "f_j",
            "f_j(z)",
            "deflection of mode $j$ through the thickness",
            shape_f,
            "m",
            "2",
            ("radial_ode", "axial_ode"),
            proof,
        ),
        Formula(
            "g_j",
            "g_j(z)",
            r"radial displacement of mode $j$ through the thickness, divided by $\phi_j$",
            shapes[1],
            "m^2",
            "2",
            ("f_j",),
            proof,
        ),
    )
