"""A mode as four exponentials, derived by hand, and the 4x4 system of its face tractions.

Independent of the derivation in `theory`: Navier's equations are solved for
z^k e^(+-phi z), and the weights are computed numerically at mpmath's precision.
"""

from dataclasses import dataclass

from mpmath import mp, mpf


@dataclass(frozen=True)
class ModeMaterial:
    """Lame's constants."""

    lam: mpf
    mu: mpf


@dataclass(frozen=True)
class Exponential:
    """W(z) = z^power e^(sign phi (z - foot)), and the U(z) that satisfies the equations with it.

    For u = U J1(phi r), w = W J0(phi r) the dilatation is D J0 with
    D = phi U + W'. Navier's axial equation, mu (W'' - phi^2 W) + (lam + mu) D' = 0,
    gives D; then U = (D - W')/phi. `foot` is the face where the exponential is 1: nothing
    overflows, and no large terms cancel.
    """

    phi: mpf
    sign: int
    power: int
    foot: mpf
    material: ModeMaterial

    def _parts(self, z: mpf) -> tuple[mpf, mpf, mpf, mpf]:
        """Return W, W', D and the exponential itself."""
        e = mp.exp(self.sign * self.phi * (z - self.foot))
        if self.power == 0:
            return e, self.sign * self.phi * e, mpf(0), e
        dilatation = -2 * self.material.mu / (self.material.lam + self.material.mu) * e
        return z * e, (1 + self.sign * self.phi * z) * e, dilatation, e

    def at(self, z: mpf) -> "ModeState":
        """Return displacements and stresses at height z."""
        lam, mu = self.material.lam, self.material.mu
        w, slope_w, dilatation, e = self._parts(z)
        u = (dilatation - slope_w) / self.phi
        # U' = (D' - W'')/phi, with W'' = phi^2 W + 2 sign phi e for power 1.
        curvature = self.phi**2 * w + (2 * self.sign * self.phi * e if self.power else 0)
        slope_u = (self.sign * self.phi * dilatation - curvature) / self.phi
        return ModeState(
            w=w,
            u=u,
            zz=lam * dilatation + 2 * mu * slope_w,
            rz=mu * (slope_u - self.phi * w),
            rr=lam * dilatation + 2 * mu * self.phi * u,
            tt=lam * dilatation,
        )


@dataclass(frozen=True)
class ModeState:
    """A mode at one height: factors of J0 (w, zz, rr, tt) and J1 (u, rz).

    sigma_rr and sigma_tt also contain -+ 2 mu u J1(phi r)/r.
    """

    w: mpf
    u: mpf
    zz: mpf
    rz: mpf
    rr: mpf
    tt: mpf


def combine(weights: list[mpf], states: list[ModeState]) -> ModeState:
    """Return a weighted sum of states."""

    def total(part: str) -> mpf:
        return mp.fsum(c * getattr(s, part) for c, s in zip(weights, states, strict=True))

    return ModeState(*(total(part) for part in ("w", "u", "zz", "rz", "rr", "tt")))


def basis(phi: mpf, h: mpf, material: ModeMaterial) -> list[Exponential]:
    """Return the four exponentials of a plate, each 1 on the face towards which it grows."""
    return [
        Exponential(phi, sign, power, sign * h, material) for power in (0, 1) for sign in (1, -1)
    ]


def solve_tractions(phi: mpf, h: mpf, material: ModeMaterial) -> list[mpf]:
    """Return weights of the four exponentials for unit axial traction on the upper face only."""
    four = basis(phi, h, material)
    above, below = [e.at(h) for e in four], [e.at(-h) for e in four]
    rows = [
        [s.zz for s in above],
        [s.rz for s in above],
        [s.zz for s in below],
        [s.rz for s in below],
    ]
    solution = mp.lu_solve(mp.matrix(rows), mp.matrix([1, 0, 0, 0]))
    return list(solution)


def unit_mode(phi: mpf, h: mpf, material: ModeMaterial, z: mpf) -> ModeState:
    """Return the mode under unit pressure coefficient at height z."""
    weights = solve_tractions(phi, h, material)
    return combine(weights, [e.at(z) for e in basis(phi, h, material)])


def half_space(phi: mpf, material: ModeMaterial) -> mpf:
    """Return the deflection of the half-space z < 0 per unit traction, by decaying exponentials."""
    surface = [Exponential(phi, 1, power, mpf(0), material).at(mpf(0)) for power in (0, 1)]
    rows = mp.matrix([[s.zz for s in surface], [s.rz for s in surface]])
    weights = mp.lu_solve(rows, mp.matrix([1, 0]))
    return mp.fsum(c * s.w for c, s in zip(weights, surface, strict=True))
