"""Test the plate curvature under the contact due to a simply supported or clamped edge."""

import itertools
import math

import numpy as np
import platecontact as pc
import pytest
from mpmath import mp

from derivation.plate.edge.oracle import clamped as clamp_balls
from derivation.plate.edge.oracle import supported as support_balls
from derivation.plate.edge.remainder import MESHES, RADIUS, Field, RemainderCase
from derivation.plate.edge.route import clamped as clamp_route
from derivation.plate.edge.route import supported as support_route
from derivation.scene.contact_law.edge_curvature import LINEAR, SQUARE, edge_curvature_errors
from derivation.scene.indentation import StaticContact, static_law
from generated import non_hertzian_pressure as solver
from generated.contact_law import force_of_radius
from generated.edge_curvature import clamped_edge_curvature, supported_edge_curvature

CURVATURES = {"clamped": clamped_edge_curvature, "supported": supported_edge_curvature}
SIZES = (0.02, 0.05, 0.13, 0.4, 1.0, 5.0)
POISSON = (-0.5, 0.0, 0.25, 0.375)


def lame(nu: float) -> float:
    """Return the first Lame constant for a second one of 1."""
    return 2.0 * nu / (1.0 - 2.0 * nu)


@pytest.mark.parametrize(("h", "nu"), list(itertools.product(SIZES, POISSON)))
def test_simple_support_equals_both_references(h: float, nu: float) -> None:
    ball = support_balls.curvature(h, 1.0, lame(nu), 1.0, 20)
    assert float(support_route.curvature(h, 1.0, nu, 18)) == pytest.approx(float(ball), rel=1e-15)
    got = float(supported_edge_curvature(h, 1.0, lame(nu), 1.0))
    assert got == pytest.approx(float(ball), rel=4e-15, abs=1e-16)


@pytest.mark.parametrize(("h", "nu"), list(itertools.product(SIZES, POISSON)))
def test_clamp_agrees_with_a_coefficient_of_the_slope(h: float, nu: float) -> None:
    """The second reference integrates the pressure; this factor multiplies alpha^2 in S/alpha."""
    ball = clamp_balls.curvature(h, 1.0, lame(nu), 1.0, 20)
    widths = [0.25, 0.5]
    with mp.workdps(40):
        low, high = (clamp_route.clamp_part("slope", a, h, 1.0, nu, 30) / a for a in widths)
        second = (high - low) / (widths[1] ** 2 - widths[0] ** 2)
        assert float(-3 * mp.mpf(h) ** 3 * second) == pytest.approx(float(ball), rel=1e-12)
    got = float(clamped_edge_curvature(h, 1.0, lame(nu), 1.0))
    assert got == pytest.approx(float(ball), rel=4e-15, abs=1e-16)


@pytest.mark.parametrize("support", CURVATURES)
@pytest.mark.parametrize("h", [0.05, 0.2, 0.3, 0.5])
@pytest.mark.parametrize("nu", [-0.4, 0.0, 0.3, 0.45])
def test_finite_elements_have_the_same_curvature(support: str, h: float, nu: float) -> None:
    """A polynomial is fitted to the displacement that the edge adds in 3-D finite elements."""
    case, a = RemainderCase(support, h, nu), 0.01
    r, added = Field(case, MESHES[1]).face(a)
    near = r <= 0.4
    powers = np.vander(r[near] ** 2, 4, increasing=True)
    curvature = 2.0 * np.linalg.lstsq(powers, added[near])[0][1]
    modulus = 2.0 / (1.0 - nu)
    expected = 2.0 * modulus * h**3 * curvature / float(force_of_radius(a, RADIUS, case.lam, 1.0))
    assert float(CURVATURES[support](h, 1.0, case.lam, 1.0)) == pytest.approx(
        expected, rel=max(LINEAR * h, SQUARE * h * h)
    )


@pytest.mark.parametrize("h", [0.01, 0.3])
@pytest.mark.parametrize("edge", [0.1, -0.06])
@pytest.mark.parametrize("part", [1.0, 0.4])
def test_edge_acts_like_a_change_of_sphere_curvature(h: float, edge: float, part: float) -> None:
    """At one contact radius, the contact is that of a sphere of curvature 1/R + kappa P.

    kappa is the curvature due to a bending moment at the edge. A load at the distance r from the
    axis has the factor 1 - r^2/b^2; the mean of r^2 is twice that of t^2, weighted with chi.
    """
    R = 5.0
    a = np.linspace(0.2, 1.0, 801) * min(2.0 * h, 0.5)
    plain, with_edge = (
        solver.contact(solver.plate(h, 1.0, x), a, R, part, 1.0) for x in (0.0, edge)
    )
    weights = np.polynomial.legendre.leggauss(48)[1][24:]
    spread = (with_edge.nodes**2 * with_edge.chi) @ weights / (with_edge.chi @ weights)
    kappa = edge / (2.0 * h**3) * (1.0 - 2.0 * spread)
    factor = with_edge.force / plain.force
    np.testing.assert_allclose(1.0 + R * kappa * with_edge.force, factor, rtol=1e-12)
    np.testing.assert_allclose(
        with_edge.centre_pressure, factor * plain.centre_pressure, rtol=1e-11
    )
    pressures = (
        solver.pressure(0.5 * a[400], solver.plate(h, 1.0, x), a[400], R, part, 1.0)
        for x in (0.0, edge)
    )
    before, after = pressures
    assert after / before == pytest.approx(factor[400], rel=1e-11)


