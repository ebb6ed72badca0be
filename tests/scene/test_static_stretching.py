"""Static contacts on a plate that stretches: finite elements, published laws, limits, impacts."""

import math
from typing import Any

import numpy as np
import pytest

from derivation.scene import SceneError, indent, read, simulate
from derivation.scene.contact_law.corrections import stretching
from derivation.scene.contact_law.limits import local_indentation
from derivation.scene.indentation import StaticContact, static_law
from tests.scene.large_rotations import Reduced, Shell, Theory

EDGES = "clamped", "simply-supported", "paper"
RADIUS = 0.05
YIELDS = {"yield_stress": 2e7}


def tables(edge: str, thickness: float, nu: float = 0.3, R: float = 0.005) -> dict[str, Any]:
    """Return a rigid sphere on a polymer plate of unknown density."""
    plate = {"radius": RADIUS, "thickness": thickness, "youngs_modulus": 2.4e9, "edge": edge}
    return {
        "sphere": {"radius": R, "mass": 0.01},
        "plate": plate | {"poissons_ratio": nu},
        "impact": {"speed": 0.1},
    }


def linear(scene: dict[str, Any]) -> dict[str, Any]:
    """Return a scene without stretching."""
    return scene | {"effects": {"stretching": False}}


def shell_of(edge: str, thickness: float, nu: float) -> Reduced:
    """Return the plate by finite elements."""
    return Shell(2.4e9, nu, 1000.0, thickness, RADIUS, edge, 30).in_modes(0, 0)


@pytest.mark.one_version
@pytest.mark.parametrize("theory", ["angle", "Green"])
@pytest.mark.parametrize(
    ("edge", "thickness", "nu", "deflection"),
    [
        ("clamped", 3e-4, 0.45, 1.0), ("clamped", 1e-3, 0.3, 3.0), ("clamped", 2e-3, -0.2, 0.5),
        ("simply-supported", 4e-4, 0.2, 4.0), ("simply-supported", 2e-3, 0.4, 1.2),
        ("paper", 5e-4, 0.3, 2.0), ("paper", 1.5e-3, 0.0, 0.7),
    ],
)  # fmt: skip
def test_contacts_are_those_of_a_plate_with_large_rotations(
    edge: str, thickness: float, nu: float, deflection: float, theory: Theory
) -> None:
    """Indentation and stiffness are within the model error, and far from the linear ones.

    The elements have no shear: their load gives the same deflection without stretching.
    """
    scene, shell = tables(edge, thickness, nu), shell_of(edge, thickness, nu)
    (contact,) = indent(read(scene), indentation=deflection * thickness)
    near = [0.999 * contact.force, contact.force, 1.001 * contact.force]
    plain = indent(read(linear(scene)), force=near)
    compliance = float(shell.loaded**2 @ (1.0 / shell.stiffness))
    expected = []
    for one in plain:
        local = float(local_indentation(static_law(read(scene)), one.contact_radius))
        load = (one.indentation - local) / compliance
        q, _ = shell.static(theory, load * shell.loaded)
        expected.append(local + float(shell.loaded @ q))
    stiffness = (near[2] - near[0]) / (expected[2] - expected[0])
    assert contact.stretched
    assert contact.force_error < 0.1 * min(1.0, plain[1].model_error)
    assert contact.indentation == pytest.approx(expected[1], rel=contact.force_error)
    assert contact.stiffness == pytest.approx(stiffness, rel=contact.force_error)


