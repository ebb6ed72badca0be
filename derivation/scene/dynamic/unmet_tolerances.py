"""Errors of tolerances that a simulation has not met."""

import json
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.errors import SceneError, ToleranceError
from derivation.scene.quantity import rounded_up
from derivation.scene.selection.achieved_accuracy import AchievedAccuracy

if TYPE_CHECKING:
    from derivation.scene.dynamic.reach import OutOfReachError


def branches_exceed(rtol: float, omitted: float, error: "OutOfReachError") -> ToleranceError:
    """Return the error for a tolerance that the omitted wave branches alone exceed.

    Parameters
    ----------
    omitted
        Bound on the change by the omitted effects [1].
    error
        The error of the simulation, which has ended early.
    """
    least, change = (
        math.expm1(math.log1p(omitted) + math.log1p(part)) for part in (error.least, error.change)
    )
    expected = f"at least about {rounded_up(least)}"
    remedy = (
        "this is a lower limit, to which omitted modes may add: increase the tolerance to it or "
        "further"
    )
    if not least <= 1.0:
        expected, remedy = "no tolerance", "remove the tolerance"
    return ToleranceError(
        f"rtol: expected {expected}, because {error.why}, got {rtol:.3g}; {remedy}, or remove "
        f"this limit: {error.remedy}",
        change,
    )


def duration_may_jump(
    rtol: float, law: ContactLaw, by_effects: bool, others: float | None, slow: bool
) -> SceneError:
    """Return the error for a first contact whose duration may jump.

    Parameters
    ----------
    by_effects
        Whether it jumps by omitted effects only, which a small enough tolerance includes.
    others
        Error bound of the other requested results [1]; None if there are none.
    slow
        Whether the impact lasts too long for more modes.
    """
    remedy = "try a smaller tolerance, with which more of them are included, or "
    if slow:
        remedy = ""
    elif by_effects:
        remedy = "reduce the tolerance, so that more of them are included, or "
    elif law.model.inertia.modes:  # their number does not depend on the tolerance
        remedy = "try more inertia.modes, or "
    without = "remove contact_time from accuracy.outputs"
    if others is None:
        without = "request other results in accuracy.outputs"
    elif math.isfinite(others) and others > rtol:
        without += f" (the error of the other results is up to {rounded_up(others)})"
    return SceneError(
        f"rtol: contact_time, the duration of the first contact, cannot be computed to {rtol:.3g}, "
        "because the omitted effects, modes or wave branches may split this contact, or join it "
        f"with the next one; {remedy}{without}"
    )


def out_of_reach(
    rtol: float,
    accuracy: AchievedAccuracy,
    law: ContactLaw,
    a: float,
    growth: float,
    met: Sequence[str],
    named: float,
) -> SceneError:
    """Return the error for a tolerance that is not met, or cannot be compared with a bound.

    Parameters
    ----------
    a
        Largest contact radius [m].
    growth
        As in `ToleranceError`.
    met
        The outputs that meet the tolerance.
    named
        A tolerance that can be met [1].
    """
    if math.isinf(accuracy.effects.bound):
        return SceneError(
            f"rtol: the tolerance {rtol:.3g} cannot be checked because there is no bound on the "
            "omitted effects; remove the keys of [effects] that are false, or remove the tolerance"
        )
    expected, where = "at least", f"for a contact radius of {a / law.model.R:.4g} sphere radii"
    remedy = "increase the tolerance"
    if law.dynamic:
        where = "with the dynamic modes and wave branches of this scene"
        if law.model.inertia.modes:
            remedy += " or inertia.modes"
        else:  # the simulation ends when more modes cannot meet this tolerance
            expected = "a tolerance that can be met, such as"
    if math.isinf(accuracy.bound):
        return SceneError(
            f"inertia.modes: expected enough modes for an error bound, got "
            f"{law.model.inertia.modes}; increase inertia.modes, or remove the tolerance"
        )
    if met:
        remedy += (
            ", or request only results whose errors are small enough in this simulation: "
            f"accuracy.outputs = {json.dumps(list(met))}"
        )
    if not named <= 1.0:
        instead = remedy.replace("increase the tolerance", "remove the tolerance")
        return ToleranceError(
            f"rtol: expected no tolerance, because the error {where} is up to "
            f"{rounded_up(accuracy.bound)}, got {rtol:.3g}; {instead}",
            accuracy.bound,
            growth,
        )
    return ToleranceError(
        f"rtol: expected {expected} {rounded_up(named)} {where}, got {rtol:.3g}; {remedy}",
        accuracy.bound,
        growth,
    )
