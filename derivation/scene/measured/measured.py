"""Determines the yield stress or retardation time of a body from a measured restitution.

The restitution was measured on a thick block, which does not vibrate, or on the plate itself. The
impact is simulated repeatedly until the restitution agrees.
"""

import json
import math
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from derivation.scene.dynamic.contact_errors import rounded_down
from derivation.scene.effects.effect import NO_BOUND
from derivation.scene.errors import SceneError, Slower, ToleranceError
from derivation.scene.input.settings import TIGHTEST
from derivation.scene.measured.constant import UNITS, name_of, with_constant
from derivation.scene.measured.measurement import Measurement
from derivation.scene.measured.narrowing import AGREES
from derivation.scene.measured.rough_search import is_repeated, rough_value, searched_value
from derivation.scene.measured.scan import value_near
from derivation.scene.measured.specimen import measurement_of
from derivation.scene.measured.trial import Trial
from derivation.scene.quantity import digits_of, prefixed, rounded_up
from derivation.scene.selection.achieved_accuracy import remaining

if TYPE_CHECKING:
    from derivation.scene.scene import Scene

DIGITS = 4
"""Number of significant digits of the constant that are shown."""
CLOSE = {"static": 1e-12, "dynamic": 1e-4}
"""Relative accuracy of the constant [1]; with plate inertia the restitution is less smooth."""
LOOSE, DEFAULT = 0.1, 1e-3
"""Tolerance of the simulations that search for the constant, and of the accurate ones if the
results have none [1]."""
FURTHEST, POLISHES = 0.2, 6
"""Largest change of the logarithm of a constant after the search, and largest number of
simulations."""
ENOUGH = 1.6
"""Tolerance that a message recommends, over the error bound, which increases with the tolerance."""
NEGLIGIBLE = 0.01
"""Error due to a constant over the tolerance below which a message does not state it."""
CHANGE = 1e-2
"""Relative change of the constant that gives the sensitivities of the results."""
STIFFER = 1.2
"""Relative change of a constant over that of the indentation at equal force which the model causes,
without plate inertia, at equal restitution [1]. The contact modulus E* changes as the power 3/2 of
this change, the yield stress as E*^(4/5), and the retardation time, like the contact time, less."""
LEAST_RATIO, MARGIN = 3.0, 1.5
"""Error of the results over that of the restitution in a measurement with plate inertia, estimated:
its least value, and its value over that of a simulation with few modes."""


class Fit(NamedTuple):
    """The constant that a measured restitution determines.

    Attributes
    ----------
    value
        The constant [Pa or s].
    error
        Estimated relative error of the results due to it [1].
    bound
        Error bound of the restitution in the measurement [1].
    constant
        Estimated relative error of the constant [1], with that by the model of the measurement.
    model
        Estimated relative error of the results by the model of the measurement [1].
    parts
        Tolerance of the results over that of a measurement with plate inertia [1]; 0 without
        plate inertia, where the tolerance of the measurement is `STATIC_RTOL`.
    contacts
        Number of contacts in the measurement.
    repeated
        Whether a value with which the sphere is hit again gives the restitution, too.
    """

    value: float
    error: float
    bound: float
    constant: float
    model: float
    parts: float
    contacts: int = 1
    repeated: bool = False


def fitted(scene: "Scene") -> "Scene":
    """Return the scene with the constant that its measured restitution determines.

    It has no table `measured`.

    Raises
    ------
    SceneError
        If no value gives the restitution, or a simulation with a trial value fails.
    """
    from derivation.scene.scene import read

    wanted, tables = scene.measured, scene.to_json()
    assert wanted is not None
    del tables["measured"]
    return read(with_constant(tables, wanted.solve_for, wanted.body, solved(scene)))


def without_constant(scene: "Scene") -> "Scene":
    """Return the scene of a measurement in which no energy is lost by the constant."""
    wanted, tables = scene.measured, scene.to_json()
    assert wanted is not None
    del tables["measured"]
    one = Measurement(tables, wanted.solve_for, wanted.restitution, body=wanted.body)
    return one.scene(None)


def toleranced(scene: "Scene", rtol: float | None) -> "Scene":
    """Return a scene with a measurement whose tolerance is that of the results, if one is given."""
    if scene.measured is None or rtol is None:
        return scene
    from derivation.scene.scene import read

    tables = scene.to_json()
    return read(tables | {"accuracy": tables.get("accuracy", {}) | {"rtol": rtol}})


def solved(scene: "Scene") -> float:
    """Return the constant that the measured restitution of a scene determines [Pa or s]."""
    return _fit_of(scene).value


def error_of(scene: "Scene") -> float:
    """Return the estimated relative error of the results due to the fitted constant [1].

    Without plate inertia it is the error of the constant: the results change at most about as much.
    """
    return _fit_of(scene).error


def error_of_constant(scene: "Scene") -> float:
    """Return the estimated relative error of the constant, with that by the model [1]."""
    return _fit_of(scene).constant


