"""Dynamic modes of the plate, and the quasi-static remainder of the contact law.

Each radial shape has one mode for each wave branch of the plate. With P_j = int_0^a P'(c) s_j(c) dc
the force that drives shape j, s_j the mean of the shape under a flat punch of radius a, and c_j the
static compliance of its modes,

    z = delta(a) - sum c_j P_j s_j + sum s_j q_j,   q'' + omega^2 q = omega^2 c P_j

s_j = dP_j/dP conserves energy for every law delta(a); s_j = 1 refers to the deflection at the axis,
as in the paper's definition of the indentation.

On the paper's edge J0(phi_j r) is an exact mode of every branch. For a clamped or simply supported
edge the lowest branch A0 has the modes of `generated.edge_modes`. The quasi-static remainder is
that of the paper's edge: with the law of another edge it would depend on the edge before any wave
has reached it.
"""

import itertools
import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene import kernels
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects.edge import CLAMPED, SUPPORTED
from derivation.scene.errors import SceneError
from derivation.scene.model import Model
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from generated.edge_modes import Waves

Indices = NDArray[np.intp]
Parts = tuple[tuple[slice, slice, Indices, Indices], ...]
SMALL = 1e-6
"""Contact radius over plate radius and thickness at which a contact counts as a point."""
UNMOVED = 1e-30
"""Strength W rho h r of a wave below which the wave does not move the contact face. Some waves have
the strength 0, which rounding may change."""
MOST_BELOW_CUTOFF = 100_000
"""Largest number of bending modes of a clamped or simply supported plate; they are computed in 1
s."""


@dataclass(frozen=True)
class Modes:
    """Modes that the contact force drives, in the order of their shapes.

    Attributes
    ----------
    phi
        Wave numbers of the shapes [1/m], shape (shapes,).
    omega
        Angular frequencies [rad/s], shape (modes,).
    inverse_modal_mass
        Acceleration by a unit force [1/kg], shape (modes,); divided by omega^2 it is the static
        compliance.
    first
        Index of the first mode of each shape, shape (shapes,).
    bends
        Whether each mode is antisymmetric; the others are symmetric. Shape (modes,).
    held
        The first shapes, if the edge is clamped or simply supported; the others are J0(phi r).
    b
        Plate radius [m], the unit of length of `held`.
    """

    phi: Array
    omega: Array
    inverse_modal_mass: Array
    first: Indices
    bends: NDArray[np.bool_]
    held: "Waves | None" = None
    b: float = 1.0

    def some(self, modes: Indices) -> "Modes":
        """Return some of the modes, in their order, and their shapes."""
        shapes, first = np.unique(self.shape[modes], return_index=True)
        omega, inverse_mass = self.omega[modes], self.inverse_modal_mass[modes]
        return Modes(self.phi[shapes], omega, inverse_mass, first, self.bends[modes], None, self.b)

    @property
    def compliances(self) -> Array:
        """Static deflection of each mode at the axis by a unit force [m/N]."""
        return np.asarray(self.inverse_modal_mass / self.omega**2)

    @property
    def compliance(self) -> Array:
        """Static deflection of each shape at the axis by a unit force [m/N]."""
        return self.by_shape(self.compliances)

    @cached_property
    def shape(self) -> Indices:
        """Index of the shape of each mode."""
        ends = np.append(self.first[1:], self.omega.size)
        return np.repeat(np.arange(self.first.size), ends - self.first)

    @cached_property
    def _parts(self) -> dict[int, Parts]:
        return {}

    def parts(self, most: int) -> Parts:
        """Return parts of whole shapes, each with about `most` modes."""
        if most not in self._parts:
            self._parts[most] = self._split(most)
        return self._parts[most]

    def _split(self, most: int) -> Parts:
        bounds = np.append(self.first, self.omega.size)
        indices = np.searchsorted(bounds, np.arange(0, self.omega.size, most))
        ends = [*sorted(set(indices.tolist())), self.first.size]
        return tuple(
            (
                slice(low, high),
                slice(bounds[low], bounds[high]),
                self.shape[bounds[low] : bounds[high]] - low,
                self.first[low:high] - bounds[low],
            )
            for low, high in itertools.pairwise(ends)
        )

    def by_shape(self, values: Array) -> Array:
        """Return the sum over the modes of each shape, along the last axis."""
        if self.first.size == self.omega.size:
            return values
        return np.asarray(np.add.reduceat(values, self.first, axis=-1), dtype=np.float64)

    def shapes(self, r: Array) -> Array:
        """Return each shape at distances [m] over its value on the axis: (shapes, distances)."""
        from generated.bessel import bessel_j0

        free = np.asarray(bessel_j0(np.outer(self.phi[self._held :], r)), dtype=np.float64)
        if self.held is None:
            return free
        from generated.edge_modes import shape

        return np.concatenate((shape(self.held, r / self.b), free))

    def modal_weights_less_one(self, a: Array) -> Array:
        """Return s_j - 1 at contact radii [m], shape (radii, shapes)."""
        y = np.outer(a, self.phi[self._held :])
        free = sine_less_one(np.sin(y), y)
        if self.held is None:
            return free
        from generated.edge_modes import modal_weights_less_one

        return np.concatenate((modal_weights_less_one(self.held, a / self.b), free), axis=1)

    @property
    def _held(self) -> int:
        return 0 if self.held is None else self.held.k.size


