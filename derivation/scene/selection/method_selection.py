"""Selects the fastest method whose error bound meets the tolerance, with the basis of the bound.

The effects of the law have been selected before. In the order of run time: `hertz` and `leading`
omit terms of the plate's law and have a proved bound; `coarse` and `full` use the whole law, with
half the quadrature nodes and with all of them. An error bound is a relative error of each output
against the law with all effects that the scene does not disable, for inputs that are exact doubles.
"""

import math
from dataclasses import replace
from numbers import Real
from typing import TYPE_CHECKING

import numpy as np

from derivation.engine.threads import one_thread
from derivation.scene import kernels
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import check_energy, check_numbers
from derivation.scene.dynamic.unmet_tolerances import (
    branches_exceed,
    duration_may_jump,
    out_of_reach,
)
from derivation.scene.effects import BY_NAME, PAPER
from derivation.scene.effects.effect import Results
from derivation.scene.errors import SceneError
from derivation.scene.input.messages import shown, tolerance_remedy
from derivation.scene.model import Model
from derivation.scene.quantity import ONE_DIGIT
from derivation.scene.quasi_static import motion, simple_laws
from derivation.scene.quasi_static.closed_form import closed_form
from derivation.scene.scene import TIGHTEST
from derivation.scene.selection.achieved_accuracy import (
    ESTIMATED,
    PROVED,
    ROUNDING_ANALYSIS,
    TESTED,
    AchievedAccuracy,
    Part,
    remaining,
)
from derivation.scene.selection.effect_selection import NO_GROWTH, SelectedEffects, largest_growth

if TYPE_CHECKING:
    from derivation.scene.dynamic.wave_motion import DynamicImpact

CERTAIN = 0.75
"""Bound on an output over the tolerance, up to which a message states that it meets it alone: with
fewer outputs the simulation may end with fewer modes."""
SEARCHES, LARGER = 20, 1.05
"""Largest number of tolerances that are considered for a message, and the least ratio of two."""


def check_rtol(rtol: float) -> float:
    """Return the tolerance as a float.

    Raises
    ------
    SceneError
        If it is not between 1e-13 and 1.
    """
    if isinstance(rtol, np.ndarray) and rtol.ndim == 0:
        rtol = rtol[()]
    number = isinstance(rtol, Real) and not isinstance(rtol, bool)  # NumPy's numbers too
    if not number or not TIGHTEST <= rtol <= 1:
        raise SceneError(
            f"rtol: expected a relative tolerance from {TIGHTEST:g} to 1, got {shown(rtol)}"
            + (tolerance_remedy(rtol) or "; write for example 0.01")
        )
    return float(rtol)


def solve_selected(
    selected: SelectedEffects, rtol: float | None = None, within: bool = True
) -> tuple[Results, AchievedAccuracy]:
    """Return the five outputs by the law of the selected effects, with their accuracy.

    Parameters
    ----------
    selected
        The selected effects.
    rtol
        Relative tolerance of each output [1], omitted effects included; by default the full
        method is used.
    within
        Whether the tolerance must be met.

    Raises
    ------
    ToleranceError
        If the tolerance is not met.
    SceneError
        If the impact exceeds the law's range.
    """
    law, rest = selected.law, remaining(rtol, selected.error)
    moving: DynamicImpact | None = None
    if law.of_paper:
        results, accuracy = solve(law.model, rest)
    elif law.dynamic:
        moving = dynamic_impact(selected, rtol, within)
        results, accuracy = moving.numbers, _accuracy_with_inertia(law, moving)
    else:
        results, accuracy = _composed(law)
    accuracy = _of_outputs(selected, moving, replace(accuracy, rtol=rtol))
    # An incomplete impact has no bound; it is returned and marked as incomplete.
    if within and rtol is not None and rtol < accuracy.bound and not math.isnan(results[-1]):
        timed = moving is not None and "contact_time" in selected.outputs
        jumps = bool(moving and timed and moving.inertia.jump > rtol)
        if jumps or _may_jump(selected, moving):
            others = tuple(name for name in selected.outputs if name != "contact_time")
            rest = _of_outputs(selected.on(others), moving, accuracy).bound if others else None
            slow = bool(moving and moving.inertia.slow)
            raise duration_may_jump(rtol, law, not jumps, rest, slow)
        room = rtol - replace(accuracy, effects=Part(0.0, PROVED)).bound
        growth = largest_growth(growth_of(moving), selected.outputs)
        growth = growth * rtol / room if room > 0.0 else 0.0
        met = () if moving is None else _met(selected, moving, accuracy, rtol)
        named = accuracy.bound if moving is None else _named(selected, moving, accuracy)
        raise out_of_reach(rtol, accuracy, law, results[3], growth, met, named)
    check_numbers(law.model, *(results[:-1] if math.isnan(results[-1]) else results))
    return results, accuracy


