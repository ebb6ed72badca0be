"""Mutation tests of the pressure solution: independent values detect each error in the code."""

import math
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from mutated_code import BEYOND_ALL, GUARDS, ModuleTests, undetected
from within_ulp import WithinUlp

from derivation.plate.pressure import oracle as pressure_balls
from generated.pressure_numbers import ERROR

NAN = math.nan

SOLVED = (
    # a/h, b/h, R/h, E* over that of the plate, sphere
    (0.5, 2.0, 0.8, 0.75, True),
    (3.0, 10.0, 50.0, 1.0, False),
    (0.9, 1.2, 2.0, 0.6, False),
    (5.0, 8.5, 90.0, 1.0, False),
    (2.0, 40.0, 3.0, 0.75, True),
    (5.5, 300.0, 90.0, 1.0, False),
)
E, H = 7e10, 0.125
ULP = ERROR / float(np.finfo(float).eps)
PLACES = 0.25, 0.9375


def pressure_cases() -> list[WithinUlp]:
    actual = []
    for numbers in SOLVED:
        for compliance in (0.0, 2e-10):
            actual.append(solved(*numbers, compliance))
        actual.append(distribution(*numbers))
    actual += [work(*numbers) for numbers in SOLVED[:3]]
    actual += [edge_as_sphere(*sizes) for sizes in ((200.0, 0.1), (3.0, -0.3))]
    return [*actual, *invalid_contacts(), in_other_units(0.5)]


@cache
def state(
    a: float, v: float, R: float, modulus_ratio: float, sphere: bool
) -> pressure_balls.PressureState:
    points = () if sphere else PLACES
    return pressure_balls.solve(
        pressure_balls.case(a, 1.0, v, R if sphere else 0, modulus_ratio, points), 18
    )


