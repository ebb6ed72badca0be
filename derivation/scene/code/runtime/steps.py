"""Extrapolated midpoint steps, and extrema and zeros of their Chebyshev series."""

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebroots, chebval

from derivation.scene.code.runtime.viscous_motion import _rates

_ORDER, _TOLERANCE, _MOST = (
    16,
    1e-13,
    2000,
)  # order of a step; relative tolerance; largest number of steps
_TIMES = 0.5 - 0.5 * np.cos(np.pi * np.arange(_ORDER + 1) / _ORDER)


def _extrapolated(state: np.ndarray, tau: np.ndarray, unit: float) -> tuple[np.ndarray, np.ndarray]:
    """Return states after steps tau and their errors, by the midpoint rule extrapolated to 0."""
    last: list[np.ndarray] = []
    for n in range(2, _ORDER + 1, 2):
        step = tau / n
        before, now = state, state + step * _rates(state, unit)
        for _ in range(n - 1):
            before, now = now, before + 2.0 * step * _rates(now, unit)
        row = [0.5 * (before + now + step * _rates(now, unit))]
        for j, older in enumerate(last, 1):
            row.append(row[-1] + (row[-1] - older) / ((n / (n - 2 * j)) ** 2 - 1.0))
        last = row
    return last[-1], last[-1] - last[-2]


def _largest(series: np.ndarray) -> float:
    """Return the largest value of a Chebyshev series, at an end or at a zero of its slope."""
    roots = chebroots(chebder(series))
    inner = roots.real[(np.abs(roots.imag) < 1e-9) & (np.abs(roots.real) < 1.0)]
    return float(np.max(chebval(np.concatenate(([-1.0, 1.0], inner)), series)))


def _end(series: np.ndarray) -> float:
    """Return the zero of a decreasing Chebyshev series, by bisection."""
    low, high = -1.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if chebval(middle, series) > 0.0 else (low, middle)
    return low
