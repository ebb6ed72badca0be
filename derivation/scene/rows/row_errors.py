"""Relative errors of the results of many impacts on quasi-static plates, as of `simulate`."""

from typing import NamedTuple

import numpy as np

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import local_indentation, plate_times
from derivation.scene.effects.plasticity import Plasticity
from derivation.scene.effects.viscosity import unlike_bodies_on_static_plate
from derivation.scene.kernels import YIELD_LIMIT
from derivation.scene.model_errors import quasi_static_errors
from derivation.scene.output.result_errors import OF_OTHERS
from derivation.scene.rows.selection import Group
from derivation.scene.rows.static_rows import Impacts
from derivation.scene.scene import OUTPUTS
from derivation.scene.tensile_stress import QUASI_STATIC_CHANGE, static_errors, vibration
from generated.arrays import Double as Array


class RowErrors(NamedTuple):
    """Relative errors of rows [1], shape (rows,).

    Attributes
    ----------
    of_results
        Those by bound and model of each result, by the names of `UNITS`, as of `Result.error_of`.
    bound, model
        The bound, and the largest model error, of the results to which the tolerance applies.
    bounds
        The bound of each output.
    pressure, stress
        Those of pressure and stress for comparison with limits: the pressure without a neglected
        yield, the stress under a static load.
    """

    of_results: dict[str, Array]
    bound: Array
    model: Array
    bounds: dict[str, Array]
    pressure: Array
    stress: Array


def errors_of_rows(
    group: Group, impacts: Impacts, numbers: dict[str, Array], outputs: tuple[str, ...]
) -> RowErrors:
    """Return the errors of rows with the same effects.

    Parameters
    ----------
    numbers
        The results, by the names of `UNITS`.
    outputs
        The results that the tolerance applies to.
    """
    law, columns = group.law, {name: values[:, None] for name, values in numbers.items()}
    a, depth = columns["max_contact_radius"], columns["max_indentation"]
    deflection = depth - local_indentation(law, a)

    def bound_with(omitted: Array) -> Array:
        parts = (omitted, impacts.law, impacts.quadrature, impacts.rounding)
        return np.asarray(np.expm1(sum(np.log1p(part) for part in parts)))

    def omitted_on(*names: str) -> Array:
        return group.error if set(names) <= set(outputs) else group.error_on(names)

    with np.errstate(all="ignore"):
        found = quasi_static_errors(law, a, depth, deflection, columns["restitution"])
        model = {name: error[:, 0] for name, error in found.items()}
        if law.viscous:
            unlike = unlike_bodies_on_static_plate(law.model, columns["contact_time"])
            size, time = (np.broadcast_to(x, a.shape)[:, 0] for x in unlike)
            model = {name: error + (time if name == "contact_time" else size)
                     for name, error in model.items()}  # fmt: skip
        bound = bound_with(group.error)
        bounds: dict[str, Array] = {
            x: bound if x in outputs else bound_with(omitted_on(x)) for x in OUTPUTS
        }

        def on_pressure(names: tuple[str, ...]) -> Array:
            omitted = omitted_on(*names)
            parts = np.log1p(bound_with(omitted)) + 2.0 * np.log1p(omitted)
            return np.asarray(np.expm1(parts))

        pressure = on_pressure(OF_OTHERS["max_pressure"])
        stress, change = _stress_errors(law, columns, deflection, group.held)
        stress = bounds["max_force"] + stress
        of_results: dict[str, Array] = {name: bounds[name] + model[name] for name in OUTPUTS}
        of_results["max_pressure"] = (
            np.maximum(pressure, _beyond_yield(group, numbers["max_pressure"]))
            + model["max_pressure"]
        )
        slow = (np.ravel(law.model.density) > 0.0) & (change <= QUASI_STATIC_CHANGE)
        of_results["max_tensile_stress"] = np.where(slow, stress, np.inf)
        largest = np.maximum.reduce([model[name] for name in outputs])
        compared = on_pressure(OUTPUTS) + model["max_pressure"]
    return RowErrors(of_results, bound, largest, bounds, compared, stress)


def _stress_errors(
    law: ContactLaw, columns: dict[str, Array], deflection: Array, held: bool
) -> tuple[Array, Array]:
    """Return the errors of stresses under static loads, and their changes by vibration [1]."""
    model, a = law.model, columns["max_contact_radius"]
    periods = plate_times(model).period if np.any(model.density) else 0.0
    change = vibration(
        law, columns["max_tensile_stress"], columns["max_force"], columns["contact_time"],
        periods, columns["restitution"],
    )  # fmt: skip
    errors = static_errors(law, a, deflection, change, held)
    return tuple(np.broadcast_to(x, a.shape)[:, 0] for x in (errors, change))  # type: ignore[return-value]


def _beyond_yield(group: Group, pressure: Array) -> Array:
    """Return how far pressures [Pa] exceed that of a yield which is omitted [1]."""
    if not any(effect.name == Plasticity.name for effect in group.omitted):
        return np.zeros_like(pressure)
    limit = YIELD_LIMIT * np.ravel(group.law.model.yield_stress)
    return np.maximum(0.0, pressure / limit - 1.0)