class ModalPlate(NamedTuple):
    """The modes of the plate, and the modes that the quasi-static remainder depends on.

    The remainder is the law with the paper's edge, minus the static deflection of `removed` (modes
    of that edge), plus the static deflection of `added` (modes of the edge of the scene).
    """

    modes: Modes
    removed: Modes
    added: Modes | None


@lru_cache(maxsize=8)
def plate_of(law: ContactLaw, count: int) -> ModalPlate:
    """Return the plate of a law with a number of modes of the lowest branch A0.

    If the scene includes all branches, their modes that are not faster than the last one of A0 are
    added.
    """
    if not law.other_edge or law.model.edge not in (SUPPORTED, CLAMPED):
        modes = free_modes(law.model, count)
        return ModalPlate(modes, modes, None)
    return _held_plate(law, count)


def free_modes(model: Model, count: int) -> Modes:
    """Return the modes of a plate with the paper's edge, `count` of them of the lowest branch."""
    modes = _free(model, count)
    if model.inertia.branches != "all":
        return _modes(model, modes)
    highest = float(modes.root[-1])
    return _modes(model, _branches(modes, _higher(model, modes, highest), highest))


def bending_fraction(model: Model, modes: Modes) -> Array:
    """Return the static compliance of a thin plate over that of each mode of A0 [1]."""
    from generated import inertia

    x, nu = modes.phi * model.h, model.poissons_ratio
    thin = inertia.bending_frequency(x, nu) / (x * x * math.sqrt(2.0 / (3.0 * (1.0 - nu))))
    return np.asarray(0.5 * thin * thin / inertia.bending_residue(x, nu), dtype=np.float64)


class _Shapes(NamedTuple):
    """Wave numbers times b, omega h/c_T, strength W rho h r, index of first modes, and symmetry."""

    k: Array
    root: Array
    strength: Array
    first: Indices
    bends: NDArray[np.bool_]


def _free(model: Model, count: int) -> _Shapes:
    """Return the modes of A0 with the paper's edge."""
    return _free_shapes(model.eta, model.poissons_ratio, count)


@lru_cache(maxsize=64)
def _free_shapes(eta: float, nu: float, count: int) -> _Shapes:
    """Return the modes of `_free`, which depend on h/b and Poisson's ratio alone."""
    from generated import inertia
    from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros

    j = bessel_j0_zeros(count)
    x = j * eta
    root = inertia.bending_frequency(x, nu)
    residue = inertia.bending_residue(x, nu)
    weight = 1.0 / (np.pi * bessel_j1_at_j0_zeros(count) ** 2)
    return _Shapes(j, root, residue * weight, np.arange(count), np.ones(count, dtype=bool))


