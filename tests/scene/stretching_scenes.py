"""Scenes whose plates stretch, and their independent simulation."""

import math
from functools import cache
from typing import Any

from derivation.scene import Result, read, simulate
from derivation.scene.dynamic.modal import plate_of
from derivation.scene.dynamic.mode_count import branching
from tests.scene.von_karman import Hertz, Plastic, ThinPlate, Viscoelastic, impact

SCENES: dict[str, dict[str, Any]] = {
    "several contacts with a clamped plate": {
        "sphere": {"radius": 0.0104, "material": "steel"},
        "plate": {"radius": 0.0365, "thickness": 1.6e-3, "edge": "clamped"},
        "impact": {"speed": 2.5},
    },
    "heavy sphere on a supported plate": {
        "sphere": {"radius": 0.00704, "material": "steel"},
        "plate": {"radius": 0.0202, "thickness": 0.91e-3, "edge": "simply-supported"},
        "impact": {"speed": 2.2},
    },
    "paper's edge": {
        "sphere": {"radius": 0.0103, "material": "steel"},
        "plate": {"radius": 0.05, "thickness": 2e-3, "edge": "paper"},
        "impact": {"speed": 4.0},
    },
    "damped plate": {
        "sphere": {"radius": 0.0115, "material": "steel"},
        "plate": {"radius": 0.0295, "thickness": 1.7e-3, "edge": "clamped", "loss_factor": 0.57},
        "impact": {"speed": 7.3},
    },
    "yielding contacts, of which a later one becomes the strongest": {
        "sphere": {"radius": 0.0148, "material": "steel"},
        "plate": {
            "radius": 0.136,
            "thickness": 3.87e-3,
            "material": "steel",
            "edge": "clamped",
            "yield_stress": 1.02e9,
        },
        "impact": {"speed": 17.3},
    },
    "contact with a light damped plate that ends slowly": {
        "sphere": {"radius": 5.87e-3, "material": "steel"},
        "plate": {
            "radius": 0.279,
            "thickness": 4.03e-3,
            "material": "PMMA",
            "edge": "clamped",
            "loss_factor": 0.096,
        },
        "impact": {"speed": 15.1},
    },
    "viscoelastic contact that is widest long after its largest force": {
        "sphere": {"radius": 7.13e-3, "material": "steel"},
        "plate": {
            "radius": 0.0426,
            "thickness": 0.591e-3,
            "material": "steel",
            "loss_factor": 0.092,
            "edge": "simply-supported",
            "retardation_time": 1.2e-5,
        },
        "impact": {"speed": 2.6},
    },
    "viscoelastic contact with a damped plate": {
        "sphere": {"radius": 0.0122, "mass": 0.293, "material": "steel"},
        "plate": {
            "radius": 0.0359,
            "thickness": 1.96e-3,
            "edge": "clamped",
            "loss_factor": 0.07,
            "retardation_time": 2.5e-5,
        },
        "impact": {"speed": 1.47},
    },
}


def simulated(scene: dict[str, Any], **effects: bool) -> Result:
    """Return the result of a scene with some effects."""
    plate = {"material": "glass"} | scene["plate"]
    return simulate(read(scene | {"plate": plate, "effects": effects}), rtol=0.05)


@cache
def moving(name: str, stretching: bool = False) -> Result:
    """Return the result of a scene on a plate with inertia."""
    return simulated(SCENES[name], inertia=True, stretching=stretching)


@cache
def simulations(name: str, thick: bool = False) -> tuple[dict[str, float], dict[str, float]]:
    """Return the results of the independent simulation without and with stretching.

    With `thick` its modes have the frequencies and masses of a plate of finite thickness.
    """
    model, plate = moving(name).model, SCENES[name]["plate"]
    nu, modulus = model.poissons_ratio, model.modulus / (1.0 + model.softness)
    thin = ThinPlate(
        2.0 * model.mu * (1.0 + nu), nu, model.density, plate["thickness"], plate["radius"],
        plate["edge"], modes=30 if plate["radius"] > 0.04 else 10, points=80,
    )  # fmt: skip
    if thick:
        modes = plate_of(branching(moving(name).effects.law, "A0"), thin.modes).modes
        at_centre = thin.shapes[-1]  # the deflection of the program's modes there is 1
        thin.__dict__["frequencies"] = modes.omega
        thin.__dict__["masses"] = at_centre**2 / modes.inverse_modal_mass
    stiffness = 4.0 / 3.0 * modulus * math.sqrt(model.R)

    def contact() -> Hertz:
        if "yield_stress" in plate:
            onset = 0.5 * math.pi * model.R * 1.6 * plate["yield_stress"] / modulus
            return Plastic(stiffness, model.R, onset)
        if "retardation_time" in plate:
            return Viscoelastic(stiffness, model.retardation_time)
        return Hertz(stiffness)

    loss = plate.get("loss_factor", 0.0)
    linear, stretched = (
        impact(thin, model.m, contact(), model.v0, on, loss) for on in (False, True)
    )
    return linear, stretched
