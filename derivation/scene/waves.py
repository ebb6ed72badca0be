"""Impact on a plate with inertia: its oscillators, its contacts, and where the energy goes.

The modes up to some frequency are oscillators (see `modal`), the others respond quasi-statically.
With twice as many the impact is computed again, and that is the result: the difference is the
estimated error of the omitted modes. Where the branches beyond the first are worth more than the
tolerance, all of them oscillate. An infinite plate is one so large that no wave can return from
its edge while the sphere is in contact.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from derivation.scene import contact_sequence
from derivation.scene.contact_sequence import ImpactHistory, expected_work
from derivation.scene.contact_tables import contact_of
from derivation.scene.dynamic_problem import DynamicProblem
from derivation.scene.dynamic_results import UNKNOWN, dynamic_impact_of
from derivation.scene.effects.inertia import WIDER
from derivation.scene.law import ContactLaw
from derivation.scene.modal import ModalPlate, Modes, plate_of
from derivation.scene.mode_count import (
    LAST,
    affordable,
    branching,
    check_followed,
    count_of,
    fast,
    followed,
    too_dear,
)
from derivation.scene.model import Model
from derivation.scene.scene import OUTPUTS, SceneError
from derivation.scene.wave_motion import DynamicImpact
from derivation.scene.yielding import units_of, yielding_of

NODES, MANY = (32, 24, 16), (500, 5000)
"""Nodes of an element, and numbers of oscillators above which an element has fewer."""
FEWER = 2
"""Difference in the number of nodes between a run and the coarser one that checks it."""
WIDEST = 30.0
"""How much larger than the first guess an infinite plate is made, to wait for a contact's end."""
LOOSE, SHARE = 3e-4, 1.0 / 3.0
"""Change with the number of modes that is small enough: where no tolerance is given [1], and of
one that is given."""
HEAVY, IN_CONTACT = 10.0, 0.7
"""Sphere mass over that of the plate's first mode above which the plate acts as a spring, and the
least fraction of its half period in contact; random scenes have at least 0.77."""
INTEGRATION, GROWTH, ROUNDING = 10.0, 1e-12, 2e-12
"""Tested bounds: error of the results over the tolerance of the time elements and the number of
contacts; rounding that the contacts amplify over the cube of their number; other rounding [1]."""
WORK = 4e7
"""Work of all runs of an impact, as `contact_sequence` counts that of one."""


def goal(rtol: float | None) -> float:
    """How much the modes left out may change, of a tolerance of everything [1]."""
    return LOOSE if rtol is None else SHARE * rtol


def nodes_for(problem: DynamicProblem) -> int:
    """Return the number of nodes of an element: fewer for many oscillators, to save time."""
    return NODES[int(np.searchsorted(MANY, problem.omega.size))]


def time_tolerance(goal: float) -> float:
    """Return the tolerance of the time elements, small against the goal for more modes [1]."""
    return min(1e-8, max(contact_sequence.TOLERANCE, 1e-3 * goal))


def integration_error(history: ImpactHistory) -> float:
    """Return the tested bound on the error of the results due to the time elements [1]."""
    return _integration_error(history.problem, history.tolerance, len(history.contacts))


def _integration_error(problem: DynamicProblem, tolerance: float, contacts: int = 1) -> float:
    """Return that bound; elements may resolve the force of a viscoelastic contact less well.

    Every contact adds errors, and a small change of one changes the next ones more.
    """
    viscous = problem.retardation_time > 0.0
    each = (contact_sequence.ROUGH if viscous else INTEGRATION) * tolerance
    return each * contacts + GROWTH * (contacts - 1) ** 3


@dataclass
class Budget:
    """Work that the runs of an impact may still take together."""

    left: float


@lru_cache(maxsize=4)
def impact(
    law: ContactLaw, goal: float = LOOSE, outputs: tuple[str, ...] = OUTPUTS
) -> DynamicImpact:
    """The impact by a law with inertia.

    Parameters
    ----------
    goal
        Relative change of the results with the number of modes that is small enough: while it
        is larger the modes are doubled, unless the scene says how many there are. If the scene
        leaves the branches open, all of them oscillate where those beyond the first are worth
        more.
    outputs
        The results that it applies to.

    Raises
    ------
    SceneError
        If an impact on a plate that does not deflect exceeds the law's range, or the first contact
        cannot be followed to its end. If a later one cannot, the impact is incomplete.
    """
    _check_heavy(law)
    budget = Budget(WORK)
    rough: DynamicImpact | None = None
    if law.model.inertia.branches == "auto" and not law.viscous:
        law, rough = _branched(law, goal, outputs, budget)
    found, first = _converged(law, goal, outputs, budget, rough), law.model.b
    while law.model.inertia.infinite_plate and _edge_heard(found):
        if law.model.b > WIDEST * first:
            raise SceneError(
                f"inertia.extent: the contact on an infinite plate had not ended after "
                f"{found.inertia.total_time:.6g} s; use a thicker plate or a lighter sphere"
            )
        law = replace(law, model=replace(law.model, b=2.0 * law.model.b))
        found = _converged(law, goal, outputs, budget)
    return found