def _modes(model: Model, shapes: _Shapes, held: "Waves | None" = None) -> Modes:
    """Return modes in SI units."""
    inverse_mass = shapes.strength / (model.density * model.h * model.b * model.b)
    omega = shapes.root * (model.shear_speed / model.h)
    return Modes(shapes.k / model.b, omega, inverse_mass, shapes.first, shapes.bends, held, model.b)


class _Higher(NamedTuple):
    """Higher branches of shapes: omega h/c_T and strength, (shapes, branches), and symmetry."""

    root: Array
    strength: Array
    bends: NDArray[np.bool_]


def _higher(model: Model, lowest: _Shapes, highest: float) -> _Higher:
    """Return all branches but A0 with the paper's edge, beyond omega h/c_T = `highest`."""
    from generated.bessel import bessel_j1_at_j0_zeros
    from generated.plate_waves import branches

    nu, x = model.poissons_ratio, lowest.k * model.eta
    weight = 1.0 / (np.pi * bessel_j1_at_j0_zeros(x.size)[:, None] ** 2)
    # At x = 0 branches are at least pi/2 apart, and none of them decreases by much.
    count = math.ceil(highest / (math.pi / 2.0)) + 2
    bent, stretched = (branches(x, nu, count, kind) for kind in ("antisymmetric", "symmetric"))
    root = np.hstack((bent[0][:, 1:], stretched[0]))
    strength = weight * np.hstack((bent[1][:, 1:], stretched[1]))
    return _Higher(root, strength, np.arange(root.shape[1]) < count - 1)


def _branches(lowest: _Shapes, higher: _Higher, highest: float, without: int = 0) -> _Shapes:
    """Return all branches with the paper's edge up to omega h/c_T = `highest`.

    A0 of the first `without` shapes is omitted. `higher` may be those of more shapes.
    """
    shapes = lowest.k.size
    root = np.hstack((lowest.root[:, None], higher.root[:shapes]))
    strength = np.hstack((lowest.strength[:, None], higher.strength[:shapes]))
    taken = (root <= highest * (1.0 + 1e-12)) & (strength > UNMOVED)
    taken[:, 0] = np.arange(shapes) >= without
    any_taken = np.any(taken, axis=1)
    sizes = np.sum(taken[any_taken], axis=1)
    bends = np.broadcast_to(np.append(True, higher.bends), root.shape)[taken]
    first = np.cumsum(sizes) - sizes
    return _Shapes(lowest.k[any_taken], root[taken], strength[taken], first, bends)


def _held_plate(law: ContactLaw, count: int) -> ModalPlate:
    """Return a plate with a clamped or simply supported edge.

    Its modes exist below the cut-off of their evanescent partner; above it, modes of the paper's
    edge are used. The static deflection by a point force is that of the law, because the compliance
    of the first mode includes the difference between the law and the sum over the modes.
    """
    model, every = law.model, _waves(law.model)
    known, moving = every.k.size, min(count, every.k.size)
    partner = _free(model, max(count, known))
    strength = every.residue * every.weight
    held = _Shapes(every.k, every.root.copy(), strength, np.arange(known), partner.bends[:known])
    own, other = (_modes(model, x).compliance for x in (held, partner))
    lacking = _edge_compliance(law) - float(np.sum(own) - np.sum(other[:known]))
    held.root[0] /= math.sqrt(1.0 + lacking / own[0])
    free, waves = _first(partner, count), _some(every, slice(moving))
    if model.inertia.branches == "all":
        highest = float(free.root[-1])
        higher = _higher(model, partner, highest)
        removed = _modes(model, _branches(partner, higher, highest))
        free = _branches(free, higher, highest, moving)
    else:
        removed = _modes(model, partner)
        free = _first(free, count, moving)
    modes = _modes(model, _joined(_first(held, moving), free), waves)
    if moving == known:
        return ModalPlate(modes, removed, None)
    rest = _first(held, known, moving)
    return ModalPlate(modes, removed, _modes(model, rest, _some(every, slice(moving, known))))


