"""Step 8: Hertz pressure (7) -> its Fourier-Bessel coefficients A_j, (4) and (8).

Sonine's integral is proved by comparing power series; the relation between contact radius and force
follows from the half-space's influence coefficient.
"""

from functools import cache

import sympy as sp

from derivation.engine.cache import in_file
from derivation.engine.formula.proof import Proof, lower_bessel, prove
from derivation.plate.modes.theory.influence import influence_coefficients
from derivation.plate.vocabulary import J1, Formula, P, R, a, b, phi, r

SOURCES = (
    "engine/cache.py",
    "engine/formula",
    "mathematics",
    "plate/vocabulary.py",
    "plate/modes/theory",
    "plate/contact/theory",
)
"""Sources on which the formulas of a contact depend."""
_m = sp.Symbol("m", integer=True, nonnegative=True)
_y, _t, _s = sp.symbols("y t s", positive=True)

SINE_MINUS = sp.sin(a * phi) - a * phi * sp.cos(a * phi)
"""s(a phi), with s(y) = sin y - y cos y."""


@cache
def pressure() -> Formula:
    """Return Hertz's pressure of resultant P on the contact disc, compression negative."""
    peak = sp.Symbol("p_0", real=True)
    resultant = -2 * sp.pi * sp.integrate(peak * _t * a**2 * sp.sqrt(1 - _t**2), (_t, 0, 1))
    (solution,) = sp.solve(resultant - P, peak)
    shape = sp.sqrt(1 - r**2 / a**2)
    proof = prove(
        "Hertz pressure",
        "The resultant of the pressure over the contact area is $P$; half an ellipsoid is 3/2 "
        "times as high at the centre as in the mean.",
        lambda p: {
            "resultant": resultant.subs(peak, p / shape) - P,
            "compression": sp.Abs(p / shape) + p / shape,
            "largest over mean pressure": p.subs(r, 0) / (P / (sp.pi * a**2)) + sp.Rational(3, 2),
        },
        solution * shape,
    )
    return Formula(
        "p",
        "p(r)",
        r"Hertz pressure at $r \le a$, negative in compression",
        solution * shape,
        "Pa",
        "7",
        (),
        proof,
        where=("r <= a",),
    )


@cache
def sonine() -> Formula:
    """Return int_0^a r sqrt(1 - r^2/a^2) J0(phi r) dr, proved by its power series in phi.

    J0's series, which converges absolutely, is integrated term by term (each term is a Beta
    integral). Every coefficient equals that of (sin y - y cos y)/y^3, y = a phi, times a^2.
    """
    bessel = (-1) ** _m / (4**_m * sp.factorial(_m) ** 2)
    integral = (
        sp.gamma(_m + 1) * sp.gamma(sp.Rational(3, 2)) / (2 * sp.gamma(_m + sp.Rational(5, 2)))
    )
    order = 2 * _m + 3
    closed = (-1) ** (_m + 1) * (1 / sp.factorial(order) - 1 / sp.factorial(order - 1))
    ratio = sp.gammasimp((bessel * integral / closed).rewrite(sp.gamma))
    value = SINE_MINUS / (a * phi**3)
    series = sp.series(sp.sin(_y) - _y * sp.cos(_y), _y, 0, 10).removeO()
    proof = prove(
        "Sonine's integral",
        "$J_0$'s power series is integrated term by term: the ratio of every coefficient to that "
        r"of $a^2 (\sin y - y \cos y)/y^3$, $y = a \phi$, is 1.",
        lambda value: (
            {
                "ratio of coefficients - 1": sp.simplify(ratio) - 1,
                "in y": value.subs(phi, _y / a) - a**2 * (sp.sin(_y) - _y * sp.cos(_y)) / _y**3,
            }
            | {
                f"closed coefficient of y^{2 * k}": closed.subs(_m, k) - series.coeff(_y, 2 * k + 3)
                for k in range(4)
            }
        ),
        value,
    )
    return Formula(
        "sonine",
        r"\int_0^a r\sqrt{1-r^2/a^2}\,J_0(\phi_j r)\,dr",
        "Sonine's integral",
        value,
        "m^2",
        "8",
        (),
        proof,
    )


