"""Impact with plastic deformation on a quasi-static plate.

The results follow from quadratures. With weight, and for the history, the time elements of
`contact_sequence` are used, with a plate without modes: all deflection is in the contact law.
"""

from dataclasses import dataclass, replace

import numpy as np

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.yielding import Yielding, units_of, yielding_of
from derivation.scene.dynamic import contact_sequence
from derivation.scene.dynamic.contact_sequence import ContactRun
from derivation.scene.dynamic.contact_tables import contact_of
from derivation.scene.dynamic.history_at import rows_of
from derivation.scene.dynamic.modal import ModalPlate, Modes
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.dynamic.time_element import A, P, V, Z
from derivation.scene.effects.inertia import WIDER
from derivation.scene.errors import SceneError
from derivation.scene.numerics.collocation import largest_of
from derivation.scene.quasi_static import motion
from derivation.scene.quasi_static.motion import EnergyBalance, Motion
from derivation.scene.quasi_static.yield_phases import (
    ENOUGH,
    impacts,
    onset_in,
    without_plasticity,
)
from generated.arrays import Double as Array

STAGES = 14, 16
"""Nodes of a time element, in the run for the error estimate and in the final run."""
ROUNDING = 2e-12
"""Tested bound on the rounding errors of time elements [1]."""


@dataclass(frozen=True)
class PlasticMotion(Motion):
    """An impact with plastic deformation."""

    def history(self, law: ContactLaw, times: Array) -> tuple[Array, Array, Array, Array]:
        """Return indentation [m], velocity [m/s], contact radius [m] and force [N] at times [s]."""
        problem = _problem(law)
        touching = _contact(problem, STAGES[-1])
        inside = np.minimum(times / problem.T, touching.end)
        rows = rows_of(problem, touching, inside)
        depth, velocity = problem.depth * rows[Z], problem.v0 * rows[V]
        return depth, velocity, problem.a * rows[A], problem.force * rows[P]


def impact(law: ContactLaw) -> PlasticMotion:
    """Return the impact by a law with plasticity.

    Raises
    ------
    SceneError
        If the impact exceeds the range of the law, or the sphere does not rebound.
    """
    found = None if law.gravity else _by_quadrature(law)
    return found or by_time_elements(law)


def _by_quadrature(law: ContactLaw) -> PlasticMotion | None:
    """Return the impact without weight; None if it is outside the range of the method."""
    (*numbers, ratio), error = impacts(law)
    branch = yielding_of(law)
    assert branch is not None
    if error.item() <= ENOUGH:
        time, depth, force, radius, restitution = (number.item() for number in numbers)
        found = PlasticMotion(time, depth, force, radius, error.item(), restitution)
        return _balanced(found, law, replace(branch, ratio=ratio.item()))
    try:
        elastic = motion.impact(without_plasticity(law))
    except SceneError:
        return None
    if not elastic.max_contact_radius <= onset_in(law).a.item():
        return None
    return _balanced(PlasticMotion(*elastic.numbers[:4], elastic.quadrature), law, branch)


def by_time_elements(law: ContactLaw) -> PlasticMotion:
    """Return the impact by time elements, with weight if the law includes it.

    Both runs have the same tolerance, and may differ by less than their errors; therefore twice the
    error of the speed by the energy balance is added.
    """
    problem = _problem(law)
    rough, fine = (_motion(problem, n, law) for n in STAGES)
    pairs = zip(fine.numbers, rough.numbers, strict=True)
    change = ROUNDING + max(abs(new / old - 1.0) for new, old in pairs)
    balance = fine.energy_balance
    assert balance is not None
    if balance.initial_kinetic * balance.rebound_kinetic > 0.0:  # not below the smallest double
        change += abs(balance.residual) * (balance.initial_kinetic / balance.rebound_kinetic)
    return replace(fine, quadrature=change)


def _balanced(
    found: PlasticMotion, law: ContactLaw, branch: Yielding, fallen: float = 0.0
) -> PlasticMotion:
    """Return a motion with its dent and energies.

    Parameters
    ----------
    branch
        The branch of the contact at its end.
    fallen
        Displacement of the sphere up to separation, if its weight does work on it [m].
    """
    initial = 0.5 * law.model.m * law.model.v0 * law.model.v0
    balance = EnergyBalance(
        initial_kinetic=initial,
        gravity_work=law.model.m * law.gravity * fallen,
        rebound_kinetic=initial * found.restitution**2,
        viscous_loss=0.0,
        unrecovered_elastic=0.0,
        plastic_loss=branch.work,
    )
    return replace(found, energy_balance=balance, dent=branch.dent)


def _problem(law: ContactLaw) -> DynamicProblem:
    """Return the scene in units of an impact on a plate that does not deflect."""
    model, (a, T) = law.model, units_of(law)
    none, no_index = np.zeros(0), np.zeros(0, dtype=np.intp)
    still = Modes(none, none, none, no_index, np.zeros(0, dtype=bool))
    contact = contact_of(law, ModalPlate(still, still, None), min(WIDER * a, law.limit), False)
    weight = law.gravity * (T / model.v0)
    units = a, T, model.m, model.v0
    limit, words, branch = float(law.limit), law.limit_in_words, yielding_of(law)
    return DynamicProblem(contact, *units, weight, yielding=branch, limit=limit, range_end=words)


def _contact(problem: DynamicProblem, n: int) -> ContactRun:
    """Return the contact by time elements with n nodes."""
    return contact_sequence.contact(problem, n, problem.begin(), 0.0, 0.0)


def _motion(problem: DynamicProblem, n: int, law: ContactLaw) -> PlasticMotion:
    """Return the impact by time elements with n nodes."""
    touching = _contact(problem, n)
    after, branch = touching.after, touching.yielding
    assert branch is not None
    elements = [piece.element for piece in touching.pieces]
    depth, force, radius = (largest_of(elements, row) for row in (Z, P, A))
    found = PlasticMotion(
        problem.T * touching.end,
        problem.depth * depth,
        problem.force * force,
        problem.a * radius / branch.flattening,
        0.0,
        -after.velocity,
    )
    return _balanced(found, law, branch, problem.depth * after.displacement)