def _first(shapes: _Shapes, end: int, begin: int = 0) -> _Shapes:
    """Return some shapes with one mode each."""
    part = slice(begin, end)
    k, bends = shapes.k[part], shapes.bends[part]
    return _Shapes(k, shapes.root[part], shapes.strength[part], np.arange(k.size), bends)


def _joined(one: _Shapes, other: _Shapes) -> _Shapes:
    """Return the shapes of both, in this order."""
    k, root, strength = (np.concatenate(pair) for pair in zip(one[:3], other[:3], strict=True))
    first = np.concatenate((one.first, one.root.size + other.first))
    return _Shapes(k, root, strength, first, np.concatenate((one.bends, other.bends)))


def _some(waves: "Waves", part: slice) -> "Waves":
    """Return some of the modes of a clamped or simply supported plate."""
    return type(waves)(*(values[part] for values in waves))


def _waves(model: Model) -> "Waves":
    """Return all modes of the edge of a model below the cut-off.

    Raises
    ------
    SceneError
        If the plate is too thick for a bending mode of this edge, or so thin that it has more than
        `MOST_BELOW_CUTOFF`.
    """
    from generated.edge_modes import THICKEST

    if model.eta > THICKEST:
        raise _too_thick(model)
    if _cutoff(model.poissons_ratio) > math.pi * MOST_BELOW_CUTOFF * model.eta:
        raise SceneError(
            f"plate.edge: expected a {model.edge} plate with at most {MOST_BELOW_CUTOFF} bending "
            f"modes below the cut-off frequency, got a radius of {model.b:.3g} m and a thickness "
            f'of {2.0 * model.h:.3g} m; reduce the radius, or set extent = "infinite" in [inertia]'
        )
    modes = _edge_waves(model.edge, model.eta, model.poissons_ratio)
    if not modes.k.size:
        raise _too_thick(model)
    return modes


@lru_cache(maxsize=8)
def _edge_waves(edge: str, eta: float, nu: float) -> "Waves":
    """Return the modes of `_waves`, which depend on edge, h/b and Poisson's ratio alone."""
    from generated.edge_modes import clamped_waves, supported_waves

    count = math.ceil(_cutoff(nu) / (math.pi * eta)) + 1
    run = clamped_waves if edge == CLAMPED else supported_waves
    return run(count, eta, nu)


@lru_cache(maxsize=64)
def _cutoff(nu: float) -> float:
    """Return x = k h above which held plates have no modes of `generated.edge_modes`."""
    from generated.edge_modes import cutoff

    return cutoff(nu)


def _too_thick(model: Model) -> SceneError:
    """Return the error for a plate too thick for bending modes of its edge."""
    return SceneError(
        f"plate.edge: expected a {model.edge} plate with bending modes, thickness up to about 0.8 "
        f"times its radius, got {2.0 * model.h:.3g} m and {model.b:.3g} m; reduce the thickness, "
        'write edge = "paper", or effects.inertia = false'
    )


def _edge_compliance(law: ContactLaw) -> float:
    """Return the static deflection per point force that the edge adds at the axis [m/N]."""
    model = law.model
    edge = kernels.supported_edge if model.edge == SUPPORTED else kernels.clamped_edge
    a = SMALL * min(model.h, model.b)
    contribution = float(edge(np.array([a]), model.h, model.b, model.lam, model.mu)[0])
    # delta = (a^2/R) F and P = (4/3) E* a^3/R with the plate's own E*.
    return 0.75 * contribution / (model.modulus * a)


def sine_less_one(sine: Array, y: Array) -> Array:
    """Return sin(y)/y - 1 from sin(y)."""
    small = np.abs(y) < 0.1
    if not small.any():
        return np.asarray(sine / y - 1.0, dtype=np.float64)
    values = np.asarray(sine / np.where(small, 1.0, y) - 1.0, dtype=np.float64)
    z = y[small] ** 2
    values[small] = -z / 6.0 * (1.0 - z / 20.0 * (1.0 - z / 42.0 * (1.0 - z / 72.0)))
    return values
