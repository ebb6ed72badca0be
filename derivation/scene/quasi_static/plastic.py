"""Impact with plastic deformation on a quasi-static plate.

The time elements of `contact_sequence` are used with a plate without modes: all deflection is in
the contact law.
"""

from dataclasses import dataclass, replace

import numpy as np

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.yielding import units_of, yielding_of
from derivation.scene.dynamic import contact_sequence
from derivation.scene.dynamic.contact_sequence import ContactRun
from derivation.scene.dynamic.contact_tables import contact_of
from derivation.scene.dynamic.history_at import rows_of
from derivation.scene.dynamic.modal import ModalPlate, Modes
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.dynamic.time_element import A, P, V, Z
from derivation.scene.effects.inertia import WIDER
from derivation.scene.numerics.collocation import largest_of
from derivation.scene.quasi_static.motion import EnergyBalance, Motion
from generated.arrays import Double as Array

STAGES = 14, 16
"""Nodes of a time element, in the run for the error estimate and in the final run."""
ROUNDING = 2e-12
"""Tested bound on the rounding errors of the results [1]."""


@dataclass(frozen=True)
class PlasticMotion(Motion):
    """An impact with plastic deformation, with its time elements."""

    problem: DynamicProblem | None = None
    touching: ContactRun | None = None

    def history(self, law: ContactLaw, times: Array) -> tuple[Array, Array, Array, Array]:  # noqa: ARG002
        """Return indentation [m], velocity [m/s], contact radius [m] and force [N] at times [s]."""
        problem, touching = self.problem, self.touching
        assert problem is not None
        assert touching is not None
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
    problem = _problem(law)
    rough, fine = (_motion(problem, n) for n in STAGES)
    pairs = zip(fine.numbers, rough.numbers, strict=True)
    change = max(abs(new / old - 1.0) for new, old in pairs)
    # Both runs have the same tolerance, and may differ by less than their errors; therefore the
    # error of the speed from the energy balance is also used.
    return replace(fine, quadrature=change + _speed_error(fine))


def _speed_error(motion: PlasticMotion) -> float:
    """Return twice the relative error of the final speed by the energy balance [1]."""
    balance = motion.energy_balance
    if balance is None or not balance.initial_kinetic * balance.rebound_kinetic > 0.0:
        return 0.0  # energies below the smallest double
    return abs(balance.residual) * (balance.initial_kinetic / balance.rebound_kinetic)


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


def _motion(problem: DynamicProblem, n: int) -> PlasticMotion:
    """Return the impact by time elements with n nodes."""
    touching = contact_sequence.contact(problem, n, problem.begin(), 0.0, 0.0)
    after, branch = touching.after, touching.yielding
    assert branch is not None
    elements = [piece.element for piece in touching.pieces]
    depth, force, radius = (largest_of(elements, row) for row in (Z, P, A))
    energy = problem.m * problem.v0 * problem.v0
    balance = EnergyBalance(
        initial_kinetic=0.5 * energy,
        gravity_work=energy * problem.weight * after.displacement,
        rebound_kinetic=0.5 * energy * after.velocity**2,
        viscous_loss=0.0,
        unrecovered_elastic=0.0,
        plastic_loss=branch.work,
    )
    return PlasticMotion(
        problem.T * touching.end,
        problem.depth * depth,
        problem.force * force,
        problem.a * radius / branch.flattening,
        0.0,
        -after.velocity,
        balance,
        problem,
        touching,
        dent=branch.dent,
    )