def accuracy_on(
    outputs: tuple[str, ...],
    selected: SelectedEffects,
    moving: "DynamicImpact | None",
    accuracy: AchievedAccuracy,
) -> AchievedAccuracy:
    """Return the accuracy of outputs: that of all to which the tolerance applies.

    It is their own if the tolerance does not apply to them, or leaves at most one digit for all.
    """
    if set(outputs) <= set(accuracy.outputs) and accuracy.bound < ONE_DIGIT:
        return accuracy
    return _of_outputs(selected.on(outputs), moving, accuracy)


def _of_outputs(
    selected: SelectedEffects, moving: "DynamicImpact | None", accuracy: AchievedAccuracy
) -> AchievedAccuracy:
    """Return an accuracy with the errors of the outputs of `selected` by all that is omitted."""
    effects, outputs = Part(_omitted(selected, moving), _basis(selected)), selected.outputs
    law = Part(moving.inertia.error(outputs), ESTIMATED) if moving else accuracy.law
    return replace(accuracy, law=law, effects=effects, outputs=outputs)


def _omitted(selected: SelectedEffects, motion: "DynamicImpact | None") -> float:
    """Return the bound on the omitted effects; with plate inertia it may exceed the selection's.

    If the omitted effects may split the first contact or join it with the second, there is no bound
    on its duration, which jumps.
    """
    if _may_jump(selected, motion):
        return math.inf
    return largest_growth(growth_of(motion), selected.outputs) * selected.error


def _named(selected: SelectedEffects, moving: "DynamicImpact", accuracy: AchievedAccuracy) -> float:
    """Return a tolerance that a simulation with plate inertia meets with these or more modes [1].

    With a larger tolerance more effects may be omitted, which takes a part of it.
    """
    from derivation.scene.dynamic.mode_convergence import attainable
    from derivation.scene.dynamic.refinement import KEPT

    law = Part(attainable(moving).error(selected.outputs), ESTIMATED)
    simulated = replace(accuracy, law=law, effects=Part(0.0, PROVED)).bound / KEPT
    growth, error = largest_growth(growth_of(moving), selected.outputs), selected.error
    named = math.expm1(math.log1p(growth * error) + math.log1p(simulated))
    for _ in range(SEARCHES):
        if not named < 1.0:
            break
        error = selected.omitted_at(named)
        least = math.expm1(math.log1p(growth * error) + math.log1p(simulated))
        if least <= named:
            break
        named = LARGER * least
    return named


def _met(
    selected: SelectedEffects, moving: "DynamicImpact", accuracy: AchievedAccuracy, rtol: float
) -> tuple[str, ...]:
    """Return the outputs that meet a tolerance, which the outputs together do not meet."""

    def bound(name: str) -> float:
        return _of_outputs(replace(selected, outputs=(name,)), moving, accuracy).bound

    return tuple(name for name in selected.outputs if bound(name) <= CERTAIN * rtol)


