"""Oracle 2 of the contact law: the modal sum added up in mpmath, mode by mode, then accelerated.

Indentation, slope and work are sums of one kernel each over the nodes of
`contact_modes`. Everything is done twice, with other nodes, another number of modes
and more digits; where the two differ there is no answer.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from mpmath import mp, mpf

from derivation.reference.contact_modes import nodes_of, spread
from derivation.reference.routes import RouteError


class Impact(NamedTuple):
    """What an impact comes to."""

    contact_time: mpf
    max_indentation: mpf
    max_force: mpf
    max_contact_radius: mpf


class Setting(NamedTuple):
    """How one evaluation is done.

    Parameters
    ----------
    first
        Modes added before the acceleration; the phase's asymptotic series needs about half as
        many as there are digits.
    level
        3 * 2^(level - 1) Gauss-Legendre nodes to an interval of the acceleration.
    dps
        Working digits.
    arcs, arc_level
        Into how many intervals the quarter turn of an impact is cut, and their nodes.
    """

    first: int
    level: int
    dps: int
    arcs: int
    arc_level: int


SETTINGS: dict[int, tuple[Setting, Setting]] = {
    24: (Setting(20, 4, 38, 2, 4), Setting(24, 4, 42, 3, 4)),
    42: (Setting(30, 5, 56, 4, 4), Setting(37, 6, 62, 3, 5)),
}
"""Up to so many digits, the two evaluations that must agree: light ones, and full ones."""

MAX_DIGITS = max(SETTINGS)
EDGE = mpf("0.9999")
"""Largest a/b that is looked for."""


def _lost(y: mpf, power: int) -> int:
    return 5 + max(0, math.ceil(-power * math.log10(float(abs(y)))))


def _sines(y: mpf) -> tuple[mpf, mpf]:
    """(sin y - y cos y)/y^2 and sin y, with the digits the cancellation takes."""
    with mp.workdps(mp.dps + _lost(y, 3)):
        cosine, sine = mp.cos_sin(y)
        return (sine - y * cosine) / (y * y), sine


def _moments(y: mpf) -> tuple[mpf, mpf]:
    """int_0^1 t^4 sin(y t) dt and sin y, with the digits the cancellation takes."""
    with mp.workdps(mp.dps + _lost(y, 6)):
        cosine, sine = mp.cos_sin(y)
        inverse = 1 / y
        square = inverse * inverse
        odd = (12 * square - 1 - 24 * square * square) * cosine + 24 * square * square
        return inverse * (odd + (4 - 24 * square) * inverse * sine), sine


class Law(NamedTuple):
    """One evaluation of the law for a plate of h/b = eta, lengths in units of b and R."""

    eta: mpf
    setting: Setting

    def _sums(self, x: mpf, kernels: Callable[[mpf], tuple[mpf, mpf]]) -> tuple[mpf, mpf, mpf]:
        """Both kernels of y = x z summed over the nodes, and y where the closed rests begin."""
        nodes = nodes_of(self.eta, *self.setting[:3])
        one, other = [], []
        for z, w in nodes.plain:
            first, second = kernels(x * z)
            one.append(mp.re(w * first))
            other.append(mp.re(w * second))
        return mp.fsum(one), mp.fsum(other), x * nodes.start

    def depth_and_slope(self, x: mpf) -> tuple[mpf, mpf]:
        """delta R/b^2 at a/b = x, f = s(x z)/z^3; and its derivative, f = x sin(x z)/z."""
        depth, slope, y = self._sums(x, _sines)
        with mp.workdps(mp.dps + _lost(y, 3)):
            head = -mp.sin(y) / (2 * y * y) + mp.cos(y) / (2 * y) + mp.si(y) / 2
            depth += (mp.pi / 4 - head) / 2
            slope += (mp.pi / 2 - mp.si(y)) / 2
        return 8 / mp.pi * x * x * depth, 8 / mp.pi * x * slope

    def work_and_slope(self, x: mpf) -> tuple[mpf, mpf]:
        """int_0^x t^3 slope dt, f = (1/z) int_0^x t^4 sin(z t) dt; and the slope."""
        work, slope, y = self._sums(x, _moments)
        rest = mp.pi / 2 - mp.si(y)
        work += (rest + _moments(y)[0]) / 10
        slope += rest / 2
        return 8 / mp.pi * x**5 * work, 8 / mp.pi * x * slope


def _twice(compute: Callable[[Law], Sequence[mpf]], eta: mpf, digits: int) -> list[mpf]:
    """Both settings' results, or none.

    Raises
    ------
    RouteError
        If they differ by more than 10^-(digits + 1), or more digits are asked than this
        route is set for.
    """
    if digits > MAX_DIGITS:
        raise RouteError(f"this route is set for {MAX_DIGITS} digits, got {digits}")
    chosen = SETTINGS[min(limit for limit in SETTINGS if digits <= limit)]
    results = []
    for setting in chosen:
        with mp.workdps(setting.dps):
            results.append(list(compute(Law(eta, setting))))
    with mp.workdps(chosen[-1].dps):
        for one, other in zip(*results, strict=True):
            if not abs(one - other) <= abs(other) * mpf(10) ** (-digits - 1):
                differ = mp.nstr((one - other) / other, 3)
                raise RouteError(f"two evaluations differ by {differ} at h/b = {float(eta)}")
    return results[-1]


def _quotient(one: float, other: float) -> mpf:
    with mp.workdps(SETTINGS[MAX_DIGITS][-1].dps + 10):
        return mpf(one) / mpf(other)


def _inside(x: mpf) -> mpf:
    if not 0 < x < 1:
        raise ValueError(f"the law has meaning for 0 < a/b < 1, got {mp.nstr(x)}")
    return x


def indentation(a: float, R: float, h: float, b: float, digits: int = 40) -> mpf:
    """Indentation at a contact radius."""
    x = _inside(_quotient(a, b))
    return _twice(
        lambda law: [mpf(b) ** 2 / mpf(R) * law.depth_and_slope(x)[0]], _quotient(h, b), digits
    )[0]  # fmt: skip


def slope(a: float, R: float, h: float, b: float, digits: int = 40) -> mpf:
    """d delta/da at a contact radius."""
    x = _inside(_quotient(a, b))
    return _twice(
        lambda law: [mpf(b) / mpf(R) * law.depth_and_slope(x)[1]], _quotient(h, b), digits
    )[0]  # fmt: skip


def hertz_stiffness(R: mpf, lam: float, mu: float) -> mpf:
    """P/a^3 = 4 E*/(3 R)."""
    first, second = mpf(lam), mpf(mu)
    return 16 * second * (first + second) / (first + 2 * second) / (3 * R)


def stiffness(
    a: float, R: float, h: float, b: float, lam: float, mu: float, digits: int = 40
) -> mpf:
    """dP/d delta at a contact radius: (dP/da)/(d delta/da)."""
    x = _inside(_quotient(a, b))

    def compute(law: Law) -> list[mpf]:
        steep = 3 * hertz_stiffness(mpf(R), lam, mu) * mpf(a) ** 2
        return [steep / (mpf(b) / mpf(R) * law.depth_and_slope(x)[1])]

    return _twice(compute, _quotient(h, b), digits)[0]


def _root(function: Callable[[mpf], tuple[mpf, mpf]], target: mpf, start: mpf) -> mpf:
    """x in (0, 1) where an increasing function reaches its target: Newton in logarithms.

    The function gives its value and d log value/d log x. Values beside the root, a
    relative 10^(12 - dps) away, must enclose the target.

    Raises
    ------
    ValueError
        If the target lies beyond the edge of the plate.
    RouteError
        If no root is found.
    """
    x, close = min(start, mpf(1) / 2), mpf(10) ** (-mp.dps // 2 - 4)
    for _ in range(60):
        value, steepness = function(x)
        step = mp.log(target / value) / steepness
        proposed = x * mp.exp(step)
        if proposed > EDGE and not function(EDGE)[0] > target:
            raise ValueError("the contact would reach the edge of the plate")
        x = min(proposed, (x + EDGE) / 2)
        if abs(step) < close:
            break
    margin = x * mpf(10) ** (12 - mp.dps)
    if not function(x - margin)[0] < target < function(x + margin)[0]:
        raise RouteError(f"no root found near {mp.nstr(x)}")
    return x


def contact_radius(delta: float, R: float, h: float, b: float, digits: int = 40) -> mpf:
    """Contact radius at an indentation."""

    def compute(law: Law) -> list[mpf]:
        def function(x: mpf) -> tuple[mpf, mpf]:
            depth, steep = law.depth_and_slope(x)
            return depth, x * steep / depth

        target = mpf(delta) * mpf(R) / mpf(b) ** 2
        # Hertz's, or that of a bent plate, x^3/(4 pi eta^3) = target, if it is smaller.
        start = min(mp.sqrt(target), mp.cbrt(4 * mp.pi * target) * law.eta)
        return [mpf(b) * _root(function, target, start)]

    return _twice(compute, _quotient(h, b), digits)[0]


def impact(
    R: float, m: float, v0: float, h: float, b: float, lam: float, mu: float, digits: int = 30
) -> Impact:
    """The conservative impact: a = a_m sin t takes the root's singularity away."""

    def compute(law: Law) -> list[mpf]:
        stiff = hertz_stiffness(mpf(R), lam, mu)
        unit = stiff * mpf(b) ** 5 / mpf(R)

        def function(x: mpf) -> tuple[mpf, mpf]:
            work, steep = law.work_and_slope(x)
            return work, x**4 * steep / work

        target = mpf(m) * mpf(v0) ** 2 / 2 / unit
        # Hertz's 2 x^5/5, or a bent plate's x^6/(8 pi eta^3), if it leads less far.
        start = min(mp.root(5 * target / 2, 5), mp.root(8 * mp.pi * law.eta**3 * target, 6))
        largest = _root(function, target, start)
        time = _quarter(law, largest) * mp.sqrt(mpf(m) / (2 * unit))
        depth, radius = mpf(b) ** 2 / mpf(R), mpf(b) * largest
        deepest = depth * law.depth_and_slope(largest)[0]
        return [2 * depth * time, deepest, stiff * radius**3, radius]

    return Impact(*_twice(compute, _quotient(h, b), digits))


def _quarter(law: Law, largest: mpf) -> mpf:
    """int slope dx/sqrt(work(largest) - work(x)) from 0 to the largest x, x = largest sin t."""
    total, time, arcs = law.work_and_slope(largest)[0], mpf(0), law.setting.arcs
    for t, w in spread([mp.pi / 2 * k / arcs for k in range(arcs + 1)], law.setting.arc_level):
        work, slope = law.work_and_slope(largest * mp.sin(t))
        time += w * slope * largest * mp.cos(t) / mp.sqrt(total - work)
    return time
