"""Hard cases of clamped and supported plates, and their references: switch of I0, cut-off."""

import math
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

import flint
from flint import arb

from derivation.engine.measure.case import HardCase
from derivation.engine.measure.neighbours import around, case_around, exact_inputs
from derivation.engine.measure.suite import Given, HardLaw
from derivation.plate.edge_modes.oracle import modes as mode_balls
from derivation.plate.edge_modes.oracle import waves as wave_balls
from derivation.plate.waves.cases.laws import differences
from derivation.plate.waves.cases.switch_points import partner_crossing
from generated.edge_mode_numbers import SMALL

SWITCHES, WAVES = (
    "switch points of clamped and supported plates",
    "waves of clamped and supported plates",
)
_MODES = ("clamped_waves", "supported_waves")
_METAL = 0.3
_LAST, _FIRST = math.nextafter(0.5, 0.0), -1.0 + 2.0**-53
CROSSING = 12
"""Index of the mode whose k2 passes the switch point of I0."""


def edge_mode_families() -> Iterator[HardCase]:
    """Yield the hard cases of clamped and supported plates."""
    for kernel in _MODES:
        place = partner_crossing(kernel.removesuffix("_waves"), CROSSING, _METAL)
        why = f"h/b = {place:g}, where k2 of mode {CROSSING} reaches the series at infinity"
        given = exact_inputs(count=float(CROSSING), eta=around(place), nu=_METAL)
        yield case_around(SWITCHES, kernel, why, given)
    for kernel, at in (("wave_shape", "r"), ("wave_mean", "a")):
        why = f"{at}/b = 0.5, where k {at} or k2 {at} = {SMALL:g} ends the power series"
        size = 2.0 * SMALL
        for k, k2 in ((size, 3.0), (5.0, size)):
            yield case_around(
                SWITCHES, kernel, why, exact_inputs(k=k, k2=k2, t=1.02, **{at: around(0.5)})
            )
        cause = "From the axis, and from a punch of zero radius, to the edge."
        places = (1e-9, 1e-3, 0.3, 0.9)
        given = exact_inputs(k=(2.2, 8.6), k2=(2.1, 8.1), t=1.02, **{at: places})
        yield HardCase(WAVES, kernel, cause, given, "broadcast")
        cause = "High modes of a thin plate, whose I0 overflows."
        given = exact_inputs(k=1259.0, k2=1258.5, t=1.0, **{at: (0.3, 0.9)})
        yield HardCase(WAVES, kernel, cause, given, "array")
    yield from _ends()


def _ends() -> Iterator[HardCase]:
    for kernel in _MODES:
        cause = "The thinnest plates."
        given = exact_inputs(count=2.0, eta=(1e-80, 1e-30, 1e-9), nu=_METAL)
        yield HardCase(WAVES, kernel, cause, given, "array")
        cause = "Poisson's ratio at its limits and at 0."
        yield HardCase(
            WAVES,
            kernel,
            cause,
            exact_inputs(count=2.0, eta=0.05, nu=(_FIRST, 0.0, _LAST)),
            "array",
        )
        cause = "A high mode, whose part of I0 is small."
        yield HardCase(WAVES, kernel, cause, exact_inputs(count=30.0, eta=0.01, nu=_METAL))
        cause = "The last mode below the cut-off."
        yield HardCase(WAVES, kernel, cause, exact_inputs(count=6.0, eta=0.1, nu=_METAL))
    cause = "The first mode, whose wave number vanishes at nu = -1, of a thick plate."
    given = exact_inputs(count=1.0, eta=0.5, nu=(_FIRST, -1.0 + 1e-9, -0.97, _LAST))
    yield HardCase(WAVES, "supported_waves", cause, given, "array")


_FREE = 1e-9
"""1 + nu below which a support has little stiffness: a function that computes 1 + nu exactly
keeps its accuracy there, even if the condition number of nu is large."""


# --- references


def _of_waves(edge: mode_balls.Edge) -> HardLaw:
    """Return the reference of a mode; errors of c and k2 are scaled as the budgets state."""

    def values(given: Given, digits: int) -> tuple[arb, ...]:
        count, eta, nu = given
        return wave_balls.wave(edge, int(count), eta, nu, digits)

    def sizes(_: Given, values: Sequence[arb]) -> tuple[arb, ...]:
        mode = wave_balls.EdgeMode(*values)
        counted = mode._replace(k2=mode.k**2 / mode.k2, c=mode.c * (1 + mode.k))
        return tuple(abs(x) for x in counted._replace(t=abs(mode.t).max(arb(1))))

    def slopes(given: Given, eigenvalues: Sequence[arb]) -> Sequence[arb]:
        if 1 + Fraction(given[2]) < _FREE:
            return differences(values, 1)(given, eigenvalues)
        return differences(values, 1, 2)(given, eigenvalues)

    return HardLaw(values, sizes, slopes=slopes, results=7, oracle=(wave_balls.__name__,))


def _of_face(punch: bool) -> HardLaw:
    """Return the reference of a mode's contact face, or of its mean under a punch minus 1.

    Errors are relative to the largest of its terms.
    """

    def values(given: Given, digits: int) -> tuple[arb]:
        with flint.ctx.workprec(8 * digits + 64):
            return (wave_balls.on_face(punch, *given),)

    def sizes(_: Given, values: Sequence[arb]) -> tuple[arb]:
        return (abs(values[0]) if punch else abs(values[0]).max(arb(1)),)

    return HardLaw(
        values, sizes, slopes=differences(values, 0, 1, 2, 3), oracle=(wave_balls.__name__,)
    )


CASES = edge_mode_families
LAWS: Mapping[str, HardLaw] = {
    "clamped_waves": _of_waves("clamped"),
    "supported_waves": _of_waves("supported"),
    "wave_shape": _of_face(punch=False),
    "wave_mean": _of_face(punch=True),
}
"""References by function."""
