"""Simulates an impact: from the scene to contact time, indentation, force and their history."""

from collections.abc import Iterable

from derivation.scene.choice import check_rtol, solve
from derivation.scene.limits import check_numbers, check_radius, warnings_at
from derivation.scene.model import model_of
from derivation.scene.result import Result
from derivation.scene.scene import Scene


def simulate(
    scene: Scene, times: Iterable[float] | None = None, rtol: float | None = None
) -> Result:
    """Simulate the impact of a scene.

    Parameters
    ----------
    scene
        The scene, as `load` returns it.
    times
        Times after first contact [s] at which `Result.history` is to be given; without them
        it covers the contact evenly.
    rtol
        Relative tolerance of every result [1]: the cheapest method is taken whose bound meets
        it. Without it that of the scene counts, and without that too the full method runs.
        The history is by the full method always.

    Returns
    -------
    Result
        Contact time [s], largest indentation [m], force [N] and contact radius [m], with the
        method and the bound of its error.

    Raises
    ------
    SceneError
        If the impact leaves the contact law's range, a time lies outside the contact, or the
        tolerance is not between 1e-13 and 1.
    """
    model = model_of(scene)
    if rtol is None and scene.accuracy is not None:
        rtol = scene.accuracy.rtol
    found, accuracy = solve(model, None if rtol is None else check_rtol(rtol))
    contact_time, delta, P, a = found
    check_radius(model, a, "impact.speed", "lower the speed")
    check_numbers(model, contact_time, delta, P, a)
    warnings = warnings_at(model, a, delta)
    result = Result(contact_time, delta, P, a, accuracy, warnings, scene, model)
    return result if times is None else result.at(times)