@pytest.mark.one_version
def test_the_force_is_that_of_a_much_narrower_contact() -> None:
    """A large sphere on a plate that is hardly thin: its local indentation is 6 % of the whole.

    It is that of Hertz's law here, because the linear law has a contact of nearly twice the radius.
    The stiffness of that contact would be 20 % smaller.
    """
    thickness, nu = 0.084 * RADIUS, 0.13
    scene, shell = tables("paper", thickness, nu, 0.43 * RADIUS), shell_of("paper", thickness, nu)
    (contact,) = indent(read(scene), indentation=1.88 * thickness)
    law, compliance = static_law(read(scene)), float(shell.loaded**2 @ (1.0 / shell.stiffness))
    near = [0.999 * contact.force, contact.force, 1.001 * contact.force]
    (small,) = indent(read(linear(scene)), force=1e-5 * contact.force)
    bent = (small.indentation - float(local_indentation(law, small.contact_radius))) / small.force
    expected = []
    for P in near:
        local = float(local_indentation(law, float(law.hertz_radius(np.array(P)))))
        q, _ = shell.static("angle", P * bent / compliance * shell.loaded)
        expected.append(local + float(shell.loaded @ q))
    stiffness = (near[2] - near[0]) / (expected[2] - expected[0])
    assert contact.stiffness == pytest.approx(stiffness, rel=0.1)
    assert contact.stiffness == pytest.approx(stiffness, rel=contact.force_error)
    assert contact.indentation == pytest.approx(expected[1], rel=contact.force_error)


@pytest.mark.one_version
@pytest.mark.parametrize("nu", [0.0, 0.45])
def test_deep_contacts_tend_to_those_of_a_membrane(nu: float) -> None:
    """P = E H q^3 w^3/b^2, q = 1/(1.05 - 0.15 nu - 0.16 nu^2) (Komaragiri et al., 2005).

    That is a membrane under a point force. The bending of a plate below the force changes P by a
    part in proportion to H/w, and bends the plate by 16 pi D w/b^2 in addition.
    """
    thickness = 5e-6
    scene = read(tables("clamped", thickness, nu, 5e-4))
    ratios = []
    for contact in indent(scene, indentation=[10 * thickness, 20 * thickness]):
        w = contact.indentation / RADIUS
        membrane = 2.4e9 * thickness * RADIUS * w**3 / (1.05 - 0.15 * nu - 0.16 * nu * nu) ** 3
        stiffness = 2.4e9 * thickness**3 / (12.0 * (1.0 - nu * nu))
        ratios.append(contact.force / (membrane + 16.0 * math.pi * stiffness * w / RADIUS))
        assert 2.7 < contact.stiffness * contact.indentation / contact.force < 3.0
    assert 2.0 * ratios[1] - ratios[0] == pytest.approx(1.0, abs=0.02)


@pytest.mark.one_version
@pytest.mark.parametrize("edge", EDGES)
def test_small_deflections_stiffen_by_the_closed_form(edge: str) -> None:
    """To first order in S = A w^2/H^2 a plate of stiffness k carries k w (1 + S)."""
    scene = tables(edge, 1e-3)
    plain = indent(read(linear(scene)), indentation=[0.03e-3, 0.06e-3])
    for one in plain:
        (contact,) = indent(read(scene), force=one.force)
        w = one.indentation - float(local_indentation(static_law(read(scene)), one.contact_radius))
        size = float(stretching(static_law(read(scene)).model, w))
        assert contact.stretched
        assert 1e-4 < size < 3e-3
        assert (one.indentation - contact.indentation) / w == pytest.approx(size, rel=0.02)


@pytest.mark.one_version
@pytest.mark.parametrize("edge", EDGES)
def test_stretching_begins_without_a_step(edge: str) -> None:
    """Below a stiffening of 1e-4 it is neglected; the model error includes that."""
    scene = read(tables(edge, 1e-3))
    depths = np.geomspace(5e-6, 5e-5, 24)
    contacts = indent(scene, indentation=depths)
    stretched = [contact.stretched for contact in contacts]
    first = stretched.index(True)
    assert first > 0
    assert all(stretched[first:])
    below, above = contacts[first - 1], contacts[first]
    growth = math.log(above.force / below.force) / math.log(above.indentation / below.indentation)
    assert growth == pytest.approx(
        below.stiffness * below.indentation / below.force,
        abs=2e-4 / math.log(depths[1] / depths[0]),
    )
    assert below.model_error >= 3e-5


