"""Static contacts on plates that stretch, against finite elements with finite strains."""

from typing import Any

import pytest

from derivation.checks.finite_elements.plate import Plate
from derivation.scene import indent, read
from derivation.scene.indentation import StaticContact
from tests.scene.finite_strains import Fineness, Pressed, PressedPlate

RADIUS, YOUNG = 0.05, 2.4e9
MESH, MESH_OF_CONTACT = 2e-4, 5e-4
"""Relative errors by the mesh: of force and stiffness, and of contact radius and pressure."""
Scene = tuple[str, float, float, float]
"""Edge, Poisson's ratio, thickness over plate radius, and sphere radius over plate radius."""


def stated(scene: Scene, deflection: float, stretching: bool = True) -> StaticContact:
    """Return the contact of the program at an indentation over the thickness."""
    edge, nu, thickness, R = scene
    plate: dict[str, Any] = {"radius": RADIUS, "thickness": thickness * RADIUS, "edge": edge}
    tables = {
        "sphere": {"radius": R * RADIUS, "mass": 0.01},
        "plate": plate | {"youngs_modulus": YOUNG, "poissons_ratio": nu},
        "impact": {"speed": 0.1},
        "effects": {"stretching": stretching},
    }
    scene_of = read(tables if not stretching else {k: tables[k] for k in tables if k != "effects"})
    [contact] = indent(scene_of, indentation=deflection * thickness * RADIUS)
    return contact


def elements(
    scene: Scene,
    deflections: list[float],
    radius: float,
    fine: Fineness | None = None,
    turns: bool = True,
) -> list[Pressed]:
    """Return the contacts of finite elements at indentations over the thickness."""
    edge, nu, thickness, R = scene
    plate = Plate(RADIUS, thickness * RADIUS, YOUNG, nu, 1000.0, edge)
    pressed = PressedPlate.of(plate, R * RADIUS, radius, fine or Fineness(), turns)
    return pressed.press([x * thickness * RADIUS for x in deflections])


@pytest.mark.one_version
@pytest.mark.parametrize(
    ("scene", "deflection"),
    [
        (("clamped", 0.26, 0.016, 2.8), 0.62),  # less pressure than a Hertzian change of radius
        (("simply-supported", 0.45, 0.014, 12.7), 0.72),  # a contact of 1.7 thicknesses
        (("paper", 0.3, 0.009, 7.2), 1.1),  # narrower by 40 %
        (("clamped", 0.43, 0.064, 2.0), 0.08),  # tension makes the plate thinner
        (("simply-supported", 0.1, 0.012, 0.15), 6.0),  # deep
    ],
)
def test_contacts_are_those_of_finite_strains(scene: Scene, deflection: float) -> None:
    """Force, stiffness, radius and pressure are within the stated errors, which are useful."""
    contact = stated(scene, deflection)
    [expected] = elements(scene, [deflection], contact.contact_radius)
    assert contact.stretched
    assert contact.force_error < 0.06
    assert contact.model_error < 0.12
    assert contact.force == pytest.approx(expected.force, rel=contact.force_error + MESH)
    assert contact.stiffness == pytest.approx(expected.stiffness, rel=contact.force_error + MESH)
    of_contact = contact.model_error + MESH_OF_CONTACT
    assert contact.contact_radius == pytest.approx(expected.radius, rel=of_contact)
    assert contact.max_pressure == pytest.approx(expected.pressure, rel=of_contact)


@pytest.mark.one_version
def test_finite_elements_have_the_linear_law_on_two_meshes() -> None:
    """A plate that does not stretch agrees within the errors by the mesh."""
    scene, deflection = ("paper", 0.3, 0.08, 300.0), 2e-3
    linear = stated(scene, deflection, stretching=False)
    for fine in (Fineness(), Fineness(8, 3, 1.5)):
        [small] = elements(scene, [deflection], linear.contact_radius, fine)
        assert small.force == pytest.approx(linear.force, rel=MESH)
        assert small.stiffness == pytest.approx(linear.stiffness, rel=MESH)
        assert small.radius == pytest.approx(linear.contact_radius, rel=MESH_OF_CONTACT)
        assert small.pressure == pytest.approx(linear.max_pressure, rel=MESH_OF_CONTACT)


@pytest.mark.one_version
def test_a_support_over_the_whole_height_stiffens_a_plate_that_stretches() -> None:
    """It stretches the turned edge: the stiffening is larger by about H/b.

    In the elements, the elastic energy is the work of the force.
    """
    scene, deflection = ("simply-supported", 0.3, 0.03, 2.0), 0.6
    plain, contact = stated(scene, deflection, stretching=False), stated(scene, deflection)
    before, turned = elements(scene, [0.9 * deflection, deflection], contact.contact_radius)
    [held] = elements(scene, [deflection], contact.contact_radius, turns=False)
    assert turned.force == pytest.approx(contact.force, rel=contact.force_error)
    more = (held.force - turned.force) / (contact.force - plain.force)
    assert more == pytest.approx(scene[2], rel=0.3)
    step = turned.indentation - before.indentation
    mean = 0.5 * (before.force + turned.force) - (turned.stiffness - before.stiffness) * step / 12
    assert turned.energy - before.energy == pytest.approx(mean * step, rel=MESH)