def contacts(radius: float, edge: str, nu: float, spherical: bool) -> list[StaticContact]:
    """Return static contacts with radii up to 3/2 of the plate thickness, which is 4 mm."""
    effects = pc.Effects(non_hertzian_pressure=True, spherical_profile=spherical, stretching=False)
    scene = pc.Scene(
        sphere=pc.Sphere(radius=0.3, density=7800),
        plate=pc.Plate(
            radius=radius, thickness=4e-3, youngs_modulus=70e9, poissons_ratio=nu, edge=edge,
            density=2500,
        ),
        impact=pc.Impact(speed=0.1), effects=effects,
    )  # fmt: skip
    return list(pc.indent(scene, contact_radius=[2e-4, 1e-3, 2e-3, 4e-3, 6e-3]))


@pytest.mark.parametrize("spherical", [True, False])
@pytest.mark.parametrize(("nu", "agreement"), [(0.0, 1e-6), (0.3, 5e-6)])
@pytest.mark.parametrize("edge", ["clamped", "simply-supported"])
def test_edge_acts_like_the_edge_of_the_paper_at_another_radius(
    edge: str, nu: float, agreement: float, spherical: bool
) -> None:
    """A thin plate under a point load deflects by P r^2 log(r/c)/(8 pi D) plus a constant.

    The paper's edge has c = e b, a clamped edge c = sqrt(e) b. The contact depends on c, not on the
    edge, and the indentations differ by a constant compliance, up to terms of the order (a/b)^2.
    """
    b = 2.0
    part = -1.0 if edge == "clamped" else (1.0 - nu) / (1.0 + nu)
    one = contacts(b, edge, nu, spherical)
    other = contacts(b * math.exp(0.5 * part), "paper", nu, spherical)
    forces, pressures, compliances = (
        np.array(x)
        for x in (
            [x.force / y.force - 1.0 for x, y in zip(one, other, strict=True)],
            [x.max_pressure / y.max_pressure - 1.0 for x, y in zip(one, other, strict=True)],
            [
                (x.indentation - y.indentation * x.force / y.force) / x.force
                for x, y in zip(one, other, strict=True)
            ],
        )
    )
    assert np.abs(forces).max() < agreement
    assert np.abs(pressures).max() < agreement
    assert np.ptp(compliances) < agreement * abs(compliances[0])


@pytest.mark.parametrize("edge", ["clamped", "simply-supported"])
@pytest.mark.parametrize("thickness", [0.02, 0.06])
def test_model_error_includes_the_error_of_the_curvature(edge: str, thickness: float) -> None:
    """The error covers the difference from finite elements, for a contact radius of b/4."""
    b, R, nu, modulus = 0.1, 1e3, 0.3, 7e10
    case = RemainderCase({"clamped": "clamped"}.get(edge, "supported"), 0.5 * thickness / b, nu)
    r, added = Field(case, MESHES[1]).face(0.01)
    near = r <= 0.4
    powers = np.vander(r[near] ** 2, 4, increasing=True)
    curvature = 2.0 * np.linalg.lstsq(powers, added[near])[0][1]
    force = float(force_of_radius(0.01, RADIUS, case.lam, 1.0))
    exact = 4.0 / (1.0 - nu) * case.h**3 * curvature / force
    scene = pc.Scene(
        sphere=pc.Sphere(radius=R, mass=1.0),
        plate=pc.Plate(
            radius=b, thickness=thickness, youngs_modulus=modulus, poissons_ratio=nu, edge=edge,
            density=2500,
        ),
        impact=pc.Impact(speed=1e-3),
        effects=pc.Effects(inertia=False, non_hertzian_pressure=True, spherical_profile=False),
    )  # fmt: skip
    law = static_law(scene)
    a = np.array([0.25 * b])
    stated, reference = (
        solver.contact(solver.plate(0.5 * thickness, b, x), a, R, law.modulus, law.model.modulus)
        for x in (law.edge_curvature, exact)
    )
    change = abs(float(stated.force[0] / reference.force[0]) - 1.0) / 3.0
    errors = edge_curvature_errors(law, float(a[0]))
    assert 0.0 < change <= errors.results <= errors.pressure
    result = pc.simulate(scene)
    at = edge_curvature_errors(result.effects.law, result.max_contact_radius)
    assert result.model_errors["max_contact_radius"] >= at.pressure > 0.0
