"""Step 21: a sphere instead of a paraboloid, for a and delta not small against R (Sneddon 1965).

A flat punch of radius c with force dP is displaced by d delta = dP/(2 E* c) and deflects the
surface by

    dw(r) = d delta (2/pi) arcsin(c/r)    for r > c.

A contact that grows from 0 to a in steps of flat punches matches the profile f if

    f(r) = (2/pi) int_0^r arccos(c/r) delta'(c) dc    for r <= a.

For the sphere, f = R - sqrt(R^2 - r^2), this is solved by delta = (a/2) log((R+a)/(R-a)). At equal
force, with the Hertz radius a_H, a_H^3 = 3 P R/(4 E*), the half-space's part of
S = (R/2a_H) d delta/d a_H is a_H/a. It is 1 at a = 0 and increases with a.
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import Proof, ProofError, prove
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS, influence_coefficients
from derivation.plate.vocabulary import Formula, R, a, phi, r

_c, _x, _s = sp.symbols("c x s", positive=True)
_m = sp.Symbol("m", integer=True, nonnegative=True)
_k = sp.Symbol("k", integer=True, positive=True)
LOGARITHM = sp.log((R + a) / (R - a))


@cache
def flat_punch() -> Proof:
    """Prove the pressure and the deflection of a flat punch, arcsin(c/r) outside it.

    The pressure is p = dP/(2 pi c sqrt(c^2 - s^2)). Its Fourier-Bessel transform is
    dP sin(c phi)/(2 pi c phi), by power series. With the half-space's influence coefficient,
    w = dP/(pi c E*) int_0^oo sin(c phi)/phi J0(phi r) dphi. Differentiated with respect to
    c, this is the integral of cos(c phi) J0(phi r), the real part of the Laplace transform of J0
    at i c:
    1/sqrt(r^2 - c^2) for c < r and 0 for c > r.
    """
    bessel = (-1) ** _m / (4**_m * sp.factorial(_m) ** 2)
    moment = sp.sqrt(sp.pi) / 2 * sp.gamma(_m + 1) / sp.gamma(_m + sp.Rational(3, 2))
    sine = (-1) ** _m / sp.factorial(2 * _m + 1)
    half_space = influence_coefficients()[2].expression
    transform = sp.laplace_transform(sp.besselj(0, r * _x), _x, _s, noconds=True)
    outside = sp.diff(sp.asin(_c / r), _c) - 1 / sp.sqrt(r**2 - _c**2)
    return prove(
        "Flat punch",
        "The transform is compared by its power series, and the influence coefficient is that of a "
        "half-space. The Laplace transform of J0 on the imaginary axis is integrated from c = 0.",
        {
            "transform": sp.combsimp(sp.gammasimp(bessel * moment / sine)) - 1,
            "half-space": half_space * phi * PLANE_STRAIN_MODULUS - 2,
            "Laplace": transform - 1 / sp.sqrt(_s**2 + r**2),
            "outside the punch": outside.subs(r, sp.sqrt(_c**2 + _x**2)),
            "at its edge": sp.asin(1) - sp.pi / 2,
        },
    )


@cache
def spherical_contact() -> tuple[Formula, Formula]:
    """Return indentation and force of a sphere on a half-space, as functions of contact radius."""
    flat_punch()
    depth = a / 2 * LOGARITHM
    force = PLANE_STRAIN_MODULUS * ((a**2 + R**2) / 2 * LOGARITHM - a * R)
    # delta' = sum 2k/(2k-1) a^(2k-1)/R^(2k-1); int_0^1 arccos(u) u^(2k-1) du by parts.
    slope = 2 * _k / (2 * _k - 1)
    arc = sp.sqrt(sp.pi) / 2 * sp.gamma(_k + sp.Rational(1, 2)) / sp.gamma(_k + 1) / (2 * _k)
    profile = sp.binomial(2 * _k, _k) / (4**_k * (2 * _k - 1))
    ratio = (2 / sp.pi * slope * arc / profile).rewrite(sp.gamma)
    inner = (R + a) / (R - a) - (1 + a / R) / (1 - a / R)
    atanh_slope = sp.diff(sp.log((1 + _x) / (1 - _x)) / 2, _x)
    proof = prove(
        "Sphere on a half-space",
        r"$\delta'$ is expanded in $a$ and gives the profile of the sphere power by power. $dP = "
        r"2 E^* a d \delta$ gives the force. For $a/R \to 0$ both tend to Hertz's law.",
        lambda depth, force: {
            "profile": sp.simplify(sp.gammasimp(ratio)) - 1,
            "slope": sp.diff(depth, a) - atanh_slope.subs(_x, a / R) * a / R - depth / a,
            "geometric series": atanh_slope - 1 / (1 - _x**2),
            "argument of the logarithm": inner,
            "force": sp.diff(force, a) - 2 * PLANE_STRAIN_MODULUS * a * sp.diff(depth, a),
            "point of contact": force.subs(a, 0),
            "Hertz indentation": sp.limit(depth * R / a**2, a, 0) - 1,
            "Hertz force": sp.limit(force * R / a**3, a, 0)
            - PLANE_STRAIN_MODULUS * sp.Rational(4, 3),
        },
        *(depth, force),
    )
    _powers()
    sources = "C_top", "p"
    return (
        Formula(
            "delta_sphere",
            r"\delta",
            "indentation of a half-space by an exact sphere",
            depth,
            "m",
            "7",
            sources,
            proof,
        ),
        Formula(
            "P_sphere",
            "P",
            "force of an exact sphere on a half-space",
            force,
            "N",
            "7",
            sources,
            proof,
        ),
    )


def _powers() -> None:
    """Check that delta' has the coefficients that `spherical_contact` uses, up to the tenth power.

    Raises
    ------
    ProofError
        If a coefficient differs.
    """
    slope = sp.diff(_x / 2 * sp.log((1 + _x) / (1 - _x)), _x)
    expanded = sp.series(slope, _x, 0, 11).removeO()
    for k in range(1, 6):
        if expanded.coeff(_x, 2 * k - 1) != sp.Rational(2 * k, 2 * k - 1):
            raise ProofError(f"delta' of the sphere: power {2 * k - 1} differs")


@cache
def growth() -> Proof:
    """Prove S = a_H/a at equal force; it increases: (a_H/a)^3 has positive coefficients."""
    depth, force = (formula.expression for formula in spherical_contact())
    radius = sp.cbrt(3 * R * force / (4 * PLANE_STRAIN_MODULUS))
    order = sp.Symbol("n", integer=True, positive=True)
    # (3/4) P/(E* R^2) = (3/4) sum 4n/(4n^2 - 1) (a/R)^(2n+1)
    term = 1 / (2 * order + 1) + 1 / (2 * order - 1)
    return prove(
        "Slope of the sphere's law",
        "d delta/d a_H = (4 E* a_H^2/R)/(2 E* a). P expanded in a/R has the coefficients "
        "4n/(4n^2 - 1) > 0, so a_H/a grows with a, and with a_H.",
        {
            "slope": (R / (2 * radius) * sp.diff(depth, a) / sp.diff(radius, a)) - radius / a,
            "coefficients": term - 4 * order / (4 * order**2 - 1),
        },
    )


def spherical_profile() -> tuple[Formula, ...]:
    """Return the formulas of the step, after proving that the slope increases."""
    growth()
    return spherical_contact()
