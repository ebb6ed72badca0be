"""Simulates an impact: from the scene to contact time, indentation, force and their history."""

from collections.abc import Iterable

import numpy as np

from derivation.scene import kernels
from derivation.scene.limits import check_energy, check_numbers, check_radius, warnings_at
from derivation.scene.model import model_of
from derivation.scene.result import Result
from derivation.scene.scene import Scene


def simulate(scene: Scene, times: Iterable[float] | None = None) -> Result:
    """Simulate the impact of a scene.

    Parameters
    ----------
    scene
        The scene, as `load` returns it.
    times
        Times after first contact [s] at which `Result.history` is to be given; without them
        it covers the contact evenly.

    Returns
    -------
    Result
        Contact time [s], largest indentation [m], force [N] and contact radius [m].

    Raises
    ------
    SceneError
        If the impact leaves the contact law's range, or a time lies outside the contact.
    """
    model = model_of(scene)
    check_energy(model)
    with np.errstate(all="ignore"):  # extreme scenes end in NaN, which is looked for
        found = kernels.impact(model.R, model.m, model.v0, model.h, model.b, model.lam, model.mu)
    contact_time, delta, P, a = (float(value) for value in found)
    check_radius(model, a, "impact.speed", "lower the speed")
    check_numbers(model, contact_time, delta, P, a)
    result = Result(contact_time, delta, P, a, warnings_at(model, a, delta), scene, model)
    return result if times is None else result.at(times)
