"""The runtime of the impact with one thing wrong, in memory: the oracles notice it."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from itertools import product
from types import ModuleType
from typing import Any

import flint
import numpy as np
import pytest
from flint import arb
from mpmath import mp, mpf
from mutated_code import (
    BEYOND_ALL,
    FINE,
    GUARDS,
    MARGIN,
    ORDER,
    PROMISES,
    SAME,
    SIZE,
    START,
    Answer,
    Case,
    Expected,
    named,
    survivors,
)
from printed_sums import plate_factor, truncated_gamma
from reversed_terms import reversed_terms

from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import forces as contact_forces
from derivation.plate.impact.kernels import simple as tables
from derivation.plate.impact.oracle import impact as contact_impact
from derivation.plate.impact.oracle import printed_motion as motion_balls
from derivation.plate.impact.theory.substitution import exponents
from generated import simple_impact_numbers as numbers
from generated.perturbation import PrintedMotion

Point = tuple[float, ...]
LAME = 0.36e9, 0.43e9

# R, m, v0, h, b
IMPACTS = [(0.13, 72.2, 1.0, 0.1, 1.0, *LAME), (0.13, 72.2, 1.0, 10.0, 1.0, *LAME),
           (2.0, 3e4, 12.0, 0.06, 0.6, *LAME)]  # fmt: skip
SLOW = [(0.13, 0.5, 1e-4, 0.1, 1.0, *LAME)]
SEAMS = [(2.0, 3e4, v0, 0.06, 0.6, *LAME) for v0 in (7.2, 7.5, 50.0)]
SEAMS += [(2.0, 3e4, 2.05, 0.06, 0.2, *LAME)]
"""On both sides of the first polynomial's end, a = 3 h, and before the last one's, 6 h."""
TOO_FAST = [
    (2.0, 3e4, 51.5, 0.06, 0.6, *LAME),
    (0.13, 72.2, 1e9, 0.1, 1.0, *LAME),
    (0.13, -1.0, 1.0, 0.1, 1.0, *LAME),
]


@cache
def impact_cases() -> list[Expected]:
    every = [*IMPACTS, *SLOW, *SEAMS]
    found = [[float(x) for x in contact_impact.impact(*p, digits=18)] for p in every]
    nowhere = [[math.nan] * 4] * len(TOO_FAST)
    return [Case("impact", [*every, *TOO_FAST], [*found, *nowhere]), *map(by_history, IMPACTS)]


def by_history(scene: Point) -> Case:
    """Radii shortly after the start, half way and near the deepest, when they are reached."""
    time, _, _, largest = (float(x) for x in contact_impact.impact(*scene, digits=18))
    R, m, v0, h, b, lam, mu = scene
    radii = [0.3 * largest, 0.7 * largest, 0.97 * largest]
    times = [float(x) for x in contact_impact.history(radii, *scene, digits=18)]
    energy = [float(contact_impact.stored_energy(a, R, h, b, lam, mu, digits=18)) for a in radii]
    rows = [
        (
            float(contact_balls.indentation(a, R, h, b, digits=18)),
            math.sqrt(v0**2 - 2 * work / m),
            a,
            float(contact_forces.force_of_radius(a, R, lam, mu, digits=18)),
        )
        for a, work in zip(radii, energy, strict=True)
    ]
    again = [(depth, -speed, a, load) for depth, speed, a, load in rows]
    start, free = (0.0, v0, 0.0, 0.0), [(0.0, v0, 0.0, 0.0), (0.0, -v0, 0.0, 0.0)]
    moments = [0.0, *times, *(time - t for t in times), -0.1 * time, 1.1 * time]
    return Case("history", [(t, *scene) for t in moments], [start, *rows, *again, *free])


# --- the paper's own motion

PAPER: Point = (0.13, 72.2, 1.0, 0.1, 1.0, *LAME)
OTHERS: Sequence[Point] = [
    (1.3, 0.5, 3.0, 0.02, 0.3, -0.5, 0.8), (1.3, 0.5, 3.0, 0.02, 0.3, -0.5e9, 0.8e9)
]  # fmt: skip
NO_MOTION: Sequence[Point] = [
    (*PAPER[:5], 0.36e9, -1.0), (*PAPER[:5], -0.7e9, 1e9), (*PAPER[:5], -0.7, 1.0),
    (PAPER[0], 0.0, *PAPER[2:]),
]  # fmt: skip
MOTIONS: Sequence[Point] = [(72.2, 1.0, 3e7, 4e8), (0.5, 3.0, 2e5, 8e3), (2.0, 0.01, 30.0, 5e5)]
"""m, v0, xi_2, xi_3: from a small correction to one that counts more than the linear term."""


@cache
def motion_cases() -> list[Expected]:
    known = [(scene, kind) for scene in (PAPER, *OTHERS) for kind in (False, True)]
    found = [Answer(partial(coefficients, motion=x), by_sums(*x)) for x in known]
    nothing = [math.nan] * 4
    found += [Answer(partial(coefficients, motion=(x, True)), nothing) for x in NO_MOTION]
    return [*found, *map(by_motion, MOTIONS), *map(at_the_end, MOTIONS)]


def coefficients(module: ModuleType, motion: tuple[Point, bool]) -> Point:
    scene, corrected = motion
    found = module.printed_motion(*scene, 12, corrected=corrected)
    return found.m, found.v0, found.xi_2, found.xi_3


def by_sums(scene: Point, corrected: bool) -> list[float]:
    with mp.workdps(30):
        gamma_2, gamma_3 = (truncated_gamma(k, 12, scene) for k in (2, 3))
        power = mpf(8) / 3 if corrected else 3
        return [scene[1], scene[2], float(1 / gamma_2), float(-gamma_3 / gamma_2**power)]


def by_motion(numbers: Point) -> Answer:
    """All that is said of a motion: its ends, (15), and (16) on the way and outside."""
    m, v0, xi_2, xi_3 = map(mpf, numbers)
    shares = (0.01, 0.11, 0.5, 0.93)
    with mp.workdps(30):
        rate, excess = mp.sqrt(xi_2 / m), 3 * xi_3 / 4 * (v0 * mp.sqrt(m / xi_2)) ** (mpf(8) / 3)
        excess /= m * v0**2
        last = mp.findroot(
            lambda s: s**2 + excess * s ** (mpf(8) / 3) - 1, (1e-9, 1), solver="anderson"
        )
        breaks = float(mp.asin(last) / rate)
        times = [share * breaks for share in shares]
        linear = [float(v0 / rate * mp.sin(rate * t)) for t in times]
        ends = [mp.pi / rate, v0 / rate, excess, last, breaks, 2 * mp.asin(last) / mp.pi]
    whole = [float(motion_balls.corrected(t, *numbers, digits=16)) for t in times]
    outside = [-1e-3 * breaks, 1.001 * breaks]

    def ask(module: ModuleType) -> list[float]:
        motion = module.PrintedMotion(*numbers)
        names = "contact_time", "max_indentation", "excess", "last", "breaks_at", "share"
        return [
            *(getattr(motion, name) for name in names),
            *motion.linear(np.array(times)),
            float(motion.linear(times[1])),
            *motion.corrected(np.array([*times, *outside])),
            float(motion.corrected(times[1])),
        ]

    true = [*ends, *linear, linear[1], *whole, math.nan, math.nan, whole[1]]
    return Answer(ask, [float(x) for x in true])


def at_the_end(motion: Point) -> Answer:
    """Where the radicand vanishes: what (16) tends to, like a square root."""
    end = PrintedMotion(*motion).breaks_at  # which `by_motion` tests
    true = float(motion_balls.corrected(end * (1 - 1e-10), *motion, digits=12))

    def ask(module: ModuleType) -> float:
        found = module.PrintedMotion(*motion)
        return float(found.corrected(found.breaks_at))

    return Answer(ask, true, 1e-4)


# --- the reversed series

TERMS = 6
SERIES: Sequence[Point] = [
    (1e4, 1.0, 20.0, 6e10, 8e10), (0.7, 1.0, 1.5, -2e10, 8e10), (1e4, 1.0, 4.0, 6e10, 8e10)
]  # fmt: skip
"""R, h, b, lam, mu."""


@cache
def reversed_cases() -> list[Expected]:
    """Within the radius of convergence, and on both sides of it."""
    points, true = [], []
    for R, h, b, lam, mu in SERIES:
        radius = convergence(h, b)
        for share in (0.3, 0.05, 0.8, 0.996, 1.004):
            delta = (share * radius * h) ** 2 / R
            points.append((delta, R, h, b, lam, mu))
            true.append(force_of_series(*points[-1]) if share < 1 else math.nan)
    bad = [
        (-points[0][0], *points[0][1:]),
        (*points[0][:4], -0.7, 1.0),
        (*points[0][:2], -1.0, *points[0][3:]),
    ]
    arguments = [np.array(column) for column in zip(*points, *bad, strict=True)]
    whole = [*true, *([math.nan] * len(bad))]
    one = force_of_series(*points[0], 1)
    return [
        Answer(partial(by_series, arguments=arguments), whole),
        Answer(partial(by_series, arguments=points[0], terms=1), one),
    ]


def by_series(
    module: ModuleType, arguments: Sequence[np.ndarray | float], terms: int = TERMS
) -> np.ndarray:
    found: np.ndarray = module.force_by_series(*arguments, terms=terms)
    return found


def force_of_series(
    delta: float, R: float, h: float, b: float, lam: float, mu: float, terms: int = TERMS
) -> float:
    with flint.ctx.workprec(200):
        stiff = 16 * arb(mu) * (arb(lam) + mu) / (arb(lam) + 2 * arb(mu)) / 3
        a = (arb(R) * arb(delta)).sqrt()
        bracket = sum((p * (a / h) ** n for n, p in enumerate(reversed_terms(h, b, terms))), arb(0))
        return float(stiff * a * arb(delta) * bracket)


def convergence(h: float, b: float) -> float:
    """The largest of the least |eps| on circles on which A, and so the series of F, is small."""
    reach = min(3.0, b / h)
    orders = range(1, 34, 2)
    series = [float(contact_balls.coefficient(n, h, b, 25)) for n in orders]
    directions = np.exp(1j * np.linspace(0.0, np.pi, 401))
    least = []
    for circle in np.geomspace(1e-3, 1.0, 2000) * reach:
        A = circle * directions
        F = sum(c * A**n for c, n in zip(series, orders, strict=True))
        least.append(np.abs(A * np.sqrt(1 + F)).min())
        if least[-1] < 0.9 * max(least):
            break
    return float(max(least))


# --- simple laws


@dataclass(frozen=True)
class Bounded:
    """A bound that a module states: above what it is of, and hardly above what is proved."""

    ask: Callable[[ModuleType], Any]
    true: Any
    above: float

    def holds(self, module: ModuleType) -> bool:
        found, true = np.asarray(self.ask(module), dtype=float), np.asarray(self.true, dtype=float)
        same = (found == true) | ((found >= true) & (found <= true * (1 + self.above)))
        return found.shape == true.shape and bool(same.all())


ETAS = (0.17, 0.3, 1.0, 5.0, 1 / 6.5, 1 / 13, 1 / 40)
"""h/b: by modes, and by the closed forms."""
SIMPLE: Sequence[Point] = [
    (1.0, 2.0, 3e-4, 0.6, 2.0, 3.6e4, 4.3e4), (1.0, 2.0, 0.05, 0.6, 2.0, 3.6e4, 4.3e4),
    (0.9, 2.0, 0.02, 0.5, 0.5, -0.5e4, 0.8e4), (30.0, 0.5, 1e-3, 0.02, 0.8, 3.6e4, 4.3e4),
    (0.01, 2.0, 0.1, 0.6, 2.0, 3.6e4, 4.3e4),
]  # fmt: skip
"""The last wide for its sphere."""
NO_ESTIMATE: Sequence[Point] = [
    (1.0, 2.0, 1e3, 0.3, 1.0, 3.6e4, 4.3e4), (1e-3, 2.0, 0.05, 0.3, 1.0, 3.6e4, 4.3e4),
    (1.0, 1e-101, 0.05, 0.3, 1.0, 3.6e4, 4.3e4), (1.0, 2.0, 0.05, 0.3, 1e51, 3.6e4, 4.3e4),
    (1.0, 2.0, 0.05, 0.3, 1e-51, 3.6e4, 4.3e4), (1.0, 1e101, 0.05, 0.3, 1.0, 3.6e4, 4.3e4),
    (0.01, 2.0, 0.24, 0.6, 2.0, 3.6e4, 4.3e4),
]  # fmt: skip


@cache
def simple_cases() -> list[Expected]:
    found: list[Expected] = []
    for eta in ETAS:
        c_1, K_3 = plate(eta)
        found += [
            Answer(lambda x, eta=eta: x.plate_of(eta).bend, c_1, 1e-8 if eta > 1 / 7 else 1e-12),
            Bounded(lambda x, eta=eta: x.plate_of(eta).rest, K_3, 1.9e-9 if eta > 0.2 else 1.5e-7),
            Bounded(lambda x, eta=eta, c=c_1: x.plate_of(eta).doubt - abs(x.plate_of(eta).bend - c)
                    >= 0, True, 0.0),
        ]  # fmt: skip
    for sizes in product((0.0, 0.01, 0.03), (0.0, 0.02), (0.0, 0.3), (0.0, 0.7, 2.0), (0.0, 0.004)):
        true = [float(x) for x in lemma(*sizes)]
        found.append(Bounded(lambda x, sizes=sizes: x.law_errors(*sizes), true, 1.5e-9))
    endless = [
        (1.0, 0.0, 0.0, 0.0),
        (0.01, 0.0, 2.0, 0.0),
        (0.1, 0.0, 0.0, 0.0),
        (0.01, 1e999, 0.0, 0.0),
    ]
    found += [Answer(lambda x, s=s: x.law_errors(*s), [math.inf] * 4) for s in endless]
    wide = [math.inf, math.inf, *map(float, lemma(0.01, 1e306, 0.0, 0.0)[2:])]
    found.append(Bounded(lambda x: x.law_errors(0.01, 1e306, 0.0, 0.0), wide, 1.5e-9))
    for scene in SIMPLE:
        for name in ("hertz", "leading"):
            results, law = simple(scene, name == "leading")
            found += [
                Answer(
                    lambda x, n=name, s=scene: [*getattr(x, n)(*s)[:4], getattr(x, n)(*s)[5]],
                    results,
                ),
                Bounded(lambda x, n=name, s=scene: getattr(x, n)(*s).law, law, 1e-6),
            ]
    return [*found, Answer(nowhere, [True] * 2 * len(NO_ESTIMATE))]


def nowhere(module: ModuleType) -> list[bool]:
    return [run(*x) is None for x in NO_ESTIMATE for run in (module.hertz, module.leading)]


@cache
def plate(eta: float) -> tuple[float, float]:
    """c_1 by its ball, and K_3 as the theory of the substitution has it."""
    c_1, c_3 = (contact_balls.coefficient(n, eta, 1.0, 25) for n in (1, 3))
    if eta < 1 / tables.THIN:
        return float(c_1), float(-5 * c_3 / 2) + numbers.WALL_CUBIC * eta**3
    with mp.workdps(25):
        total, n = mpf(0), 1
        while 2 * eta * (j := mp.besseljzero(0, n)) < 35:
            total += (plate_factor(2 * eta * j) - 1) / (j * mp.j1(j) ** 2) * j**2
            n += 1
        return float(c_1), float((2 * total / (3 * mp.pi) + numbers.WALL_REST) * mpf(eta) ** 3)


def lemma(low: Any, up: Any, fall: Any, rise: Any, energy: Any = 0) -> list[mpf]:
    """Bounds of time, indentation, force and radius as the theory says the lemma, in products."""
    with mp.workdps(25):
        least, most, fall, rise, more = (
            1 - mpf(low),
            1 + mpf(up),
            mpf(fall),
            mpf(rise),
            mp.exp(energy),
        )
        found = exponents(fall, rise)
        wide, narrow = (more / least) ** (1 / found["energy"]), most ** (1 / found["energy"])
        if wide >= mpf("1.02"):
            return [mp.inf] * 4
        longer, shorter = max(found["longer"], 0), found["shorter"]
        later = most * mp.sqrt(more / least) * max(wide**longer, narrow**shorter)
        sooner = mp.sqrt(most) / least * max(wide**shorter, narrow**longer)
        deep = max(most * wide ** found["depth"], narrow ** found["depth"] / least)
        return [max(later, sooner) - 1, deep - 1, max(wide, narrow) ** 3 - 1, max(wide, narrow) - 1]


def simple(scene: Point, corrected: bool) -> tuple[list[float], float]:
    """Results by delta = a^2/R (1 + c_1 a/h) or by Hertz's law, and how far that may be off."""
    c_1, K_3 = plate(scene[3] / scene[4])
    with mp.workdps(25):
        R, m, v0, h, _, lam, mu = map(mpf, scene)
        c, E = mpf(c_1 if corrected else 0) / h, 4 * mu * (lam + mu) / (lam + 2 * mu)
        work = lambda a: 4 * E / (3 * R**2) * (2 * a**5 / 5 + c * a**6 / 2)  # noqa: E731
        start = (15 * m * v0**2 * R**2 / (16 * E)) ** mpf("0.2")
        a = mp.findroot(lambda x: work(x) / work(start) - m * v0**2 / 2 / work(start), start)
        rate = lambda x: (2 * x + 3 * c * x**2) / R  # noqa: E731

        def step(u: mpf) -> mpf:
            x = a * (1 - u**2)
            return rate(x) * 2 * a * u / mp.sqrt(v0**2 * (1 - work(x) / work(a)))

        time = 2 * mp.quad(step, [0, 0.5, 1], method="gauss-legendre")
        top = mpf("1.02") * a / h
        if corrected:
            steep = 3 * c_1 * top / 2
            law = lemma(K_3 * top**3 / (1 + steep), 0, max(0, -steep / (1 + steep)),
                        max(0, steep / (1 + steep)))  # fmt: skip
        else:
            most = 3 * c_1 * top / 2
            law = lemma(max(0, K_3 * top**3 - most), max(0, most), 0, 0)
        depth, load = a**2 / R * (1 + c * a), 4 * E * a**3 / (3 * R)
        quadrature = numbers.QUADRATURE if corrected else 0
        return [float(x) for x in (time, depth, load, a, quadrature)], float(max(law))


