"""Finite-element impacts: statics, frequencies, conservation laws, convergence, causality."""

import itertools
import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from derivation.checks.finite_elements.cases import HERTZ, ElementCase
from derivation.checks.finite_elements.impact import (
    Sphere,
    Stepper,
    WideContactError,
    contact_forces,
    results,
    simulate_impact,
    static_contact,
)
from derivation.checks.finite_elements.mesh import Grading, contactless_mesh, graded_mesh
from derivation.checks.finite_elements.plate import EDGES, Plate, System
from derivation.scene import kernels
from generated.bessel import bessel_j0_zeros
from generated.contact_law import force
from generated.inertia import bending_frequency

PLATE = Plate(0.1, 0.02, 70e9, 0.3, 2700.0)
COARSE = Grading(contact=5, thickness=1.0, far=2.0, edge=0)
FINE = Grading(contact=10)
SMALL = ElementCase("small", "small", PLATE, Sphere(0.01, 0.002, 5.0))
"""A light sphere, whose contact ends before waves return from the edge."""


def system(case: ElementCase, grading: Grading = COARSE, reach: float = 1.1) -> System:
    mesh = graded_mesh(case.plate.radius, case.plate.thickness, reach * case.radius, grading)
    return System(case.plate, mesh)


@pytest.mark.parametrize("edge", EDGES)
def test_static_force_on_a_thick_block_is_that_of_hertz(edge: str) -> None:
    """The static force on a block of thickness 2000 a (contact radius a) is Hertz's."""
    block, a, R = Plate(1.0, 1.0, 70e9, 0.3, 2700.0, edge), 5e-4, 0.01
    mesh = graded_mesh(1.0, 1.0, 1.25 * a, Grading(contact=12))
    _, forces = static_contact(System(block, mesh), Sphere(R, 1.0, 1.0), a * a / R)
    assert forces.sum() == pytest.approx(4.0 / 3.0 * block.modulus * a**3 / R, rel=1.5e-3)


@pytest.mark.parametrize(("ratio", "nu"), [(0.02, 0.3), (0.2, 0.0), (0.3, 0.45)])
def test_static_force_with_the_edge_of_the_paper_agrees_with_the_law(
    ratio: float, nu: float
) -> None:
    plate = Plate(0.02 / ratio, 0.02, 70e9, nu, 2700.0)
    a, R = 1e-3, 0.02
    mesh = graded_mesh(plate.radius, 0.02, 1.25 * a, Grading(contact=12, far=2.0))
    law = force(1.05 * a * a / R, R, 0.01, plate.radius, plate.lam, plate.mu)
    _, forces = static_contact(System(plate, mesh), Sphere(R, 1.0, 1.0), 1.05 * a * a / R)
    assert forces.sum() == pytest.approx(float(law), rel=5e-4)


@pytest.mark.parametrize(
    ("edge", "stress"),
    [
        ("paper", kernels.back_face_stress),
        ("simply-supported", kernels.supported_back_face_stress),
        ("clamped", kernels.clamped_back_face_stress),
    ],
)
def test_static_stress_on_the_back_face_agrees_with_the_closed_form(
    edge: str, stress: Callable[..., float]
) -> None:
    """They agree up to the error of Hertz's pressure on a plate."""
    plate, a, R = Plate(0.2, 0.01, 70e9, 0.3, 2700.0, edge), 5e-4, 0.02
    mesh = graded_mesh(plate.radius, plate.thickness, 1.5 * a, Grading(contact=12, far=2.0))
    made = System(plate, mesh)
    _, forces = static_contact(made, Sphere(R, 1.0, 1.0), 1.2 * a * a / R)
    load = np.zeros(made.free.size)
    load[made.contact_nodes] = -forces
    found = made.back_face_stress(made.static_solver.solve(load))
    force, radius = float(forces.sum()), math.cbrt(0.75 * float(forces.sum()) / plate.modulus * R)
    expected = stress(force, radius, 0.005, plate.radius, plate.lam, plate.mu)
    assert found == pytest.approx(float(expected), rel=2e-3)


