"""The poles of the plate factor: every root of sinh T = +-T, numbered without gaps, in balls.

In the first quadrant they are T_1, T_2, ..., in order of height; T_n is the solution of

    T - asinh T = i pi n,    sinh T_n = (-1)^n T_n,    pi n < Im T_n < pi n + pi/2,

and there is exactly one for each n >= 1.

Every root is one of these: let u = asinh T, Re u > 0. Then sinh u = +-sinh T, so that u = T or
u = -T up to multiples of i pi, and -T has a negative real part. sinh maps the half strip Re u > 0,
0 < Im u < pi/2 onto the first quadrant, one to one, hence n >= 0. n = 0 would be sinh T = T with
T = x + iy, 0 < y < pi/2: cos y = x/sinh x and sin y/y = 1/cosh x < x/sinh x, since tanh x < x.
Hence tan y < y, a contradiction.

There is one for each n: asinh T + i pi n maps the closed half strip Re T >= 0,
pi n <= Im T <= pi n + pi/2 into itself (values on the cut taken from the right). Since
|1 + T^2| >= (pi n)^2 - 1 there, the map is a contraction with the factor `contraction(n)` < 0.34
and has one fixed point. The fixed point is not on the imaginary axis, where sin y = +-y only at 0.
On the real axis sinh T > T.
"""

from functools import cache

import flint
import sympy as sp

from derivation.engine.formula.proof import Proof, prove
from derivation.plate.vocabulary import T

SIZE_OVER_INDEX = 8
"""|T_n| <= 8 n: |T| - log(2 |T| + 1) <= pi (n + 1/2) at T_n, but larger for |T| = 8 n, n >= 1."""


@cache
def numbering() -> Proof:
    """Prove the periods of sinh and cosh and the slope of asinh that the argument above uses."""
    u = sp.Symbol("u", positive=True)
    turned = {n: u + sp.I * sp.pi * n for n in (1, 2)}
    return prove(
        "Roots of sinh T = +-T",
        "With u = asinh T a root is T = u + i pi n, where sinh T = (-1)^n T. There is one for each "
        "n, because asinh T + i pi n is a contraction of its strip.",
        {f"sinh {n}": sp.sinh(x) - (-1) ** n * sp.sinh(u) for n, x in turned.items()}
        | {f"cosh {n}": sp.cosh(x) - (-1) ** n * sp.cosh(u) for n, x in turned.items()}
        | {"slope": sp.diff(sp.asinh(T), T) - 1 / sp.sqrt(1 + T**2)},
    )


def contraction(n: int) -> flint.arb:
    """Return a bound of |d asinh T/dT| where Im T >= pi n."""
    return 1 / ((n * flint.arb.pi()) ** 2 - 1).sqrt()


@cache
def root(n: int, bits: int = 128) -> flint.acb:
    """Return a ball around T_n with a radius below 2^-bits.

    Newton's iteration gives a point. Its distance from the root is at most its distance from its
    own image over 1 - `contraction`.

    Raises
    ------
    ValueError
        Unless n >= 1.
    ArithmeticError
        If the iteration does not converge to this root.
    """
    if n < 1:
        raise ValueError(f"the roots are counted from 1, got {n}")
    numbering()
    with flint.ctx.workprec(bits + 32 + n.bit_length()):
        pi = flint.arb.pi()
        shift = flint.acb(0, n * pi)
        x = flint.acb((2 * n * pi).log(), n * pi + 1).mid()
        for _ in range(bits.bit_length() + 4):
            slope = 1 - 1 / (1 + x * x).sqrt()
            x = (x - (x - shift - x.asinh()) / slope).mid()
        inside = x.real > 0 and x.imag > n * pi and x.imag < n * pi + pi / 2
        error = abs(x - shift - x.asinh()) / (1 - contraction(n))
        if not (inside and error < flint.arb(2) ** -bits):
            raise ArithmeticError(f"root {n} of sinh T = +-T is not shown to be near {x}")
        radius = flint.arb(0, error.upper())
        return x + flint.acb(radius, radius)