# --- what changes nothing

STEPS = ["_STEPS: 60 -> 120 in _STEPS = 60", "_CLOSE: 1e-09 -> 2e-09 in _CLOSE = 1e-09"]
CIRCLES = "400 * (1 - np.log10(start / reach))"
ORDINARY = "which numbers are ordinary, to a factor"

EQUIVALENT: Mapping[str, Mapping[str, Sequence[str]]] = {
    "impact": {
        ORDER: [
            *STEPS,
            "_deepest: 0.3 -> 0.6 in np.clip(1.0 + step, 0.3, 3.0)",
            "_deepest: 3.0 -> 6.0 in np.clip(1.0 + step, 0.3, 3.0)",
            "_state: 0.1 -> 0.2 in 0.1 * w",
            "_state: 1.0 -> 2.0 in np.clip(w + 2.0 * time * residual / slope, 0.1 * w, 1.0)",
            "_state: _CLOSE * goal -> _CLOSE / goal",
            "_far_deepest: _CLOSE * goal -> _CLOSE / goal",
        ],
        START: [
            "_state: 0.5 * whole[owner] -> 0.5 / whole[owner]",
            "_state: 0.5 -> 1.0 in 0.5 * whole[owner]",
            (
                "_state: np.minimum(goal / np.sqrt(half), 1.0) -> "
                "np.maximum(goal / np.sqrt(half), 1.0)"
            ),
            "_state: goal / np.sqrt(half) -> goal * np.sqrt(half)",
            "_state: np.sqrt(half) -> np.cbrt(half)",
            "_state: 1.0 -> 2.0 in np.minimum(goal / np.sqrt(half), 1.0)",
            "_deepest: 0.0 -> 1 in np.maximum(np.asarray(piece.coefficients[0]), 0.0)",
            "_deepest: 0.4 -> 0.8 in 0.4 / bending",
            "_deepest: 6.0 -> 12.0 in 1.0 / 6.0",
            (
                "_deepest: np.minimum(np.minimum(thin, 1.0), most) -> "
                "np.maximum(np.minimum(thin, 1.0), most)"
            ),
            "_deepest: np.minimum(thin, 1.0) -> np.maximum(thin, 1.0)",
            "_deepest: 1.0 -> 2.0 in np.minimum(thin, 1.0)",
            (
                "_far_deepest: np.minimum(near * (goal / known) ** 0.2, end) -> "
                "np.maximum(near * (goal / known) ** 0.2, end)"
            ),
            "_far_deepest: near * (goal / known) ** 0.2 -> near / (goal / known) ** 0.2",
            "_far_deepest: goal / known -> goal * known",
            "_far_deepest: 0.2 -> 1.2 in (goal / known) ** 0.2",
        ],
        GUARDS: [
            "history: 1.0 -> 2.0 in np.where(t > 0, t, 1.0)",
            "_solve: 1e+200 -> 2e+200 in np.minimum(np.ravel(hertz / h), 1e+200)",
            "_solve: ROUNDED * b -> ROUNDED / b",
            (
                "_far_deepest: kernels.far_work(known, end, rise(end)) * ROUNDED -> "
                "kernels.far_work(known, end, rise(end)) / ROUNDED"
            ),
            "_solve: 1 -> 2 in -1",  # any negative number says that there is none
        ],
        SIZE: [
            "_SCENES: 512 -> 1024 in _SCENES = 512",
            "_solve: 8 -> 16 in _parts(over_h.size, 8)",
        ],
    },
    "impact_shapes": {
        GUARDS: [
            "_far_shapes: 1.0 -> 2.0 in np.minimum(q / ratio, 1.0)",
            "_far_shapes: 0.0 -> 1 in np.where(outside, 0.0, left - gap)",
            "_far_shapes: 1.0 -> 2.0 in np.where(outside, 1.0, left)",
        ],
        SAME: [
            "_near_shapes: terms[-1][:, None] + 0.0 * s -> terms[-1][:, None] - 0.0 * s",
            "_near_shapes: tails[-1][:, None] + 0.0 * s -> tails[-1][:, None] - 0.0 * s",
            "_near_shapes: 0.0 * s -> 0.0 / s",
            "_near_shapes: 0.0 * s -> 0.0 / s",
        ],
    },
    "impact_kernels": {
        ORDER: [
            "deeper_step: 1 -> 2 in exponent - 1",
            "deeper_step: 2 -> 4 in residual * (exponent - 1) / 2",
            "deeper_step: exponent * residual * (inner + 1) -> exponent * residual / (inner + 1)",
            "deeper_step: exponent - 1 -> exponent + 1",
            "deeper_step: residual * (exponent - 1) -> residual / (exponent - 1)",
            "deeper_step: residual * (exponent - 1) / 2 -> residual * (exponent - 1) * 2",
        ],
    },
    "perturbation": {
        FINE: ["_NODES: 24 -> 48 in _NODES = 24", "_PARTS: 27 -> 54 in _PARTS = 27"],
        ORDER: [
            "_STEPS: 60 -> 120 in _STEPS = 60",
            "last: 1e-16 * y -> 1e-16 / y",
            "last: 1e-16 -> 2e-16 in 1e-16 * y",
        ],
        BEYOND_ALL: ["_eta: 0.0 -> 1 in np.append(0.5 ** np.arange(_PARTS), 0.0)"],
        START: ["last: 1.0 -> 2.0 in min(1.0, excess ** (-0.25))"],
        GUARDS: [*(["_eta: 1 -> 2 in _PARTS - 1"] * 2), "_eta: _PARTS - 1 -> _PARTS + 1"],
    },
    "reversed_series": {
        FINE: [
            "_CIRCLE: 128 -> 256 in _CIRCLE = 128",
            "_reversed: 1 -> 2 in _CIRCLE + 1",
            "_reversed: _CIRCLE + 1 -> _CIRCLE - 1",
            f"_reversed: 1 -> 2 in 1 + int({CIRCLES})",
            "_reversed: 1 -> 2 in 1 - np.log10(start / reach)",
            f"_reversed: {CIRCLES} -> {CIRCLES.replace('*', '/')}",
            f"_reversed: 400 -> 800 in {CIRCLES}",
            *(["_reversed: start / reach -> start * reach"] * 2),
        ],
        START: [
            "_reversed: 0.05 -> 0.1 in 0.05 / max(abs(float(row[0])), 1e-300)",
            "_reversed: 1e-300 -> 2e-300 in max(abs(float(row[0])), 1e-300)",
        ],
        SAME: [
            "_reversed: 1.0 -> 2.0 in scaled[0] = 1.0",  # it is taken as 1
            "_reversed: circle * directions -> circle / directions",
            # Of an even number of terms that is F at -A, which is on the same circle.
            "_reversed: value * t + coefficient -> value * t - coefficient",
        ],
    },
    "simple_impact": {
        PROMISES: ["ROUNDING: 4e-14 -> 8e-14 in ROUNDING = 4e-14"],
        ORDER: ["_CLOSE: 4e-15 -> 8e-15 in _CLOSE = 4e-15", "_STEPS: 40 -> 80 in _STEPS = 40"],
        START: [
            "_share: -1.0 -> 1.0",
            "_share: 0.0 -> 1 in y > 0.0",
            "_share: 1.0 -> 2.0 in -1.0",
            "_share: 1.0 -> 2.0 in min(1.0, y ** (-1.0 / 6.0))",
            "_share: 1.0 -> 2.0 in min(1.0, y ** (-1.0 / 6.0)) if y > 0.0 else 1.0",
            "_share: 6.0 -> 12.0 in -1.0 / 6.0",
        ],
        GUARDS: [
            "_DEEP: 0.5 -> 1.0 in _DEEP = 0.5",
            "_share: 2.0 -> 4.0 in -2.0",
            "_share: 3.0 * y * s -> 3.0 * y / s",
            "_share: 3.0 -> 6.0 in 3.0 * y",
        ],
        ORDINARY: [
            "_ORDINARY: 1e+100 -> 2e+100 in (1e-100, 1e+100)",
            "_ORDINARY: 1e-100 -> 2e-100 in (1e-100, 1e+100)",
            "_PLATES: 1e+50 -> 2e+50 in (1e-50, 1e+50)",
            "_PLATES: 1e-50 -> 2e-50 in (1e-50, 1e+50)",
            "_scene: energy / modulus -> energy * modulus",
            "_scene: h / b -> h * b",
        ],
        MARGIN: [
            "plate_of: 1e-13 * size -> 1e-13 / size",
            "plate_of: 1e-13 -> 2e-13 in 1e-13 * size",
            "plate_of: 1e-14 -> 2e-14 in 1e-14 * bend",
            "plate_of: more_bend + 1e-13 * size -> more_bend - 1e-13 * size",
            "plate_of: rest * _SLACK + more_rest -> rest * _SLACK - more_rest",
        ],
    },
}
"""Mutants that change no result, by the reason; every other one must be noticed."""

USERS: Mapping[str, Sequence[str]] = {
    "impact_shapes": ["impact"],
    "impact_kernels": ["impact_shapes", "impact"],
}
"""By whose functions a module is judged that has none of its own."""
CASES: Mapping[str, Callable[[], Sequence[Expected]]] = {
    "impact": impact_cases,
    "impact_shapes": impact_cases,
    "impact_kernels": impact_cases,
    "perturbation": motion_cases,
    "reversed_series": reversed_cases,
    "simple_impact": simple_cases,
}


@pytest.mark.parametrize("name", CASES)
def test_every_mutant_is_noticed_or_changes_nothing(name: str) -> None:
    found = [mutant.name for mutant in survivors(name, CASES[name](), USERS.get(name, ()))]
    assert sorted(found) == named(EQUIVALENT.get(name, {}))