def solved(
    a: float, v: float, R: float, modulus_ratio: float, sphere: bool, compliance: float
) -> WithinUlp:
    """Return the case of force, indentation, stiffness, slope, pressures and chi at the nodes.

    The pressure at the centre almost vanishes for a = 6 h: it is added to the mean pressure.
    """
    exact, own = state(a, v, R, modulus_ratio, sphere), modulus_ratio * E
    width, radius = a * H, R * H
    force = own * width**3 / radius * float(exact.force)
    stiffness = own * width * float(exact.stiffness)
    nodes, weights = (x[len(x) // 2 :] for x in np.polynomial.legendre.leggauss(48))
    values = [
        force,
        width**2 / radius * float(exact.depth) + compliance * force,
        1 / (1 / stiffness + compliance),
        width / radius * float(exact.slope) * (1 + compliance * stiffness),
        own * width / radius * float(exact.centre) + force / (math.pi * width**2),
        force / (math.pi * width**2),
        width,
        force,
        width * nodes[0],
    ]

    def call(m: ModuleType) -> list[float]:
        radii = np.full(9, width)  # more than one batch
        every = m.contact(
            m.plate(H, v * H), radii, radius, own, E, sphere=sphere, compliance=compliance
        )
        got = [x[-1] for x in every]
        carried = 2 * np.pi * width * weights @ got[9]
        return [*got[1:5], got[6] + got[7], got[7], got[0], carried, got[8][0]]

    return WithinUlp(call, np.array(values), ULP)


def distribution(a: float, v: float, R: float, modulus_ratio: float, sphere: bool) -> WithinUlp:
    """Return the case of the pressure: total force, two reference values, NaN outside."""
    exact, own = state(a, v, R, modulus_ratio, sphere), modulus_ratio * E
    width, radius = a * H, R * H
    nodes, weights = np.polynomial.legendre.leggauss(40)
    u, w = (1 + nodes) / 2, weights / 2

    def call(m: ModuleType) -> list[float]:
        of = m.plate(H, v * H)
        r = np.append(width * np.sqrt((1 - u) * (1 + u)), [PLACES[0] * width, PLACES[1] * width])
        q = m.pressure(r, of, width, radius, own, E, sphere=sphere)
        ends = m.pressure([-0.1 * width, 1.01 * width], of, width, radius, own, E, sphere=sphere)
        alone = m.pressure(width, of, width, radius, own, E, sphere=sphere)
        carried = 2 * np.pi * width**2 * (q[:40] * u) @ w
        return [carried, *([] if sphere else q[40:]), *ends, alone]

    force = own * width**3 / radius * float(exact.force)
    pressures = [own * width / radius * float(x) for x in exact.pressures]
    return WithinUlp(call, np.array([force, *pressures, NAN, NAN, 0.0]), ULP)


def work(a: float, v: float, R: float, modulus_ratio: float, sphere: bool) -> WithinUlp:
    """Return the case that dU = P d delta holds along a."""
    width, radius = a * H, R * H
    nodes, weights = np.polynomial.legendre.leggauss(30)

    def call(m: ModuleType) -> float:
        of, kept = m.plate(H, v * H), {"sphere": sphere, "compliance": 2e-10}
        path = m.contact(of, width * (1 + nodes) / 2, radius, modulus_ratio * E, E, **kept)
        end = m.contact(of, width, radius, modulus_ratio * E, E, **kept)
        return float(width * (path.force * path.slope) @ weights / 2 / end.energy)

    return WithinUlp(call, np.asarray(1.0), 1e6)


def edge_as_sphere(v: float, edge: float) -> WithinUlp:
    """Return the case that an edge acts like a sphere of the curvature 1/R + kappa P.

    kappa is that of a point load times the mean of 1 - 2 t^2/b^2.
    """
    weights = np.polynomial.legendre.leggauss(48)[1][24:]

    def call(m: ModuleType) -> float:
        plain, with_edge = (m.contact(m.plate(H, v * H, x), 0.8 * H, 1e3, E) for x in (0.0, edge))
        spread = (
            (with_edge.nodes / (v * H)) ** 2 @ (weights * with_edge.chi) / (weights @ with_edge.chi)
        )
        kappa = edge / (2.0 * E * H**3) * (1.0 - 2.0 * spread)
        return float(with_edge.force / plain.force / (1.0 + kappa * 1e3 * with_edge.force))

    return WithinUlp(call, np.asarray(1.0), 1000.0)


def in_other_units(unit: float) -> WithinUlp:
    """Return the case that force and pressure are proportional to E*."""

    def call(m: ModuleType) -> list[float]:
        of = m.plate(H, 2 * H)
        one, other = (
            (float(m.contact(of, 0.1, 1.0, x).force), float(m.pressure(0.05, of, 0.1, 1.0, x)))
            for x in (1.0, unit)
        )
        return [small / large for small, large in zip(other, one, strict=True)]

    return WithinUlp(call, np.full(2, unit), 2.0)


def invalid_contacts() -> list[WithinUlp]:
    """Return the case of NaN results for an invalid contact or plate."""
    within = 0.1, 1.0, 50.0, 1.0, 1.0
    outside = [
        (0.0, *within[1:]), (-0.1, *within[1:]), (0.951, *within[1:]), (0.1, 1.0, 0.1, 1.0, 1.0),
        (0.1, 1.0, 50.0, 0.0, 1.0), (0.1, 1.0, 50.0, 1.0, 0.9), (7.01, 1e3, 50.0, 1.0, 1.0),
        (6.5, 1e3, 50.0, 1.0, 1.0),
    ]  # fmt: skip

    def force(m: ModuleType, a: float, b: float, R: float, modulus: float, own: float) -> float:
        return float(m.contact(m.plate(1.0, b), a, R, modulus, own).force)

    actual = [WithinUlp(lambda m, p=point: force(m, *p), np.asarray(NAN), 0.0) for point in outside]
    none = np.array([NAN, NAN, 0.0, 0.0])
    sizes = (0.0, 1.0), (1.0, 0.0), (-1.0, -2.0), (1e-91, 1.0), (1e91, 1.0), (1e-60, 1e60)
    for size in (*sizes, (1e60, 1e-60)):
        actual.append(WithinUlp(lambda m, size=size: numbers_of(m.plate(*size)), none, 0.0))
    thin = WithinUlp(lambda m: float(m.plate(1.0, 100.0).rises.size), np.asarray(0.0), 0.0)
    steep = WithinUlp(
        lambda m: float(m.contact(m.plate(1.0, 2.0), 0.48, 0.5, 1.0, sphere=True).force),
        np.asarray(NAN),
        0.0,
    )
    return [*actual, thin, steep]


def numbers_of(plate: Any) -> list[float]:
    return [plate.h, plate.first, plate.waves.size, plate.rises.size]


TESTS = {
    "non_hertzian_pressure": ModuleTests(
        pressure_cases,
        {
            "plate": (2, BEYOND_ALL),
            "contact": (1, "contact is lost at the centre before the limit"),
            "_unit_solutions": (1, GUARDS),
        },
    )
}


@pytest.mark.parametrize("name", TESTS)
def test_mutants_are_detected_up_to_the_listed_number(name: str) -> None:
    assert undetected(name, TESTS[name]) == {}
