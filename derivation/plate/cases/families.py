"""Families of hard cases: every switch point, and the constants with an index.

The switch points are read from the data of the rewriting rules, so that the cases follow them.
"""

import math
from collections.abc import Callable, Iterator
from itertools import chain

from derivation.engine.cache import in_file
from derivation.engine.formula.ulp import neighbours
from derivation.engine.measure.case import HardCase, checked_case
from derivation.engine.measure.neighbours import OFFSETS, Inputs, around, exact_inputs, neighbour
from derivation.mathematics.bessel import kernels as bessel_tables
from derivation.mathematics.bessel.oracle import j0_zero, j1_zero
from derivation.plate.cases.scene_families import scene_families
from derivation.plate.cases.steel import LAM, MU
from derivation.plate.contact.kernels import tables as contact_tables
from derivation.plate.contact.kernels.moments import (
    FIRST_K,
    SOURCES,
    finite_part_start,
    kappa_start,
)
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.grids import switches
from derivation.plate.impact.oracle import impact as contact_impact
from derivation.plate.subjects import exports

INDICES = (1, 2, 10, 100, 1000, 10**4, 10**5, 10**6)
LAST_KAPPA, LAST_FINITE_PART = 196, 99
"""Largest indices whose value does not overflow in double precision."""


@in_file(
    (
        *SOURCES,
        "engine/oracle",
        "plate/*/oracle*",
        "plate/*/route*",
        "engine/emit",
        "engine/measure/case.py",
        "engine/measure/neighbours.py",
        "plate/cases",
        "plate/*/cases*",
    ),
    HardCase,
)
def families() -> tuple[HardCase, ...]:
    """Return every systematic case."""
    made = chain(
        _block_switches(),
        _bessel_switches(),
        _zeros_by_index(),
        _around_zeros(),
        _moments(),
        _contact_switches(),
        _thickness_switches(),
        _thinnest(),
        _impact_switches(),
        scene_families(),
        *(cases() for cases in exports("cases", "CASES")),
    )
    return tuple(checked_case(case) for case in made)


_MODE = {"lam": LAM, "mu": MU, "A_j": -1e6}

_OF_SWITCH: dict[str, tuple[tuple[str, Callable[[float], Inputs]], ...]] = {
    "T": (
        ("G", lambda T: exact_inputs(T=T)),
        ("G_minus_1", lambda T: exact_inputs(T=T)),
        ("Omega_1_scaled", lambda T: exact_inputs(phi=T / 2, h=1.0, lam=LAM, mu=MU)),
        ("K_j", lambda T: exact_inputs(phi=T / 2, h=1.0, b=10.0, R=3.0, J1=0.25)),
        ("mode_zz", lambda T: exact_inputs(z=0.25, phi=T / 2, h=1.0, **_MODE)),
        ("mode_rz", lambda T: exact_inputs(z=-0.5, phi=T / 2, h=1.0, **_MODE)),
        ("mode_g", lambda T: exact_inputs(z=0.0625, phi=T / 2, h=1.0, **_MODE)),
        ("mode_rr", lambda T: exact_inputs(z=-0.0625, phi=T / 2, h=1.0, **_MODE)),
        ("mode_tt", lambda T: exact_inputs(z=0.0625, phi=T / 2, h=1.0, **_MODE)),
        ("mode_g", lambda T: exact_inputs(z=-0.875, phi=T / 2, h=1.0, **_MODE)),
        ("mode_rr", lambda T: exact_inputs(z=0.875, phi=T / 2, h=1.0, **_MODE)),
        ("mode_tt", lambda T: exact_inputs(z=0.25, phi=T / 2, h=1.0, **_MODE)),
    ),
    "y": (
        ("sonine", lambda y: exact_inputs(phi=y, a=1.0)),
        ("A_j", lambda y: exact_inputs(phi=y, b=10.0, R=3.0, a=1.0, lam=LAM, mu=MU, J1=0.25)),
    ),
}
"""Functions with switch points in T = 2 phi h or y = a phi, and their arguments at given T or y;
lengths are 1."""