def test_static_contact_converges() -> None:
    """Four times as many nodes reduce the error of the static force by more than a factor of 5."""
    a, R = 1e-3, 0.02
    depths = a * a / R * np.linspace(0.5, 1.0, 5)
    law = force(depths, R, 0.01, PLATE.radius, PLATE.lam, PLATE.mu)
    errors = []
    for count in (4, 16):
        plate = System(PLATE, graded_mesh(PLATE.radius, 0.02, 1.25 * a, Grading(contact=count)))
        sums = [static_contact(plate, Sphere(R, 1.0, 1.0), depth)[1].sum() for depth in depths]
        errors.append(np.abs(sums / law - 1.0).mean())
    assert errors[1] < errors[0] / 5.0


@pytest.mark.parametrize(("ratio", "nu"), [(0.02, 0.3), (0.3, 0.0), (0.3, 0.45)])
def test_frequencies_for_the_edge_of_the_paper_are_exact(ratio: float, nu: float) -> None:
    """Natural frequencies are the exact ones, because J0(phi_j r) satisfies this edge condition."""
    plate = Plate(1.0, ratio, 1.0, nu, 1.0)
    frequencies = System(plate, contactless_mesh(1.0, ratio, 1, 6)).bending_frequencies(4)
    exact = bending_frequency(bessel_j0_zeros(4) * ratio / 2, nu) * plate.shear_wave_speed
    np.testing.assert_allclose(frequencies * ratio / 2, exact, rtol=2e-6)


def test_frequencies_of_a_thin_clamped_plate_agree_with_plate_theory() -> None:
    """Frequencies are just below those of a thin plate, lambda^2 sqrt(D/(rho H))/b^2."""
    ratio, nu = 0.01, 0.3
    frequencies = System(
        Plate(1.0, ratio, 1.0, nu, 1.0, "clamped"), contactless_mesh(1.0, ratio, 2, 4)
    ).bending_frequencies(2)
    thin = np.array([10.21583, 39.77115]) * ratio / math.sqrt(12.0 * (1.0 - nu**2))
    assert (frequencies < thin).all()
    np.testing.assert_allclose(frequencies, thin, rtol=5e-3)


def test_contact_time_agrees_with_hertz() -> None:
    """Hertz's contact time is 2.943 times the largest indentation divided by the speed."""
    x = np.sin(np.linspace(0.0, math.pi / 2, 200001)) ** 0.8
    speed = np.sqrt(1.0 - np.minimum(x, 1.0 - 1e-16) ** 2.5)
    assert 2.0 * np.trapezoid(1.0 / speed[:-1], x[:-1]) == pytest.approx(HERTZ, rel=1e-3)


def test_contact_set_is_the_only_admissible_one() -> None:
    """The solution is the only admissible one among all sets of touching nodes."""
    generator = np.random.default_rng(1)
    for _ in range(20):
        roots = generator.normal(size=(5, 5))
        compliance, gap = roots @ roots.T + 0.5 * np.eye(5), generator.normal(size=5)
        forces, active = contact_forces(compliance, gap, np.zeros(5, dtype=bool))
        solutions = []
        for chosen in itertools.product([False, True], repeat=5):
            indices = np.flatnonzero(chosen)
            trial = np.zeros(5)
            trial[indices] = np.linalg.solve(compliance[np.ix_(indices, indices)], -gap[indices])
            if (trial >= 0.0).all() and (compliance @ trial + gap > -1e-10).all():
                solutions.append(trial)
        assert len(solutions) == 1
        np.testing.assert_allclose(forces, solutions[0], atol=1e-10)
        assert (active == (forces > 0.0)).all()


