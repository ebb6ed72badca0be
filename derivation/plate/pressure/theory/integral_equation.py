"""Step 20: the non-Hertzian contact pressure: an integral equation with a smooth kernel.

The pressure is written as q(r) = -int_r^a chi'(t)/sqrt(t^2 - r^2) dt, chi(a) = 0, so that its
Hankel transform is int_0^a chi cos(phi t) dt and its resultant P = 2 pi int_0^a chi dt. Abel's
operator d/dt int_0^t r(.)/sqrt(t^2 - r^2) dr turns the condition that the surface follows the
sphere for r < a into

    chi(t) + int_0^a N(t, s) chi(s) ds = (E*/pi) (delta - f(t)),
    N(t, s) = [k((t + s)/b) + k((t - s)/b)]/(2 b),

f = t^2/R for the paraboloid and t artanh(t/R) for the sphere. The part G = 1 of the modes gives
chi itself and the lateral surface's part of k by the sum identity of step 12, as cos(t z) times
the transform is entire, grows slower than e^(2 |Im z|) for t < b, and decreases like 1/z^2. The
kernel is the derivative of the law's slope: k = dS/d alpha, S = (R/2a) d delta/da of Hertz
pressure. chi(a) = 0 determines delta. A flat punch, (I + N) psi = 1, gives the stiffness.
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import Proof, prove
from derivation.plate.contact.theory.hertz import contact_radius, norm_of_bessel, pressure
from derivation.plate.contact.theory.plate_series import coefficient
from derivation.plate.contact.theory.split import LATERAL, contour
from derivation.plate.impact.theory.sensitivity import law_slopes, reduced_modulus
from derivation.plate.impact.theory.substitution import slope_law
from derivation.plate.modes.theory.influence import influence_coefficients
from derivation.plate.modes.theory.plate_factor import plate_factors
from derivation.plate.pressure.theory.bound import pressure_bound
from derivation.plate.pressure.theory.remaining_curvature import remaining_curvature
from derivation.plate.pressure.theory.results import results, substitution
from derivation.plate.vocabulary import (
    J1,
    Formula,
    P,
    R,
    T,
    a,
    a_ratio,
    alpha,
    b,
    c_A,
    eta,
    h,
    j_n,
    phi,
    r,
)

_t, _s, _u, _x, _y = sp.symbols("t s u x y", positive=True)
_m = sp.Symbol("m", integer=True, nonnegative=True)
_MODULUS = sp.Symbol("E", positive=True)
ORDER = 4
"""Power of a/h up to which the law at given force is expanded."""


@cache
def abel_of_bessel() -> Proof:
    """Prove int_0^t r J0(phi r)/sqrt(t^2 - r^2) dr = sin(phi t)/phi by its power series."""
    bessel = (-1) ** _m / (4**_m * sp.factorial(_m) ** 2)
    # int_0^1 x^(2m+1)/sqrt(1 - x^2) dx, a Beta integral.
    moment = sp.gamma(_m + 1) * sp.gamma(sp.Rational(1, 2)) / (2 * sp.gamma(_m + sp.Rational(3, 2)))
    ratio = sp.gammasimp(
        (bessel * moment * sp.factorial(2 * _m + 1) * (-1) ** _m).rewrite(sp.gamma)
    )
    return prove(
        "Abel's integral of J0",
        "J0's power series is integrated term by term: every coefficient is that of the sine.",
        {"ratio of coefficients - 1": sp.simplify(ratio) - 1},
    )


@cache
def representation() -> Proof:
    """Prove transform, resultant and Hertz's case of the pressure that chi represents.

    The transform is -int chi' sin(phi t)/phi dt by the integral above, by parts int chi cos.
    """
    abel_of_bessel()
    chi = sp.Function("chi")(_t)
    by_parts = sp.diff(chi * sp.sin(phi * _t) / phi, _t) - sp.diff(chi, _t) * sp.sin(phi * _t) / phi
    hertz = _MODULUS / (sp.pi * R) * (a**2 - _t**2)
    # t = sqrt(r^2 + (a^2 - r^2) u^2) makes dt/sqrt(t^2 - r^2) = sqrt(a^2 - r^2) du/t.
    integrand = sp.cancel(-sp.diff(hertz, _t) / _t)
    peak = a * sp.integrate(integrand, (_u, 0, 1))
    force = 2 * sp.pi * sp.integrate(hertz, (_t, 0, a))
    return prove(
        "Pressure by its Abel transform",
        "The transform is integrated by parts, with chi(a) = 0. chi = (E*/(pi R)) (a^2 - t^2) "
        "gives Hertz's force and pressure.",
        {
            "by parts": sp.expand(by_parts - chi * sp.cos(phi * _t)),
            "Hertz's force": (force - contact_radius().expression).subs(
                _MODULUS, reduced_modulus()
            ),
            "Hertz's pressure": pressure().expression.subs({P: force})
            + peak * sp.sqrt(1 - r**2 / a**2),
        },
    )


def profile() -> tuple[sp.Expr, sp.Expr]:
    """Return f(t) of the paraboloid and of the sphere, Abel's transform of the profile's depth."""
    return _t**2 / R, _t / 2 * sp.log((R + _t) / (R - _t))


@cache
def profiles() -> Proof:
    """Prove Abel's operator on the sphere's profile: f = t int_0^t depth'/sqrt(t^2 - r^2) dr.

    For the sphere depth' = r/sqrt(R^2 - r^2); with v^2 = (t^2 - r^2)/(R^2 - r^2) the integrand is
    -v'/(1 - v^2), and v decreases from t/R to 0. Without the plate, chi = (E*/pi) (f(a) - f(t)).
    """
    parabola, sphere = profile()
    angle = sp.Symbol("theta", positive=True)
    square = (_t**2 - r**2) / (R**2 - r**2)
    # v' = (v^2)'/(2 v), and r/((R^2 - r^2) v) is what is integrated.
    integrand = -sp.diff(square, r) / (2 * (1 - square)) - r / (R**2 - r**2)
    depth, force = sneddon()
    return prove(
        "Abel's transform of the sphere",
        "For the paraboloid r = t sin(theta) is substituted; for the sphere an antiderivative is "
        "differentiated. Without the plate delta = f(a) and dP/da = 2 E* a d delta/da.",
        {
            "paraboloid": _t * sp.integrate(_t * sp.sin(angle) / R, (angle, 0, sp.pi / 2))
            - parabola,
            "sphere": sp.cancel(integrand),
            "artanh": sp.diff(sphere / _t, _t) - R / (R**2 - _t**2),
            "at 0": sp.limit(sphere / _t, _t, 0),
            "indentation": sphere.subs(_t, a) - depth,
            "force": sp.diff(force, a) - 2 * _MODULUS * a * sp.diff(depth, a),
            "no contact": sp.limit(force, a, 0),
            "Hertz's indentation": sp.series(depth, a, 0, 4).removeO() - a**2 / R,
        },
    )


def sneddon() -> tuple[sp.Expr, sp.Expr]:
    """Return indentation and force of a sphere on the half-space (Sneddon 1965), E* a symbol."""
    logarithm = sp.log((R + a) / (R - a))
    return a / 2 * logarithm, _MODULUS * ((a**2 + R**2) / 2 * logarithm - a * R)


@cache
def kernel() -> tuple[Formula, Formula]:
    """Return both parts of k: one mode's term, and the integral of the lateral surface."""
    contour()
    norm_of_bessel()
    representation()
    G = plate_factors()[0].expression.subs(T, 2 * phi * h)
    half = influence_coefficients()[2].expression
    # A mode's coefficient is 2 Q/(b^2 J1^2); its deflection is cos(phi t) by Abel's operator.
    load = 2 * sp.cos(phi * _s) / (b**2 * J1**2)
    one_mode = reduced_modulus() / sp.pi * half * G * load * sp.cos(phi * _t)
    weight = plate_factors()[2].expression.subs(T, 2 * eta * j_n) / (j_n * J1**2)
    mode = 4 / sp.pi * weight * sp.cos(alpha * j_n)
    lateral = sp.Integral(-4 / sp.pi**2 * sp.cosh(alpha * _y) * LATERAL, (_y, 0, sp.oo))

    def paired(part: sp.Expr) -> sp.Expr:
        ends = (part.subs(alpha, (_t + sign * _s) / b) for sign in (1, -1))
        return sp.Add(*ends) / (2 * b)

    # f of the sum identity: one mode's term with G = 1 is f(j_n)/(j_n J1^2), j_n = b phi.
    f = 4 / (sp.pi * b) * sp.cos(_x * _t / b) * sp.cos(_x * _s / b)
    both = f.subs(_x, sp.I * _y) + f.subs(_x, -sp.I * _y)
    slope = law_slopes()[1].expression, slope_law().expression.function
    (height,) = slope_law().expression.variables
    bessel = sp.besselk(0, height) / sp.besseli(0, height)
    scaled = {eta: h / b, j_n: b * phi}
    proof = prove(
        "Kernel of the contact's integral equation",
        r"Abel's operator gives the deflection of a mode under $\chi$. With $G = 1$ the sum "
        r"identity gives $(2/\pi) \int \cos(x t) \cos(x s) dx$, whose contribution is $\chi$, and "
        "the part of the lateral surface. Finally, $S$ is differentiated.",
        lambda mode, lateral: {
            "one mode": one_mode - f.subs(_x, b * phi) / (b * phi * J1**2) * G,
            "thickness": f.subs(_x, b * phi) / (b * phi * J1**2) * (G - 1)
            - _spread(paired(mode).subs(scaled), sp.cos),
            "half-space": f / 2 * b - 2 / sp.pi * sp.cos(_x * _t / b) * sp.cos(_x * _s / b),
            "finite radius": -both / (2 * sp.pi)
            - _spread(paired(lateral.function / LATERAL), sp.cosh),
            "slope of the modes": sp.diff(slope[0], alpha) - mode,
            "slope of the radius": sp.diff(slope[1] / bessel, alpha).subs(height, _y) * LATERAL
            - lateral.function,
        },
        *(mode, lateral),
    )
    sources = ("slope_modes", "slope_lateral", "C_half", "G")
    return (
        Formula(
            "k_modes",
            r"k_h(\alpha)",
            r"contribution of the finite thickness to the kernel, for $(t + s)/b$ and $(t - s)/b$",
            mode,
            "1",
            "",
            sources,
            proof,
            summed=True,
        ),
        Formula(
            "k_lateral",
            r"k_b(\alpha)",
            "contribution of the lateral surface to the kernel",
            lateral,
            "1",
            "",
            sources,
            proof,
        ),
    )


