"""The parts of a result's model error by their causes."""

from typing import TYPE_CHECKING

from derivation.scene.contact_law.finite_sphere import finite_sphere_errors
from derivation.scene.contact_law.finite_strains import more_than_radius
from derivation.scene.dynamic.stretching_error import Deflections
from derivation.scene.dynamic.unlike_bodies import unlike_bodies_errors
from derivation.scene.effects.effect import Results
from derivation.scene.measured.measured import model_error_of
from derivation.scene.model_errors import deflections_in, model_errors
from derivation.scene.scene import OUTPUTS
from derivation.scene.selection.method_selection import growth_of

if TYPE_CHECKING:
    from derivation.scene.result import Result

SMALLEST = 1e-5
"""Part of the deflection that does not stretch the plate."""
PLATE, STRETCHING, SPHERE, TIMES, MEASURED = (
    "plate", "stretching", "sphere", "retardation times", "measurement"
)  # fmt: skip


def causes(result: "Result", name: str) -> dict[str, float]:
    """Return the parts of the model error of a result [1] by cause: `PLATE` (with edge), ...

    `SPHERE` includes finite strains. Their sum is the model error.
    """
    model_error = result.model_errors[name]
    without = errors_of(result, deflections_of_result(result).times(SMALLEST))[name]
    stretching = max(model_error - without, 0.0)
    sphere, unlike = sphere_errors(result)[name], retardation_errors(result)
    times = unlike["max_contact_radius" if name == "max_pressure" else name]
    measured = model_error_of(result.scene)
    plate = max(model_error - stretching - sphere - times - measured, 0.0)
    parts = {PLATE: plate, STRETCHING: stretching, SPHERE: sphere, TIMES: times}
    return parts | {MEASURED: measured}


def numbers_of(result: "Result") -> Results:
    """Return the outputs in the order of `OUTPUTS`."""
    return (
        result.contact_time, result.max_indentation, result.max_force, result.max_contact_radius,
        result.restitution,
    )  # fmt: skip


def errors_of(result: "Result", deflections: Deflections) -> dict[str, float]:
    """Return the model errors of an impact with other deflections."""
    errors = model_errors(result.effects.law, numbers_of(result), deflections, result.dynamics)
    measured = model_error_of(result.scene)
    return {name: error + measured for name, error in errors.items()}


def sphere_errors(
    result: "Result", part: float = 1.0, growth: Results | None = None
) -> dict[str, float]:
    """Return the model errors of outputs and pressure by the sphere's finite size and by strains.

    Parameters
    ----------
    part
        Part of the contact radius [1]; the indentation is proportional to its square.
    growth
        Factors by which vibration of the plate increases the errors [1]; None for those of the
        impact.
    """
    time, depth, force, a, restitution = numbers_of(result)
    numbers = time, part**2 * depth, force, part * a, restitution
    growth = growth_of(result.dynamics) if growth is None else growth
    law = result.effects.law
    errors = dict(zip(OUTPUTS, finite_sphere_errors(law, numbers, growth), strict=True))
    pressure = errors["max_contact_radius"] + float(more_than_radius(law, part * a))
    return errors | {"max_pressure": pressure}


def retardation_errors(result: "Result") -> dict[str, float]:
    """Return the model errors by different retardation times of sphere and plate."""
    motion = result.dynamics
    return unlike_bodies_errors(result.effects.law, result.contact_time, motion, growth_of(motion))


def deflections_of_result(result: "Result") -> Deflections:
    """Return the deflections that the model errors refer to."""
    return deflections_in(result.effects.law, numbers_of(result), result.dynamics)
