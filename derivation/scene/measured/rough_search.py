"""Searches for the constant of a measured restitution by simulations with few plate modes.

They have no error bound. In 88 random scenes the restitution without energy loss by the constant
was within 1.5 % of that of usual simulations with half the modes of their first run; with an eighth
of them it was 0.75 to 20 times as large: a thin plate then has too few modes to take the energy.
"""

from contextlib import suppress
from dataclasses import replace

from derivation.scene.errors import SceneError
from derivation.scene.measured.measurement import OF_LOSS, Measurement
from derivation.scene.measured.scan import HALVED, repeats, searched
from derivation.scene.measured.trial import (
    IncompleteTrialError,
    Trial,
    UnreachedError,
    WideTrialError,
)

PART, HALF = 0.125, 0.5
"""Parts of the modes of a usual first simulation that the simulations have."""
CLEAR = 0.03
"""Relative difference from the largest or smallest restitution with `HALF` the modes that shows
that no value of the constant gives the measured one; and `LOSS`, over the loss 1 - e."""
LOSS = 0.5
FAR, ROUGHLY = 2.0, 0.1
"""Measured restitution over the largest one with `PART` of the modes that shows this; relative
difference from the restitution with `HALF` the modes at the value that gives the smallest one with
`PART` of them."""
ALIKE = 0.1
"""Relative difference of the restitution without loss up to which `PART` of the modes suffice."""
FINE = 1e-3
"""Tolerance of a single simulation that may show that a restitution is too small."""
QUICK = 5e5
"""Largest work, in the units of `contact_sequence.WORK`, of a simulation that only determines which
restitution a message names: a quarter of a second."""


def rough_value(loose: Measurement) -> float | None:
    """Return a value of the constant near the solution; None if the simulations do not find it.

    Parameters
    ----------
    loose
        The measurement with a large tolerance.

    Raises
    ------
    SceneError
        If the simulations show that no value gives the restitution.
    """
    few, half = (replace(loose, part=part) for part in (PART, HALF))
    try:
        return _steady_value(loose, few, half)
    except IncompleteTrialError as rejected:
        raise _far_below(few, half) or rejected from None
    except SceneError as rejected:
        return searched_value(half, rejected)


def searched_value(measurement: Measurement, rejected: SceneError) -> float:
    """Return a value near the solution if the restitution does not depend on it steadily.

    Parameters
    ----------
    measurement
        The measurement.
    rejected
        The error of a search that expects a steady dependence.

    Raises
    ------
    SceneError
        If no value gives the restitution.
    """
    half = measurement if measurement.part == HALF else replace(measurement, part=HALF)
    whole = _lossless(half)
    if whole is None:
        raise rejected
    return searched(half, whole, rejected)


def is_repeated(loose: Measurement, value: float, found: Trial) -> bool:
    """Return whether a value with a larger loss has the restitution of a value, too.

    Parameters
    ----------
    loose
        The measurement with a large tolerance.
    value, found
        The value and its results.
    """
    return repeats(replace(loose, part=HALF), value, found)


def _far_below(few: Measurement, half: Measurement) -> UnreachedError | None:
    """Return the error of a restitution far below all that were found; None if it is not.

    With a larger loss of energy the impact has too many contacts or time steps.
    """
    found = [
        (trial.restitution, value, one)
        for one in (few, half)
        for value, trial in one.trials().items()
    ]
    least, value, one = min(found, key=lambda item: item[0], default=(0.0, 0.0, half))
    far = least > (1.0 + HALVED) * half.goal
    return one.below(least, least, value) if far else None


def _steady_value(loose: Measurement, few: Measurement, half: Measurement) -> float | None:
    """Return a value near the solution if the restitution depends on the constant steadily.

    The parameters are the measurement with a large tolerance, with `PART` and `HALF` of the modes;
    the rest is as in `rough_value`.
    """
    cheap = _lossless(few)
    if cheap is not None and not loose.goal < FAR * cheap.restitution:
        if quick := _lossless(replace(half, work=QUICK)):
            _check_below(half, quick)
        few.check_below(cheap, 0.0)
    value = None if cheap is None else _value_with_few_modes(few, half, cheap)
    whole = _lossless(half)
    if whole is not None:
        _check_below(half, whole)
    if value and _same_restitution(cheap, whole, loose.goal):
        return value
    lowest: UnreachedError | None = None
    if whole is not None:
        try:
            return half.rough_value(whole)
        except UnreachedError as unreached:
            if loose.goal < (1.0 - CLEAR) * unreached.least:
                raise
            lowest = unreached
        except (WideTrialError, IncompleteTrialError):
            raise
        except SceneError:
            pass
    if lowest and lowest.value and _exceeds(loose.to(FINE), lowest.value):
        raise lowest
    accurate = loose.lossless(margin=1.0)
    try:
        return loose.rough_value(accurate)
    except UnreachedError as unreached:
        if loose.goal < unreached.least:
            raise
    except SceneError:
        pass
    return None


def _value_with_few_modes(few: Measurement, half: Measurement, lossless: Trial) -> float | None:
    """Return the value that `PART` of the modes give; None if there is none.

    Raises
    ------
    UnreachedError
        If the restitution is too small, also with `HALF` the modes.
    """
    try:
        return few.rough_value(lossless)
    except UnreachedError as unreached:
        smallest = unreached
    except SceneError:  # simulations with few modes may fail where those with more do not
        return None
    if not few.goal < (1.0 - ROUGHLY) * smallest.least:
        return None
    try:
        half.check_reached(smallest.value, ROUGHLY)
    except UnreachedError:
        raise
    except SceneError:
        if _same_restitution(lossless, _lossless(half), 0.0):
            raise smallest from None
    return None


def _exceeds(fine: Measurement, value: float) -> bool:
    """Return whether the smallest restitution, with a value, exceeds the measured one."""
    try:
        fine.check_reached(value)
    except UnreachedError:
        return True
    except SceneError:
        pass
    return False


def _same_restitution(few: Trial | None, half: Trial | None, goal: float) -> bool:
    """Return whether `PART` and `HALF` of the modes give about the same restitution.

    They then determine about the same constant for the measured restitution.
    """
    if few is None or half is None:
        return False
    reduced = abs(1.0 - goal / half.restitution)
    return abs(few.restitution / half.restitution - 1.0) < min(ALIKE, OF_LOSS * reduced)


def _check_below(half: Measurement, lossless: Trial) -> None:
    """Raise an error if the measured restitution is clearly above that without energy loss."""
    restitution = lossless.restitution
    half.check_below(lossless, min(CLEAR, LOSS * max(0.0, 1.0 - restitution) / restitution))


def _lossless(measurement: Measurement) -> Trial | None:
    """Return the measurement without energy loss by the constant; None if it fails."""
    with suppress(SceneError):
        return measurement.simulated(None)
    return None
