"""Hard cases of the plate's waves: switch points, ends of ranges, poles, shapes."""

import math
from collections.abc import Iterator
from fractions import Fraction
from itertools import chain, product

from derivation.engine.measure.case import HardCase
from derivation.engine.measure.neighbours import (
    Inputs,
    around,
    case_around,
    exact_inputs,
    neighbour,
)
from derivation.plate.waves import oracle as inertia_balls
from derivation.plate.waves.cases.switch_points import CROSSINGS, crossing
from generated.wave_numbers import NEAR, SHALLOW, SMALL

WAVES = "switch points of the plate's waves"
HARD_WAVES = "waves of the plate"

LOWEST = ("bending_frequency", "bending_residue", "bending_fraction")
BRANCHES = ("antisymmetric_frequency", "antisymmetric_residue", "symmetric_frequency",
            "symmetric_residue")  # fmt: skip
INFLUENCE = "dynamic_influence"

_METAL = 0.3
_LAST, _FIRST = math.nextafter(0.5, 0.0), -1.0 + 2.0**-53
RATIOS = (_METAL, 0.0, _LAST, _FIRST, -1e-300)
"""Poisson's ratios, including the limits of their range."""
_NEAREST = 2**10
"""Distance in ULP from a pole: closer, the value depends on the last bits like 1/x at 0."""


def wave_families() -> Iterator[HardCase]:
    """Yield the hard cases of the plate's waves."""
    return chain(
        _lowest_switches(), _influence_switches(), _branch_switches(), _lowest(),
        _influence(), _branches(), _shapes(),
    )  # fmt: skip


# --- switch points


def _lowest_switches() -> Iterator[HardCase]:
    everywhere = {SHALLOW: LOWEST, SMALL: LOWEST[2:], 1.0: LOWEST[2:]}
    what = {
        SHALLOW: "where a power series is replaced by exponentials",
        SMALL: "above which the fraction of A0 is no longer 1 minus a small difference",
        1.0: "above which sinh T - T, T = 2 x, is no longer a power series",
    }
    for (point, kernels), nu in product(everywhere.items(), (_METAL, _LAST, _FIRST)):
        for kernel in kernels:
            given = exact_inputs(x=around(point), nu=nu)
            yield case_around(WAVES, kernel, f"x = {point:g}, {what[point]}", given)


def _influence_switches() -> Iterator[HardCase]:
    gam = (1 - 2 * Fraction(_METAL)) / (2 * (1 - Fraction(_METAL)))
    for x in (1e-3, 0.7, 20.1):
        square = Fraction(x) ** 2
        for load, what in (
            (square, "kap = x^2, above which q is imaginary"),
            (square / gam, "gam kap = x^2, above which p is imaginary"),
            (3 * square / (4 - gam), "2 q = p, the switch point of two forms of a difference"),
        ):
            given = exact_inputs(x=x, kap=around(float(load)), nu=_METAL)
            yield case_around(WAVES, INFLUENCE, f"{what}; x = {x:g}", given)
    for kap in (0.0, 2.0):
        # p + q = S and p - q = (1 - gam) kap/S.
        p = (Fraction(NEAR) + (1 - gam) * Fraction(kap) / Fraction(NEAR)) / 2
        x = math.sqrt(p * p + gam * Fraction(kap))
        why = f"p + q = {NEAR:g} at kap = {kap:g}, below which F is a power series"
        yield case_around(WAVES, INFLUENCE, why, exact_inputs(x=around(x), kap=kap, nu=_METAL))


def _branch_switches() -> Iterator[HardCase]:
    for name, of in CROSSINGS.items():
        point = crossing(name)
        given = exact_inputs(x=around(point), nu=of.nu, index=float(of.index))
        yield case_around(WAVES, f"{of.kind}_residue", f"x = {point:g}, where {name}", given)


# --- ends of ranges


def _lowest() -> Iterator[HardCase]:
    thinnest, shortest = 1e-90, 1e90
    x = (thinnest, 1e-40, 1e-8, 1e-3, 0.3, 1.5, 17.0, 300.0, 1e5, 1e40, shortest)
    for kernel, nu in product(LOWEST, RATIOS):
        cause = f"From the thinnest plates to Rayleigh waves: nu = {nu:.17g}."
        yield HardCase(HARD_WAVES, kernel, cause, exact_inputs(x=x, nu=nu), "array")
    for kernel in LOWEST:
        ends = (neighbour(thinnest, -1), neighbour(shortest, 1))
        yield from _rejected_arguments(HARD_WAVES, kernel, "x", (*ends, *_NO_LENGTHS), nu=_METAL)
        yield from _rejected_arguments(HARD_WAVES, kernel, "nu", _NO_RATIOS, x=1.0)


_NO_LENGTHS = (0.0, -1.0, 5e-324, math.inf, math.nan)
_NO_RATIOS = (0.5, -1.0, math.inf, -math.inf, math.nan)


def _rejected_arguments(
    group: str, kernel: str, name: str, points: tuple[float, ...], **same: float
) -> Iterator[HardCase]:
    """Yield values outside the domain of an argument: all in one array, and single ones."""
    cause = f"Values of {name} outside the domain."
    for given, form in ((points, "array"), (points[0], "scalar")):
        yield HardCase(
            group, kernel, cause, exact_inputs(**{name: given}, **same), form, expect="nan"
        )