def _block_switches() -> Iterator[HardCase]:
    for variable, points in switches().items():
        for point in points:
            for offset in OFFSETS:
                cause = (
                    f"{abs(offset)} ULP {'below' if offset < 0 else 'above'} {variable} = {point:g}"
                    if offset
                    else f"On {variable} = {point:g}"
                )
                cause += ", the end of a series; beyond, exponentials or circular functions."
                for kernel, inputs in _OF_SWITCH[variable]:
                    given = inputs(neighbour(point, offset))
                    yield HardCase("switch points of the building blocks", kernel, cause, given)


def _bessel_switches() -> Iterator[HardCase]:
    start = float(bessel_tables.asymptotic_start())
    for point in bessel_tables.switches()[1:]:
        what = "the code changes to the next Taylor polynomial"
        if point == start:
            what = "the code changes from Taylor polynomials to modulus and phase"
        if point == bessel_tables.LARGEST_PHASE:
            what = "multiples of pi/4 cease to be exact doubles"
        cause = f"0, 1 and 32 ULP to either side of x = {point:g}, where {what}."
        for kernel in ("bessel_j0", "bessel_j1"):
            yield HardCase(
                "switch points of the Bessel functions",
                kernel,
                cause,
                exact_inputs(x=around(point)),
                "array",
            )


def _zeros_by_index() -> Iterator[HardCase]:
    kernels = (("bessel_j0_zeros", 0), ("bessel_j1_zeros", 1), ("bessel_j1_at_j0_zeros", 0))
    for kernel, order in kernels:
        start = bessel_tables.mcmahon_start(order)
        for count in sorted({*INDICES, start - 1, start}):
            cause = f"Zero number {count}: all bits must be correct, without iteration."
            if count in (start - 1, start):
                cause = f"Zero number {count}: the expansion begins with number {start}."
            yield HardCase("Bessel zeros by index", kernel, cause, exact_inputs(count=float(count)))


def _around_zeros() -> Iterator[HardCase]:
    for kernel, zero in (("bessel_j0", j0_zero), ("bessel_j1", j1_zero)):
        for index in (1, 3, 11, 100, 1000, 10**6):
            neighbourhood = neighbours(float(zero(index, 80)), 1)
            cause = f"The doubles next to zero number {index}: the leading digits cancel."
            yield HardCase(
                "doubles next to zeros of J0 and J1",
                kernel,
                cause,
                exact_inputs(x=neighbourhood),
                "array",
            )


def _moments() -> Iterator[HardCase]:
    group = "series constants by index"
    first, last = float(FIRST_K), float(LAST_FINITE_PART)
    for argument, kernel, low, high in (
        ("n", "kappa", 0.0, float(LAST_KAPPA)), ("k", "finite_part", first, last),
    ):  # fmt: skip
        for index in (low, low + 1, low + 2, low + 9, low + 40, high - 1, high):
            cause = "An integral that grows like a factorial, to half a unit in the last place."
            yield HardCase(group, kernel, cause, exact_inputs(**{argument: index}))
        cause = "The first index whose value exceeds the range of doubles."
        yield HardCase(group, kernel, cause, exact_inputs(**{argument: high + 1}), expect="nan")
        for index in (low, low + 1, 1e3, 1e6):
            cause = "The value over its leading term, far beyond where the value itself overflows."
            yield HardCase(group, f"{kernel}_ratio", cause, exact_inputs(**{argument: index}))
    for argument, kernel, start in (
        ("n", "kappa_ratio", kappa_start()), ("k", "finite_part_ratio", finite_part_start()),
    ):  # fmt: skip
        for offset in OFFSETS:
            cause = f"{offset:+d} from index {start}, where the expansion replaces the table."
            yield HardCase(group, kernel, cause, exact_inputs(**{argument: float(start + offset)}))


