"""Step 20, bound: the error of the law with Hertz pressure at given force.

Let a_H be the Hertz radius of the force P and S = (R/2 a_H) d delta/d a_H: S_T for the exact
pressure, S_H for Hertz pressure. N_0 = N(0, 0) adds N_0 a_H to both. With x = t/a the rest M(x, s)
of a N lies between -tau (x^2 + s^2) and 0, and M(x, s) - M(1, s) within tau (1 - x^2), where

    tau = Theta a^3,   Theta b^3 = (2/pi) sum w_n j_n^2 + (2/pi^2) int y sinh(g y)/g K0/I0 dy,

for every a <= g b/2. For a mode, 1 - cos x cos y <= (x^2 + y^2)/2 and |sin x cos y| <= x; for the
lateral surface (cosh z - 1)/z^2 and sinh(z)/z increase with z. The two parts of Theta are those of
-(15/2) c_3/h^3 except for sinh(g y)/g instead of y, which adds at most LATERAL_EXTRA to the sum.
Let tau <= 1/4.

The solution is chi = (E* a^2/(pi R)) (1 - x^2) z, and z differs from 1 by at most
zeta = (2 tau/3)/(1 - 2 tau/3): the equation minus its value at x = 1 gives
|z - 1| <= tau int (1 - s^2) |z| ds. Hence (a_H/a)^3, a mean of z, is within zeta of 1, and
theta = Theta a_H^3 >= (4/5) tau, zeta <= theta; theta < 1/5 keeps tau below 1/4 as P grows.

A flat punch without N_0 has 1 <= psi <= 1/(1 - 4 tau/3), for M <= 0 makes all terms of
Neumann's series positive, and 1 <= I = int psi dx <= 1 + (2 tau/3)/(1 - 4 tau/3). Now

    S_T = a_H N_0 + (a_H/a)/I,   S_H = a_H N_0 + 1 + int_0^1 M(x, 0) dx    (at a_H),

so that S_T - S_H is at least (1 - theta)^(1/3)/(1 + 5 theta/4) - 1 >= -(5/3) theta and at most
(1 + theta)^(1/3) - 1 + theta/3 <= (2/3) theta. Integrated, delta moves by (2/3) theta a_H^2/R.

Another edge adds N_s (t^2 + s^2 - 2 t^2 s^2/b^2)/h^3 to the kernel, a bracket between 0 and
t^2 + s^2. For N_s < 0, as of a thin supported plate, the argument is valid with |N_s| a^3/h^3 in
tau. For N_s > 0, as of a thin clamped plate, M may have either sign, |M| <= tau (x^2 + s^2). The
estimate of z remains valid; now |psi - 1| <= (4 tau/3)/(1 - 4 tau/3), |I - 1| is within the same (2
tau/3)/(1 - 4 tau/3) <= tau, and int M(x, 0) dx within tau/3, so that S_T - S_H is at most

    (1 + theta/3)/(1 - 5 theta/4) - 1 + theta/3 <= (5/2) theta

upwards, and less downwards: -(5/3) theta - theta/3.
"""

from functools import cache

import flint
import sympy as sp

from derivation.engine.formula.ball import refine
from derivation.engine.formula.proof import Proof, ProofError, prove
from derivation.plate.contact.theory.hertz import contact_radius
from derivation.plate.contact.theory.plate_series import coefficient, kappa_ball
from derivation.plate.impact.theory.sensitivity import reduced_modulus
from derivation.plate.modes.theory.plate_factor import plate_factors
from derivation.plate.vocabulary import J1, Formula, R, T, a, a_ratio, c_A, eta, j_n, kappa

WIDTH = sp.Rational(7, 8)
"""g: the actual contact radius is at most g b/2."""
WIDEST = sp.Rational(2, 5)
"""Largest ratio of the Hertz radius to that of the plate."""
LATERAL_EXTRA = sp.Rational(2, 25)
"""Upper bound of (2/pi^2) int (y sinh(g y)/g - y^2) K0/I0 dy."""
LARGEST = sp.Rational(1, 5)
"""Largest theta."""
BELOW, ABOVE, DEPTH = sp.Rational(5, 3), sp.Rational(2, 3), sp.Rational(2, 3)
"""Factors of theta in the bounds: of S downwards, of S upwards, of delta R/a^2."""
EITHER = sp.Rational(5, 2)
"""Factor of theta in the bound of S, both ways, if M has either sign."""

