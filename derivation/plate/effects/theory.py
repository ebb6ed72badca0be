"""Step 22: bounds of the change of the contact law by each effect, before it is computed.

All bounds refer to S = (R/2a) d delta/da at equal force, a being the Hertz radius. The half-space
has S = 1, and every effect adds a contribution. With A = a/h, alpha = a/b and c_1, K_3 of step 18:

    bending             3/2 A/(4 pi eta^2), exactly
    finite radius       between -(4/pi^2) (kappa_0 alpha + k_3 alpha^3) and 0
    finite thickness    the rest of 3/2 c_1 A - K_3 A^3 <= S - 1 <= 3/2 c_1 A
    spherical profile   a_H/a - 1 of step 21, between 0 and its value at a/R = a_H/R
    elastic sphere      s^2 - 1 and at most (s^2 - 1) K A^3 either way, s^3 = 1 + E*/E_1*

Weight. v^2 at equal fractions of the peak indentation is (2/m) [U_m - U - m g (delta_m - delta)],
and because U is convex, U_m - U >= U_m (1 - delta/delta_m). With e = m g delta_1/E, delta_1 the
largest indentation without weight, the energy of the contact grows by a factor between 1 and
1/(1 - e), and the contact time by one between 1 and 1/sqrt(1 - e).
"""

from functools import cache

import flint
import sympy as sp

from derivation.engine.formula.proof import Proof, prove
from derivation.plate.contact.theory.plate_series import coefficient
from derivation.plate.contact.theory.thin_plate import thin_plate
from derivation.plate.impact.theory.substitution import lateral_integral, one_sided
from derivation.plate.vocabulary import Formula, a_ratio, alpha, c_A, eta, kappa

_y, _u, _q = sp.symbols("y u q", positive=True)
_g, _e = sp.symbols("g e", positive=True)
_s = sp.Symbol("s", positive=True)


@cache
def bending() -> Formula:
    """Return the leading term of a thin plate as an effect of its own: delta = P b^2/(8 pi D)."""
    first = {formula.name: formula for formula in thin_plate()}["c_1_thin"].expression
    contribution = sp.limit(first * eta**2, eta, 0) * a_ratio / eta**2
    radius, half, wide, sphere, modulus = sp.symbols("a h b R E", positive=True)
    force = sp.Rational(4, 3) * modulus * radius**3 / sphere
    rigidity = modulus * (2 * half) ** 3 / 12
    deflection = force * wide**2 / (8 * sp.pi * rigidity)
    proof = prove(
        "Bending",
        r"The leading term of $c_1 A$ for $h/b \to 0$ is the deflection $P b^2/(8 \pi D)$ of a "
        "thin plate, $D = E^* (2h)^3/12$, divided by $a^2/R$.",
        lambda contribution: {
            "deflection": contribution.subs({a_ratio: radius / half, eta: half / wide})
            - deflection * sphere / radius**2
        },
        contribution,
    )
    return Formula(
        "F_bending",
        "F_B",
        r"contribution of bending to $\delta R/a^2$",
        contribution,
        "1",
        "6",
        ("c_1_thin",),
        proof,
        where=("a_ratio * eta < 1",),
    )


@cache
def thickness_bound() -> Formula:
    """Return an upper bound of the finite thickness's contribution to S: the rest of 3/2 c_1 A."""
    one_sided()
    first, bent = coefficient(2), bending().expression / a_ratio
    lateral = -4 / sp.pi**2 * kappa[0] * alpha
    most = sp.Rational(3, 2) * (c_A[1] * a_ratio - bending().expression) - lateral
    proof = prove(
        "Contributions to the slope of the law",
        "The contribution of finite thickness is that of the modes minus that of bending. That of "
        "the modes is at most $(3/2) c_1 A$ minus the part of the finite radius in it, "
        r"$-(4/\pi^2) \kappa_0 \alpha$.",
        lambda most: {
            "finite radius": sp.Rational(3, 2) * first.side * a_ratio
            - lateral.subs(alpha, a_ratio * eta),
            "sum": most + lateral + sp.Rational(3, 2) * (bent - c_A[1]) * a_ratio,
        },
        most,
    )
    return Formula(
        "S_thickness_bound",
        r"S_H",
        r"upper bound of the contribution of finite thickness to $(R/2a) d \delta/da$",
        most,
        "1",
        "6",
        ("S_bound", "F_bending"),
        proof,
        where=("a_ratio * eta < 1",),
    )


@cache
def elastic_sphere() -> Proof:
    """Prove the bound for an elastic sphere: the half-space's part grows by s^2.

    Each mode has s sinc(s y)/s instead of sinc y, and |sinc'| <= y/3; the finite radius has
    sinh(s y)/s, whose powers grow by s^(2k) - 1 <= k (s^2 - 1) s^(2k-2) for s alpha < 1.
    """
    order = sp.Symbol("k", integer=True, positive=True)
    slope = sp.diff(sp.sin(_y) / _y, _y) * _y**2
    # |sinc'| = (sin y - y cos y)/y^2 <= y/3: the difference vanishes at 0 and increases.
    rises = sp.diff(_y**3 / 3 + slope, _y) - (_y**2 - _y * sp.sin(_y))
    odd = _u ** (2 * order + 1) / sp.factorial(2 * order + 1)
    return prove(
        "Elastic sphere",
        "Integrated from y to s y, |sinc'| <= y/3 gives (s^2 - 1) y^2/6; sum k u^(2k+1)/(2k+1)! "
        "is (u cosh u - sinh u)/2.",
        {
            "sinc": rises,
            "integral": sp.integrate(_u / 3, (_u, _y, _s * _y)) - (_s**2 - 1) * _y**2 / 6,
            "power": sp.simplify(order - (_u * sp.diff(odd, _u) / odd - 1) / 2),
            "sum": (_u * sp.diff(sp.sinh(_u), _u) - sp.sinh(_u)) / 2
            - (_u * sp.cosh(_u) - sp.sinh(_u)) / 2,
        },
    )


@cache
def weight() -> Proof:
    """Prove the bounds for energy and time with weight by the convexity of U."""
    whole, fraction = sp.symbols("U_m x", positive=True)
    # v^2 m/2 at the fraction x of delta_m is smallest for U on its chord.
    speed = whole * (1 - fraction) - _g * (1 - fraction)
    return prove(
        "Weight during contact",
        "U <= U_m x by convexity; U_g = E + m g delta_g <= E + m g delta_1 U_g/E, because "
        "delta grows no faster than U.",
        {
            "chord": speed - whole * (1 - fraction) * (1 - _g / whole),
            "energy": sp.solve(_u - 1 - _e * _u, _u)[0] - 1 / (1 - _e),
        },
    )


def effects() -> tuple[Formula, ...]:
    """Return the formulas of the step; its lemmas are proved as well."""
    elastic_sphere()
    weight()
    return bending(), thickness_bound()


# --- numbers, as balls


def lateral_growth_ball(digits: int = 12) -> flint.arb:
    """Return (4/pi^2) int_0^oo (y cosh y - sinh y)/(2 y) K0/I0 dy.

    By parts, with (sinh y - Shi y)/2 divided by y I0^2. This is below y^3/12 + y^5/100 for y <= 1
    and below e^y/4 for larger y.
    """

    def integrand(y: flint.acb, _: bool) -> flint.acb:
        return (y.sinh() - y.shi()) / (2 * y * y.bessel_i(0) ** 2)

    return lateral_integral(integrand, digits, "the growth of the finite-radius term")
