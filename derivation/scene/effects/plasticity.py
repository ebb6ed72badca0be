"""Plasticity: the lower yield stress limits the contact pressure, and a dent remains."""

from typing import TYPE_CHECKING

import numpy as np

from derivation.scene.effects.effect import Bound, BoundContext, Effect, Numbers, weight_work_ratio
from derivation.scene.model import Model
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.contact_law.law import ContactLaw

_LARGEST, _SMALLEST = 1e50, 1e-50


class Plasticity(Effect):
    """Contact with a pressure of at most 1.6 Y; it is elastic below this limit and in unloading."""

    name = "plasticity"
    adds = "plastic deformation in the contact"
    equation = "p = min(Hertz's pressure, 1.6 Y); unloading with R_p = R P_e/P"
    parameter = "p_0/(1.6 Y), p_0 Hertz's pressure, Y yield stress"
    source = "Johnson 1985; Thornton 1997; step 31"
    hertzian = True
    plastic = True
    remedy = "give plate.yield_stress or sphere.yield_stress [Pa]"

    def not_applicable_reason(self, model: Model) -> str:
        """Return a reason if no yield stress is given."""
        return (
            "" if np.isfinite(model.yield_stress) else "neither sphere nor plate has a yield_stress"
        )

    def value(self, model: Model, a: float) -> float:
        """Return Hertz's pressure over 1.6 Y at a contact radius [m]."""
        return float(a / _onset(model) / (1.0 + model.softness))

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return the bound on a half-space, where S is xi on loading and c on unloading.

        An elastic plate decreases the change. The work of the weight adds to the energy.
        """
        from generated.plasticity_kernels import unloaded

        ratio = _over_onset(model, context)
        flat = unloaded(np.maximum(ratio[..., -1:], 1.0))[0]
        slower = _number(-np.log(np.maximum(_restitution(model, context, ratio), _SMALLEST)))
        return Bound(
            np.zeros_like(ratio) + (1.0 - flat),
            np.maximum(ratio - 1.0, 0.0),
            radius=_number(-np.log(flat)),
            results=(slower, 0.0, 0.0, 0.0, slower),
        )

    def proved(self, law: "ContactLaw") -> bool:  # noqa: ARG002
        """Return False: tested on random scenes."""
        return False


def plastic_restitution(model: Model, context: BoundContext) -> Numbers:
    """Return the least restitution of the plastic contact [1]; 1 for an elastic contact."""
    if not np.any(np.isfinite(model.yield_stress)):
        return 1.0
    return _restitution(model, context, _over_onset(model, context))


def plastic_depth(model: Model, context: BoundContext) -> Numbers:
    """Return a bound on the largest indentation [m] of a contact that may yield.

    It is that of the elastic contact, times the increase by yield on a half-space; an elastic plate
    decreases it.
    """
    if not np.any(np.isfinite(model.yield_stress)):
        return context.depth
    from generated.plasticity_kernels import loaded, reached

    elastic = np.maximum(_over_onset(model, context)[..., -1:], 1.0)
    xi = reached(elastic**5)
    deeper: Array = (np.square(xi) + loaded(xi)[0]) / np.square(elastic)
    return context.depth * _number(deeper)


def _number(values: Array) -> Numbers:
    """Return the number of one scene, or the numbers of many as a column."""
    return values if values.ndim > 1 else float(values.item())


def _restitution(model: Model, context: BoundContext, ratio: Array) -> Array:
    """Return the least restitution for the last of Hertz's radii over that at the onset [1].

    On a half-space plastic work takes a fraction of the energy of the contact, which is the kinetic
    energy and the work of the weight; the restitution refers to the kinetic energy alone.
    """
    from generated.plasticity_kernels import worked

    kept = worked(np.maximum(ratio[..., -1:], 1.0))[1]
    energy = 1.0 + weight_work_ratio(model, plastic_depth(model, context))
    lost = energy * (1.0 - np.square(kept))
    # Without gravity this is the restitution itself, to the last bit.
    return np.where(energy > 1.0, np.sqrt(np.maximum(1.0 - lost, 0.0)), kept)


def _over_onset(model: Model, context: BoundContext) -> Array:
    """Return Hertz's radii of the force over the radius at the onset of yield [1]."""
    from generated.plasticity_kernels import hertz_modulus

    # The modulus of the law follows from the forces and their Hertz radii.
    last, force = context.radii[..., -1:], context.samples.force[..., -1:]
    modulus = hertz_modulus(force, np.asarray(model.R), last)
    onset = _onset(model) * (model.modulus / modulus)
    return np.minimum(context.radii / onset, _LARGEST)


def _onset(model: Model) -> Numbers:
    """Return Hertz's radius at the onset of yield for a rigid sphere [m]."""
    from generated.plasticity import yield_radius

    return yield_radius(model.R, model.lam, model.mu, model.yield_stress)