def growth_of(motion: "DynamicImpact | None") -> Results:
    """Return the factors by which a simulated impact increases the bounds on each result [1].

    A plate may take nearly all energy. The small remaining speed then changes by a multiple. Also,
    between contacts a change of the speed displaces the sphere, which then meets the plate at
    another phase of its vibration, and the weight acts during flight. This changes the restitution,
    and the largest values if they may be those of a later contact.
    """
    if motion is None or not motion.inertia.complete:
        return NO_GROWTH
    from derivation.scene.effects.inertia import FLIGHT_GROWTH, LATER_PEAK, LEAST

    largest, speed = (1.0 + factor * motion.flight for factor in FLIGHT_GROWTH)
    later = max((one.peak_force for one in motion.inertia.contacts[1:]), default=0.0)
    peak = largest if later > LATER_PEAK * motion.max_force else 1.0
    return 1.0, peak, peak, peak, speed * max(1.0, LEAST / max(motion.restitution, 1e-300))


def _may_jump(selected: SelectedEffects, motion: "DynamicImpact | None") -> bool:
    """Return whether the omitted effects may change the duration of the first contact by a jump."""
    if motion is None or "contact_time" not in selected.outputs or not selected.error:
        return False
    return motion.decisive_change <= selected.error


def _basis(selected: SelectedEffects) -> str:
    """Return the basis of the bound on the omitted effects.

    It is proved for elastic contacts on a quasi-static plate, and otherwise tested on random
    scenes.
    """
    law = selected.law
    out = [row.name for row in selected.rows if row.bound and not (row.included or row.disabled)]
    proved = all(BY_NAME[name].proved(law) for name in out)
    return PROVED if proved and not (law.model.retardation_time or law.dynamic) else TESTED


def _composed(law: ContactLaw) -> tuple[Results, AchievedAccuracy]:
    """Return the outputs on a quasi-static plate by a law of any effects, with their accuracy."""
    closed = closed_form(law)
    if closed is not None:
        exact, quadrature = Part(0.0, PROVED), Part(closed.quadrature, PROVED)
        if law.hertzian:
            method, rounding = "hertz", Part(closed.rounding, ROUNDING_ANALYSIS)
        else:
            method, rounding = "full", Part(closed.rounding + rounding_of(law), TESTED)
        return (*closed[:4], 1.0), AchievedAccuracy(method, None, exact, quadrature, rounding)
    motion = moved(law)
    of_slope = float(law.cancellation(np.array([motion.max_contact_radius]))[0])
    return motion.numbers, AchievedAccuracy(
        "full",
        None,
        law=Part(0.0, PROVED),
        quadrature=Part(motion.quadrature, TESTED),
        rounding=Part(rounding_of(law) + of_slope, TESTED),
    )


def _accuracy_with_inertia(law: ContactLaw, impact: "DynamicImpact") -> AchievedAccuracy:
    """Return the accuracy of an impact on a plate with inertia, apart from all that is omitted."""
    from derivation.scene.dynamic.integration_error import integration_error

    return AchievedAccuracy(
        "full",
        None,
        law=Part(0.0, ESTIMATED),
        quadrature=Part(integration_error(impact.impact_history), TESTED),
        rounding=Part(rounding_of(law), TESTED),
    )


def dynamic_impact(
    selected: SelectedEffects, rtol: float | None, within: bool = True
) -> "DynamicImpact":
    """Return the impact on a plate with inertia, to a tolerance.

    Parameters
    ----------
    within
        Whether the tolerance must be met, so that the simulation may end early.

    Raises
    ------
    ToleranceError
        If an early estimate of the error exceeds the tolerance.
    SceneError
        If the impact exceeds the law's range, or the time integration fails.
    """
    from derivation.scene.dynamic import waves
    from derivation.scene.dynamic.reach import OutOfReachError

    rest = remaining(rtol, selected.error)
    need = math.inf if rest is None or not within else rest
    if math.isfinite(need) and selected.law.model.inertia.pointwise:
        raise SceneError(
            'inertia.coupling: expected "variational" with a tolerance, got "pointwise", whose '
            "results do not converge with the number of modes; set inertia.coupling = "
            '"variational", or remove the tolerance'
        )
    try:
        with one_thread(), np.errstate(all="ignore"):  # extreme scenes give NaN, which is checked
            return waves.impact(selected.law, waves.goal(rest), selected.outputs, need)
    except OutOfReachError as error:
        assert rtol is not None
        raise branches_exceed(rtol, selected.error, error) from None


