"""mpmath references of the plate: the same numbers by independent methods.

The closed forms of `theory` are not used. A mode is solved numerically (`exponentials`). The
pressure coefficients come from quadrature: of the pressure itself, of Boussinesq's point load,
and of Sonine's integral.
"""

import math
from collections.abc import Callable, Mapping
from functools import cache

from mpmath import mp, mpf

from derivation.engine.oracle.agreement import FLOOR_DIGITS, RouteError, Routes, Values
from derivation.plate import oracle as balls
from derivation.plate.contact.route.moments import (
    finite_part,
    lateral_moment,
    leading_finite_part,
    leading_lateral_moment,
)
from derivation.plate.modes.route.exponentials import (
    Exponential,
    ModeMaterial,
    combine,
    half_space,
    solve_tractions,
    unit_mode,
)
from derivation.plate.subjects import exports

MAX_OSCILLATIONS = 60


def _integral(integrand: Callable[[mpf], mpf], points: list[mpf], method: str) -> mpf:
    """Return a quadrature whose error affects only the last twenty of the working digits.

    Raises
    ------
    RouteError
        If the estimated error is larger.
    """
    value, error = mp.quad(integrand, points, error=True, method=method)
    if not error <= mpf(10) ** (20 - mp.dps) * abs(value):
        raise RouteError(f"quadrature reached {mp.nstr(value)} +- {mp.nstr(error)} only")
    return value


@cache
def _disc_moment(digits: int) -> mpf:
    """Return int_0^1 t sqrt(1-t^2) dt: resultant of the pressure over 2 pi a^2 p(0)."""
    with mp.workdps(digits):
        return _integral(lambda t: mp.sin(t) * mp.cos(t) ** 2, [0, mp.pi / 2], "tanh-sinh")


@cache
def _boussinesq_drop(digits: int) -> mpf:
    """Return pi E* (w(0) - w(a)) / (p(0) a) under Hertz pressure, by Boussinesq's point load.

    A ring of radius s < a acts on the axis with 2 pi s/s and at distance a with
    4 (s/a) K(s/a), K = pi/(2 agm(1, sqrt(1 - s^2/a^2))) the complete elliptic
    integral. With s = a cos t the root is sin t, and its logarithm lies at t = 0.
    """

    def drop(t: mpf) -> mpf:
        ring = 2 * mp.pi * mp.cos(t) / mp.agm(1, mp.sin(t))
        return mp.sin(t) ** 2 * (2 * mp.pi - ring)

    with mp.workdps(digits):
        return _integral(drop, [0, mp.pi / 2], "tanh-sinh")


def peak_pressure(R: mpf, a: mpf, material: ModeMaterial) -> mpf:
    """Return p(0) > 0 for which the half-space is a^2/(2R) lower at the centre than at the edge."""
    modulus = 2 / half_space(mpf(1), material)  # E* = 2/(phi C)
    return mp.pi * modulus * a / (2 * R * _boussinesq_drop(mp.dps))


@cache
def _sonine_unit(y: mpf, digits: int) -> mpf:
    """Return int_0^1 t sqrt(1-t^2) J0(y t) dt by quadrature.

    With c = sqrt(1-t^2) the integrand c^2 J0(y sqrt(1-c^2)) is entire in c:
    Gauss's rule converges faster than any power.
    """
    if y > MAX_OSCILLATIONS * mp.pi:
        raise RouteError(f"J0 oscillates too often for quadrature: a phi = {mp.nstr(y, 8)}")
    with mp.workdps(digits):
        return _integral(
            lambda c: c**2 * mp.besselj(0, y * mp.sqrt((1 - c) * (1 + c))), [0, 1], "gauss-legendre"
        )


def _sonine(v: Values) -> mpf:
    return v["a"] ** 2 * _sonine_unit(v["a"] * v["phi"], mp.dps)


def _pressure_coefficient(v: Values) -> mpf:
    norm = v["b"] ** 2 * v["J1"] ** 2 / 2
    return -peak_pressure(v["R"], v["a"], _material(v)) * _sonine(v) / norm


def _material(v: Values) -> ModeMaterial:
    return ModeMaterial(v["lam"], v["mu"])


