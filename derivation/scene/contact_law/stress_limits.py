"""Warnings of pressures and stresses that exceed a limit, or may do so within their errors."""

import math
from typing import Any

import numpy as np

from derivation.scene import kernels
from derivation.scene.kernels import Numbers
from derivation.scene.quantity import percent


def exceeds(value: Numbers, limit: Numbers, error: Numbers) -> Any:
    """Return whether a positive value exceeds a limit, or may do so by its relative error [1].

    A value with an unknown error, which is infinite, is compared without it.
    """
    known = np.where(np.isfinite(error), error, 0.0)
    return (value > 0.0) & (value * (1.0 + known) > limit)


def _within_error(value: float, limit: float, error: float) -> str:
    """Return that a value and its limit differ by less than its error, in words; else nothing."""
    if value * (1.0 - error) > limit:
        return ""
    if not math.isfinite(error):
        return ", and its error is unknown"
    return f", within its error of {percent(error)}"


def pressure_warnings(
    pressure: float,
    yield_stress: float | None,
    viscous: bool = False,
    body: str = "plate",
    error: float = 0.0,
) -> tuple[str, ...]:
    """Return a warning if the body with the lower yield stress yields, or may yield unchecked.

    `error` is the relative error of the pressure [1].
    """
    if yield_stress is not None and viscous:
        text = (
            f"whether the {body} yields is not checked: max_pressure is the elastic part of the "
            "pressure, which a viscoelastic contact exceeds while it grows"
        )
        return (text,)
    limit = math.inf if yield_stress is None else kernels.YIELD_LIMIT * yield_stress
    if yield_stress is None or not exceeds(pressure, limit, error):
        return ()
    within = _within_error(pressure, limit, error)
    yields = "may yield" if within else "yields"
    text = (
        f"largest pressure / yield stress = {pressure / yield_stress:.3g} "
        f"{'exceeds' if pressure > limit else 'is below'} {kernels.YIELD_LIMIT}{within}: the "
        f"{body} {yields} below the contact, and this simulation neglects the energy that this "
        "dissipates"
    )
    return (text,)


def stress_warnings(
    stress: float,
    strength: float | None,
    yield_stress: float | None = None,
    error: float = 0.0,
    static: bool = True,
) -> tuple[str, ...]:
    """Return warnings if the back face is predicted to fail or to yield, or may do so.

    Parameters
    ----------
    stress
        Largest tensile stress on the back face [Pa].
    strength, yield_stress
        Of the plate [Pa], if they are known. On the axis both in-plane stresses are equal, and
        the face yields when they reach the yield stress.
    error
        Relative error of the stress [1].
    static
        Whether the stress is that under a static load equal to the largest force.
    """
    basis = " (quasi-static, under the peak force)" if static else ""
    notes = []
    for limit, name, event in (
        (strength, "strength", "fail"), (yield_stress, "yield stress", "yield in bending")
    ):  # fmt: skip
        if limit is None or not exceeds(stress, limit, error):
            continue
        within = _within_error(stress, limit, error)
        verdict = "may" if within else "is predicted to"
        notes.append(
            f"the largest tensile stress on the back face is {stress / limit:.3g} times the "
            f"{name}{basis}{within}: the plate {verdict} {event}, and the results assume that it "
            "does not"
        )
    return tuple(notes)