def _spread(expression: sp.Expr, function: type[sp.Function]) -> sp.Expr:
    """Return the expression with addition theorems applied to functions of a sum."""
    return expression.replace(function, lambda x: sp.expand_trig(function(sp.expand(x)))).expand()


@cache
def motion_of_the_edge() -> Proof:
    """Prove dP/d delta = 2 E* int psi, (I + N) psi = 1, the stiffness of the flat punch.

    The equation is differentiated with respect to a: chi(a) = 0 leaves no term of the moving
    end, and (I + N) d chi/da = (E*/pi) d delta/da. A constant part N_0 of the kernel is a
    compliance N_0/(2 E*) in series with the rest.
    """
    whole, rest, constant, rise = sp.symbols("W I N_0 delta_a", positive=True)
    # (I + rest) psi = 1 - N_0 int psi, hence psi is (1 - N_0 W) times that of the rest.
    (stiffness,) = sp.solve(whole - (1 - constant * whole) * rest, whole)
    force = 2 * sp.pi * _MODULUS / sp.pi * rise * whole
    return prove(
        "Stiffness of the contact",
        "The integral equation is differentiated with respect to its upper limit; a constant "
        "kernel is separated.",
        {
            "stiffness": force / rise - 2 * _MODULUS * whole,
            "compliances in series": 1 / (2 * _MODULUS * stiffness)
            - 1 / (2 * _MODULUS * rest)
            - constant / (2 * _MODULUS),
        },
    )


