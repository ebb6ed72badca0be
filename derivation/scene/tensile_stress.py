"""Largest tensile stress on the axis of the back face of a plate, with its error."""

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from derivation.scene.contact_law.corrections import membrane_stress, stretching
from derivation.scene.contact_law.edge_remainder import edge_stress_error, edge_stress_errors
from derivation.scene.contact_law.finite_sphere import finite_sphere_error
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import (
    QUASI_STATIC_PERIODS,
    local_indentation,
    plate_times,
)
from derivation.scene.contact_law.stress_limits import exceeds
from derivation.scene.dynamic.model_error import stress_error
from derivation.scene.dynamic.stretching_error import stress_change
from derivation.scene.effects.effect import Results
from derivation.scene.kernels import Numbers
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.dynamic.wave_motion import DynamicImpact

VIBRATION, WAVES = 0.3, 2.0
SUDDEN_VIBRATION, SUDDEN_WAVES = 0.5, 350.0
"""Coefficients of `vibration`: of bending in a thin plate, which starts with the speed of the
sphere and vibrates about its static deflection, and of waves in a thick plate; the same for the
sudden rise of the force of a viscoelastic contact. In 420 random impacts on plates with the paper's
edge, a separate simulation of all waves under the same force changed the stress by at most 0.76 of
the estimate, where this is below `QUASI_STATIC_CHANGE`; in 505 on clamped and simply supported
plates, by at most 0.84."""
LONGEST_RETARDATION = 0.7
"""Retardation time over contact time from which on the force rises in the same way [1]."""
QUASI_STATIC_CHANGE = 0.3
"""Relative change by vibration above which the stress is called static, with unknown error [1]."""


class TensileStress(NamedTuple):
    """Largest tensile stress on the back face, on the axis.

    With plate inertia it is that until shear waves from the last contact have crossed the
    thickness. Without, it is that under a static load equal to the largest force, distributed over
    the largest contact radius as in Hertz's law, on a plate with all static effects, and with the
    edge of the scene unless `effects.edge` is false. The non-Hertzian pressure of the same force
    and radius gives a smaller stress: by up to 0.06 % at a/h = 1, 3 % at 2, 40 % at 4.

    Attributes
    ----------
    value
        The stress [Pa]; below 0 if compressive. NaN if the impact is over before waves return from
        the back face.
    error
        Estimated relative error [1], apart from the error bound of the force; that of the static
        stress if `static` is true. Infinite if that of the edge is unknown.
    static
        Whether the stress is that of a static load, although vibration of the plate may change it.
    """

    value: float
    error: float
    static: bool

    def safety(self, strength: float, bound: float, inertia_neglected: bool) -> str:
        """Return the safety against a strength [Pa] as a sentence; empty if it may be exceeded.

        `bound` is the error bound of the force [1].
        """
        if math.isnan(self.value) or exceeds(self.value, strength, bound + self.error):
            return ""
        if self.value <= 0.0:
            return "no failure predicted on the back face: no tensile stress on the axis"
        ratio = f"strength / largest tensile stress = {strength / self.value:.3g}"
        caveat = "; plate inertia is neglected but may matter" if inertia_neglected else ""
        basis = f" (quasi-static, under the peak force{caveat})" if self.static else ""
        if not math.isfinite(bound + self.error):
            unknown = "and the error of the stress is unknown"
            return f"failure on the back face is uncertain: {ratio}{basis}, {unknown}"
        return f"no failure predicted on the back face: {ratio}{basis}"

    def to_json(self) -> dict[str, float | None]:
        """Return its error, unknown for a static load, and whether it is that of one."""
        known = math.isfinite(self.error) and not self.static
        return {"error": self.error if known else None, "static": self.static}


def tensile_stress(
    law: ContactLaw, motion: "DynamicImpact | None", numbers: Results, on_edge: bool
) -> TensileStress:
    """Return the largest tensile stress of an impact.

    Parameters
    ----------
    law, motion
        The law, and the impact if the plate has inertia.
    numbers
        The results of the impact.
    on_edge
        Whether the edge of the scene is used.
    """
    from derivation.scene.dynamic.back_face import stress_end
    from derivation.scene.dynamic.wave_problem import echo_time

    contact_time, indentation, force, a, restitution = numbers
    model = law.model
    if motion is not None:
        found, measured = motion.back_face, stress_error(model, a, contact_time)
        if on_edge and stress_end(motion) > echo_time(motion.law.model):
            measured = max(measured, found.on_edge + edge_stress_error(model, a))
        error = found.error + measured + stress_change(law, motion)
        error += motion.flat_contact_errors["max_force"]  # the stress follows the force
        error += float(finite_sphere_error(law, a, indentation))
        return TensileStress(found.stress, error, static=False)
    stress = law.max_tensile_stress(a, force, on_edge)
    period = plate_times(model).period if model.density else 0.0
    radii = np.array([a])
    deflections = np.array([indentation]) - local_indentation(law, radii)
    [change] = vibration(
        law, np.array([stress]), np.array([force]), np.array([contact_time]), period, restitution
    )
    [error] = static_errors(law, radii, deflections, np.array([change]), on_edge)
    slow = model.density and change <= QUASI_STATIC_CHANGE
    return TensileStress(stress, float(error), static=not slow)


def vibration(
    law: ContactLaw,
    stress: Array,
    force: Array,
    contact_time: Array,
    period: Numbers,
    restitution: Numbers,
) -> Array:
    """Return the relative change of the stress of a quasi-static plate by its vibration [1].

    It is infinite unless the contact lasts many periods. The static stress of a thick plate
    decreases exponentially with the thickness, but not the stress of the waves, which is of the
    order of the force over the area of the plate. These are stronger if the force rises or falls
    quickly: in a viscoelastic contact at once, in a yielded one during the short unloading.

    Parameters
    ----------
    stress, force
        Stresses under static loads [Pa], and these loads [N].
    contact_time, period
        Contact times and first periods of the plate [s].
    restitution
        Restitution of the impacts [1].
    """
    model = law.model
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        fast = period / contact_time
        wave = model.eta * force / (math.pi * model.b**2 * np.abs(stress))
        change = fast * (VIBRATION + WAVES * wave / np.abs(restitution))
        if law.viscous:
            late = np.minimum(model.retardation_time / contact_time, LONGEST_RETARDATION)
            sudden = SUDDEN_VIBRATION + SUDDEN_WAVES * wave / np.sqrt(model.eta)
            change = change + late * np.sqrt(fast) * sudden
    slow = (contact_time >= QUASI_STATIC_PERIODS * period) & (change >= 0.0)
    return np.asarray(np.where(slow, change, math.inf))


def static_errors(
    law: ContactLaw, a: Array, deflection: Array, change: Array, on_edge: bool
) -> Array:
    """Return the relative errors of stresses under static loads [1].

    Parameters
    ----------
    a, deflection
        Contact radii and deflections of the plate [m].
    change
        Relative changes by vibration [1]. Those above `QUASI_STATIC_CHANGE` are not included: the
        errors are then those of the static stress.
    on_edge
        Whether the edge of the scene is used, even if the law omits it.
    """
    deflection = np.maximum(deflection, 0.0)  # of a stiff plate, by rounding or approximation
    error = membrane_stress(law.model, deflection) + stretching(law.model, deflection)
    error = error + finite_sphere_error(law, a, local_indentation(law, a) + deflection)
    if on_edge:
        error = error + edge_stress_errors(law.model, a)
    return np.asarray(error + np.where(change <= QUASI_STATIC_CHANGE, change, 0.0))
