"""Hard cases at the switch points of impacts: sensitivities, simple laws, the paper's motion."""

import math
from collections.abc import Iterator
from itertools import chain

import flint

from derivation.engine.measure.case import HardCase
from derivation.engine.measure.neighbours import (
    around,
    case_around,
    exact_inputs,
    nearest_root,
)
from derivation.mathematics.bessel.oracle import j0_zero
from derivation.plate.cases.steel import LAM, MU
from derivation.plate.contact.kernels import tables as contact_tables
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.impact.kernels import simple as simple_impact_tables
from derivation.plate.impact.oracle import impact as contact_impact
from derivation.plate.impact.oracle import printed_motion as printed_motion_balls

IMPACTS, SIMPLE = "switch points of the impact", "switch points of simple impacts"
PAPER = "switch points of the paper's motion"

_SPHERE: dict[str, float] = {"R": 50.0, "m": 1e3}
_STEEL: dict[str, float] = {"lam": LAM, "mu": MU}
_FEW = 30


def motion_families() -> Iterator[HardCase]:
    """Yield all cases; the plate's half-thickness is 1 unless stated otherwise."""
    return chain(_sensitivities(), _history(), _simple_impacts(), _paper())


def _speed(a: float, h: float, b: float) -> float:
    """Return the speed of the sphere that just reaches a contact radius."""
    energy = contact_impact.stored_energy(a, _SPHERE["R"], h, b, LAM, MU, _FEW)
    return math.sqrt(2.0 * float(energy) / _SPHERE["m"])


def _sensitivities() -> Iterator[HardCase]:
    reach, b = float(contact_tables.REACH), 10.0
    given = exact_inputs(**_SPHERE, v0=around(_speed(reach, 1.0, b)), h=1.0, b=b, **_STEEL)
    why = f"the speed that reaches a = {reach:g} h, where the second polynomial begins"
    yield case_around(IMPACTS, "impact_sensitivities", why, given)
    ends = {end for cell in (*contact_tables.CELLS, *contact_tables.FAR_CELLS) for end in cell[:2]}
    for end in sorted(float(end) for end in ends):
        a = 2.5 if end == reach else min(4.5, (reach + end) / 2)
        given = exact_inputs(**_SPHERE, v0=_speed(a, 1.0, end), h=1.0, b=around(end), **_STEEL)
        why = f"b = {end:g} h, beyond which other tables are used; the largest a is {a:g} h"
        yield case_around(IMPACTS, "impact_sensitivities", why, given)
        if end == contact_tables.FAR_REACH:  # its tables are those of the indentation
            yield case_around(IMPACTS, "impact", why, given)


def _history() -> Iterator[HardCase]:
    R, m = _SPHERE.values()
    h, b, reach = 1.0, 10.0, float(contact_tables.REACH)
    v0 = _speed(1.1 * reach, h, b)
    (crossing,) = contact_impact.history([reach], R, m, v0, h, b, LAM, MU, _FEW)
    end = contact_impact.impact(R, m, v0, h, b, LAM, MU, _FEW).contact_time
    same: dict[str, float] = {**_SPHERE, "v0": v0, "h": h, "b": b, **_STEEL}
    for point, what in (
        (float(crossing), f"the time when a = {reach:g} h, where the second polynomial begins"),
        (float(end) / 2, "the turning point, where the rate changes its sign"),
    ):
        yield case_around(IMPACTS, "history", what, exact_inputs(t=around(point), **same))


# --- simple impacts


def _simple_impacts() -> Iterator[HardCase]:
    inverse = float(simple_impact_tables.THIN)
    thin = f"b = {inverse:g} h, beyond which c_1 is the thin plate's closed form"
    yield from _estimates(thin, 1.0, around(inverse))
    yield case_around(SIMPLE, "plate_of", thin, exact_inputs(eta=around(1 / inverse)))
    for mode in (1, 2, 17):
        point = simple_impact_tables.FADED / (2 * float(j0_zero(mode, 80)))
        why = f"h/b = {point:.4g}, beyond which mode {mode} is omitted"
        yield case_around(SIMPLE, "plate_of", why, exact_inputs(eta=around(point)))
        if mode == 1:
            yield from _estimates(why, around(point), 1.0)
    root = nearest_root(lambda eta: contact_balls.coefficient(1, eta, 1, 12), 0.5, 0.6)
    why = f"h/b = {root:.4f}, where c_1 changes sign"
    yield case_around(SIMPLE, "plate_of", why, exact_inputs(eta=around(root)))
    yield from _estimates(why, around(root), 1.0)


def _estimates(
    why: str, h: float | tuple[float, ...], b: float | tuple[float, ...]
) -> Iterator[HardCase]:
    """Yield cases of both laws, for a contact that is narrow compared with thickness and radius."""
    thickness, radius = (x if isinstance(x, float) else x[0] for x in (h, b))
    speed = _speed(0.1 * min(thickness, radius), thickness, radius)
    for kernel in ("hertz", "leading"):
        given = exact_inputs(**_SPHERE, v0=speed, h=h, b=b, **_STEEL)
        yield case_around(SIMPLE, kernel, why, given)


# --- the paper's own motion


def _paper() -> Iterator[HardCase]:
    m, v0, xi_2, xi_3 = 72.0, 1.0, 7e6, 1e8
    with flint.ctx.workprec(128):
        last = float(printed_motion_balls.last_fraction(m, v0, xi_2, xi_3))
    for power in (1, 2, 5):
        u = 0.5**power
        time = math.asin(last * (1 - u * u) ** 3) / math.sqrt(xi_2 / m)
        given = exact_inputs(t=around(time), m=m, v0=v0, xi_2=xi_2, xi_3=xi_3)
        why = f"the time when u = {u:g}, where one panel of the integrals ends"
        yield case_around(PAPER, "corrected", why, given)


CASES = motion_families