Series = dict[int, sp.Expr]


def kernel_by_powers() -> Series:
    """Return a N(a x, a s) in powers of A = a/h: k h = sum n (n + 2)/2 c_n A^(n - 1)."""
    return {
        n: sp.Rational(n * (n + 2), 4) * c_A[n] * ((_x + _s) ** (n - 1) + (_x - _s) ** (n - 1))
        for n in range(1, ORDER + 1, 2)
    }


def _applied(kernel_part: sp.Expr, chi: sp.Expr) -> sp.Expr:
    return sp.expand(sp.integrate(sp.expand(kernel_part * chi.subs(_x, _s)), (_s, 0, 1)))


@cache
def small_contact_solution() -> tuple[Series, Series]:
    """Return chi over E* a^2/(pi R) at x = t/a, and delta R/a^2, in powers of A."""
    parts = kernel_by_powers()
    chi: Series = {0: 1 - _x**2}
    depth: Series = {0: sp.Integer(1)}
    for order in range(1, ORDER + 1):
        shift = sp.Add(*(_applied(parts[n], chi[order - n]) for n in parts if n <= order))
        depth[order] = shift.subs(_x, 1) if shift else sp.Integer(0)
        chi[order] = sp.expand(depth[order] - shift)
    return chi, depth


@cache
def at_given_force() -> tuple[Formula, Formula]:
    """Return the law at given force in the Hertz radius a_H; c_1 is unchanged, c_3 increases."""
    chi, depth = small_contact_solution()
    parts = kernel_by_powers()
    residuals = {"half-space": chi[0] - (depth[0] - _x**2)}
    for order in range(1, ORDER + 1):
        shift = sp.Add(*(_applied(parts[n], chi[order - n]) for n in parts if n <= order))
        residuals[f"equation at A^{order}"] = sp.expand(chi[order] + shift - depth[order])
        residuals[f"chi(a) at A^{order}"] = chi[order].subs(_x, 1)
    for n in parts:
        by_law = coefficient((n + 3) // 2).mode
        density = 4 / sp.pi * (plate_factors()[2].expression.subs(T, 2 * eta * j_n) / (j_n * J1**2))
        taylor = density * sp.series(sp.cos(_u), _u, 0, n + 1).removeO().coeff(_u, n - 1)
        value = taylor * j_n ** (n - 1) * eta**n
        residuals[f"k at A^{n - 1}"] = sp.Rational(n * (n + 2), 2) * by_law - value
    cube = sp.Rational(3, 2) * sp.Add(
        *(sp.integrate(value, (_x, 0, 1)) * a_ratio**n for n, value in chi.items())
    )
    third = c_A[3] * a_ratio**3
    ratio = 1 + sp.Rational(5, 3) * third
    hertz = a_ratio * sp.Symbol("q", positive=True)
    law = 1 + c_A[1] * hertz + sp.Rational(8, 3) * c_A[3] * hertz**3
    (q,) = hertz.free_symbols - {a_ratio}
    reduced = sp.Add(*(value * a_ratio**n for n, value in depth.items())) / q**2 - law
    residuals["radius"] = _truncated(cube - ratio**3)
    residuals["law"] = _truncated(
        sp.series(reduced.subs(q, ratio), a_ratio, 0, ORDER + 1).removeO()
    )
    proof = prove(
        "Law at given force with non-Hertzian pressure",
        r"$\chi$ in powers of $A$ solves the integral equation; the Hertz radius of its $P$ is "
        r"$a_H$, $(a_H/a)^3 = (3/2) \int \chi$. Both expansions are inserted, up to $A^4$.",
        residuals,
    )
    return (
        Formula(
            "hertz_radius_ratio",
            r"a_{\mathrm{Hertz}}(P)/a",
            "Hertz radius of the force over the actual contact radius, up to $(a/h)^4$",
            ratio,
            "1",
            "",
            ("k_modes", "k_lateral", "delta_reduced"),
            proof,
        ),
        Formula(
            "delta_non_hertzian",
            r"\delta R/a_{\mathrm{Hertz}}^2",
            "reduced indentation at given force with non-Hertzian pressure, up to $(a/h)^4$",
            law.subs(q, 1),
            "1",
            "",
            ("k_modes", "k_lateral", "delta_reduced"),
            proof,
        ),
    )


def _truncated(expression: sp.Expr) -> sp.Expr:
    expanded = sp.expand(expression)
    return sp.Add(*(expanded.coeff(a_ratio, n) * a_ratio**n for n in range(ORDER + 1)))


def non_hertzian_pressure() -> tuple[Formula, ...]:
    """Return the formulas of this step; their lemmas are proved as well."""
    profiles()
    motion_of_the_edge()
    results()
    remaining_curvature()
    substitution()
    return (*kernel(), *at_given_force(), *pressure_bound())