def _branched(
    law: ContactLaw, goal: float, outputs: tuple[str, ...], budget: Budget
) -> tuple[ContactLaw, DynamicImpact | None]:
    """The law with all branches if those beyond the first may change more than the goal leaves.

    A rough run tells, of the first branch alone, which is returned too if it is enough. What its
    first contact says is less than the whole says. Besides the branches the tolerance covers the
    modes, which take up the goal. Branches cannot be taken where the contact is so short that
    there would be too many.
    """
    every, lowest, close = branching(law, "all"), branching(law, "A0"), time_tolerance(goal)
    if not followed(every, 2 * affordable(every)):
        return lowest, None
    problem = problem_of(lowest, count_of(law))
    room = goal / SHARE - goal - _integration_error(problem, close)
    n = nodes_for(problem) - FEWER
    most, begin = contact_sequence.steps_of(problem, n), problem.begin()
    first = contact_sequence.contact(problem, n, begin, 0.0, 0.0, close, most=most)
    begun = dynamic_impact_of(lowest, ImpactHistory(problem, (first,), ""))
    if begun.inertia.left(outputs)[1] > room:
        budget.left -= first.tried * contact_sequence.weight_of(problem, n)
        return every, None
    history = contact_sequence.impact_history(problem, n, close, first=first)
    budget.left -= history.work
    rough = dynamic_impact_of(lowest, history)
    if rough.inertia.complete and rough.inertia.left(outputs)[1] > room:
        return every, None
    return lowest, rough


def half_period(m: float, modes: Modes) -> float:
    """Return half the period [s] of a mass [kg] on the static compliance of the plate."""
    return math.pi * math.sqrt(m * float(np.sum(modes.compliance)))


def _check_heavy(law: ContactLaw) -> None:
    """Reject a sphere so heavy that it stays on the plate for more time steps than are allowed.

    The contacts last about half a period, and the fastest mode limits the time step.
    """
    model, modes = law.model, plate_of(law, count_of(law)).modes
    ratio = model.m * float(modes.inverse_modal_mass[0])
    if ratio < HEAVY or model.inertia.modes or model.inertia.infinite_plate:
        return
    swing = half_period(model.m, modes)
    problem = problem_of(law, 2 * affordable(law))
    n = nodes_for(problem)
    steps = IN_CONTACT * swing / problem.T * problem.fastest / (contact_sequence.PHASE * n)
    most = contact_sequence.steps_of(problem, n)
    if steps > most:
        raise SceneError(
            f"effects.inertia: the sphere is {ratio:.3g} times as heavy as the first mode of the "
            f"plate and stays on it for about {swing:.2g} s, which needs at least {steps:.2g} time "
            f"steps, more than the limit of {most}; set effects.inertia = false (for such a sphere "
            "the plate is nearly quasi-static), or choose inertia.modes"
        )


def _edge_heard(found: DynamicImpact) -> bool:
    """Whether a wave may have come back from the edge before the last contact ended."""
    model, problem = found.law.model, found.impact_history.problem
    return problem.T * found.impact_history.contacts[-1].end > echo_time(model)


def _converged(
    law: ContactLaw,
    goal: float,
    outputs: tuple[str, ...],
    budget: Budget,
    known: DynamicImpact | None = None,
) -> DynamicImpact:
    """The impact with as many modes as it takes, or as can be afforded.

    The run with the fewest may be known.
    """
    count, close = affordable(law), time_tolerance(goal)
    check_followed(law, 2 * count)
    rough = known or _run(law, count, budget, close, FEWER)
    if not rough.inertia.complete:  # and no finer run would be
        return rough
    best: DynamicImpact | None = None
    while True:
        try:
            found = _run(law, 2 * count, budget, close, coarse=rough.impact_history)
        except SceneError:
            if best is None:
                raise
            return best  # with fewer modes it was followed to its end
        if not found.inertia.complete:
            return best or found
        best, count, rough = _judged(rough, found), 2 * count, found
        change, beyond = best.inertia.left(outputs)
        # Where omitted branches matter more than additional modes, a tenth of them is small enough.
        enough = goal if beyond <= goal / SHARE else max(goal, 0.1 * beyond)
        if law.model.inertia.modes:
            return _of_chosen_modes(best, law, count, budget)
        near = change <= LAST * enough
        if change <= enough or too_dear(law, count, _work(best.impact_history), near):
            return best


