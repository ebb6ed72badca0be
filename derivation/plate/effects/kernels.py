"""Constants of the effects: power series of the sphere's profile and of the side wall, bounds.

With t = (a/R)^2 and L = (artanh sqrt(t) - sqrt(t))/t^(3/2) = 1/3 + t/5 + t^2/7 + ... the
contact of link 21 is, over Hertz's at equal contact radius,

    delta = 1 + t L,    P = (3/4) (1 + (1 + t) L),    S = (1 + t L + 1/(1 - t))/2.

The side wall's part of delta is W = -(8/pi^2) sum kappa_(2k-4) (2k-2)/(2k-1)! alpha^(2k-3), and
S has the power n of it 1 + n/2 times.
"""

from fractions import Fraction
from pathlib import Path

import flint
from flint import arb as Ball

from derivation.engine.formula.ball import enclose, to_ball
from derivation.mathematics.bessel.kernels import nearest_double, wrapped
from derivation.plate.contact.kernels.moments import BITS, kappas
from derivation.plate.contact.theory.split import zero_of_j0
from derivation.plate.effects.theory import wall_growth_ball
from derivation.plate.impact.kernels.simple import above
from derivation.plate.impact.theory.substitution import wall_rest_ball
from derivation.plate.modules import FunctionRow, TemplateModule
from derivation.plate.pressure.theory.bound import WALL_EXTRA
from derivation.plate.vocabulary import j_n, lam, mu
from derivation.plate.waves.theory.plate_motion import plate_motion

NEAR = Fraction(1, 4)
"""t up to which L is a sum; from here on it is known to 4 roundings by what it stands for."""
NEGLIGIBLE = 2.0**-56


def effect_context() -> dict[str, object]:
    """What the template of the generated effects needs, numbers as text."""
    with flint.ctx.workprec(BITS):
        depth, slope = wall_rows()
        constants = {
            "zener": nearest_double(_factor("zener_number")),
            "period": nearest_double(_factor("bending_period")),
            "wall_linear": above(Ball(3) / 2 * depth[0]),
            "wall_rest": above(wall_rest_ball()),
            "pressure_wall": float(WALL_EXTRA),
            "wall_growth": above(wall_growth_ball()),
        }
        arc = [nearest_double(to_ball(c)) for c in arc_coefficients()]
        rows = {
            "arc": arc,
            "wall_depth": [nearest_double(c) for c in depth],
            "wall_slope": [nearest_double(c) for c in slope],
        }
    return {
        "near": repr(float(NEAR)),
        **{name: repr(value) for name, value in constants.items()},
        **{name: wrapped(map(repr, row)) for name, row in rows.items()},
    }


def _factor(name: str) -> Ball:
    """The number in front of a formula of link 23: its value where every argument makes 1.

    E* is 1 for lam = 0 and mu = 1/2; the first mode's j_1 belongs to the number.
    """
    formula = {f.name: f for f in plate_motion()}[name]
    ones = {x.symbol: Ball(1) for x in formula.arguments}
    ones |= {lam: Ball(0), mu: Ball(1) / 2}
    if j_n in formula.expression.free_symbols:
        ones[j_n] = zero_of_j0(1, BITS)
    return enclose(formula.expression, ones)


def arc_coefficients() -> list[Fraction]:
    """1/3, 1/5, ... as far as they count beside 1/3 at t = NEAR; what follows is less again."""
    found: list[Fraction] = []
    while True:
        k = len(found)
        if NEAR**k / (2 * k + 3) / (1 - NEAR) < Fraction(NEGLIGIBLE) / 3:
            return found
        found.append(Fraction(1, 2 * k + 3))


def wall_rows() -> tuple[list[Ball], list[Ball]]:
    """Coefficients of -W/alpha and of its part of -S/alpha in alpha^2, as far as they count.

    At alpha = 1 neighbours are in the ratio 1/4 at most, so that what is left out is a third
    of the last.
    """
    depth: list[Ball] = []
    slope: list[Ball] = []
    factorial = Ball(6)
    for index, kappa in enumerate(kappas()[::2]):
        k = index + 2
        term = 8 * kappa * (2 * k - 2) / factorial / Ball.pi() ** 2
        depth.append(term)
        slope.append(term * Ball(2 * k - 1) / 2)
        if float(slope[-1] / slope[0]) < NEGLIGIBLE:
            return depth, slope
        factorial *= 2 * k * (2 * k + 1)
    raise ArithmeticError("the side wall's series needs more of kappa_n")


FOLDER = Path(__file__).parent
MODULES = (
    TemplateModule(
        "effects",
        FOLDER,
        effect_context,
        (
            FunctionRow(
                "sphere_contact", ("a_over_R",), "1", "", "7", "a sphere over a paraboloid"
            ),
            FunctionRow(
                "zener_number",
                ("R", "m", "v0", "h", "lam", "mu", "rho"),
                "1",
                r"\lambda_Z",
                "",
                "how much of the impact the plate's waves carry away",
            ),
            FunctionRow(
                "bending_period", ("h", "b", "lam", "mu", "rho"), "s", "T_1", "", "bending period"
            ),
            FunctionRow(
                "echo_time", ("h", "lam", "mu", "rho"), "s", "T_e", "", "time of two echoes"
            ),
            FunctionRow("side_wall", ("alpha",), "1", "W", "6", "what the finite radius adds"),
            FunctionRow(
                "bending", ("a_ratio", "eta"), "1", "F_B", "6", "what a thin plate's bending adds"
            ),
        ),
    ),
)
