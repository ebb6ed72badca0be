"""Step 23: criteria for plate inertia: Zener's parameter, bending period, reflections.

Bending waves: D nabla^4 w + rho H w'' = 0, D = E* H^3/12, H = 2h, has w = J0(phi r) cos(omega t)
with omega = phi^2 sqrt(D/(rho H)); with the paper's edge phi_1 = j_1/b is the lowest mode.

Under a point force P an infinite plate moves with w' = P/(8 sqrt(D rho H)) (Boussinesq 1885):
every wave number contributes P phi/(2 pi rho H) sin(omega t)/omega, int_0^oo sin(s)/s ds = pi/2.
Hertz's impact on such a plate has one parameter only (Zener 1941),

    d'' + d^(3/2) + lambda (d^(3/2))' = 0,   lambda = m/(8 T sqrt(D rho H)),
    T = (m^2/(K^2 v0))^(1/5),   K = (4/3) E* sqrt(R),

time in units of T and the local indentation d in units of v0 T. Weight accelerates the sphere by g.
"""

from functools import cache
from typing import NamedTuple

import sympy as sp

from derivation.engine.cache import in_file
from derivation.engine.formula.proof import Proof, lower_bessel, prove
from derivation.plate.contact.theory.hertz import SOURCES
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.vocabulary import Formula, R, b, h, j_n, lam, m, mu, phi, r, rho, v0

_D, _s, _t, _H, _T, _impedance, _g = sp.symbols("D s t H T impedance g", positive=True)
K = sp.Symbol("K", positive=True)
"""Force over the indentation to the power 3/2, on a half-space."""
TIME_UNIT = (m**2 / (K**2 * v0)) ** sp.Rational(1, 5)
local, speed, zener, weight = sp.symbols("local speed zener weight", positive=True)
"""d, the sphere's speed, lambda and g, in units of v0 and T."""
_RIGIDITY_OVER_MASS = PLANE_STRAIN_MODULUS * (2 * h) ** 2 / (12 * rho)
"""D/(rho H), flexural rigidity of the plate divided by its mass per area."""


@cache
def bending_waves() -> Proof:
    """Prove the frequency of J0(phi r), and the velocity w' of an infinite plate under a force."""
    shape = sp.besselj(0, phi * r)

    def laplacian(w: sp.Expr) -> sp.Expr:
        return lower_bessel(sp.diff(w, r, 2) + sp.diff(w, r) / r)

    omega = phi**2 * sp.sqrt(_D / (rho * _H))
    # The response of wave number phi to a force step, integrated with s = omega t.
    response = phi / (2 * sp.pi * rho * _H) / omega
    measure = sp.diff(sp.sqrt(_s / _t) * (rho * _H / _D) ** sp.Rational(1, 4), _s)
    at = sp.sqrt(_s / _t) * (rho * _H / _D) ** sp.Rational(1, 4)
    density = response.subs(phi, at) * measure
    speed = sp.integrate(sp.sin(_s) / _s, (_s, 0, sp.oo)) * sp.simplify(density * _s)
    return prove(
        "Bending waves",
        r"$J_0(\phi r)$ is inserted into the equation of motion; the response to a point force "
        r"is integrated over all wave numbers.",
        {
            "wave": sp.expand(_D * laplacian(laplacian(shape)) - rho * _H * omega**2 * shape),
            "point force": sp.simplify(speed - 1 / (8 * sp.sqrt(_D * rho * _H))),
        },
    )


class Rates(NamedTuple):
    """Rates of change of a sphere's local indentation and of its speed, on an infinite plate."""

    local: sp.Expr
    speed: sp.Expr


@cache
def infinite_plate_rates() -> Rates:
    """Return the rates of d and of the sphere's speed, with its weight, in units of v0 and T."""
    force = K * (v0 * _T * local) ** sp.Rational(3, 2)
    rates = (v0 * speed - force / _impedance) / v0, (_g - force / m) * _T / v0
    parameters = {_impedance: m / (_T * zener), _g: weight * v0 / _T}

    def scaled(rate: sp.Expr) -> sp.Expr:
        inserted = sp.expand_power_base(rate.subs(parameters).subs(_T, TIME_UNIT))
        return sp.expand(sp.powsimp(inserted, force=True))

    return Rates(*(scaled(rate) for rate in rates))


@cache
def zener_number() -> Formula:
    """Return lambda, the parameter of Hertz's impact on an infinite plate."""
    bending_waves()
    rates, force = infinite_plate_rates(), local ** sp.Rational(3, 2)
    E = PLANE_STRAIN_MODULUS
    flat = sp.Pow(sp.Rational(4, 3) * sp.sqrt(R), sp.Rational(2, 5)) * E ** sp.Rational(2, 5)
    rate = sp.Pow(v0, sp.Rational(1, 5)) / sp.Pow(m, sp.Rational(2, 5)) * flat  # 1/T
    number = m * rate / (8 * (2 * h) ** 2 * sp.sqrt(E / 12) * sp.sqrt(rho))
    impedance = 8 * sp.sqrt(E * (2 * h) ** 3 / 12 * rho * 2 * h)
    of_units = m / (TIME_UNIT.subs(K, sp.Rational(4, 3) * E * sp.sqrt(R)) * impedance)
    proof = prove(
        "Zener's number",
        "In units of $T$ and $v_0 T$, the equations $m (d + w)'' = -K d^{3/2}$ and $w' = K "
        r"d^{3/2}/I$ with $I = 8 \sqrt{D \rho H}$ have the coefficient 1 for the force and "
        r"$\lambda = m/(T I)$ for its rate.",
        lambda number: {
            "force": rates.speed + force - weight,
            "rate": rates.local + zener * force - speed,
            "number": sp.simplify((number / of_units) ** 10) - 1,
        },
        number,
    )
    return Formula(
        "zener_number",
        r"\lambda_Z",
        "Zener's inelasticity parameter, a measure of the energy radiated by bending waves",
        number,
        "1",
        "",
        ("C_half",),
        proof,
    )


@cache
def plate_times() -> tuple[Formula, Formula]:
    """Return the first bending period for the paper's edge, and the time of four passages of H."""
    waves = bending_waves()
    period = 2 * sp.pi / ((j_n / b) ** 2 * sp.sqrt(_RIGIDITY_OVER_MASS))
    echo = 4 * 2 * h / sp.sqrt((lam + 2 * mu) / rho)
    proof = prove(
        "Periods of a plate",
        waves.argument + r" A pressure wave has the speed $\sqrt{(\lambda + 2 \mu)/\rho}$.",
        lambda period, echo: {
            "bending": phi**2 * sp.sqrt(_RIGIDITY_OVER_MASS) * period.subs(j_n, phi * b)
            - 2 * sp.pi,
            "pressure": (8 * h / echo) ** 2 * rho - lam - 2 * mu,
        },
        *(period, echo),
    )
    return (
        Formula(
            "bending_period",
            "T_n",
            "period of the $n$-th bending vibration with the paper's edge",
            period,
            "s",
            "",
            (),
            proof,
        ),
        Formula(
            "echo_time",
            "T_e",
            "time in which a pressure wave crosses the thickness four times",
            echo,
            "s",
            "",
            (),
            proof,
        ),
    )


@in_file((*SOURCES, "plate/waves/theory"), Formula, Proof)  # kernels need it at their import
def plate_motion() -> tuple[Formula, ...]:
    """Return the formulas of the step."""
    return zener_number(), *plate_times()