def _influence() -> Iterator[HardCase]:
    x = (1e-40, 1e-8, 0.3, 1.0, 2.0, 300.0, 1e40)
    for nu in (_METAL, _LAST, _FIRST):
        loads = {"static": 0.0, "of a subnormal number": 5e-324}
        for what, load in loads.items():
            cause = f"A load that is {what}, at nu = {nu:.17g}."
            yield HardCase(
                HARD_WAVES, INFLUENCE, cause, exact_inputs(x=x, kap=load, nu=nu), "array"
            )
    for nu in (_METAL, _LAST, -0.9):  # at nu = -1 the lowest symmetric branch is there
        cause = f"A load of kap = x^2, where the expression is 0/0: nu = {nu:.17g}."
        given = exact_inputs(x=x, kap=tuple(y * y for y in x), nu=nu)
        yield HardCase(HARD_WAVES, INFLUENCE, cause, given, "array")
    for y in (1e-3, 0.7, 30.0):
        for index, kind in product((0, 1, 5), inertia_balls.KINDS):
            point = float(inertia_balls.zero(y, _METAL, kind, index))
            yield _next_to(y, point, f"branch {index} ({kind}), a pole")
        for angle, what in ((0.5, "bending"), (1.0, "stretching")):
            yield _next_to(y, y * y + (angle * math.pi) ** 2, f"a zero of the part in {what}")
    cause = "Frequencies above all branches that can be separated."
    given = exact_inputs(x=(1.0, 1e-40, 1e39), kap=1e80, nu=_METAL)
    yield HardCase(HARD_WAVES, INFLUENCE, cause, given, "array")
    points = (neighbour(1e-40, -1), neighbour(1e40, 1), *_NO_LENGTHS)
    yield from _rejected_arguments(HARD_WAVES, INFLUENCE, "x", points, kap=0.5, nu=_METAL)
    loads_beyond = (-5e-324, neighbour(1e80, 1), math.inf, math.nan)
    yield from _rejected_arguments(HARD_WAVES, INFLUENCE, "kap", loads_beyond, x=1.0, nu=_METAL)
    yield from _rejected_arguments(HARD_WAVES, INFLUENCE, "nu", _NO_RATIOS, x=1.0, kap=0.5)


def _next_to(x: float, point: float, what: str) -> HardCase:
    near = tuple(neighbour(point, offset) for offset in (-_NEAREST, _NEAREST))
    cause = f"{_NEAREST} ULP to either side of {what}; x = {x:g}."
    return HardCase(HARD_WAVES, INFLUENCE, cause, exact_inputs(x=x, kap=near, nu=_METAL), "array")


def _branches() -> Iterator[HardCase]:
    for kernel in BRANCHES:
        for nu, index in product((_METAL, _LAST, _FIRST), (0, 1, 7)):
            cause = f"Branch {index} of thin plates and of short waves, nu = {nu:.17g}."
            given = exact_inputs(x=(1e-40, 1e-6, 0.3, 3.0, 200.0, 1e40), nu=nu, index=float(index))
            yield HardCase(HARD_WAVES, kernel, cause, given, "array")
        for x, index in ((1.0, 300), (1e-6, 2000)):
            cause = f"Branch {index}, at high frequency."
            yield HardCase(
                HARD_WAVES, kernel, cause, exact_inputs(x=x, nu=_METAL, index=float(index))
            )
        # sqrt(gam) = 1/3: three times a pressure wave's frequency is a shear wave's.
        cause = "Two poles that lie 8 x^2 apart enclose a branch."
        given = exact_inputs(x=(1e-9, 1e-5, 1e-2), nu=0.4375, index=1.0)
        yield HardCase(HARD_WAVES, kernel, cause, given, "array")
        points = (neighbour(1e-40, -1), neighbour(1e40, 1), *_NO_LENGTHS)
        yield from _rejected_arguments(HARD_WAVES, kernel, "x", points, nu=_METAL, index=2.0)
        yield from _rejected_arguments(HARD_WAVES, kernel, "nu", _NO_RATIOS, x=1.0, index=2.0)


# --- shapes and types


_SINGLES = (0.3125, 1.75, 9.5)
_NONE: tuple[float, ...] = ()


def _shapes() -> Iterator[HardCase]:
    cause = "Arguments of other shapes and types, with numbers on both sides of a switch point."
    for form in ("array", "strided", "read-only", "float32"):
        for kernel, same in _other_arguments().items():
            given = exact_inputs(x=_SINGLES) | same
            yield HardCase(HARD_WAVES, kernel, cause, given, form)
    cause = "An empty array."
    for kernel, same in _other_arguments().items():
        yield HardCase(HARD_WAVES, kernel, cause, exact_inputs(x=_NONE) | same, "empty")
    both = exact_inputs(x=_SINGLES, nu=(-0.5, 0.25))
    for kernel in LOWEST:
        yield HardCase(HARD_WAVES, kernel, "Every x with every nu.", both, "broadcast")
    cause, given = "Every x with every kap and nu.", both | exact_inputs(kap=(0.0, 2.5))
    yield HardCase(HARD_WAVES, INFLUENCE, cause, given, "broadcast")
    cause, whole = "Whole numbers as arguments.", exact_inputs(x=(1.0, 2.0, 300.0), nu=0.0)
    for kernel in LOWEST:
        yield HardCase(HARD_WAVES, kernel, cause, whole, "integer")
    yield HardCase(HARD_WAVES, INFLUENCE, cause, whole | exact_inputs(kap=3.0), "integer")


def _other_arguments() -> dict[str, Inputs]:
    """Return the other arguments of each function of a wave number."""
    inputs = {kernel: exact_inputs(nu=0.25) for kernel in LOWEST}
    inputs[INFLUENCE] = exact_inputs(kap=2.5, nu=0.25)
    return inputs | {kernel: exact_inputs(nu=0.25, index=2.0) for kernel in BRANCHES}
