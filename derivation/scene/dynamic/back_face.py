"""Stress on the back face of a plate with inertia, on the axis, over time.

During an impact the plate does not bend as under a static load, because the waves that leave the
contact have not reached the edge yet. With q the modes of all wave branches under the computed
contact force, c their static compliances, P_j the forces that drive them and S their stresses per
deflection,

    sigma = static stress(P, a) + sum S_n (q_n - c_n P_j).

If the plate stretches, its forces also drive the modes, and the tension of the middle plane on the
axis is added. Modes that are much faster than the impact are omitted, because they respond
quasi-statically.

Shear waves cross the thickness more slowly than pressure waves, in a nearly incompressible plate
only after many reflections of these. The largest stress may therefore occur after the last
separation.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from derivation.engine.threads import one_thread
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.contact_tables import ContactTables, contact_of
from derivation.scene.dynamic.modal import ModalPlate, Modes, free_modes, plate_of
from derivation.scene.dynamic.mode_count import (
    FEWEST,
    affordable,
    branching,
    coarser,
    finer,
    mode_total,
)
from derivation.scene.dynamic.model_error import echoes_during
from derivation.scene.dynamic.stretching_history import stretching_history
from derivation.scene.dynamic.time_element import A, P
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.dynamic.wave_problem import echo_time
from derivation.scene.model import Model
from generated.arrays import Double as Array

Amplitudes = NDArray[np.complex128]
PHASE, STEPS = 1.0, 200
"""Phase of the fastest mode in a time step, and smallest number of steps in a contact or flight.
The force is linear in each step."""
WORK, MOST = 3e5, 2e6
"""Numbers of modes times steps: up to the first the modes are doubled, above the second halved."""
MODES, ROOM = 10_000, 1.1
"""Number of modes of all branches above which a narrower plate is simulated from whose edge no wave
returns in time; its radius over the smallest such radius."""
AT_ONCE = 2**18
"""Number of values of modes that are computed at once."""
ESTIMATE = 2.0
"""Estimated error over the change since half as many modes."""
TABLE = 1e-6
"""Last coefficients of the tables of forces over the largest one."""
KINDS = "antisymmetric", "symmetric"
RADII = 65
"""Number of radii at which the quasi-static remainder is evaluated."""
SMALL = 1e-9
"""Smallest contact radius over half the thickness at which the stress is evaluated."""


class StressHistory(NamedTuple):
    """Times [s] since first contact, and the stress [Pa] then."""

    times: Array
    stress: Array


class BackFace(NamedTuple):
    """Stress on the axis of the back face: its largest value [Pa] and its history.

    The estimated relative error is that by omitted modes. Stress and error are NaN and there is no
    history if the contact ends before a pressure wave has returned from the back face: finite
    elements do not resolve the stress of such an impact.

    `on_edge` is the error of the edge [1]: only bending modes below their cut-off depend on the
    edge of the scene. It is the relative difference of two stresses under a static load equal to
    the largest force: that of the modes, and that with the edge of the scene. It is 0 if no wave
    returns from the edge.
    """

    stress: float
    error: float
    course: StressHistory | None
    on_edge: float = 0.0


def back_face(motion: DynamicImpact) -> BackFace:
    """Return the largest tensile stress on the axis of the back face.

    The history ends when shear waves from the last contact have crossed the thickness.
    """
    inertia = replace(motion.law.model.inertia, branches="all", modes=0)
    law = replace(motion.law, model=replace(motion.law.model, inertia=inertia))
    if echoes_during(law.model, motion.contact_time) < 1.0:
        return BackFace(math.nan, math.nan, None)
    until = stress_end(motion)
    if mode_total(law, affordable(law)) > MODES and not law.stretches:
        law = _narrower(law, until)
    count = _count(law, until)
    with one_thread(), np.errstate(all="ignore"):
        rough, fine = (_stress_history(motion, law, n) for n in (coarser(count), count))
        returned = until > echo_time(law.model)
        lacking = _static_difference(motion, law, count) if returned else 0.0
    changes = np.abs(fine.stress - np.interp(fine.times, *rough))
    if returned:  # short waves that return from the edge may add a peak at any time
        changes = np.max(changes)
    largest = float(np.max(fine.stress))
    higher = float(np.max(fine.stress + changes)) - largest
    return BackFace(largest, ESTIMATE * higher / abs(largest), fine, lacking / abs(largest))


def stress_end(motion: DynamicImpact) -> float:
    """Return the time [s] since first contact at which shear waves have crossed the thickness.

    For an incomplete impact, it is the time of the last separation.
    """
    model, total = motion.law.model, motion.inertia.total_time
    return total + (2.0 * model.h / model.shear_speed if motion.inertia.complete else 0.0)


def _static_difference(motion: DynamicImpact, law: ContactLaw, count: int) -> float:
    """Return by how much the static stress differs between modes and the edge of the scene [Pa]."""
    a, force = np.array([motion.max_contact_radius]), np.array([motion.max_force])
    waves = _Waves.of(law, count, motion.max_contact_radius)
    return float(np.abs(force * waves.static(a) - law.tensile_stresses(a, force))[0])


def _narrower(law: ContactLaw, time: float) -> ContactLaw:
    """Return the law of a plate that is just so wide that no wave returns from its edge in time."""
    model = law.model
    b = ROOM * model.b * time / echo_time(model)
    return replace(law, model=replace(model, b=b, edge="paper")) if b < model.b else law


def _count(law: ContactLaw, time: float) -> int:
    """Return the number of bending modes."""

    def work(count: int) -> float:
        fastest = float(free_modes(branching(law, "A0").model, count).omega[-1])
        return mode_total(law, count) * time * fastest / PHASE

    count = affordable(law)
    if work(finer(law, count)) <= WORK and mode_total(law, finer(law, count)) <= MODES:
        return finer(law, count)
    while count > FEWEST and work(count) > MOST:
        count = coarser(count)
    return count


def _stress_history(motion: DynamicImpact, law: ContactLaw, count: int) -> StressHistory:
    """Return the stress in all contacts, in the flights between them, and after the last one."""
    waves = _Waves.of(law, count, motion.max_contact_radius)
    z, end, found = np.zeros(waves.decay.size, dtype=complex), 0.0, []
    for touching in motion.inertia.contacts:
        if touching.start > end:
            times = waves.times(end, touching.start)
            stress, z = _flown(motion, waves, z, times)
            found.append((times, stress))
        times, end = waves.times(touching.start, touching.end), touching.end
        rows = motion.rows(times)
        a = np.clip(rows[A], SMALL * law.model.h, waves.widest)
        stress, z = _driven(motion, waves, z, times, a, rows[P])
        found.append((times, stress))
    if stress_end(motion) > end:
        times = waves.times(end, stress_end(motion))
        found.append((times, _flown(motion, waves, z, times)[0]))
    return StressHistory(*map(np.concatenate, zip(*found, strict=True)))


def _flown(
    motion: DynamicImpact, waves: "_Waves", z: Amplitudes, times: Array
) -> tuple[Array, Amplitudes]:
    """Return the stress in free flight, and the amplitudes at its end."""
    if not motion.law.stretches:
        return waves.flown(z, times)
    none = np.zeros_like(times)
    return _driven(motion, waves, z, times, none + SMALL * waves.law.model.h, none)


def _driven(
    motion: DynamicImpact, waves: "_Waves", z: Amplitudes, times: Array, a: Array, force: Array
) -> tuple[Array, Amplitudes]:
    """Return the stress under forces, with that of stretching, and the amplitudes at its end."""
    if not motion.law.stretches:
        return waves.driven(z, times, a, force)
    pull, tension = stretching_history(motion.impact_history, times)
    stress, z = waves.driven(z, times, a, force, pull)
    return stress + tension / (2.0 * waves.law.model.h), z


@dataclass(frozen=True)
class _Waves:
    """The modes of a plate as complex amplitudes z, whose imaginary part is the deflection.

    They obey z' = decay z + P_j. `weights` are their stresses over the imaginary part of z, and
    `widest` is the largest contact radius [m].
    """

    law: ContactLaw
    plate: ModalPlate
    widest: float
    decay: Amplitudes
    weights: Array

    @classmethod
    def of(cls, law: ContactLaw, count: int, widest: float) -> Self:
        """Return the waves of a number of bending modes and of all other branches."""
        plate, ratio = plate_of(law, count), law.damping_ratio
        modes = plate.modes
        turn = complex(-ratio, math.sqrt((1.0 - ratio) * (1.0 + ratio)))
        decay = np.asarray(turn * modes.omega, dtype=np.complex128)
        weights = wave_stresses(law.model, modes) * modes.inverse_modal_mass / decay.imag
        return cls(law, plate, widest, decay, weights)

    def times(self, start: float, end: float) -> Array:
        """Return the times [s] between two others."""
        steps = (end - start) * float(np.max(self.plate.modes.omega)) / PHASE
        return np.linspace(start, end, 1 + max(STEPS, math.ceil(steps)))

    def flown(self, z: Amplitudes, times: Array) -> tuple[Array, Amplitudes]:
        """Return the stress in free flight, and the amplitudes at its end.

        The evenly spaced times are sums of few long and few short steps, so that few exponential
        functions are computed.
        """
        short = math.ceil(math.sqrt(times.size))
        steps = np.arange(short)[:, None] * (times[1] - times[0])
        turned = z * self.weights * np.exp(self.decay * (short * steps))
        stress = (turned @ np.exp(self.decay * steps).T).imag.ravel()[: times.size]
        return stress, z * np.exp(self.decay * (times[-1] - times[0]))

    def driven(
        self, z: Amplitudes, times: Array, a: Array, force: Array, pull: Array | None = None
    ) -> tuple[Array, Amplitudes]:
        """Return the stress in a contact, and the amplitudes at its end.

        Parameters
        ----------
        a, force
            Contact radius [m] and force [N] at the times.
        pull
            Additional forces on the first shapes at the times [N].
        """
        step = float(times[1] - times[0])
        y = self.decay * step
        grown, both = np.exp(y), np.expm1(y) / y
        late = (both - 1.0) / y
        both, late = step * (both - late), step * late
        modes = self.plate.modes
        driving = force[:, None] * self.modal_force_ratios(modes, a)
        if pull is not None:
            shapes = min(pull.shape[1], driving.shape[1])
            driving[:, :shapes] += pull[:, :shapes]
        found = [np.array([z.imag @ self.weights])]
        for part in np.array_split(np.arange(1, times.size), 1 + times.size * z.size // AT_ONCE):
            early, now = (driving[places][:, modes.shape] for places in (part - 1, part))
            moved = both * early + late * now
            for row in moved:
                row += grown * z
                z = row
            found.append(moved.imag @ self.weights)
        return np.concatenate(found) + force * self.remainder(a), z

    def static(self, a: Array) -> Array:
        """Return the stress per force of a static load, under which all modes deflect [Pa/N]."""
        modes = self.plate.modes
        each = wave_stresses(self.law.model, modes) * modes.compliances
        return self.remainder(a) + self.modal_force_ratios(modes, a) @ modes.by_shape(each)

    def remainder(self, a: Array) -> Array:
        """Return the stress of the quasi-static remainder per force at contact radii [Pa/N].

        It is nearly linear in the square of the radius, and interpolated.
        """
        squares, stresses = self._sampled_remainder
        return np.interp(a * a, squares, stresses)

    @cached_property
    def _sampled_remainder(self) -> tuple[Array, Array]:
        """Squares of radii and the stress per force: as in `modal`, that of the paper's edge."""
        squares = self.widest**2 * np.linspace(0.0, 1.0, RADII)
        a = np.maximum(np.sqrt(squares), SMALL * self.law.model.h)
        still = self.law.tensile_stresses(a, np.ones_like(a), on_edge=False)
        for sign, modes in ((-1.0, self.plate.removed), (1.0, self.plate.added)):
            if modes is not None:
                each = wave_stresses(self.law.model, modes) * modes.compliances
                still = still + sign * (self.modal_force_ratios(modes, a) @ modes.by_shape(each))
        return squares, np.asarray(still)

    def modal_force_ratios(self, modes: Modes, a: Array) -> Array:
        """Return the force that drives each shape over the contact force, at radii [m]."""
        if id(modes) not in self._tables:
            rest = self.law.only(lambda e: e.static and not e.other_edge)
            plate = ModalPlate(modes, modes, None)
            self._tables[id(modes)] = contact_of(rest, plate, self.widest, False, TABLE)
        forces = self._tables[id(modes)].forces(a)
        return np.asarray(forces[:, 1:] / forces[:, :1])

    @cached_property
    def _tables(self) -> dict[int, ContactTables]:
        """Tables by the identity of their modes, which have no hash."""
        return {}


def wave_stresses(model: Model, modes: Modes) -> Array:
    """Return the stress of each mode over its deflection [Pa/m]."""
    from generated.wave_stress import mode_stress, wave_stress

    x, frequency = modes.phi[modes.shape] * model.h, modes.omega * (model.h / model.shear_speed)
    kinds = {kind: wave_stress(x, frequency, model.poissons_ratio, kind) for kind in KINDS}
    found = np.where(modes.bends, *kinds.values())
    if modes.held is not None:
        held = mode_stress(modes.held, model.eta, model.poissons_ratio)
        found[: held.size] = held
    return np.asarray(found * (model.mu / model.h))
