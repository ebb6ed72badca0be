"""mpmath reference for clamped and supported plates of finite thickness: power series in r.

With kap from the mpmath reference of A0 and k2 from the sum rule, a mode obeys

    nabla^4 w + (k^2 - k2^2) nabla^2 w - k^2 k2^2 w = 0,
    psi' + psi/r = -nabla^2 w - (kap/(k_s eta^2)) w,

where the second equation is the balance of force. The two series that are regular on the axis,
starting with 1 and with r^2, give w(1), psi(1) and psi'(1); the edge conditions are a determinant.
No Bessel function is used; the norm is a quadrature.
"""

from typing import NamedTuple

from mpmath import mp, mpf

from derivation.engine.oracle.agreement import RouteError
from derivation.plate.edge_modes.theory.waves import CHI
from derivation.plate.waves import route as inertia_routes

_STEPS = 40


class RouteWave(NamedTuple):
    """Quantities of a mode, as in `edge_modes.oracle.waves`."""

    k: mpf
    root: mpf
    k2: mpf
    c: mpf
    t: mpf
    weight: mpf
    residue: mpf


class _Series(NamedTuple):
    """Coefficients of r^0, r^2, ... of w, and of r, r^3, ... of psi."""

    w: list[mpf]
    psi: list[mpf]

    def at(self, r: mpf) -> tuple[mpf, mpf, mpf]:
        """Return w, psi and psi'."""
        square = r * r
        w = mp.polyval(self.w[::-1], square)
        psi = mp.polyval(self.psi[::-1], square)
        slope = mp.polyval([(2 * m + 1) * c for m, c in enumerate(self.psi)][::-1], square)
        return w, r * psi, slope


def wave(edge: str, thickness: float, ratio: float, near: float, digits: int = 20) -> RouteWave:
    """Return the mode next to a guess for an edge, "clamped" or "supported"."""
    with mp.workdps(2 * digits + int(near) + 20):
        eta, nu = mpf(thickness), mpf(ratio)

        def kap_at(k: mpf) -> mpf:
            return inertia_routes.zero(k * eta, nu, digits + 6)

        k = _root(edge, eta, nu, mpf(near), digits)
        kap = kap_at(k)
        partner, one, other = _both(k, kap, eta, nu)
        (w_1, _, _), (w_2, _, _) = one.at(mpf(1)), other.at(mpf(1))

        def energy(r: mpf) -> mpf:
            (a, psi_a, _), (b, psi_b, _) = one.at(r), other.at(r)
            return r * ((w_2 * a - w_1 * b) ** 2 + eta**2 / 3 * (w_2 * psi_a - w_1 * psi_b) ** 2)

        norm = mp.quad(energy, mp.linspace(0, 1, int(near) + 3))
        # w(0) = A (1 - c) and nabla^2 w(0) = -A (k^2 + c k2^2).
        axis, bend = w_2, -4 * w_1
        c = (bend + k**2 * axis) / (bend - partner * axis)
        bulge = nu / (1 - nu) / 3 * eta**2
        face = axis + bulge * (bend + k**2 * axis)
        slack = (6 - nu) / 5
        shear = 1 - kap * slack / (k * eta) ** 2
        weight = face**2 * (1 + (eta * k * shear) ** 2 / 3) / (2 * mp.pi * norm)
        t = (1 - face * (1 - c) / axis) / c
        residue = inertia_routes.residue(k * eta, nu, digits)
        return RouteWave(k, mp.sqrt(kap), mp.sqrt(partner), c, t, weight, residue)


def _both(k: mpf, kap: mpf, eta: mpf, nu: mpf) -> tuple[mpf, _Series, _Series]:
    """Return k2^2 and both regular solutions."""
    slack = (6 - nu) / 5
    partner = k**2 - kap / eta**2 * (slack + (1 - nu) / 2)
    force = kap * slack / eta**2
    values = []
    for start in ((1, 0), (0, 1)):
        w = [mpf(x) for x in start]
        while len(w) < 12 or max(abs(w[-1]), abs(w[-2])) > mp.eps * mpf(10) ** -5:
            m = len(w) - 2
            bend = 4 * (m + 1) ** 2 * w[m + 1]
            fourth = k**2 * partner * w[m] - (k**2 - partner) * bend
            w.append(fourth / (16 * (m + 2) ** 2 * (m + 1) ** 2))
        # nabla^2 r^(2m) = 4 m^2 r^(2m-2); psi' + psi/r of r^(2m+1) is (2m + 2) r^(2m).
        psi = [
            (-4 * (m + 1) ** 2 * w[m + 1] - force * w[m]) / (2 * m + 2) for m in range(len(w) - 1)
        ]
        values.append(_Series(w, psi))
    return partner, *values


def _root(edge: str, eta: mpf, nu: mpf, near: mpf, digits: int) -> mpf:
    """Return the root by the secant method."""
    chi = mpf(CHI.p) / CHI.q * (nu / (1 - nu)) ** 2

    def determinant(k: mpf) -> mpf:
        _, one, other = _both(k, inertia_routes.zero(k * eta, nu, digits + 6), eta, nu)
        rows = []
        for series in (one, other):
            w, psi, slope = series.at(mpf(1))
            rows.append((w, psi - chi * eta * slope if edge == "clamped" else slope + nu * psi))
        return rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]

    before, here = near, near * (1 + mpf(10) ** -6)
    at_before, at_here = determinant(before), determinant(here)
    for _ in range(_STEPS):
        new = here - at_here * (here - before) / (at_here - at_before)
        if abs(new - here) < abs(new) * mpf(10) ** -(digits + 2):
            return new
        before, here, at_before, at_here = here, new, at_here, determinant(new)
    raise RouteError(f"no root of the determinant near k = {mp.nstr(near, 8)}")
