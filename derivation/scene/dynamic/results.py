"""Converts the contacts of an impact on a plate with inertia into results in SI units."""

import math

import numpy as np

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.contact_sequence import ContactRun, ImpactHistory
from derivation.scene.dynamic.energy import balance_of
from derivation.scene.dynamic.flight import meeting_speed
from derivation.scene.dynamic.inertia_details import ContactInterval, InertiaDetails
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.dynamic.short_echoes import echo_errors
from derivation.scene.dynamic.time_element import A, C, P, Z
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.effects.effect import Results, weight_work_ratio
from derivation.scene.effects.inertia import after_yield, higher_branch_error
from derivation.scene.numerics.collocation import Element, largest_of
from derivation.scene.quasi_static.motion import EnergyBalance

NONE: Results = (0.0, 0.0, 0.0, 0.0, 0.0)
UNKNOWN: Results = (math.inf, math.inf, math.inf, math.inf, math.inf)
NARROW = 2.0
"""Wave number times largest contact radius from which a contact no longer drives a mode. The mean
of its logarithm for Hertz's pressure is that of 1.37; most of the time the radius is smaller."""


def dynamic_impact_of(law: ContactLaw, history: ImpactHistory) -> DynamicImpact:
    """Return the results of an impact from its contacts."""
    problem, last = history.problem, history.contacts[-1].after
    energy = problem.m * problem.v0**2
    elements = [element for touching in history.contacts for element in _elements(touching)]
    largest = {row: largest_of(elements, row) for row in (A, Z, C)}
    forces = [largest_of(_elements(touching), P) for touching in history.contacts]
    largest[P] = max(forces)
    displacement = max(
        largest[Z], max(touching.before.displacement for touching in history.contacts)
    )
    energies, widest = problem.energies(last), problem.a * largest[C]
    if problem.yielding:
        widest /= problem.yielding.flattening
    first, total = history.contacts[0], history.contacts[-1].end
    balance = balance_of(history)
    ripple, echo_error = echo_errors(
        law, history, problem.a * largest[A], problem.force * largest[P]
    )
    with_earlier = zip(history.contacts, (None, *history.contacts[:-1]), forces, strict=True)
    inertia = InertiaDetails(
        tuple(_contact_interval(problem, *each) for each in with_earlier),
        problem.T * total,
        history.reason,
        history.remedy,
        problem.omega.size,
        tuple((energy * energies).tolist()),
        NONE if history.complete else UNKNOWN,
        _branches(law, widest, problem.depth * displacement, problem.T * first.end, balance),
        _damped_octaves(problem, widest),
        largest[C] / largest[A] - 1.0,
        echo_ripple=ripple,
        echo_error=echo_error,
    )
    return DynamicImpact(
        problem.T * first.end,
        problem.depth * displacement,
        problem.force * largest[P],
        widest,
        0.0,
        -last.velocity if history.complete else math.nan,
        energy_balance=balance,
        impact_history=history,
        inertia=inertia,
        law=law,
        dent=problem.yielding.dent if problem.yielding else 0.0,
    )


def _branches(
    law: ContactLaw, a: float, displacement: float, T: float, balance: EnergyBalance
) -> Results:
    """Return the estimated change of each result by the omitted wave branches [1].

    It is 0 if all branches are included. The work of the weight increases all changes except that
    of the displacement. Dissipation in the contact increases those of contact time and restitution,
    as if all of it were plastic.

    In 153 random viscoelastic impacts, simulated by another program with and without higher
    branches, the changes were at most half of the estimates. The higher branches were damped as the
    contact is (Kelvin-Voigt). Undamped ones, driven by P_e, changed results by up to 4.7 times the
    estimates in 23 of these impacts. They are not a model of the contact: they may gain energy.
    """
    model = law.model
    if model.inertia.branches == "all":
        return NONE
    heavier = float(1.0 + weight_work_ratio(model, displacement))
    lost = balance.plastic_loss + balance.viscous_loss + balance.unrecovered_elastic
    supplied = balance.initial_kinetic + max(0.0, balance.gravity_work)
    restitution = math.sqrt(max(0.0, 1.0 - lost / supplied))
    changed = higher_branch_error(model, a, T, 2.0 * law.damping_ratio)
    time, depth, force, radius, speed = map(float, after_yield(changed, restitution))
    return heavier * time, depth, heavier * force, heavier * radius, heavier * speed


def _damped_octaves(problem: DynamicProblem, a: float) -> float:
    """Return how often doubling the number of modes would still change the results as much [1].

    A damped mode lags a slow force by 2 zeta/omega. Beyond the thickness, frequencies grow as wave
    numbers, and the static compliance is the same for each of them: each octave then dissipates as
    much, up to wave lengths of the size of the contact. Without damping the change decreases.
    """
    modes, ratio = problem.contact.modes, problem.damping_ratio
    if not ratio:
        return 0.0
    slowest = float(np.min(problem.omega[modes.first[-1] :]))
    octaves = math.log2(max(1.0, NARROW / (a * float(np.max(modes.phi)))))
    return octaves * min(1.0, 2.0 * ratio * slowest)


def _contact_interval(
    problem: DynamicProblem, touching: ContactRun, earlier: ContactRun | None, force: float
) -> ContactInterval:
    """Return a contact in SI units.

    Parameters
    ----------
    earlier
        The contact before, if there is one.
    force
        The largest force of the contact, in units of `DynamicProblem.force`.
    """
    before, after = touching.before, touching.after
    lasted, speed = touching.end - touching.start, -before.separation_speed
    if earlier is not None:
        waited = touching.start - earlier.end
        radius, met = earlier.pieces[-1].radius, None
        if problem.middle_plane is not None:
            met = problem.freed(before, radius, waited) if touching.radius else before
        speed = meeting_speed(problem, earlier.after, radius, waited, met)
    return ContactInterval(
        problem.T * touching.start,
        problem.T * touching.end,
        problem.m * problem.v0 * (before.velocity - after.velocity + problem.weight * lasted),
        problem.force * force,
        speed,
    )


def _elements(touching: ContactRun) -> list[Element]:
    """Return the polynomials of the time elements of a contact."""
    return [piece.element for piece in touching.pieces]