def test_energy_and_momentum_are_conserved() -> None:
    """Shorter steps reduce the energy error; the impulse is the sphere's change of momentum."""
    plate, losses = system(SMALL), []
    for steps in (100, 200):
        history = simulate_impact(plate, SMALL.sphere, SMALL.time / steps, 100.0 * SMALL.time)
        losses.append(abs(history.energy - 1.0))
        impulse = np.trapezoid(history.force, history.time)
        brought = SMALL.sphere.mass * (SMALL.sphere.speed - history.speed[-1])
        assert impulse == pytest.approx(brought, rel=1e-3)
    assert losses[1] < losses[0] / 2.0
    assert losses[1] < 3e-4


def test_momentum_before_the_edge_is_reached() -> None:
    """The momentum of sphere and plate is constant until waves reach the support."""
    case = SMALL
    plate = system(case)
    step = case.time / 100
    stepper = Stepper(plate, case.sphere, step)
    even = np.zeros(plate.free.size)
    even[plate.free % 2 == 1] = 1.0
    brought = case.sphere.mass * case.sphere.speed
    for _ in range(int(0.6 * case.edge_echo / 2.0 / step)):
        stepper.advance()
    plates = -even @ (plate.mass @ stepper.state.v[:-1])
    balls = case.sphere.mass * stepper.state.v[-1]
    assert plates > 0.1 * brought
    assert plates + balls == pytest.approx(brought, rel=1e-4)


def test_edge_beyond_the_reach_of_waves_has_no_influence() -> None:
    actual = []
    for edge in EDGES:
        case = replace(SMALL, plate=replace(PLATE, radius=0.2, edge=edge))
        plate = system(case)
        history = simulate_impact(
            plate, case.sphere, case.time / 100, 9.0 * case.time, until_end=False
        )
        impact = results(history, plate)
        assert impact.contact_time < case.edge_echo
        actual.append((impact.contact_time, impact.max_force, impact.restitution))
    np.testing.assert_allclose(actual[1:], actual[:1] * 2, rtol=1e-7)


def test_results_converge_with_mesh_and_steps() -> None:
    actual = []
    for grading, steps in ((FINE, 300), (COARSE, 300), (FINE, 100)):
        plate = system(SMALL, grading)
        history = simulate_impact(
            plate, SMALL.sphere, SMALL.time / steps, 9.0 * SMALL.time, until_end=False
        )
        impact = results(history, plate)
        actual.append((impact.max_indentation, impact.max_force, impact.contact_time))
    best, coarse, long = np.array(actual)
    assert np.abs(coarse / best - 1.0).max() < 3e-3
    assert np.abs(long / best - 1.0).max() < 2e-3


def test_several_contacts_conserve_energy() -> None:
    """Several contacts conserve energy; between contacts the time step is longer."""
    plate = Plate(0.03, 0.001, 70e9, 0.3, 2700.0, "clamped")
    case = ElementCase("thin", "thin", plate, Sphere(0.01, 0.001, 1.0))
    made = system(case, Grading(contact=4, thickness=1.0, far=3.0, edge=0))
    history = simulate_impact(made, case.sphere, case.time / 100, 300.0 * case.time)
    impact = results(history, made)
    assert impact.contacts > 1
    assert impact.contact_time < impact.total_time
    assert np.ptp(np.diff(history.time)) > 0.0
    assert impact.energy == pytest.approx(1.0, abs=1.5e-2)


def test_contact_wider_than_the_fine_mesh_is_rejected() -> None:
    with pytest.raises(
        WideContactError, match="contact: expected it within the fine mesh, got a wider one"
    ):
        simulate_impact(system(SMALL, reach=0.5), SMALL.sphere, SMALL.time / 100, SMALL.time)


def test_heights_of_the_profiles_of_paraboloid_and_sphere() -> None:
    r = np.array([0.0, 0.006])
    np.testing.assert_allclose(Sphere(0.01, 1.0, 1.0).profile(r), [0.0, 0.0018])
    np.testing.assert_allclose(Sphere(0.01, 1.0, 1.0, exact=True).profile(r), [0.0, 0.002])


def test_unknown_edge_is_rejected() -> None:
    with pytest.raises(ValueError, match="edge: expected one of paper"):
        Plate(1.0, 0.1, 1.0, 0.3, 1.0, "free")
