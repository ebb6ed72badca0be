"""The least stretching energy at a deflection on the axis, and the bound on later deflections."""

import math
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.optimize import minimize

from derivation.scene import explain, read
from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.dynamic.stretched_flight import SOFTER, reach
from derivation.scene.dynamic.wave_problem import problem_of
from generated import stretching_kernels
from tests.scene.large_rotations import Array

pytestmark = pytest.mark.one_version
POINTS, TURNS = 1500, 60
EDGES = "clamped", "simply-supported", "paper"
RATIOS = (-0.99, -0.9, -0.5, 0.0, 0.3, 0.49)


def edge_of(edge: str, nu: float) -> tuple[str, float, float]:
    """Return name, kappa and g of an edge, see step 33."""
    return {
        "clamped": ("clamped", (1.0 + nu) / (1.0 - nu), 0.0),
        "simply-supported": ("supported", -1.0, 1.0 / (1.0 + nu)),
        "paper": ("paper", 0.0, 0.5),
    }[edge]


class Least(NamedTuple):
    """The least integral of N_r w'^2 r for a deflection of 1 on the axis: bounds from both sides.

    N_r is that of step 33 without its factor E H/4, on a plate of radius 1.
    """

    lower: float
    upper: float


@cache
def rule() -> tuple[Array, Array]:
    """Return Gauss' rule."""
    return np.polynomial.legendre.leggauss(POINTS)


def least(kappa: float) -> Least:
    """Return the least energy of stretching, with the bound from below by duality.

    In h = w'^2 the integral is Q(h) = <h, K h> with K >= 0, and the deflection at most the integral
    of sqrt(h), which is concave. Q(h) >= 2 <K g, h> - Q(g) for any g, and by Cauchy and Schwarz
    <K g, h> >= 1/I with I the integral of 1/(r K g). Of all multiples of g the best one gives
    Q(h) >= 1/(I^2 Q(g)). In the softest shape r K h sqrt(h) is constant.
    """
    nodes, weights = rule()
    inside, outside = ((1.0 + nodes) / 2.0) ** 6, ((1.0 - nodes) / 2.0) ** 6
    r = inside / (inside + outside)  # dense at the axis and at the edge, where the slope is large
    dr = weights * 3.0 * ((1.0 - nodes**2) / 4.0) ** 5 / (inside + outside) ** 2
    slope = r ** (-1.0 / 3.0)
    for _ in range(TURNS):
        slope = slope / (slope @ dr)
        enclosed = _up_to(slope**2 * r * dr)
        beyond = _up_to((2.0 * enclosed / r**3 * dr)[::-1])[::-1]
        tension = (1.0 + kappa) * float(slope**2 * r @ dr) + beyond
        total = float(dr @ (1.0 / (tension * r)))
        energy = float(tension * slope**2 * r @ dr)
        balanced = 1.0 / (tension * r * total)
        slope = np.cbrt(slope**2 * balanced)
    return Least(1.0 / (total**2 * energy), energy)


def _up_to(parts: Array) -> Array:
    """Return sums of all parts before each one, with half of this one."""
    return np.cumsum(parts) - parts / 2.0


def test_least_energy_is_that_of_a_membrane_under_a_point_force() -> None:
    """Schwerin (1929): w = 1 - r^(2/3) on a membrane with a clamped edge and nu = 1/3."""
    assert least(2.0) == pytest.approx((2.0 / 3.0, 2.0 / 3.0), rel=1e-4)


@pytest.mark.parametrize("nu", RATIOS)
@pytest.mark.parametrize("edge", EDGES)
def test_no_shape_has_less_energy_than_the_bound(edge: str, nu: float) -> None:
    """The static deflection has the energy of the proved stiffening A."""
    name, kappa, g = edge_of(edge, nu)
    lower, upper = least(kappa)
    assert lower == pytest.approx(upper, rel=1e-6)  # the bound is attained
    stiffening = float(getattr(stretching_kernels, f"stiffening_{name}")(np.array(nu)))
    ratio = 0.375 * (1.0 + 2.0 * g) * (1.0 - nu**2) * lower / stiffening
    expected = {"clamped": 0.483, "simply-supported": 0.304, "paper": 0.56}[edge]
    assert expected - 1e-3 < ratio < 1.1 * expected
    assert ratio > SOFTER


@cache
def problem(edge: str, nu: float) -> tuple[DynamicProblem, float]:
    """Return a problem with 120 shapes, of which 48 stretch the plate, and the thickness in it."""
    scene: dict[str, Any] = {
        "sphere": {"radius": 0.0104, "material": "steel"},
        "plate": {"radius": 0.0365, "thickness": 4e-4, "edge": edge, "youngs_modulus": 7e10,
                  "poissons_ratio": nu, "density": 2500.0},
        "impact": {"speed": 2.5},
        "effects": {"inertia": True, "stretching": True},
    }  # fmt: skip
    law = explain(read(scene)).effects.law
    made = problem_of(law, 120)
    return made, 2.0 * law.model.h / made.depth


@pytest.mark.parametrize("thicknesses", [0.1, 1.0, 10.0, 100.0, 1000.0])
@pytest.mark.parametrize("nu", [-0.9, 0.3])
@pytest.mark.parametrize("edge", EDGES)
def test_no_state_deflects_further_than_its_energy_allows(
    edge: str, nu: float, thicknesses: float
) -> None:
    """The state has the least energy of all with this deflection, also in shapes without tension.

    An earlier version did not count these shapes: with 1000 thicknesses its bound was too small.
    """
    made, thickness = problem(edge, nu)
    plane, modes = made.middle_plane, made.contact.modes
    assert plane is not None
    static = modes.by_shape(made.inverse_modal_mass / made.omega**2)
    deflection, unit = thicknesses * thickness, np.sqrt(static)

    def energy(z: Array) -> tuple[float, Array]:
        """Return the logarithm of the energy and its slopes; z^2/2 is the energy of bending."""
        part = unit * z
        factor = deflection / np.sum(part)
        q = factor * part
        total = 0.5 * float(np.sum(q**2 / static)) + float(plane.energy(q))
        by_q = q / static - plane.forces(q)
        slopes = unit * factor * (by_q - by_q @ part / np.sum(part))
        return math.log(total), slopes / total

    z = unit / np.linalg.norm(unit)
    for _ in range(3):
        z = minimize(energy, z, jac=True, method="L-BFGS-B", options={"maxiter": 3000}).x
        z = z / np.linalg.norm(z)
    shapes = deflection * unit * z / np.sum(unit * z)
    q = np.zeros(made.omega.size)
    q[modes.first] = shapes
    furthest = reach(made, ImpactState(0.0, 0.0, q, 0.0 * q, 0.0))
    assert deflection <= furthest < 1.6 * deflection