_UNIT = ModeMaterial(mpf(1), mpf(1))


def _omega(k: int, v: Values) -> mpf:
    """Return the constants of cosh, sinh, z cosh, z sinh from the weights of the exponentials."""
    material = ModeMaterial(v.get("lam", mpf(1)), v["mu"])
    up, down, z_up, z_down = solve_tractions(v["phi"], v["h"], material)
    foot = mp.exp(-v["phi"] * v["h"])  # the exponentials are 1 on their faces
    sums = (up + down, up - down, z_up + z_down, z_up - z_down)
    return sums[k - 1] * foot


def _plate_factor(v: Values, side: int) -> mpf:
    phi = v["T"] / 2
    return unit_mode(phi, mpf(1), _UNIT, mpf(side)).w / half_space(phi, _UNIT)


def _plate_factor_slope(v: Values) -> mpf:
    """Return T dG/dT by a symmetric difference; its step squared is below the last digit."""
    with mp.workdps(2 * mp.dps):
        step = mpf(10) ** (-mp.dps // 4)
        values = (_plate_factor({"T": v["T"] * (1 + x)}, 1) for x in (step, -step))
        return (next(values) - next(values)) / (2 * step)


def _face(v: Values, side: int) -> mpf:
    return unit_mode(v["phi"], v["h"], _material(v), side * v["h"]).w


def _indentation(v: Values, side: int) -> mpf:
    """Return K_j: deflection over s(a phi), independent of material and radius; here a phi = 2."""
    inner = {**v, "a": 2 / v["phi"], "lam": mpf(1), "mu": mpf(1)}
    s = mp.sin(mpf(2)) - 2 * mp.cos(mpf(2))
    return -_pressure_coefficient(inner) * _face(inner, side) / s


def _mode(v: Values, part: str) -> mpf:
    state = unit_mode(v["phi"], v["h"], _material(v), v["z"])
    return v["A_j"] * getattr(state, part)


def _general(v: Values, part: str) -> mpf:
    """Return the general solution: hyperbolic functions as exponentials equal to 1 at z = 0."""
    c1, c2, c3, c4 = (v.get(f"C{k}", mpf(0)) for k in range(1, 5))
    material = ModeMaterial(v.get("lam", mpf(1)), v.get("mu", mpf(1)))
    four = [
        Exponential(v["phi"], sign, power, mpf(0), material) for power in (0, 1) for sign in (1, -1)
    ]
    weights = [(c1 + c2) / 2, (c1 - c2) / 2, (c3 + c4) / 2, (c3 - c4) / 2]
    return getattr(combine(weights, [e.at(v["z"]) for e in four]), part)


def _field(v: Values, quantity: str) -> mpf:
    """Return one mode's contribution to a displacement or stress at (r, z)."""
    phi, r = v["phi"], v["r"]
    state = unit_mode(phi, v["h"], _material(v), v["z"])
    j0, j1 = mp.besselj(0, phi * r), mp.besselj(1, phi * r)
    # J1(phi r)/r as J0 + J2 needs no limit at r = 0.
    ring = v["mu"] * state.u * phi * (j0 + mp.besselj(2, phi * r))
    shapes = {
        "u": state.u * j1,
        "w": state.w * j0,
        "sigma_rr": state.rr * j0 - ring,
        "sigma_tt": state.tt * j0 + ring,
        "sigma_zz": state.zz * j0,
        "sigma_rz": state.rz * j1,
    }
    return _pressure_coefficient(v) * shapes[quantity]


def _term_of_delta(v: Values) -> mpf:
    inner = {**v, "lam": mpf(1), "mu": mpf(1)}
    return -_pressure_coefficient(inner) * _face(inner, 1)


def _pressure(v: Values) -> mpf:
    t = v["r"] / v["a"]
    return -v["P"] * mp.sqrt((1 - t) * (1 + t)) / (2 * mp.pi * v["a"] ** 2 * _disc_moment(mp.dps))


def _force(v: Values) -> mpf:
    peak = peak_pressure(v["R"], v["a"], _material(v))
    return 2 * mp.pi * v["a"] ** 2 * peak * _disc_moment(mp.dps)


def _part(route: Callable[[Values, str], mpf], part: str) -> Callable[[Values], mpf]:
    return lambda v: route(v, part)


@cache
def _zero(j: int, digits: int) -> mpf:
    with mp.workdps(digits):
        return mp.besseljzero(0, j)


def _omega_routes() -> dict[str, Callable[[Values], mpf]]:
    def scaled(k: int) -> Callable[[Values], mpf]:
        return lambda v: mp.exp(v["phi"] * v["h"]) * _omega(k, v)

    def plain(k: int) -> Callable[[Values], mpf]:
        return lambda v: _omega(k, v)

    return {f"Omega_{k}": plain(k) for k in range(1, 5)} | {
        f"Omega_{k}_scaled": scaled(k) for k in range(1, 5)
    }


ROUTES: dict[str, Callable[[Values], mpf]] = {
    **_omega_routes(),
    **{f"S_{part}": _part(_general, part) for part in ("zz", "rz", "rr", "tt")},
    **{f"mode_{part}": _part(_mode, part) for part in ("zz", "rz", "rr", "tt")},
    **{
        name: _part(_field, name)
        for name in ("u", "w", "sigma_rr", "sigma_tt", "sigma_zz", "sigma_rz")
    },
    "f_j": _part(_general, "w"),
    "g_j": lambda v: _general(v, "u") / v["phi"],
    "mode_f": _part(_mode, "w"),
    "mode_g": lambda v: _mode(v, "u") / v["phi"],
    "C_top": lambda v: _face(v, 1),
    "C_bottom": lambda v: _face(v, -1),
    "C_half": lambda v: half_space(v["phi"], _material(v)),
    "G": lambda v: _plate_factor(v, 1),
    "G_m": lambda v: _plate_factor(v, -1),
    "G_minus_1": lambda v: _plate_factor(v, 1) - 1,
    "G_slope": _plate_factor_slope,
    "p": _pressure,
    "sonine": _sonine,
    "P": _force,
    "A_j": _pressure_coefficient,
    "K_j": lambda v: _indentation(v, 1),
    "K_j_bottom": lambda v: _indentation(v, -1),
    "delta": _term_of_delta,
    "bessel_j0": lambda v: mp.besselj(0, v["x"]),
    "bessel_j1": lambda v: mp.besselj(1, v["x"]),
    "bessel_j0_zeros": lambda v: _zero(int(v["count"]), mp.dps),
    "bessel_j1_zeros": lambda v: mp.besseljzero(1, int(v["count"])),
    "bessel_j1_at_j0_zeros": lambda v: mp.besselj(1, _zero(int(v["count"]), mp.dps)),
    "kappa": lambda v: lateral_moment(int(v["n"]), mp.dps),
    "kappa_ratio": lambda v: lateral_moment(int(v["n"]), mp.dps) / leading_lateral_moment(v["n"]),
    "finite_part": lambda v: finite_part(int(v["k"]), mp.dps),
    "finite_part_ratio": lambda v: finite_part(int(v["k"]), mp.dps) / leading_finite_part(v["k"]),
}
"""Method for the value of each formula, or for one mode's contribution to it."""
for _routes in exports("route", "ROUTES"):
    ROUTES |= _routes


def _mode_of_plate(j: int, values: Values) -> dict[str, mpf]:
    zero = _zero(j, mp.dps)
    return {"phi": zero / values["b"], "J1": mp.besselj(1, zero)}


def _cancellation(values: Mapping[str, float]) -> int:
    """Return digits the 4x4 system may lose: up to the sixth power of small phi h, or e^(2 phi h).

    The estimate only saves attempts; agreement of two precisions decides.
    """
    x = values["T"] if "T" in values else values.get("phi", 1.0) * values.get("h", 0.0)
    if 0.0 < x < 1.0:
        return math.ceil(6 * -math.log10(x))
    return math.ceil(min(2 * x / math.log(10), FLOOR_DIGITS))


ORACLE = Routes(balls.ORACLE, ROUTES, _mode_of_plate, _cancellation)
value, agree = ORACLE.value, ORACLE.agree
