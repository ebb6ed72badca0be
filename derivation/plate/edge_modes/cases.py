"""Hard cases of held plates with a thickness: the switch of I0, ends of ranges, the cut-off."""

import math
from collections.abc import Iterator

from derivation.plate.hard.case import Case
from derivation.plate.hard.places import about, around, exactly
from derivation.plate.waves.cases.places import partner_crossing
from generated.edge_modes import _SMALL

SEAMS, WAVES = "seams of held plates with a thickness", "waves of held plates"
_MODES = ("clamped_waves", "supported_waves")
_METAL = 0.3
_LAST, _FIRST = math.nextafter(0.5, 0.0), -1.0 + 2.0**-53
CROSSING = 12
"""Mode that is followed to where its partner k2 passes the switch of I0."""


def held_wave_families() -> Iterator[Case]:
    """Every one of them."""
    for kernel in _MODES:
        place = partner_crossing(kernel.removesuffix("_waves"), CROSSING, _METAL)
        why = f"h/b = {place:g}, where k2 of mode {CROSSING} reaches the series at infinity"
        given = exactly(count=float(CROSSING), eta=around(place), nu=_METAL)
        yield about(SEAMS, kernel, why, given)
    for kernel, at in (("wave_shape", "r"), ("wave_share", "a")):
        why = f"{at}/b = 0.5, where k {at} or k2 {at} = {_SMALL:g} ends the power series"
        size = 2.0 * _SMALL
        for k, k2 in ((size, 3.0), (5.0, size)):
            yield about(SEAMS, kernel, why, exactly(k=k, k2=k2, t=1.02, **{at: around(0.5)}))
        cause = "From the axis, and from a punch of no size, to the edge."
        places = (1e-9, 1e-3, 0.3, 0.9)
        given = exactly(k=(2.2, 8.6), k2=(2.1, 8.1), t=1.02, **{at: places})
        yield Case(WAVES, kernel, cause, given, "broadcast")
        cause = "High modes, whose I0 overflows, of a thin plate."
        given = exactly(k=1259.0, k2=1258.5, t=1.0, **{at: (0.3, 0.9)})
        yield Case(WAVES, kernel, cause, given, "array")
    yield from _ends()


def _ends() -> Iterator[Case]:
    for kernel in _MODES:
        cause = "The thinnest plates."
        given = exactly(count=2.0, eta=(1e-80, 1e-30, 1e-9), nu=_METAL)
        yield Case(WAVES, kernel, cause, given, "array")
        cause = "Poisson's ratio at its ends and at 0."
        yield Case(
            WAVES, kernel, cause, exactly(count=2.0, eta=0.05, nu=(_FIRST, 0.0, _LAST)), "array"
        )
        cause = "A high mode, whose part of I0 is small."
        yield Case(WAVES, kernel, cause, exactly(count=30.0, eta=0.01, nu=_METAL))
        cause = "The last mode below the cut-off."
        yield Case(WAVES, kernel, cause, exactly(count=6.0, eta=0.1, nu=_METAL))
    cause = "The first mode, whose wave number vanishes at nu = -1, of a thick plate."
    given = exactly(count=1.0, eta=0.5, nu=(_FIRST, -1.0 + 1e-9, -0.97, _LAST))
    yield Case(WAVES, "supported_waves", cause, given, "array")