def model_error_of(scene: "Scene") -> float:
    """Return the estimated model error of the results by that of a measurement [1]; 0 without."""
    return 0.0 if scene.measured is None else _fit_of(scene).model


def remaining_of(scene: "Scene", rtol: float | None) -> float | None:
    """Return the part of a tolerance that the error of a constant leaves [1]; an error if none."""
    if scene.measured is None or rtol is None:
        return rtol
    fit = _fit_of(scene)
    rest = remaining(rtol, fit.error)
    if rest is None or not rest >= TIGHTEST:
        least = fit.error if math.isinf(fit.error) else fit.parts * fit.bound or fit.error
        raise _inaccurate(fit.error, rtol, ENOUGH * least)
    return rest


def in_words(scene: "Scene") -> str:
    """Return a phrase with the constant, the measured restitution, specimen and speed."""
    wanted = scene.measured
    assert wanted is not None
    digits = min(DIGITS, digits_of(min(error_of_constant(scene), NO_BOUND)))
    value = " ".join(filter(None, prefixed(solved(scene), UNITS[wanted.solve_for], digits)))
    specimen = "a thick block" if wanted.target == "block" else "the plate"
    return (
        f"{name_of(wanted.solve_for, wanted.body)} = {value}, from the restitution "
        f"{wanted.restitution:g} measured on {specimen} at "
        f"{wanted.tested_at or scene.impact.speed:g} m/s"
    )


def ambiguity_warnings(scene: "Scene") -> tuple[str, ...]:
    """Warn of other constants with the same restitution, if a measurement has several contacts."""
    wanted = scene.measured
    if wanted is None:
        return ()
    fit = _fit_of(scene)
    why = "a sphere that loses more energy is hit again by the plate"
    if fit.contacts > 1:
        why = f"the measured impact has {fit.contacts} contacts"
    elif not fit.repeated:
        return ()
    text = (
        f"{why}: other values of {name_of(wanted.solve_for, wanted.body)} may have the measured "
        "restitution, too, but other results, which no error bound includes"
    )
    return (text,)


def _fit_of(scene: "Scene") -> Fit:
    """Return the constant of a scene; errors of the measurement name its own speed."""
    assert scene.measured is not None
    try:
        return _fit(json.dumps(scene.to_json()))
    except SceneError as error:
        text, remedy = str(error), getattr(error, "remedy", None)
        if scene.measured.solve_for == "yield_stress" and isinstance(remedy, Slower):
            slower = _slower(scene.measured.restitution, remedy)
            text = text.replace(str(remedy), str(slower))
        if scene.measured.tested_at is not None:
            text = text.replace("impact.speed", "measured.tested_at")
        if scene.accuracy is not None and text.startswith("measured.restitution"):
            text += f" (the tolerance {scene.accuracy.rtol:g} is checked after that)"
        if text == str(error):
            raise
        where = "" if text.startswith("measured.") else "measured: its simulation fails: "
        raise SceneError(where + text) from None


def _slower(restitution: float, elastic: Slower) -> Slower:
    """Return a speed at which a contact is narrow enough that yields until it has a restitution.

    Such a contact is at most as wide as an elastic one of the speed v/e: far above yield, its
    radius is 0.91 times as large, and also proportional to (v/e)^(2/5).
    """
    return replace(elastic, speed=rounded_down(restitution * elastic.speed))


@lru_cache(maxsize=64)
def _fit(text: str) -> Fit:
    """Return the constant of a scene, which is given as JSON text; results are cached."""
    tables = json.loads(text)
    measured = measurement_of(tables, tables.pop("measured"))
    if not measured.static:
        return _with_inertia(measured, tables.get("accuracy", {}).get("rtol"))
    value = measured.value(CLOSE["static"])
    found, changed = (measured.simulated(x) for x in (value, (1.0 + CHANGE) * value))
    slope, change = _changes(found, changed)
    error = _error_over_slope(_error_in(measured, found), slope)
    model = STIFFER * float(found.model_errors["max_indentation"])
    return Fit(value, error, found.bound, error + model, change * abs(slope) * model, 0.0)


def _error_in(measured: Measurement, found: Trial) -> float:
    """Return the error of the restitution in a measurement, without that of the model [1]."""
    return found.bound + abs(found.restitution / measured.goal - 1.0)


def _changes(one: Trial, other: Trial) -> tuple[float, float]:
    """Return the change d ln e/d ln c of the restitution, and the largest of all over it."""
    changes = [
        math.log(after / before) / math.log1p(CHANGE)
        for after, before in zip(other.outputs, one.outputs, strict=True)
    ]
    return changes[-1], _error_over_slope(max(map(abs, changes)), changes[-1])


def _error_over_slope(error: float, slope: float) -> float:
    """Return an error over the size of a slope; infinite if the slope vanishes."""
    return error / abs(slope) if slope else math.inf


