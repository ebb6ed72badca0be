"""The contact time of an impact by steps: SciPy's solvers, and velocity Verlet."""

import math
from collections.abc import Callable
from functools import cache
from typing import Any

import flint
import numpy as np
from flint import arb

from derivation.plate.benchmark.arithmetic import HAS_LONG, LONG, Array
from derivation.plate.benchmark.by_series import LONG_NUMBERS
from derivation.plate.benchmark.collocation import radau_step
from derivation.plate.benchmark.interface import Call, Doubles, Method, Regime
from derivation.plate.benchmark.law_sums import wrapped
from derivation.plate.benchmark.motion import hertz_time
from derivation.plate.benchmark.reference_law import sure_law
from derivation.plate.benchmark.replay import Step, dop853_step, turning_time
from generated import contact_law, contact_series
from generated.contact_numbers import REACH
from generated.impact import impact

LONGEST = 40.0
"""Contact times over Hertz's up to which fixed steps of his time are tried."""

MOST_STEPS = 80_000
"""Enough for 1000 steps of the longest of these, twice over."""

SAME_STEPS = 20_000 if HAS_LONG else 1500
"""Steps at most without rounding: in long doubles each takes up to a millisecond, else many."""


def scalar_force(regime: Regime) -> Callable[[float], float]:
    """Force over indentation for one number, fast in plain Python: Newton's iteration for a/h.

    It starts from the last contact radius found, as steps are small.
    """
    plates = contact_series.plates_of(np.array([regime.eta]))
    pieces = [(plates.first, float(plates.reach[0]))]
    if regime.eta < 1 / REACH:
        pieces.append((contact_series.far_piece(plates.eta), float(plates.far[0])))
    rows = [
        (p.coefficients[::-1, 0].tolist(), float(p.middle[0]), 1 / float(p.half[0]), end)
        for p, end in pieces
    ]
    stiff = 4 * regime.modulus * regime.h**3 / (3 * regime.R)
    last = 0.0

    def share(A: float) -> tuple[float, float]:
        """F and A F'."""
        row, middle, inverse, _ = next((r for r in rows if r[3] >= A), rows[-1])
        t = (A * A - middle) * inverse
        value, slope = 0.0, 0.0
        for coefficient in row:
            slope = slope * t + value
            value = value * t + coefficient
        return A * value, A * (value + 2 * A * A * inverse * slope)

    def force(delta: float) -> float:
        nonlocal last
        if delta <= 0:
            return 0.0
        target = delta * regime.R / regime.h**2
        # Hertz's radius may lie beyond the polynomials' end, where they mean nothing.
        A = last or min(math.sqrt(target), rows[-1][3])
        for _ in range(60):
            F, rise = share(A)
            step = (A * A * (1 + F) - target) / (A * (2 * (1 + F) + rise))
            A = min(max(A - step, 0.3 * A), rows[-1][3])
            if abs(step) < 1e-15 * A:
                break
        last = A
        return stiff * A**3

    return force


REPEATED: dict[str, Step] = {"DOP853": dop853_step, "Radau": radau_step}
"""Solvers whose steps are taken again. LSODA's orders and past steps stay in compiled code."""

REMARKS = {
    "DOP853": "the search of the turning point, which ends within 9e-16 seconds, counts as "
    "rounding",
    "Radau": "what its Newton iteration leaves of the stages' equations counts as rounding, and "
    "so does the search of the turning point, which ends within 9e-16 seconds",
    "LSODA": "an estimate: rounding is the spread of runs in other units of length and of time, "
    "which change nothing but rounding, and by it the choice of steps",
}
"""What is to be said of a solver's split."""

RUNS, SEED = 8, 5
"""Runs in other units, and the seed of these."""

Units = tuple[float, float]


def solver(name: str, rtol: float, share: float | None = None, quick: bool = True) -> Method:
    """SciPy's solve_ivp up to the turning point; `share` of the contact bounds its steps.

    Steps are repeated in long doubles (`replay`) where that is possible. Of LSODA the result
    without rounding is estimated, as a ball: mean and deviation of runs in random units of
    length and time. In exact arithmetic they would take the same steps to the same result, for
    tolerances go with the units; what is rounded where differs in each, inside the solver
    too (stochastic arithmetic after Vignes, 1993).
    """
    limited = "" if share is None else f", steps below T/{1 / share:g}"

    def prepare(regime: Regime) -> Call:
        def one(v0: float) -> float:
            found = solved(regime, v0)
            return 2 * float(found.t_events[0][0]) if found.t_events[0].size else math.nan

        return lambda v0: np.array([one(float(v)) for v in np.atleast_1d(v0)])

    def solved(regime: Regime, v0: float, dense: bool = False, units: Units | None = None) -> Any:
        from scipy.integrate import solve_ivp

        r = regime
        force = scalar_force(regime)
        time = float(impact(r.R, r.m, v0, r.h, r.b, r.lam, r.mu).contact_time)
        if units is not None:
            force, v0, time = _in_units(force, v0, time, units)
        depth = v0 * time

        def rate(t: float, state: Doubles) -> tuple[float, float]:  # noqa: ARG001
            return state[1], -force(state[0]) / r.m

        def top(t: float, state: Doubles) -> float:  # noqa: ARG001
            return float(state[1])

        top.terminal = True  # type: ignore[attr-defined]
        return solve_ivp(
            rate, (0, 2 * time), (0.0, v0), method=name, rtol=rtol,
            atol=(1e-3 * rtol * depth, 1e-3 * rtol * v0), events=top, dense_output=dense,
            max_step=np.inf if share is None else share * time,
        )  # fmt: skip

    def met(found: Any) -> float:
        if not found.t_events[0].size:
            raise NotImplementedError("it steps over the whole contact")
        return float(found.t_events[0][0])

    def same(regime: Regime) -> Call:
        def one(v0: float) -> Any:
            found = solved(regime, v0, dense=True)
            met(found)
            pieces = found.sol.interpolants
            ends = (*(piece.t_old for piece in pieces), pieces[-1].t)
            return 2 * _repeated(regime, name, v0, ends)

        return lambda v0: [one(float(v)) for v in v0]

    def estimated(regime: Regime) -> Call:
        def one(v0: float) -> arb:
            draws = np.random.default_rng(SEED).uniform(1, 2, (RUNS, 2)).tolist()
            times = [2 * met(solved(regime, v0, units=(L, T))) for L, T in draws]
            with flint.ctx.workprec(128):
                return spread([arb(T) * t for (_, T), t in zip(draws, times, strict=True)])

        return lambda v0: [one(float(v)) for v in v0]

    return Method(
        "impact", f"solve_ivp {name}{limited}", f"rtol {rtol:g}", prepare,
        same=same if name in REPEATED else estimated, one_by_one=True, quick=quick,
        remark=REMARKS.get(name),
    )  # fmt: skip