_x, _s, _y = sp.symbols("x s y", positive=True)
_tau, _theta = sp.symbols("tau theta", positive=True)


def lateral_ratio_ball(digits: int = 12) -> flint.arb:
    """Return int_0^oo y sinh(g y)/g K0/I0 dy over kappa_2.

    By parts, (K0/I0)' = -1/(y I0^2): int (y cosh(g y) - sinh(g y)/g)/(g^2 y I0^2) dy. Its tail is
    below e^y/(g^2 I0^2) <= pi^2 e y e^(-y)/g^2, as `contact.theory.split.lateral_tail` has I0.
    """

    def integrand(y: flint.acb, _: bool) -> flint.acb:
        u = g * y
        return (y * u.cosh() - u.sinh() / g) / (g**2 * y * y.bessel_i(0) ** 2)

    g = flint.arb(int(WIDTH.p)) / int(WIDTH.q)

    def compute() -> flint.arb:
        bits = flint.ctx.prec
        start, end = flint.arb(2) ** -(bits // 3), flint.arb(bits)
        with flint.ctx.workprec(2 * bits):
            body = flint.acb.integral(integrand, flint.acb(start), flint.acb(end)).real
        # Below `start` the integrand is below y^2, as u cosh u - sinh u <= u^3/2 for u <= 1.
        rest = (
            start**3 + flint.arb.pi() ** 2 * flint.arb.const_e() * (end + 1) * (-end).exp() / g**2
        )
        return (body + flint.arb(0, rest.upper())) / kappa_ball(2)

    return refine(compute, digits, "the contribution of the lateral surface")


@cache
def lateral_ratio() -> flint.arb:
    """Return the contribution as a ball; prove LATERAL_EXTRA and that a stays below g b/2.

    Raises
    ------
    ProofError
        If one of both fails.
    """
    ratio = lateral_ratio_ball()
    extra = 2 / flint.arb.pi() ** 2 * (ratio - 1) * kappa_ball(2)
    if not extra < flint.arb(int(LATERAL_EXTRA.p)) / int(LATERAL_EXTRA.q):
        raise ProofError(f"Bound for Hertz pressure: the contribution of the edge is {ratio}")
    # a^3 <= a_H^3/(1 - zeta) with zeta <= theta.
    if not WIDEST**3 / (1 - LARGEST) <= (WIDTH / 2) ** 3:
        raise ProofError("Bound for Hertz pressure: the actual contact may be too wide")
    return ratio


@cache
def estimates(slope: sp.Expr, depth: sp.Expr) -> Proof:
    """Prove the integrals and the inequalities between rational functions of the argument above.

    Each inequality is true because the difference is a product of factors of known sign, for tau <=
    1/4 or theta <= 1/5; cube roots lie below their tangents and above the cubed expressions.
    """
    zeta = 2 * _tau / 3 / (1 - 2 * _tau / 3)
    rise = 2 * _tau / 3 / (1 - 4 * _tau / 3)
    quarter = sp.Rational(1, 4)
    excess = plate_factors()[2].expression.subs(T, 2 * eta * j_n)
    third = coefficient(3)
    modes = 2 / sp.pi * excess / (j_n * J1**2) * j_n**2 * eta**3
    side = 2 / sp.pi**2 * kappa[2] * eta**3
    lower = 1 - 5 * _theta / 12
    either = (1 + _theta / 3) / (1 - 5 * _theta / 4)
    E = sp.Symbol("E", positive=True)
    force_rise = sp.diff(contact_radius().expression, a) * E / reduced_modulus()
    return prove(
        "Bound of the error of Hertz pressure",
        r"$\Theta a^3$ bounds the change of the kernel over the contact. The proof derives both "
        r"parts of $\Theta$, evaluates the integrals of the estimates, and writes each inequality "
        "as a product of factors of known sign.",
        lambda slope, depth: {
            "slope": slope.subs(c_A[3], third.mode + third.side) / (BELOW * a_ratio**3)
            - modes - side - LATERAL_EXTRA * eta**3,
            "depth": depth / DEPTH - slope / BELOW,
            "Theta of the modes": modes + sp.Rational(15, 2) * third.mode,
            "Theta of the finite radius": side + sp.Rational(15, 2) * third.side,
            "1 - cos x cos y": (1 - sp.cos(_x) * sp.cos(_y)).expand()
            - sp.expand_trig(
                (1 - sp.cos(_x + _y)) / 2 + (1 - sp.cos(_x - _y)) / 2,
            ).expand(),
            "squares": ((_x + _y) ** 2 / 2 + (_x - _y) ** 2 / 2).expand() / 2 - (_x**2 + _y**2) / 2,
            "z": sp.integrate(1 - _s**2, (_s, 0, 1)) - sp.Rational(2, 3),
            "zeta": sp.cancel(4 * _tau / 5 - zeta)
            - sp.cancel(8 * _tau / 15 * (quarter - _tau) / (1 - 2 * _tau / 3)),
            "1 - zeta": sp.Rational(4, 5) - (1 - sp.Rational(4, 5) * quarter),
            "psi": sp.integrate((_x**2 + _s**2).subs(_x, 1), (_s, 0, 1)) - sp.Rational(4, 3),
            "I": sp.integrate(_x**2 + _s**2, (_x, 0, 1), (_s, 0, 1)) - sp.Rational(2, 3),
            "I - 1": sp.cancel(_tau - rise)
            - sp.cancel(sp.Rational(4, 3) * _tau * (quarter - _tau) / (1 - 4 * _tau / 3)),
            "cube root": (1 - _theta - lower**3).expand()
            - (_theta * (quarter - 25 * _theta / 48 + 125 * _theta**2 / 1728)).expand(),
            "downwards": lower * (1 - 5 * _theta / 4) - (1 - BELOW * _theta) - 25 * _theta**2 / 48,
            "M(x, 0)": sp.integrate(_x**2, (_x, 0, 1)) - sp.Rational(1, 3),
            "upwards": sp.diff((1 + _theta) ** sp.Rational(1, 3), _theta).subs(_theta, 0)
            + sp.Rational(1, 3)
            - ABOVE,
            "either sign": sp.cancel(EITHER * _theta - (either - 1 + _theta / 3))
            - sp.cancel(_theta * (14 - 65 * _theta) / 24 / (1 - 5 * _theta / 4)),
            "S_T": R / (2 * a) * force_rise / (2 * E) - a,
            "indentation": 2 / R * sp.integrate(BELOW * _s * (_s / a) ** 3, (_s, 0, a))
            - DEPTH * a**2 / R,
        },
        *(slope, depth),
    )  # fmt: skip


@cache
def pressure_bound() -> tuple[Formula, Formula]:
    """Return bounds of |S_T - S_H| and of |delta_T - delta_H| R/a^2 at the Hertz radius a.

    c_3 < 0 for every plate, because both of its parts are negative: the bounds are positive.
    """
    lateral_ratio()
    factor = LATERAL_EXTRA * eta**3 - sp.Rational(15, 2) * c_A[3]
    theta = factor * a_ratio**3
    proof = estimates(BELOW * theta, DEPTH * theta)
    holds = (f"({factor}) * a_ratio**3 <= {LARGEST}", f"a_ratio * eta <= {WIDEST}")

    def bound(name: str, latex: str, what: str, multiple: sp.Rational) -> Formula:
        return Formula(
            name,
            latex,
            f"bound of the error of {what} with Hertz pressure at given force",
            multiple * theta,
            "1",
            "",
            ("c_3_modes", "c_3_lateral", "k_modes", "k_lateral"),
            proof,
            where=holds,
        )

    return (
        bound(
            "pressure_slope_bound", r"|\Delta S|_{\max}", r"the slope $(R/2a) d \delta/da$", BELOW
        ),
        bound(
            "pressure_indentation_bound", r"|\Delta\delta|_{\max} R/a^2", r"$\delta R/a^2$", DEPTH
        ),
    )