def _with_inertia(measured: Measurement, rtol: float | None) -> Fit:
    """Return the constant from a measurement with plate inertia.

    A simulation to the tolerance of the measurement may take seconds; few of them are needed near
    the solution, which simulations with a large tolerance find.

    Parameters
    ----------
    rtol
        Tolerance of the results [1].
    """
    first = rough = rough_value(measured.to(LOOSE))
    slope, change = (0.0, 0.0) if first is None else _sensitivities(measured, first)
    if not slope:  # with the rough value no energy is lost, but with the accurate one it may be
        first, change = None, 0.0
    ratio = _ratio(change)
    parts = 2.0 + (1.0 + AGREES) * ratio
    accurate = measured.to(DEFAULT if rtol is None else rtol / parts)
    try:
        found = None if first is None else _polished(accurate, first, slope, rtol is not None)
    except ToleranceError as unmet:
        assert rtol is not None
        least, named = ratio * unmet.error, ENOUGH * parts * unmet.error
        raise _inaccurate(least, rtol, named) from None
    if found is None:
        value = _accurate_value(accurate, rough)
        slope, change = _sensitivities(measured, value)
        ratio = _ratio(change)
        found = value, accurate.simulated(value)
    value, trial = found
    error, model = _error_in(measured, trial), float(trial.model_errors["restitution"])
    constant = _error_over_slope(error + model, slope)
    repeated = trial.contacts == 1 and is_repeated(measured.to(LOOSE), value, trial)
    contacts = trial.contacts, repeated
    return Fit(value, ratio * error, trial.bound, constant, change * model, parts, *contacts)


def _accurate_value(accurate: Measurement, rough: float | None) -> float:
    """Return the value that accurate simulations find by themselves, or near that of few modes."""
    close = CLOSE["dynamic"]
    try:
        return accurate.value(close)
    except SceneError as rejected:
        if rough is None:
            rough = searched_value(accurate, rejected)
        return value_near(accurate, rough, close, rejected)


def _ratio(change: float) -> float:
    """Return the error of the results over that of the restitution in a measurement [1]."""
    return max(LEAST_RATIO, MARGIN * change)


def _sensitivities(measured: Measurement, value: float) -> tuple[float, float]:
    """Return the sensitivity of the restitution, and the change of the results over its change [1].

    It is large where the restitution hardly depends on the constant.
    """
    # The same modes, so that their number does not change the results.
    tables = {k: v for k, v in measured.tables.items() if k != "accuracy"}
    same = replace(measured, tables=tables, part=2.0)
    one, other = (same.simulated(x) for x in (value, (1.0 + CHANGE) * value))
    return _changes(one, other)


def _polished(
    measured: Measurement, first: float, slope: float, within: bool
) -> tuple[float, Trial] | None:
    """Return the accurate value of the constant near a first one, and its simulation.

    None if few simulations do not lead to it.

    Parameters
    ----------
    slope
        Sensitivity of the restitution to the constant, d ln e/d ln c [1].
    within
        Whether the tolerance of the measurement must be met.

    Raises
    ------
    ToleranceError
        If a simulation does not meet the tolerance of the measurement.
    """
    x, before, change = math.log(first), math.inf, 0.0
    for _ in range(POLISHES):
        try:
            trial = measured.simulated(math.exp(x), within)
        except ToleranceError:
            raise
        except SceneError:
            return None
        off = math.log(trial.restitution / measured.goal)
        if abs(off) <= AGREES * trial.bound:
            return math.exp(x), trial
        slope = slope if math.isinf(before) else (off - before) / change
        before, change = off, -off / slope if slope else math.inf
        if not abs(change) < FURTHEST:
            return None
        x += change
    return None


def inaccurate_constant(scene: "Scene", rtol: float | None, error: ToleranceError) -> SceneError:
    """Return the error of results that miss the tolerance because of a fitted constant.

    Parameters
    ----------
    rtol
        The tolerance of the results [1].
    error
        The error of the results with the remaining tolerance.
    """
    if scene.measured is None or rtol is None:
        return error
    fit = _fit_of(scene)
    if not fit.parts and fit.error < NEGLIGIBLE * rtol:
        return error
    bound = math.expm1(math.log1p(fit.error) + math.log1p(error.error))
    # A measurement leaves at least two parts of the tolerance.
    named = ENOUGH * (0.5 * fit.parts * error.error if fit.parts else bound)
    return _inaccurate(fit.error, rtol, named)


def _inaccurate(error: float, rtol: float, named: float) -> SceneError:
    """Return the error of a constant that is not accurate enough for a tolerance.

    Parameters
    ----------
    error
        Error of the results due to the constant [1].
    rtol, named
        Their tolerance, and one that they meet [1].
    """
    why = f"the constant from the measured restitution causes an error of {rounded_up(error)}"
    if math.isinf(error):
        why = "the measured restitution does not determine the constant"
    expected, larger = "no tolerance", "remove the tolerance"
    if named < 1.0:
        expected = f"about {rounded_up(named)} or more"
        larger = f"increase the tolerance to {rounded_up(named)}"
    return SceneError(
        f"accuracy.rtol: expected {expected}, because {why}, got {rtol:g}; {larger}, or give the "
        "constant instead of [measured]"
    )