def _contact_switches() -> Iterator[HardCase]:
    """Yield cases at the ends of the polynomials in a/h, with h = 1."""
    group = "switch points of the contact law"
    for b in (1e3, 10.0, 5.0, 2.0, 0.25):
        reach = min(float(contact_tables.REACH), b)
        ends = [(reach / contact_tables.SHORT, "the short polynomial ends")]
        if b > contact_tables.REACH:
            ends.append((reach, "the polynomial about 0 ends"))
        if b > contact_tables.FAR_REACH:
            ends.append((float(contact_tables.FAR_REACH), "the second polynomial ends"))
        for point, what in ends:
            cause = f"0, 1 and 32 ULP to either side of a = {point:g} h, where {what}."
            same: dict[str, float] = {"R": 50.0, "h": 1.0, "b": b}
            neighbourhood = around(point)
            yield HardCase(
                group, "indentation", cause, exact_inputs(a=neighbourhood, **same), "array"
            )
            yield HardCase(
                group,
                "stiffness",
                cause,
                exact_inputs(a=neighbourhood, **same, lam=LAM, mu=MU),
                "array",
            )
            if point in (contact_tables.REACH, contact_tables.FAR_REACH):
                yield HardCase(
                    group,
                    "indentation_slope",
                    cause,
                    exact_inputs(a=neighbourhood, **same),
                    "array",
                )
            if point == contact_tables.FAR_REACH:
                continue  # the inversion ends here
            depth = float(contact_balls.indentation(point, 50.0, 1.0, b, 30))
            given = exact_inputs(delta=around(depth), **same)
            yield HardCase(group, "contact_radius", cause, given, "array")
            if b == 10.0 and point == reach:
                yield HardCase(group, "force", cause, given | exact_inputs(lam=LAM, mu=MU), "array")


def _thickness_switches() -> Iterator[HardCase]:
    """Yield cases at the ends of the cells in b/h, for both polynomials, with h = 1."""
    ends = {float(end) for cell in contact_tables.CELLS for end in cell[:2]}
    far_ends = {float(end) for cell in contact_tables.FAR_CELLS for end in cell[:2]}
    far_ends -= {float(contact_tables.REACH)}  # such a plate has no second polynomial
    for near, points in ((True, ends), (False, far_ends)):
        for b in sorted(points):
            a = 2.5 if near else min(4.5, (contact_tables.REACH + b) / 2)
            cause = f"0, 1 and 32 ULP to either side of b = {b:g} h, where "
            cause += "the closed form of thin plates" if b == max(points) else "another table"
            cause += f" takes over; a = {a:g} h."
            same: dict[str, float] = {"a": a, "R": 50.0, "h": 1.0}
            group = "switch points of the contact law"
            given = exact_inputs(**same, b=around(b))
            yield HardCase(group, "indentation", cause, given, "array")
            yield HardCase(group, "indentation_slope", cause, given, "array")
            given = exact_inputs(**same, b=around(b), lam=LAM, mu=MU)
            yield HardCase(group, "stiffness", cause, given, "array")


def _thinnest() -> Iterator[HardCase]:
    """Yield cases at h/b = 1e-5, the thinnest plate whose modes are summed directly; b = 1."""
    for offset in OFFSETS:
        given = exact_inputs(a=6.5e-5, R=1e-2, h=neighbour(1e-5, offset), b=1.0)
        cause = f"{offset:+d} ULP from h/b = 1e-5, below which no sum is taken for a > 6 h."
        expect = "nan" if offset < 0 else "value"
        yield HardCase(
            "switch points of the contact law", "indentation", cause, given, expect=expect
        )


def _impact_switches() -> Iterator[HardCase]:
    """Yield cases at speeds that just reach a = 3 h, in a thin plate and in the paper's."""
    for b in (100.0, 10.0):
        point = float(contact_tables.REACH)
        energy = float(contact_impact.stored_energy(point, 50.0, 1.0, b, LAM, MU, 30))
        speeds = around(math.sqrt(2.0 * energy / 1e3))
        cause = f"0, 1 and 32 ULP to either side of the speed that reaches a = {point:g} h."
        given = exact_inputs(R=50.0, m=1e3, v0=speeds, h=1.0, b=b, lam=LAM, mu=MU)
        yield HardCase("switch points of the contact law", "impact", cause, given, "array")
