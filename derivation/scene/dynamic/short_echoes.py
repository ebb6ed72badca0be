"""Short waves from the onset of a viscoelastic contact that return from the edge of the plate.

The elastic force begins as P_e = K (v t)^(3/2), and gives mode j the velocity

    c_j K v^(3/2) Gamma(5/2) omega_j^(-1/2) sqrt(1 + (f_j A_v omega_j)^2)

with its compliance c_j and its bending fraction f_j. Waves much shorter than the thickness have the
same speed. They return to the axis all at once, and the force of a viscoelastic contact follows
their velocity: it has a sharp peak of A_v dP_e/dz times the sum of s_j q_j'. The sum over the
modes converges as slowly as the inverse square root of their number, while the results seem to have
converged as long as this peak is lower than another maximum. Here the sum over the omitted modes is
a bound on the change of the force. In 17 random impacts, each with two numbers of modes, the
largest change after the first echo was 0.2 to 0.9 of it where it exceeded 4e-4 of the largest
force; smaller changes were mostly those of the elastic force.
"""

import math

import numpy as np

from derivation.scene import scales
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.contact_sequence import ImpactHistory
from derivation.scene.dynamic.modal import bending_fraction, free_modes
from derivation.scene.dynamic.mode_count import branching
from derivation.scene.dynamic.time_element import P
from derivation.scene.dynamic.wave_problem import echo_time
from derivation.scene.numerics.collocation import ONSET, largest_of

ONSET_POWER = math.gamma(2.5)
"""Amplitude of the Fourier transform of t^(3/2), times omega^(5/2)."""
SUMMED = 4
"""Largest number of summed modes over that of the dynamic modes; a bound on the rest of the sum
follows from its last term."""


def echo_errors(
    law: ContactLaw, history: ImpactHistory, a: float, max_force: float, count: int = 0
) -> tuple[float, float]:
    """Return the ripple of the force by short echoes, and the error of the largest force by it [1].

    Parameters
    ----------
    a, max_force
        Largest contact radius [m] and largest force [N].
    count
        Number of bending modes, if more than those of the history are dynamic.
    """
    ripple = largest_echo(law, history, a, count) / max_force
    late = late_force(law, history) / max_force if ripple else 0.0
    return ripple, max(0.0, late + ripple - 1.0)


def largest_echo(law: ContactLaw, history: ImpactHistory, a: float, count: int = 0) -> float:
    """Return a bound on the change of the force by echoes in the omitted modes [N].

    It is 0 if the contact is elastic, or ends before a wave returns from the edge.

    Parameters
    ----------
    a
        Largest contact radius [m].
    count
        As for `echo_errors`.
    """
    problem, model = history.problem, branching(law, "A0").model
    delay = echo_time(model)
    over = problem.T * history.contacts[-1].end <= delay
    if over or not problem.retardation_time or model.inertia.infinite_plate:
        return 0.0
    count = count or problem.contact.modes.phi.size
    modes = free_modes(model, SUMMED * count)
    lag = bending_fraction(model, modes) * model.retardation_time * modes.omega
    speed = model.v0 * max(-one.before.separation_speed for one in history.contacts)
    begun = scales.hertz_constant(model, law.modulus) * speed**1.5
    rates = begun * ONSET_POWER * modes.compliance * np.sqrt((1.0 + lag * lag) / modes.omega)
    rates *= np.exp(-problem.damping_ratio * modes.omega * delay)
    rates *= np.minimum(1.0, 1.0 / (a * modes.phi))
    # The terms decrease as the power -3/2 of their number, or faster.
    total = float(np.sum(rates[count:])) + 2.0 * modes.phi.size * float(rates[-1])
    at = problem.at(np.array([a]))
    return model.retardation_time * float(at.force_a[0] / at.depth_a[0]) * total


def late_force(law: ContactLaw, history: ImpactHistory) -> float:
    """Return the largest force in time elements that end after the first echo [N]."""
    problem, late = history.problem, []
    for one in history.contacts:
        begun = one.start - one.pieces[0].element.x ** ONSET
        for element in (piece.element for piece in one.pieces):
            ended = begun + (element.x + element.length) ** ONSET
            if problem.T * ended > echo_time(law.model):
                late.append(element)
    return problem.force * largest_of(late, P) if late else 0.0
