"""Modified Bessel functions of the evanescent wave, and the contact face of a mode."""

from functools import partial

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import GUARDED, Choice, Facts, Let, Routine, Several, routine
from derivation.engine.formula.proof import lower_bessel
from derivation.plate.edge_modes.kernels.states import c, j0, k, t
from derivation.plate.edge_modes.theory import mindlin
from derivation.plate.edge_modes.theory import waves as theory
from derivation.plate.edge_modes.theory.mindlin import k_2
from derivation.plate.vocabulary import alpha, k_n

START, SMALL = sp.symbols("START SMALL", positive=True)
y, z, r = sp.symbols("y z r", positive=True)
mean, less, scaled, near, far = sp.symbols("mean less scaled near far", real=True)
scaled_amplitude, series, series_2, plain, scaled_there = sp.symbols(
    "scaled_amplitude series series_2 plain scaled_there", real=True
)
inverse, logarithm, above, scale = sp.symbols("inverse logarithm above scale", real=True)
FADED = sp.besseli(0, y) * sp.exp(-y)
"""I0 e^(-y)."""
BEYOND = sp.Gt(y, START)
"""Condition for the series at infinity; Bessel's integral is used elsewhere."""
_AT_INFINITY = (
    Choice(z, BEYOND, y, START, unclaimed="no", reason="the series at infinity end there"),
    Let(inverse, 1 / z),
    Let(scale, inverse / (2 * sp.pi)),
    Several((logarithm,), "logarithm_series", (inverse,), (
        y * sp.log(FADED * sp.sqrt(2 * sp.pi * y)),
    )),
)  # fmt: skip
_FADED_ANYWHERE = Choice(far, BEYOND, sp.exp(inverse * logarithm) * sp.sqrt(scale), scaled)


@named_routine
def modified() -> Claims:
    """Return 2 I1/(y I0), I2/(y^2 I0) and I0 e^(-y) for y >= 0."""
    ratio, fourth, second = sp.symbols("ratio fourth second", real=True)
    I0, I1, I2 = (sp.besseli(order, y) for order in range(3))
    exact = I1 / y * sp.exp(-y), 3 * I2 / y**2 * sp.exp(-y)
    statements = (
        Several((scaled, second, fourth), "turn_means", (GUARDED(y, START),), (FADED, *exact)),
        *_AT_INFINITY,
        Several((ratio,), "ratio_series", (inverse,), (I1 / I0,)),
        Let(above, 2 * inverse * ratio),
        Choice(mean, BEYOND, above, 2 * second / scaled),
        Choice(less, BEYOND, (1 - above) * inverse**2, fourth / (3 * scaled)),
        _FADED_ANYWHERE,
    )
    return Claims(
        (y,),
        statements,
        (mean, less, far),
        (2 * I1 / (y * I0), I2 / (y**2 * I0), FADED),
        {},
        _reduce,
    )


@named_routine
def faded() -> Claims:
    """Return I0 e^(-y) for y >= 0."""
    return Claims(
        (y,),
        (
            Several((scaled,), "turn_mean", (GUARDED(y, START),), (FADED,)),
            *_AT_INFINITY,
            _FADED_ANYWHERE,
        ),
        (far,),
        (FADED,),
        {},
        _reduce,
    )


def _reduce(expression: sp.Expr) -> sp.Expr:
    plain = expression.replace(sp.exp, lambda z: sp.exp(sp.expand_log(z, force=True)))
    return lower_bessel(plain)


class _FaceParts:
    """Expressions and functions of both waves, for the face or for the mean under a punch."""

    def __init__(self, punch: bool) -> None:
        self.exact = theory.UNDER_PUNCH if punch else theory.ON_FACE
        self.first = self.exact.subs(mindlin.c, 0)
        self.second = (self.first - self.exact) / (mindlin.c * theory.t)
        self.series = "punch_beyond" if punch else "even_beyond"
        self.scaled = "shc" if punch else "faded"
        self.calls = () if punch else (Several((plain,), "bessel_j0", (y,), (self.first,)),)
        self.plain = sp.sin(y) / y if punch else plain
        self.safe: Facts = {y: SMALL} if punch else {}


def on_face(punch: bool) -> Routine:
    """Return the deflection at a distance from the axis, or the mean under a punch minus 1."""
    parts = _FaceParts(punch)
    value = (near - t * far) / (1 - c * t)
    claim = parts.exact / (1 - mindlin.c * theory.t)
    statements = (
        Let(y, r * k),
        Let(z, r * k_2),
        Several((j0,), "bessel_j0", (k,), (theory.J0,)),
        Several((scaled,), "faded", (k_2,), (theory.I0 * sp.exp(-k_2),)),
        Let(scaled_amplitude, j0 / scaled, "c e^k2"),
        *_less_one(series, y, parts.first, parts.series, -1),
        *_less_one(series_2, z, parts.second, parts.series, 1),
        *parts.calls,
        Choice(near, y < SMALL, -(y**2) * series, parts.plain - 1, safe_no=parts.safe),
        Several((scaled_there,), parts.scaled, (z,), (parts.second * sp.exp(-k_2 * alpha),)),
        Choice(
            far,
            z < SMALL,
            c * (z**2 * series_2),
            scaled_amplitude * scaled_there * sp.exp(z - k_2) - c,
        ),
    )  # fmt: skip
    return routine(
        "punch_mean_less_one" if punch else "face",
        (r, k, k_2, c, t),
        statements,
        (value if punch else 1 + value,),
        ((claim - int(punch)).subs(mindlin.c, theory.PART),),
        "Return the contact-face deflection over that on the axis: "
        + ("its mean under a punch, minus 1." if punch else "its value at r."),
        {r: alpha, k: k_n, c: theory.PART},
    )


def _less_one(
    symbol: sp.Symbol, of: sp.Symbol, exact: sp.Expr, name: str, sign: int
) -> tuple[Several]:
    """Return (wave - 1) divided by the square of its argument."""
    square = sign * ((k_n if of == y else k_2) * alpha) ** 2
    return (Several((symbol,), name, (sign * GUARDED(of, SMALL) ** 2,), ((exact - 1) / square,)),)


ROUTINES = (modified, faded, partial(on_face, False), partial(on_face, True))
