"""The model error of static contacts: that of an impact, and of stretching in each quantity."""

import math
import re
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from derivation.scene import indent, read, simulate
from derivation.scene.contact_law.corrections import stretching
from derivation.scene.contact_law.limits import local_indentation
from derivation.scene.indentation import static_law


def tables(edge: str, **plate: float) -> dict[str, Any]:
    """Return a glass plate under a rigid sphere; inertia is neglected."""
    glass = {"youngs_modulus": 70e9, "poissons_ratio": 0.23}
    return {
        "sphere": {"radius": 0.01, "density": 7850.0},
        "plate": {"radius": 0.1, "thickness": 0.004, "edge": edge} | glass | plate,
        "impact": {"speed": 1.0},
        "effects": {"inertia": False, "non_hertzian_pressure": True},
    }


def unstretched(edge: str, **plate: float) -> dict[str, Any]:
    """Return the same without stretching."""
    scene = tables(edge, **plate)
    return scene | {"effects": scene["effects"] | {"stretching": False}}


@pytest.mark.parametrize("edge", ["paper", "simply-supported", "clamped"])
@pytest.mark.parametrize("thickness", [0.004, 0.06])
def test_model_error_is_at_least_that_of_an_impact(edge: str, thickness: float) -> None:
    scene = read(unstretched(edge, thickness=thickness))
    result = simulate(scene, rtol=1e-9)
    (contact,) = indent(scene, contact_radius=result.max_contact_radius)
    assert 0.999 * result.model_error <= contact.model_error < 5.0 * result.model_error


@pytest.mark.parametrize("edge", ["paper", "simply-supported", "clamped"])
def test_model_error_covers_a_plate_that_stretches(edge: str) -> None:
    """A plate of stiffness k carries k w (1 + S(w)), S the relative stiffening."""
    scene = read(unstretched(edge))
    law = static_law(scene)

    def stretched(depth: float) -> tuple[float, float]:
        """Return force and stiffness at an indentation."""

        def excess(force: float) -> float:
            (one,) = indent(scene, force=force)
            local = float(local_indentation(law, one.contact_radius))
            linear = one.indentation - local  # deflection without stretching
            w = brentq(lambda w: w * (1.0 + float(stretching(law.model, w))) - linear, 0.0, linear)
            return local + float(w) - depth

        return float(brentq(excess, 1.0, 1e4, rtol=1e-12)), depth

    for depth in (1e-4, 4e-4):
        (linear,) = indent(scene, indentation=depth)
        force = stretched(depth)[0]
        more = stretched(1.001 * depth)[0]
        stiffness = (more - force) / (0.001 * depth)
        changes = force / linear.force - 1.0, stiffness / linear.stiffness - 1.0
        assert 0.2 * linear.force_error < max(changes) < linear.force_error
        assert min(changes) > 0.0


def test_an_unknown_model_error_is_stated() -> None:
    contacts = indent(read(tables("clamped", thickness=0.3)), force=10.0)
    assert contacts[0].model_error == math.inf
    assert contacts[0].to_json()["model_error"] is None
    assert "Model error: unknown" in str(contacts)


def test_model_errors_of_few_contacts_are_shown_if_they_differ() -> None:
    scene = read(unstretched("clamped"))
    errors = [contact.model_error for contact in indent(scene, force=[1.0, 300.0])]
    assert errors[1] > 4 * errors[0]
    note, _, of_force = indent(scene, force=[1.0, 300.0]).model_note.partition(";")
    assert "of force, indentation and stiffness" in of_force
    first, second = (float(text) / 100 for text in re.findall(r"([\d.]+) %", note))
    assert errors[0] <= first < 1.1 * errors[0]
    assert errors[1] <= second < 1.1 * errors[1]
    assert indent(scene, force=[1.0, 1.01]).model_note.startswith("Model error: up to ")
    many = indent(scene, force=np.geomspace(1.0, 300.0, 50)).model_note
    assert many.partition(";")[0] == f"Model error: up to {100 * second:.2g} %"
