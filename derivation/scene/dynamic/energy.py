"""Energy balance of an impact on a plate with inertia, each part by integration."""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from derivation.scene.dynamic.contact_sequence import ContactRun, ImpactHistory
from derivation.scene.dynamic.flight_history import energy_lost
from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.dynamic.time_element import DAMPED, LEAK, LOST, integral
from derivation.scene.numerics.collocation import ONSET
from derivation.scene.numerics.quadrature import NODES, gauss
from derivation.scene.quasi_static.motion import EnergyBalance


def balance_of(history: ImpactHistory) -> EnergyBalance:
    """Return the energy balance up to the last separation [J]."""
    problem, last = history.problem, history.contacts[-1].after
    energy = problem.m * problem.v0**2
    pieces = [piece for touching in history.contacts for piece in touching.pieces]
    lost = sum(integral(piece, LOST) for piece in pieces) if problem.retardation_time else 0.0
    spurious = sum(integral(piece, LEAK) for piece in pieces) if problem.contact.pointwise else 0.0
    return EnergyBalance(
        initial_kinetic=0.5 * energy,
        gravity_work=energy * problem.weight * last.displacement,
        rebound_kinetic=0.5 * energy * last.velocity**2,
        viscous_loss=energy * lost,
        unrecovered_elastic=energy
        * (sum(_unrecovered(problem, one) for one in history.contacts) + _lagging(history)),
        plate=energy * _mode_energy(problem, last),
        coupling_loss=energy * spurious,
        damping_loss=energy * _damping_loss(history),
        plastic_loss=problem.yielding.work if problem.yielding else 0.0,
    )


def _damping_loss(history: ImpactHistory) -> float:
    """Return the energy over m v0^2 dissipated by damping, up to the last separation.

    During contact the power is integrated; between contacts, and after the last time element of a
    contact, the modes vibrate freely.
    """
    problem, loss = history.problem, 0.0
    if not problem.damping_ratio:
        return 0.0
    ends = [touching.start for touching in history.contacts[1:]]
    for touching, until in zip(history.contacts, [*ends, history.contacts[-1].end], strict=True):
        last, first = touching.pieces[-1], touching.pieces[0].element
        followed = (last.element.x + last.element.length) ** ONSET - first.x**ONSET
        loss += sum(integral(piece, DAMPED) for piece in touching.pieces)
        loss += problem.flight_loss(last.end, touching.end - touching.start - followed)
        if not touching.flight:
            loss += problem.flight_loss(touching.after, until - touching.end)
        elif until > touching.end:  # not after the last separation
            loss += energy_lost(problem, touching.flight)
    return loss


def _unrecovered(problem: DynamicProblem, touching: ContactRun) -> float:
    """Return the energy over m v0^2 stored in a viscoelastic contact at its end, minus start."""
    if not problem.retardation_time:
        return 0.0
    begun = 0.0
    if touching.radius:
        before = replace(problem, yielding=touching.pieces[0].yielding)
        begun = _stored(before, touching.radius, touching.before)
    after = replace(problem, yielding=touching.yielding)
    last = touching.pieces[-1]
    return _stored(after, last.radius, last.end) - begun


def _lagging(history: ImpactHistory) -> float:
    """Return the energy over m v0^2 of the deflections that recover with a viscoelastic face."""
    problem, energy = history.problem, 0.0
    if not problem.retardation_time:
        return energy
    for one in history.contacts:
        energy += _mode_energy(problem, one.pieces[-1].end) - _mode_energy(problem, one.after)
    for one, two in pairwise(history.contacts):
        wait = two.start - one.end
        if two.radius:
            met = problem.freed(two.before, one.pieces[-1].radius, wait)
            energy -= _mode_energy(problem, two.before) - _mode_energy(problem, met)
    return energy


def _mode_energy(problem: DynamicProblem, state: ImpactState) -> float:
    """Return the energy of all modes over m v0^2, with that of stretching."""
    energy = float(np.sum(problem.energies(state)))
    if problem.middle_plane is not None:
        energy += float(problem.middle_plane.energy(problem.contact.modes.by_shape(state.q)))
    return energy


def _stored(problem: DynamicProblem, radius: float, state: ImpactState) -> float:
    """Return the energy over m v0^2 stored in a contact: int P dD + sum q_j (P s_j - P_j)."""
    nodes, weights = gauss(NODES[1])
    at = problem.at(problem.a * radius * nodes)
    rest = problem.a * radius * float(weights @ (at.force * at.depth_a))
    end = problem.contact.at(problem.a * np.array([radius]))
    q = problem.contact.modes.by_shape(state.q)
    more = float((end.force * (1.0 + end.weights_less_one[0]) - end.modal_forces[0]) @ q)
    return rest / (problem.force * problem.depth) + more / problem.force