def _in_units(
    force: Callable[[float], float], v0: float, time: float, units: Units
) -> tuple[Callable[[float], float], float, float]:
    """A force, a speed and a time where lengths and times are counted in other units [m, s]."""
    length, span = units
    scale = span * span / length
    return lambda x: force(length * x) * scale, v0 * span / length, time / span


def spread(values: list[arb]) -> arb:
    """Mean of some values, and the standard deviation of one of them as its radius."""
    mean = sum(values, arb(0)) / len(values)
    square = sum(((x - mean) ** 2 for x in values), arb(0)) / (len(values) - 1)
    return mean + arb(0, square.sqrt().abs_upper())


@cache
def _repeated(regime: Regime, name: str, v0: float, ends: tuple[float, ...]) -> Any:
    """The turning point by a solver's steps between given times, in long doubles [s].

    Runs whose bound on the steps never counts have the same ones: kept, they are repeated once.
    """
    if not HAS_LONG:
        raise NotImplementedError("the platform's long double is no longer than double")
    force = sure_law(regime, LONG).force
    try:
        found = turning_time(REPEATED[name], v0, regime.m, ends, force)
    except ArithmeticError as reason:
        raise NotImplementedError(str(reason)) from reason
    if np.isnan(found):
        raise NotImplementedError("in long doubles the sphere does not stop in the last step")
    return found


def verlet(
    steps: int, quick: bool = True, dtype: type[np.float32 | np.float64] = np.float64
) -> Method:
    """Velocity Verlet as particle codes use it: a fixed step, Hertz's contact time over `steps`.

    All speeds advance together; the end is interpolated linearly in the last step.
    """

    def fails(regime: Regime) -> str | None:
        longer = _longer(regime)
        if longer < LONGEST:
            return None
        return f"contact lasts {longer:.3g} times as long as Hertz's, whose time sets the step"

    def prepare(regime: Regime) -> Call:
        r, free = regime, hertz_time(regime)
        others = [dtype(x) for x in (r.R, r.h, r.b, r.lam, r.mu)]

        def force(delta: Array) -> Array:
            return contact_law.force(delta, *others)

        return lambda v0: _verlet(v0.astype(dtype), free(v0.astype(dtype)) / steps, r.m, force)

    def same(regime: Regime) -> Call:
        count, free = steps * _longer(regime), hertz_time(regime)
        if count > SAME_STEPS:
            raise NotImplementedError("so many steps in longer numbers would take minutes")
        numbers = LONG if HAS_LONG else LONG_NUMBERS
        law = sure_law(regime, numbers)
        return wrapped(numbers, lambda v0: _verlet(v0, free(v0) / steps, law.m, law.force))

    return Method(
        "impact", "velocity Verlet", f"Hertz's time/{steps}", prepare, np.dtype(dtype).name, same,
        fails=fails, quick=quick,
    )  # fmt: skip


def _longer(regime: Regime) -> float:
    """Contact time over Hertz's."""
    r = regime
    time = impact(r.R, r.m, r.speed, r.h, r.b, r.lam, r.mu).contact_time
    return float(time / hertz_time(regime)(r.speed))


def _verlet(v0: Array, dt: Array, m: Any, force: Callable[[Array], Array]) -> Array:
    """Contact times for speeds; those still open when steps run out are NaN."""
    v, x, acceleration, ended = v0, 0 * v0, 0 * v0, 0 * v0
    touching = np.ones(v0.shape, bool)
    for step in range(MOST_STEPS):
        ahead = x + dt * v + dt * dt * acceleration / 2
        pressed = ahead > 0
        load = np.where(pressed, force(np.where(pressed, ahead, dt * v0)), 0 * v0)
        v = v - dt * (load / m - acceleration) / 2
        over = touching & ~pressed
        share = x / np.where(over, x - ahead, 1)
        ended = np.where(over, dt * (step + share), ended)
        touching = touching & pressed
        x, acceleration = ahead, -load / m
        if not touching.any():
            return ended
    return np.where(touching, math.nan, ended)
