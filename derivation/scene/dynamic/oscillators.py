"""Free motion of plate modes and their response to a force, with or without damping.

With the damping ratio zeta, root^2 = 1 - zeta^2 and c, s the cosine and sine of root omega t,

    free motion          q(t) = q_0 + t q_0' + t q_0' by_rate - q_0 by_q,
                         q'(t) = q_0' cos - omega q_0 sin,
    impulse at time u    omega q(t) = moved_sin(t) drive_cos(u) - moved_cos(t) drive_sin(u),
                         q'(t) = rate_cos(t) drive_cos(u) + rate_sin(t) drive_sin(u).

Without damping all factors follow from c and s, each of which is computed once. With damping
`generated.damping_kernels` computes them.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Self

import numpy as np

from derivation.scene.dynamic.modal import sine_less_one
from generated.arrays import Double as Array

SMALL = 0.5
"""Phase below which the free motion cannot be computed from the response without cancellation."""


@dataclass(frozen=True)
class FreeMotion:
    """Factors of the free motion at phases omega t (see above), each computed at its first use.

    They have no cancellation at small phases.
    """

    phase: Array
    damping_ratio: float

    @cached_property
    def by_q(self) -> Array:
        """1 - q/q_0 after an initial displacement [1]."""
        return -self._damped[0] if self.damping_ratio else self._turned[0]

    @cached_property
    def by_rate(self) -> Array:
        """q/(t q_0') - 1 after an initial velocity [1]."""
        if self.damping_ratio:
            return self._damped[1]
        return sine_less_one(self.sin, self.phase)

    @cached_property
    def sin(self) -> Array:
        """omega q/q_0' after an initial velocity; -q'/(omega q_0) after a displacement [1]."""
        return -self._damped[2] if self.damping_ratio else self._turned[1]

    @cached_property
    def cos(self) -> Array:
        """q'/q_0' after an initial velocity [1]."""
        return self._damped[3] if self.damping_ratio else 1.0 - self._turned[0]

    @cached_property
    def _turned(self) -> tuple[Array, Array]:
        """1 - cos and sin of the phase [1]."""
        return versed_and_sine(self.phase / 2.0)

    @cached_property
    def _damped(self) -> tuple[Array, Array, Array, Array]:
        from generated.damping_kernels import free_motion

        return free_motion(self.phase, np.asarray(self.damping_ratio))


def versed_and_sine(half: Array) -> tuple[Array, Array]:
    """Return 1 - cos and sin of angles, given half of each; both to a few ULP.

    Both follow from the tangent, which NumPy may compute several times as fast as the sine.
    """
    t = np.tan(half)
    sine = 2.0 * t / (1.0 + t * t)
    return t * sine, sine


class Response(NamedTuple):
    """Factors of the response to an impulse (see above), shape (times, 2, modes).

    `moved` contains moved_sin and -moved_cos; `rate` and `drive` contain their cosine and sine.
    """

    moved: Array
    rate: Array
    drive: Array

    @classmethod
    def empty(cls, shape: tuple[int, int], damping_ratio: float) -> Self:
        """Return factors without values; without damping `rate` and `drive` share memory."""
        times, oscillators = shape
        moved, *others = np.empty((3 if damping_ratio else 2, times, 2, oscillators))
        return cls(moved, others[0], others[-1])

    def of(self, part: slice) -> Self:
        """Return views of the factors of some modes."""
        return type(self)(*(values[..., part] for values in self))


def response_at(
    since: Array, omega: Array, damping_ratio: float, response: Response, part: slice
) -> tuple[Array, Array]:
    """Fill in the response of some modes at times; return `by_q` and `by_rate` at them."""
    of = response.of(part)
    if damping_ratio:
        from generated.damping_kernels import free_by_response, free_motion
        from generated.damping_kernels import response as damped

        phase, zeta = np.multiply.outer(since, omega), np.asarray(damping_ratio)
        factors = damped(phase, zeta)
        rows = (values[:, k] for values in of for k in range(2))
        for row, values in zip(rows, factors, strict=True):
            row[:] = values
        np.negative(of.moved[:, 1], out=of.moved[:, 1])
        moved, by_rate = free_by_response(phase, zeta, factors[0], factors[2])
        small = phase < SMALL
        moved[small], by_rate[small] = free_motion(phase[small], zeta)[:2]
        return np.negative(moved, out=moved), by_rate
    half = np.multiply.outer(since, 0.5 * omega)
    versed, sine = versed_and_sine(half)
    of.drive[:, 0], of.drive[:, 1] = 1.0 - versed, sine
    of.moved[:, 0], of.moved[:, 1] = sine, versed - 1.0
    return versed, sine_less_one(sine, 2.0 * half)
