"""Where the generated code changes its form, hard cases lie on both sides."""

import math
from collections.abc import Iterable, Mapping
from fractions import Fraction

import pytest
from seams import SEAMS as KERNEL_SEAMS
from seams import Place, Seam
from wave_seams import WAVE_SEAMS

from derivation.engine.formula.ulp import ordinal
from derivation.engine.measure.case import HardCase
from derivation.engine.measure.places import OFFSETS
from derivation.plate.cases import suite as hard_suite

SEAMS = KERNEL_SEAMS | WAVE_SEAMS


def missing(seam: Seam, cases: Iterable[HardCase]) -> list[str]:
    """Kernels and places without cases at the place, and 1 and 32 ULP to either side."""
    values: dict[str, set[float]] = {kernel: set() for kernel in seam.kernels}
    for case in cases:
        if case.kernel in values:
            for point in case.points:
                if all(map(math.isfinite, point.values())):
                    values[case.kernel].add(value_of(seam, point))
    return [
        f"{kernel} at {float(place):.17g}"
        for place in seam.places()
        for kernel, found in values.items()
        if not surrounded(place, found)
    ]


def value_of(seam: Seam, point: Mapping[str, float]) -> float:
    """The variable as a double; NaN where it has no meaning."""
    try:
        return float(seam.of({name: Fraction(x) for name, x in point.items()}))
    except (ZeroDivisionError, OverflowError, KeyError):
        return math.nan


def surrounded(place: Place, found: Iterable[float]) -> bool:
    """Whether values lie as `OFFSETS` do, up to what rounding the variable makes of them.

    Whole numbers are their own neighbours.
    """
    if isinstance(place, int) and place > 1:
        return {place + offset for offset in OFFSETS if place + offset > 0} <= set(found)
    middle = ordinal(float(place))
    steps = [ordinal(x) - middle for x in found if math.isfinite(x)]
    near = sorted(step for step in steps if abs(step) <= 80)
    beside = [step for step in near if abs(step) <= 4]
    return (
        len(near) >= len(OFFSETS)
        and near[0] <= -14
        and near[-1] >= 14
        and any(step < 0 for step in beside)
        and any(step > 0 for step in beside)
    )


@pytest.mark.parametrize("name", SEAMS)
def test_every_seam_has_cases_on_both_sides(name: str) -> None:
    assert missing(SEAMS[name], hard_suite.cases()) == []


@pytest.mark.parametrize("name", ["thin edge", "sphere", "index of kappa", "cells of the law"])
def test_a_seam_without_cases_is_noticed(name: str) -> None:
    seam = SEAMS[name]
    others = [case for case in hard_suite.cases() if case.kernel != seam.kernels[0]]
    assert missing(seam, others)
    moved = Seam(seam.kernels, seam.of, lambda: [float(x) * 1.001 for x in seam.places()])
    assert missing(moved, hard_suite.cases())