def dirichlet_under_bessel() -> tuple[sp.Expr, sp.Expr]:
    """Return int_0^oo sin(phi t) J0(phi r)/phi dphi for t < r and for t >= r.

    J0(phi r) = (2/pi) int_0^(pi/2) cos(phi r sin theta) dtheta turns the integral into Dirichlet's,
    which is pi/2 where r sin theta < t and 0 beyond. The result is the length of that interval of
    theta.
    """
    dirichlet = sp.integrate(sp.sin(_y) / _y, (_y, 0, sp.oo))
    return 2 / sp.pi * dirichlet * sp.asin(_t / r), 2 / sp.pi * dirichlet * sp.pi / 2


@in_file(SOURCES, Formula, Proof)  # modules of kernels need it when they are imported
def contact_radius() -> Formula:
    """Return Hertz's relation between a and P in (7), for a sphere on the half-space.

    The pressure's Hankel transform is Sonine's integral. Since
    s(a phi)/phi^2 = int_0^a t sin(phi t) dt, the surface displacement under the pressure is a
    parabola in r, which must match the sphere's profile r^2/(2R).
    """
    radius = sp.Symbol("r", positive=True)
    near, far = (value.subs(r, radius) for value in dirichlet_under_bessel())
    kernel = sp.integrate(_t * near, (_t, 0, radius)) + sp.integrate(_t * far, (_t, radius, a))
    half = influence_coefficients()[2].expression
    transform = pressure().expression.subs(r, 0) * sonine().expression
    amplitude = sp.simplify(half * transform * phi / (SINE_MINUS / phi**3))
    deflection = sp.expand(amplitude * kernel)
    curvature = sp.diff(deflection, radius, 2) - 1 / R
    force = sp.factor(sp.solve(curvature, P)[0])
    moment = sp.integrate(_t * sp.sin(phi * _t), (_t, 0, a))
    proof = prove(
        "Hertz contact radius",
        r"Under this pressure the surface of the half-space is, for $r \le a$, a parabola with "
        r"the curvature $1/R$ of the sphere and the depth $a^2/R$ at the centre.",
        lambda force: {
            "moment of the sine": moment - SINE_MINUS / phi**2,
            "curvature": curvature.subs(P, force),
            "higher powers of r": sp.diff(deflection, radius, 3),
            "indentation": -deflection.subs(P, force).subs(radius, 0) - a**2 / R,
        },
        force,
    )
    return Formula(
        "P",
        "P",
        "contact force of Hertz pressure with contact radius a",
        force,
        "N",
        "7",
        ("p", "sonine", "C_half"),
        proof,
    )


def norm_of_bessel() -> tuple[sp.Expr, Proof]:
    """Return b^2 J1^2/2, and prove that it or 0 is int_0^b r J0(phi_i r) J0(phi_j r) dr.

    Both antiderivatives are checked by differentiation; their values at the limits follow from
    J0(b phi) = 0.
    """
    k = sp.Symbol("k", positive=True)
    j0, j1 = sp.besselj(0, phi * r), sp.besselj(1, phi * r)
    i0, i1 = sp.besselj(0, k * r), sp.besselj(1, k * r)
    square = r**2 / 2 * (j0**2 + j1**2)
    product = r * (phi * j1 * i0 - k * j0 * i1) / (phi**2 - k**2)
    norm = square.subs({j0: 0, j1: J1}).subs(r, b)
    return norm, prove(
        "Orthogonality",
        r"Lommel's antiderivatives are differentiated and give "
        r"$r J_0(\phi r)^2$ and $r J_0(\phi r) J_0(k r)$.",
        {
            "norm": lower_bessel(sp.diff(square, r)) - r * j0**2,
            "orthogonality": lower_bessel(sp.diff(product, r)) - r * j0 * i0,
        },
    )


@cache
def pressure_coefficient() -> Formula:
    """Return A_j of (4) and (8): the pressure's moment, Sonine's integral, over the mode's norm."""
    norm, orthogonality = norm_of_bessel()
    peak = pressure().expression.subs(r, 0).subs(P, contact_radius().expression)
    moment = peak * sonine().expression
    expression = sp.factor(moment / norm / SINE_MINUS) * SINE_MINUS
    proof = prove(
        "Pressure coefficients",
        f"{orthogonality.argument} The moment of the pressure is Sonine's integral times $p(0)$.",
        lambda A_j: {"moment": A_j * norm - moment},
        expression,
    )
    return Formula(
        "A_j",
        "A_j",
        "Fourier-Bessel coefficient of Hertz pressure",
        expression,
        "Pa",
        "8",
        ("p", "sonine", "P"),
        proof,
    )
