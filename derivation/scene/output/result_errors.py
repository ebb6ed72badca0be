"""Error bound of each single result, and the number of its significant digits."""

import math
from typing import TYPE_CHECKING

from derivation.scene.contact_law.yielding import dent_error
from derivation.scene.errors import SceneError
from derivation.scene.kernels import YIELD_LIMIT
from derivation.scene.quantity import ONE_DIGIT, digits_of
from derivation.scene.scene import OUTPUTS
from derivation.scene.selection.achieved_accuracy import AchievedAccuracy
from derivation.scene.selection.method_selection import accuracy_on

if TYPE_CHECKING:
    from derivation.scene.result import Result

FORCE, PLASTICITY = "max_force", "plasticity"
RESULTS = (*OUTPUTS, "max_pressure", "max_tensile_stress", "total_time", "dent")
OF_OTHERS = {
    "max_pressure": (FORCE, "max_contact_radius"),
    "max_tensile_stress": (FORCE,),
    "total_time": OUTPUTS,
}
"""The outputs whose bounds apply to a result that is no output."""
ONSET = 2.0
"""Power in which omitted effects change the largest force's Hertz radius over that at the onset of
yield. Elasticity s of the sphere changes this ratio by the power -2/3 of 1 + s, and the contact
time by the power 2/5, so that the latter's bound to the power 5/3 covers it; the force adds 1/3."""


def bound_of(result: "Result", name: str) -> float:
    """Return the bound on the relative error of a result [1], without its model error.

    The tolerance need not apply to it. The bound is infinite if there is none.

    Raises
    ------
    SceneError
        If there is no such result.
    """
    if name not in RESULTS:
        raise SceneError(f"name: expected one of {', '.join(RESULTS)}, got {name!r}")
    if name == "dent":
        return _dent_error(result, 0.0)
    outputs = OF_OTHERS.get(name, (name,))
    accuracy = accuracy_on(outputs, result.effects, result.dynamics, result.accuracy)
    if name == "max_pressure":
        return max(accuracy.pressure_bound, _beyond_yield(result))
    return accuracy.bound


def error_of(result: "Result", name: str) -> float:
    """Return the relative error of a result by its bound and by the model [1].

    It is infinite if there is no bound, and for the stress under a static load if vibration of the
    plate may change it.

    Raises
    ------
    SceneError
        If there is no such result.
    """
    bound = bound_of(result, name)
    if name == "max_tensile_stress" and result.tensile_stress.static:
        return math.inf
    return _error_of(result, name, bound)


def digits_of_result(result: "Result", name: str) -> int:
    """Return the significant digits that bound and model error of a result support.

    A result with an error bound has at least one digit, even if its model error is large. A result
    without a bound has none, unless no result has a bound.
    """
    bound = bound_of(result, name)
    if math.isinf(bound) and any(math.isfinite(bound_of(result, other)) for other in OUTPUTS):
        return 0
    if math.isinf(bound):
        return min(digits_of(bound), max(1, digits_of(_error_of(result, name, 0.0))))
    return max(digits_of(_error_of(result, name, bound)), min(1, digits_of(bound)))


def _error_of(result: "Result", name: str, bound: float) -> float:
    """Return the relative error of a result by its bound and by the model [1]."""
    if name == "max_tensile_stress":
        return bound + result.tensile_stress.error
    if name == "dent":
        return _dent_error(result, result.model_errors[FORCE])
    return bound + result.model_errors.get(name, result.model_error)


def largest_within_error(result: "Result", name: str) -> float:
    """Return a result in its unit, increased by its error if this is known."""
    error = _error_of(result, name, bound_of(result, name))
    return float(getattr(result, name)) * (1.0 + (error if math.isfinite(error) else 0.0))


def unknown(result: "Result") -> tuple[str, ...]:
    """Return the outputs without a digit, if others have one."""
    names = tuple(name for name in OUTPUTS if not digits_of_result(result, name))
    return names if len(names) < len(OUTPUTS) else ()


def stated_accuracy(result: "Result") -> tuple[AchievedAccuracy, dict[str, float]]:
    """Return the accuracy of the outputs to which the tolerance applies, and the larger bounds.

    If together they have at most one digit, the accuracy is that of those which have more, and the
    bounds are those of the others.
    """
    accuracy, bounds = result.accuracy, {x: bound_of(result, x) for x in result.accuracy.outputs}
    better = tuple(name for name, bound in bounds.items() if bound < ONE_DIGIT)
    if accuracy.bound < ONE_DIGIT or not better:
        return accuracy, {}
    others = {name: bound for name, bound in bounds.items() if name not in better}
    return accuracy_on(better, result.effects, result.dynamics, accuracy), others


def _omits_yield(result: "Result") -> bool:
    """Return whether the contact may yield, but plasticity was omitted within the tolerance."""
    rows = (row for row in result.effects.rows if row.name == PLASTICITY)
    return any(row.bound and not (row.included or row.disabled) for row in rows)


def _beyond_yield(result: "Result") -> float:
    """Return how far the pressure exceeds that of yield, which was omitted [1].

    A contact that yields has the same results up to its onset, and the pressure of the onset. Thus
    this pressure is the smaller one of the limit and that of the elastic contact.
    """
    if not _omits_yield(result):
        return 0.0
    return max(0.0, result.max_pressure / (YIELD_LIMIT * result.model.yield_stress) - 1.0)


def _dent_error(result: "Result", model_error: float) -> float:
    """Return the relative error of the dent [1], with a model error of the force [1]."""
    if _omits_yield(result):
        return math.inf
    accuracy = accuracy_on(OUTPUTS, result.effects, result.dynamics, result.accuracy)
    if math.isinf(accuracy.bound):
        return math.inf
    omitted, all_errors = math.log1p(accuracy.effects.bound), math.log1p(accuracy.bound)
    change = (all_errors - omitted + math.log1p(model_error)) / 3.0 + ONSET * omitted
    return dent_error(result.effects.law, result.max_force, change)
