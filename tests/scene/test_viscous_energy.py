"""Energy of the plate over time in an impact with a viscoelastic contact and plate inertia.

The sphere, the plate, the contact and what is dissipated have the energy of the impact at all
times, also between contacts, while the face and the deflection that lags with it recover.
"""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from derivation.scene import read, simulate
from derivation.scene.dynamic.history_at import deflections
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.dynamic.time_element import A, E, P, V, W
from derivation.scene.result import Result

pytestmark = pytest.mark.one_version

Array = NDArray[np.float64]
GAUSS, WEIGHTS = np.polynomial.legendre.leggauss(12)
TIMES = 1200
"""Number of times in each contact and in each flight."""


@pytest.fixture(scope="module")
def impact() -> Result:
    """Return an impact with two contacts; the second begins before the face has recovered."""
    return simulate(
        read(
            {
                "sphere": {"radius": 0.02, "mass": 0.3},
                "plate": {
                    "radius": 0.1,
                    "thickness": 0.02,
                    "material": "PMMA",
                    "retardation_time": 3e-4,
                },
                "impact": {"speed": 1.0},
                "effects": {"inertia": True},
                "inertia": {"modes": 12},
            }
        )
    )


def spans(result: Result) -> list[tuple[float, float]]:
    """Return start and end of contacts and flights in turn, in units of the problem.

    The last flight lasts until most of the face has recovered.
    """
    assert result.dynamics is not None
    history = result.dynamics.impact_history
    ends = [time for one in history.contacts for time in (one.start, one.end)]
    ends.append(ends[-1] + 5.0 * history.problem.retardation_time)
    return list(pairwise(ends))


def test_plate_is_continuous_where_contacts_begin_and_end(impact: Result) -> None:
    """An earlier version omitted the deflection that recovers with the face from separation on."""
    dynamics: Any = impact.dynamics
    unit = dynamics.impact_history.problem.T
    for _, end in spans(impact)[:-1]:
        before, after = dynamics.rows(unit * end * np.array([1.0 - 1e-11, 1.0 + 1e-11])).T
        assert after[[W, E]] == pytest.approx(before[[W, E]], rel=1e-6)
        profiles = dynamics.profiles(unit * end * np.array([1.0 - 1e-11, 1.0 + 1e-11]), np.zeros(1))
        assert profiles[1] == pytest.approx(profiles[0], rel=1e-6)


def test_energies_add_up_at_all_times(impact: Result) -> None:
    dynamics: Any = impact.dynamics
    history, lost, total = dynamics.impact_history, 0.0, []
    problem = history.problem
    face = 0.0
    for k, (start, end) in enumerate(spans(impact)):
        t = start + (end - start) * np.linspace(0.0, 1.0, TIMES) ** 2
        t[[0, -1]] += 1e-12 * end * np.array([1.0, -1.0])
        rows = dynamics.rows(problem.T * t)
        a, force = rows[A] / problem.a, rows[P] / problem.force
        if k % 2:
            face = history.contacts[k // 2].pieces[-1].radius
            a = recovered(problem, face, t - start)
        q = np.array([deflections(history, float(time)) for time in t])
        at = problem.contact.at(problem.a * a)
        elastic, modal_forces = at.force / problem.force, at.modal_forces / problem.force
        stored = work(problem, a) + np.vecdot(
            elastic[:, None] * (1.0 + at.weights_less_one) - modal_forces, q
        )
        depth = at.depth / problem.depth + np.vecdot(1.0 + at.weights_less_one, q)
        late = force - elastic
        ratio = problem.bending_fraction * modal_forces / np.maximum(elastic, 1e-300)[:, None]
        power = cumulative_trapezoid(late, depth, initial=0.0)
        for j in range(q.shape[1]):
            power -= cumulative_trapezoid(late * ratio[:, j], q[:, j], initial=0.0)
        kinetic = 0.5 * (rows[V] / problem.v0) ** 2
        plate = rows[E] / (problem.m * problem.v0**2)
        total.append(kinetic + plate + stored + lost + power)
        lost += float(power[-1])
    assert lost > 0.02
    assert np.max(np.abs(np.concatenate(total) - 0.5)) < 2e-5


def recovered(problem: DynamicProblem, radius: float, since: Array) -> Array:
    """Return the radius of a face whose elastic force decays as exp(-t/A_v)."""
    grid = radius * np.linspace(0.0, 1.0, 4000)
    force = np.cbrt(problem.contact.at(problem.a * grid).force)
    return np.interp(force[-1] * np.exp(-since / problem.retardation_time / 3.0), force, grid)


def work(problem: DynamicProblem, a: Array) -> Array:
    """Return int P dD up to radii, in units of m v0^2."""
    radii = 0.5 * a[:, None] * (1.0 + GAUSS)
    at = problem.contact.at(problem.a * radii.ravel())
    values = (at.force * at.depth_a).reshape(radii.shape) @ WEIGHTS
    return np.asarray(0.5 * a * values * problem.a / (problem.force * problem.depth))