def moved(law: ContactLaw) -> motion.Motion:
    """Return the impact on a quasi-static plate by a law of any effects.

    Raises
    ------
    SceneError
        If the impact exceeds the law's range, or the sphere does not rebound.
    """
    with np.errstate(all="ignore"):
        if law.viscous:
            from derivation.scene.quasi_static import viscous

            return viscous.impact(law)
        if law.plastic:
            from derivation.scene.quasi_static import plastic

            return plastic.impact(law)
        return motion.impact(law)


def rounding_of(law: ContactLaw) -> float:
    """Return the tested bound on rounding errors, including those of pressure and time steps."""
    rounding = kernels.ROUNDING
    if law.solved:
        from derivation.scene.contact_law.solved_contact import INTERPOLATION
        from generated.pressure_numbers import ERROR

        rounding += ERROR + INTERPOLATION
    if law.viscous:
        from derivation.scene.quasi_static.viscous import ROUNDING

        rounding += ROUNDING
    if law.plastic:
        from derivation.scene.quasi_static import plastic, yield_phases

        rounding += plastic.ROUNDING if law.viscous else yield_phases.ROUNDING
    return rounding


def solve(model: Model, rtol: float | None = None) -> tuple[Results, AchievedAccuracy]:
    """Return the five outputs by the paper's law (rigid paraboloid), by the fastest method.

    Parameters
    ----------
    model
        The quantities of the scene.
    rtol
        Relative tolerance of each output [1], from 1e-13 to 1; by default the full method is used.

    Raises
    ------
    SceneError
        If the impact exceeds the law's range.
    """
    within = False
    if rtol is not None:
        for method, run in (("hertz", simple_laws.hertz), ("leading", simple_laws.leading)):
            estimate = simple_laws.single(run, *model.numbers)
            if estimate is None:  # no bound is known
                continue
            accuracy = estimated(method, estimate, rtol)
            if accuracy.bound <= rtol:
                return (*estimate[:4], 1.0), accuracy
            within = True  # the bound also limits the radius
    if not within:
        check_energy(ContactLaw(model, PAPER))
    coarse = rtol is not None and whole_law("coarse", rtol).bound <= rtol
    with np.errstate(all="ignore"):  # extreme scenes give NaN, which is checked
        # An array of one, so that the result is that of a row, to the last bit.
        values = kernels.impact(*(np.array([x]) for x in model.numbers), coarse=coarse)
    contact_time, delta, P, a = (np.asarray(value).item() for value in values)
    check_numbers(model, contact_time, delta, P, a)
    return (contact_time, delta, P, a, 1.0), whole_law("coarse" if coarse else "full", rtol)


def whole_law(method: str, rtol: float | None) -> AchievedAccuracy:
    """Return the accuracy of `coarse` or `full`, which does not depend on the scene."""
    coarse = method == "coarse"
    quadrature = kernels.COARSE_QUADRATURE if coarse else kernels.FULL_QUADRATURE
    return AchievedAccuracy(
        method,
        rtol,
        law=Part(0.0, PROVED),
        quadrature=Part(quadrature, TESTED),
        rounding=Part(kernels.ROUNDING, TESTED),
    )


def estimated(method: str, estimate: kernels.Estimate, rtol: float | None) -> AchievedAccuracy:
    """Return the accuracy of `hertz` or `leading`."""
    return AchievedAccuracy(
        method,
        rtol,
        law=Part(estimate.law, PROVED),
        quadrature=Part(estimate.quadrature, PROVED),
        rounding=Part(estimate.rounding, ROUNDING_ANALYSIS),
    )
