"""mpmath reference for a clamped edge: the pressure is integrated and the states are evaluated.

By Betti's theorem, the work of Hertz pressure on the states of bending and extension gives the
rotation and strain that a clamp suppresses. The states give the deflection at the centre of the
contact face and the stress at the centre of the back face. b, R and E* are 1.
"""

from collections.abc import Callable
from typing import NamedTuple

from mpmath import mp, mpf

from derivation.plate.edge.theory.clamped import LEVEL_FIT, SHEAR_TERM, TURN_FIT


class ClampedResponse(NamedTuple):
    """Load P, the rotation that a clamp suppresses, its part psi = chi eta psi', and the strain."""

    force: mpf
    turn: mpf
    own: mpf
    strain: mpf


def clamp_part(kind: str, a: float, h: float, b: float, nu: float, digits: int = 30) -> mpf:
    """Return the reduction of delta R/a^2, or of (R/2a) d delta/da for kind `slope`.

    Parameters
    ----------
    kind
        `indentation` or `slope`.
    a, h, b, nu
        Exact numbers; 0 < a < b.
    digits
        Number of decimal digits requested.
    """
    with mp.workdps(2 * digits + 20):
        alpha, eta, n = mpf(a) / mpf(b), mpf(h) / mpf(b), mpf(nu) / (1 - mpf(nu))

        def depth(width: mpf) -> mpf:
            response = _clamped(width, eta, n)
            # eta^3/5 in units of P b^2/(16 pi D), D = 2 h^3/3.
            shear = 3 * response.force / (32 * mp.pi) * SHEAR_TERM.p / SHEAR_TERM.q
            bent = response.turn * _bent(mpf(0), eta, n) + response.own / 2
            return bent + response.strain * 2 * n * eta + shear

        if kind == "indentation":
            return +(depth(alpha) / alpha**2)
        step = alpha * mpf(10) ** (-(digits // 2) - 5)
        return +((depth(alpha + step) - depth(alpha - step)) / (4 * alpha * step))


def back_face_clamp(a: float, h: float, b: float, nu: float, digits: int = 30) -> mpf:
    """Return the reduction of S; the stress is (1 + nu) P/(2 pi H^2) times S, H = 2 h."""
    with mp.workdps(digits + 20):
        eta, n = mpf(h) / mpf(b), mpf(nu) / (1 - mpf(nu))
        response = _clamped(mpf(a) / mpf(b), eta, n)
        # sigma_rr = (1 + nu) E* times a strain that is equal in all directions.
        strain = response.strain + (response.turn + response.own) * eta
        return +(strain * 8 * mp.pi * eta**2 / response.force)


def _clamped(a: mpf, h: mpf, n: mpf) -> ClampedResponse:
    """Return the motion that a clamp suppresses under Hertz pressure (2/pi) sqrt(a^2 - r^2)."""

    def load(weight: Callable[[mpf], mpf]) -> mpf:
        """Return an integral over the contact, with r = a sin t."""
        return mp.quad(
            lambda t: 4 * a**3 * mp.sin(t) * mp.cos(t) ** 2 * weight(a * mp.sin(t)), [0, mp.pi / 2]
        )

    force, work = load(lambda _: mpf(1)), load(lambda r: _bent(r, h, n))
    # The edge's moment 2 E* (2 h^3/3) k and force 2 E* 2 h e work on 2 pi b.
    stiff = 2 * mp.pi * 2 * (2 * h**3 / 3)
    moment = 2 * n**2 * _fitted(TURN_FIT, n) * h * load(lambda r: (1 - r * r) / 2)
    strain = force * 2 * n * h / (2 * mp.pi * 2 * 2 * h)
    return ClampedResponse(force, work / stiff, moment / stiff, strain)


def _bent(r: mpf, h: mpf, n: mpf) -> mpf:
    """Return the deflection of the contact face in the bending state k = 1."""
    return (1 - r * r) / 2 - n * h * h * (1 - 2 * _fitted(LEVEL_FIT, n))


def _fitted(powers: tuple[int, ...], n: mpf) -> mpf:
    return 1000 / mp.polyval(list(reversed(powers)), n)