def inverted(contacts: tuple[StaticContact, ...], name: str, scene: Any) -> list[float]:
    """Return the forces of contacts that are given by another of their quantities."""
    return [one.force for one in indent(scene, **{name: [getattr(c, name) for c in contacts]})]


@pytest.mark.one_version
@pytest.mark.parametrize(("edge", "yielding"), [*((edge, {}) for edge in EDGES), ("paper", YIELDS)])
def test_each_quantity_gives_the_same_contact(edge: str, yielding: dict[str, float]) -> None:
    plain = tables(edge, 5e-4)
    scene = read(plain | {"plate": plain["plate"] | yielding})
    contacts = indent(scene, force=np.geomspace(1e-3, 5.0, 12))
    forces = [contact.force for contact in contacts]
    assert not contacts[0].stretched
    assert contacts[-1].stretched
    for name in ("indentation", "contact_radius"):
        assert inverted(contacts, name, scene) == pytest.approx(forces, rel=1e-11)
    for contact in contacts:
        near = indent(scene, force=[0.9999 * contact.force, 1.0001 * contact.force])
        slope = (near[1].force - near[0].force) / (near[1].indentation - near[0].indentation)
        assert contact.stiffness == pytest.approx(slope, rel=1e-6)


@pytest.mark.one_version
def test_a_heavy_sphere_turns_where_the_static_force_stops_it() -> None:
    """A slow, heavy sphere has lost its energy to the static law at the largest indentation."""
    scene = tables("paper", 5e-4)
    plate = scene["plate"] | {"density": 1200.0}
    sphere, speed = scene["sphere"] | {"mass": 0.05}, 0.3
    heavy = scene | {"sphere": sphere, "plate": plate, "impact": {"speed": speed}}
    stretched = {"effects": {"stretching": True}, "inertia": {"modes": 8}}
    result = simulate(read(heavy | stretched))
    depths = result.max_indentation * np.linspace(0.0, 1.0, 41)[1:]
    forces = [0.0, *(contact.force for contact in indent(read(heavy), indentation=depths))]
    work = np.trapezoid(forces, [0.0, *depths])
    energy = 0.5 * 0.05 * speed**2
    plain = [c.force for c in indent(read(linear(heavy)), indentation=depths)]
    assert np.trapezoid([0.0, *plain], [0.0, *depths]) < 0.7 * work
    assert work == pytest.approx(energy, rel=0.05)


def test_infinite_and_thick_plates_and_scenes_without_it_do_not_stretch() -> None:
    scene = tables("clamped", 1e-3)
    infinite = scene | {"inertia": {"extent": "infinite"}}
    infinite["plate"] = scene["plate"] | {"density": 1200.0, "edge": "paper"}
    for one in (linear(scene), infinite):
        (contact,) = indent(read(one), force=0.1)
        assert not contact.stretched
    thick = tables("clamped", 0.03)
    (contact,) = indent(read(thick), force=100.0)
    assert not contact.stretched
    errors = []
    for one in (thick, linear(thick)):
        with pytest.raises(SceneError) as error:
            indent(read(one), force=1e12)
        errors.append(str(error.value))
    assert errors[0] == errors[1]


def test_a_contact_that_stretching_changes_too_far_is_rejected_with_the_range() -> None:
    scene = read(tables("simply-supported", 5e-4))
    with pytest.raises(SceneError, match="force: expected less than") as error:
        indent(scene, force=1e3)
    end = float(str(error.value).split("less than ")[1].split(" N")[0])
    assert indent(scene, force=0.999 * end)[0].stretched
    with pytest.raises(SceneError, match="force: expected less than"):
        indent(scene, force=1.001 * end)


def test_the_table_says_in_which_rows_the_plate_stretches() -> None:
    scene = read(tables("clamped", 5e-4))
    assert "Stretching" not in str(indent(scene, force=1e-4))
    assert "included in 1 of 2 rows." in str(indent(scene, force=[1e-4, 1.0]))
    assert "Stretching of the plate is included." in str(indent(scene, force=1.0))
    assert "Stretching of the plate is included." in indent(scene, force=1.0)._repr_html_()
