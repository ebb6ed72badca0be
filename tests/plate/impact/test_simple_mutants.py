"""Mutation tests of impacts by simple laws: independent evaluations detect each error."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf
from mutated_code import GUARDS, MARGIN, Expected, ExpectedResult, ModuleTests, undetected
from printed_sums import plate_factor

from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.impact.kernels import simple as tables
from derivation.plate.impact.theory.substitution import exponents
from generated import simple_impact_numbers as numbers

Point = tuple[float, ...]
LAME = 0.36e9, 0.43e9
ORDINARY = "limits of the numbers for which an error is estimated"

# --- simple laws


@dataclass(frozen=True)
class Bounded:
    """A bound of a module, which must be from `expected` (proved) to (1 + `above`) times that."""

    call: Callable[[ModuleType], Any]
    expected: Any
    above: float

    def accepts(self, module: ModuleType) -> bool:
        actual, exact = (
            np.asarray(self.call(module), dtype=float),
            np.asarray(self.expected, dtype=float),
        )
        same = (actual == exact) | ((actual >= exact) & (actual <= exact * (1 + self.above)))
        return actual.shape == exact.shape and bool(same.all())


ETAS = (0.17, 0.3, 1.0, 5.0, 1 / 6.5, 1 / 13, 1 / 40)
"""Values of h/b for the sum over modes and for the closed forms."""
SIMPLE: Sequence[Point] = [
    (1.0, 2.0, 3e-4, 0.6, 2.0, 3.6e4, 4.3e4), (1.0, 2.0, 0.05, 0.6, 2.0, 3.6e4, 4.3e4),
    (0.9, 2.0, 0.02, 0.5, 0.5, -0.5e4, 0.8e4), (30.0, 0.5, 1e-3, 0.02, 0.8, 3.6e4, 4.3e4),
    (0.01, 2.0, 0.1, 0.6, 2.0, 3.6e4, 4.3e4),
    (1.0, 2e-60, 0.05, 0.6, 2.0, 3.6e-56, 4.3e-56),
]  # fmt: skip
"""Scenes, among them a contact wide compared with its sphere, and one in other units."""
NO_ESTIMATE: Sequence[Point] = [
    (1.0, 2.0, 1e3, 0.3, 1.0, 3.6e4, 4.3e4), (1e-3, 2.0, 0.05, 0.3, 1.0, 3.6e4, 4.3e4),
    (1.0, 1e-101, 0.05, 0.3, 1.0, 3.6e4, 4.3e4), (1.0, 2.0, 0.05, 0.3, 1e51, 3.6e4, 4.3e4),
    (1.0, 2.0, 0.05, 0.3, 1e-51, 3.6e4, 4.3e4), (1.0, 1e101, 0.05, 0.3, 1.0, 3.6e4, 4.3e4),
    (0.01, 2.0, 0.24, 0.6, 2.0, 3.6e4, 4.3e4),
]  # fmt: skip


@cache
def simple_cases() -> list[Expected]:
    actual: list[Expected] = []
    for eta in ETAS:
        c_1, K_3 = plate(eta)
        actual += [
            ExpectedResult(lambda x, eta=eta: x.plate_of(eta).bend, c_1,
                           1e-8 if eta > 1 / 7 else 1e-12),
            Bounded(lambda x, eta=eta: x.plate_of(eta).rest, K_3, 1.9e-9 if eta > 0.2 else 1.5e-7),
            Bounded(lambda x, eta=eta, c=c_1: x.plate_of(eta).bend_error
                    - abs(x.plate_of(eta).bend - c) >= 0, True, 0.0),
        ]  # fmt: skip
    for sizes in product((0.0, 0.01, 0.03), (0.0, 0.02), (0.0, 0.3), (0.0, 0.7, 2.0), (0.0, 0.004)):
        exact = [float(x) for x in lemma(*sizes)]
        actual.append(Bounded(lambda x, sizes=sizes: x.law_errors(*sizes), exact, 1.5e-9))
    unbounded = [
        (1.0, 0.0, 0.0, 0.0),
        (0.01, 0.0, 2.0, 0.0),
        (0.1, 0.0, 0.0, 0.0),
        (0.01, 1e999, 0.0, 0.0),
    ]
    actual += [ExpectedResult(lambda x, s=s: x.law_errors(*s), [math.inf] * 4) for s in unbounded]
    wide = [math.inf, math.inf, *map(float, lemma(0.01, 1e306, 0.0, 0.0)[2:])]
    actual.append(Bounded(lambda x: x.law_errors(0.01, 1e306, 0.0, 0.0), wide, 1.5e-9))
    for scene in SIMPLE:
        for name in ("hertz", "leading"):
            results, law = simple(scene, name == "leading")
            actual += [
                ExpectedResult(
                    lambda x, n=name, s=scene: [*getattr(x, n)(*s)[:4], getattr(x, n)(*s)[5]],
                    results,
                ),
                Bounded(lambda x, n=name, s=scene: getattr(x, n)(*s).law, law, 1e-6),
            ]
    return [*actual, ExpectedResult(without_estimate, [True] * 2 * len(NO_ESTIMATE))]


def without_estimate(module: ModuleType) -> list[bool]:
    return [run(*x) is None for x in NO_ESTIMATE for run in (module.hertz, module.leading)]


@cache
def plate(eta: float) -> tuple[float, float]:
    """Return c_1 from Arb and K_3 from the theory of the substitution."""
    c_1, c_3 = (contact_balls.coefficient(n, eta, 1.0, 25) for n in (1, 3))
    if eta < 1 / tables.THIN:
        return float(c_1), float(-5 * c_3 / 2) + numbers.LATERAL_CUBIC * eta**3
    with mp.workdps(25):
        total, n = mpf(0), 1
        while 2 * eta * (j := mp.besseljzero(0, n)) < 35:
            total += (plate_factor(2 * eta * j) - 1) / (j * mp.j1(j) ** 2) * j**2
            n += 1
        return float(c_1), float((2 * total / (3 * mp.pi) + numbers.LATERAL_REST) * mpf(eta) ** 3)


def lemma(low: Any, up: Any, fall: Any, rise: Any, energy: Any = 0) -> list[mpf]:
    """Return the bounds of time, indentation, force and radius by the lemma, as products."""
    with mp.workdps(25):
        least, most, fall, rise, more = (
            1 - mpf(low),
            1 + mpf(up),
            mpf(fall),
            mpf(rise),
            mp.exp(energy),
        )
        actual = exponents(fall, rise)
        wide, narrow = (more / least) ** (1 / actual["energy"]), most ** (1 / actual["energy"])
        if wide >= mpf("1.02"):
            return [mp.inf] * 4
        longer, shorter = max(actual["longer"], 0), actual["shorter"]
        later = most * mp.sqrt(more / least) * max(wide**longer, narrow**shorter)
        sooner = mp.sqrt(most) / least * max(wide**shorter, narrow**longer)
        deep = max(most * wide ** actual["depth"], narrow ** actual["depth"] / least)
        return [max(later, sooner) - 1, deep - 1, max(wide, narrow) ** 3 - 1, max(wide, narrow) - 1]


def simple(scene: Point, corrected: bool) -> tuple[list[float], float]:
    """Return results by delta = a^2/R (1 + c_1 a/h) or Hertz's law, and their error bound."""
    c_1, K_3 = plate(scene[3] / scene[4])
    with mp.workdps(25):
        R, m, v0, h, _, lam, mu = map(mpf, scene)
        c, E = mpf(c_1 if corrected else 0) / h, 4 * mu * (lam + mu) / (lam + 2 * mu)
        work = lambda a: 4 * E / (3 * R**2) * (2 * a**5 / 5 + c * a**6 / 2)  # noqa: E731
        start = (15 * m * v0**2 * R**2 / (16 * E)) ** mpf("0.2")
        a = start * mp.findroot(lambda x: (work(x * start) - m * v0**2 / 2) / work(start), 1)
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


TESTS = {
    "simple_impact": ModuleTests(
        simple_cases,
        {
            **dict.fromkeys(("ORDINARY", "PLATES"), (2, ORDINARY)),
            "_scene": (1, ORDINARY),
            "DEEP": (1, GUARDS),
            "_radius_ratio": (4, GUARDS),
            "ROUNDING": (1, MARGIN),
            "with_margins_of_thin": (1, MARGIN),
            "with_margins_of_thick": (4, MARGIN),
        },
        steps=6,
    )
}


@pytest.mark.parametrize("name", TESTS)
def test_mutants_are_detected_up_to_the_listed_number(name: str) -> None:
    assert undetected(name, TESTS[name]) == {}