def _work(history: ImpactHistory) -> float:
    """Number of time elements, weighted by the run time of each."""
    pieces = [piece.element for touching in history.contacts for piece in touching.pieces]
    return len(pieces) * contact_sequence.weight_of(history.problem, pieces[0].slope.size)


def problem_of(law: ContactLaw, count: int) -> DynamicProblem:
    """An impact with so many bending modes, to be followed by `contact_sequence`."""
    return _problem(law, plate_of(law, count))


def _run(
    law: ContactLaw,
    count: int,
    budget: Budget,
    tolerance: float,
    fewer_nodes: int = 0,
    coarse: ImpactHistory | None = None,
) -> DynamicImpact:
    """The impact with so many bending modes by elements of a tolerance, or of fewer nodes too.

    If with the contacts of a coarser run it would exceed its work, it is not begun, and those are
    all that is known.
    """
    problem = _problem(law, plate_of(law, count))
    n = nodes_for(problem) - fewer_nodes
    work = min(contact_sequence.WORK, budget.left)
    if coarse and expected_work(problem, n, coarse) > work:
        fewer = count // 2
        while fewer > 1 and expected_work(problem_of(law, fewer), n, coarse) > work:
            fewer //= 2
        return dynamic_impact_of(law, _unchecked(coarse, problem, fewer))
    history = contact_sequence.impact_history(problem, n, tolerance, work)
    budget.left -= history.work
    return dynamic_impact_of(law, history)


def _unchecked(coarse: ImpactHistory, problem: DynamicProblem, fewer: int) -> ImpactHistory:
    """A run that none with more modes can check, which fewer modes would meet: it is incomplete."""
    return replace(
        coarse,
        reason=f"the error of {coarse.problem.omega.size} modes is unknown, because the "
        f"{problem.omega.size} modes for its estimate exceed the limit of work",
        remedy=f"set inertia.modes = {fewer} and remove the tolerance, or set "
        "effects.inertia = false",
    )


def _judged(rough: DynamicImpact, found: DynamicImpact) -> DynamicImpact:
    """Return the finer run with the relative change of each result since the coarser run."""
    pairs = zip(found.numbers, rough.numbers, strict=True)
    time, depth, force, radius, speed = (abs(new - old) / abs(new) for new, old in pairs)
    change = time, depth, force, radius, speed
    return replace(found, inertia=replace(found.inertia, mode_convergence=change))


def _of_chosen_modes(
    found: DynamicImpact, law: ContactLaw, count: int, budget: Budget
) -> DynamicImpact:
    """A run with as many modes as the scene says, and what its error estimate is worth.

    Half as many that are slower than the contact may agree with it by chance: then a quarter as
    many are asked too. If all of them are slower, no estimate is known.
    """
    if fast(law, count // 2):
        return found
    if not fast(law, count):
        return _unjudged(found)
    coarse = _run(law, max(1, count // 4), budget, time_tolerance(LOOSE), FEWER)
    if not coarse.inertia.complete:
        return _unjudged(found)
    further = _judged(coarse, found).inertia.mode_convergence
    time, depth, force, radius, speed = map(max, found.inertia.mode_convergence, further)
    change = time, depth, force, radius, speed
    return replace(found, inertia=replace(found.inertia, mode_convergence=change))


def _unjudged(found: DynamicImpact) -> DynamicImpact:
    """Return a run of whose omitted modes no error estimate is known."""
    return replace(found, inertia=replace(found.inertia, mode_convergence=UNKNOWN))


def _problem(law: ContactLaw, plate: ModalPlate) -> DynamicProblem:
    """The scene in units of the impact on a plate that does not deflect."""
    model, (a, T) = law.model, units_of(law)
    rest = law.only(lambda e: e.static and not e.other_edge)
    contact = contact_of(rest, plate, min(WIDER * a, law.limit), model.inertia.pointwise)
    retardation = model.retardation_time / T if law.viscous else 0.0
    heard = echo_time(model) / T if model.inertia.infinite_plate else math.inf
    weight = law.gravity * (T / model.v0)
    units = a, T, model.m, model.v0
    end = law.limit_in_words if law.limit < WIDER * a else ""
    return DynamicProblem(
        contact, *units, weight, retardation, heard, law.damping_ratio, yielding_of(law), end
    )


def echo_time(model: Model) -> float:
    """Time [s] before which no wave returns from the edge: twice its way at the fastest speed.

    Of A0 no group is faster than 1.1 times shear waves; of all branches none than pressure waves.
    """
    fastest = 1.1
    if model.inertia.branches == "all":
        fastest = math.sqrt((model.lam + 2.0 * model.mu) / model.mu)
    return 2.0 * model.b / (fastest * model.shear_speed)
