"""Oracle 2 of the contact law: the modal sum added up in mpmath, mode by mode, then accelerated.

Indentation, slope and work are sums of one kernel each over the nodes of
`contact.oracle.modes`. Everything is done twice, with other nodes, another number of modes
and more digits; where the two differ there is no answer. For many digits a caller may ask
for one evaluation, if it has the other oracle's value to compare with.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from mpmath import mp, mpf

from derivation.engine.oracle.agreement import RouteError
from derivation.plate.contact.oracle.modes import nodes_of, spread


class RouteImpact(NamedTuple):
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
        3 * 2^(level - 1) Gauss-Legendre nodes to an interval of G - 1's integral, thin plates only.
    dps
        Working digits.
    arcs, arc_level
        Into how many intervals the quarter turn of an impact is cut, and 3 * 2^(arc_level - 1)
        Gauss-Legendre nodes for each.
    """

    first: int
    level: int
    dps: int
    arcs: int
    arc_level: int


Settings = Sequence[Setting] | None
"""What a caller asks for: evaluations to agree, or None for those of `SETTINGS`."""

SETTINGS: dict[int, tuple[Setting, Setting]] = {
    24: (Setting(20, 4, 38, 2, 4), Setting(24, 4, 42, 3, 4)),
    42: (Setting(30, 5, 56, 4, 4), Setting(37, 6, 62, 3, 5)),
}
"""Up to so many digits, the two evaluations that must agree: light ones, and full ones."""

MAX_DIGITS = max(SETTINGS)
_SPARE = 20
"""Working digits beyond those asked, where one evaluation is asked for."""
_PER_NODE = {1: 0.7, 2: 1.2, 3: 1.5, 4: 1.7}
"""Digits that each Gauss-Legendre node of an arc brings if there are so many arcs."""

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


class SumLaw(NamedTuple):
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


def setting(digits: int) -> tuple[Setting]:
    """How a single evaluation to any number of digits is done."""
    dps = digits + _SPARE
    level = max(5, math.ceil(math.log2(dps / 2.4)) + 1)
    cuts = [(arcs, rank) for arcs in _PER_NODE for rank in range(4, 12)]
    enough = [(n, k) for n, k in cuts if 3 * 2 ** (k - 1) * _PER_NODE[n] >= digits + 6]
    arcs, rank = min(enough, key=lambda cut: cut[0] * 2 ** cut[1])
    return (Setting(dps // 2 + 6, level, dps, arcs, rank),)


def _results(
    compute: Callable[[SumLaw], Sequence[mpf]],
    h: float,
    b: float,
    digits: int,
    settings: Settings = None,
) -> list[mpf]:
    """Both settings' results, or none; the only one's, if there is one.

    Raises
    ------
    RouteError
        If they differ by more than 10^-(digits + 1), or more digits are asked than this
        route is set for.
    """
    if settings is None and digits > MAX_DIGITS:
        raise RouteError(f"this route is set for {MAX_DIGITS} digits, got {digits}")
    chosen = settings or SETTINGS[min(limit for limit in SETTINGS if digits <= limit)]
    eta = _quotient(h, b, digits)
    results = []
    for one in chosen:
        with mp.workdps(one.dps):
            results.append(list(compute(SumLaw(eta, one))))
    with mp.workdps(chosen[-1].dps):
        for light, full in zip(results[0], results[-1], strict=True):
            if not abs(light - full) <= abs(full) * mpf(10) ** (-digits - 1):
                differ = mp.nstr((light - full) / full, 3)
                raise RouteError(f"two evaluations differ by {differ} at h/b = {float(eta)}")
    return results[-1]


def _quotient(one: float, other: float, digits: int) -> mpf:
    with mp.workdps(digits + 30):
        return mpf(one) / mpf(other)


def _inside(x: mpf) -> mpf:
    if not 0 < x < 1:
        raise ValueError(f"the law has meaning for 0 < a/b < 1, got {mp.nstr(x)}")
    return x


def indentation(
    a: float, R: float, h: float, b: float, digits: int = 40, settings: Settings = None
) -> mpf:
    """Indentation at a contact radius."""
    x = _inside(_quotient(a, b, digits))
    return _results(
        lambda law: [mpf(b) ** 2 / mpf(R) * law.depth_and_slope(x)[0]], h, b, digits, settings
    )[0]  # fmt: skip


def slope(a: float, R: float, h: float, b: float, digits: int = 40) -> mpf:
    """d delta/da at a contact radius."""
    x = _inside(_quotient(a, b, digits))
    return _results(
        lambda law: [mpf(b) / mpf(R) * law.depth_and_slope(x)[1]], h, b, digits
    )[0]  # fmt: skip


def hertz_stiffness(R: mpf, lam: float, mu: float) -> mpf:
    """P/a^3 = 4 E*/(3 R)."""
    first, second = mpf(lam), mpf(mu)
    return 16 * second * (first + second) / (first + 2 * second) / (3 * R)


def stiffness(
    a: float, R: float, h: float, b: float, lam: float, mu: float, digits: int = 40,
    settings: Settings = None,
) -> mpf:  # fmt: skip
    """dP/d delta at a contact radius: (dP/da)/(d delta/da)."""
    x = _inside(_quotient(a, b, digits))

    def compute(law: SumLaw) -> list[mpf]:
        steep = 3 * hertz_stiffness(mpf(R), lam, mu) * mpf(a) ** 2
        return [steep / (mpf(b) / mpf(R) * law.depth_and_slope(x)[1])]

    return _results(compute, h, b, digits, settings)[0]


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

    def compute(law: SumLaw) -> list[mpf]:
        def function(x: mpf) -> tuple[mpf, mpf]:
            depth, steep = law.depth_and_slope(x)
            return depth, x * steep / depth

        target = mpf(delta) * mpf(R) / mpf(b) ** 2
        # Hertz's, or that of a bent plate, x^3/(4 pi eta^3) = target, if it is smaller.
        start = min(mp.sqrt(target), mp.cbrt(4 * mp.pi * target) * law.eta)
        return [mpf(b) * _root(function, target, start)]

    return _results(compute, h, b, digits)[0]


def impact(
    R: float, m: float, v0: float, h: float, b: float, lam: float, mu: float, digits: int = 30,
    settings: Settings = None,
) -> RouteImpact:  # fmt: skip
    """The conservative impact: a = a_m sin t takes the root's singularity away."""

    def compute(law: SumLaw) -> list[mpf]:
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

    return RouteImpact(*_results(compute, h, b, digits, settings))


def _quarter(law: SumLaw, largest: mpf) -> mpf:
    """int slope dx/sqrt(work(largest) - work(x)) from 0 to the largest x, x = largest sin t."""
    total, time, arcs = law.work_and_slope(largest)[0], mpf(0), law.setting.arcs
    for t, w in spread([mp.pi / 2 * k / arcs for k in range(arcs + 1)], law.setting.arc_level):
        work, slope = law.work_and_slope(largest * mp.sin(t))
        time += w * slope * largest * mp.cos(t) / mp.sqrt(total - work)
    return time
