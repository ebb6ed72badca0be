"""The contact time of an impact: published formulas, quadrature, and time integration."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from derivation.plate.benchmark.arithmetic import DOUBLE, Arithmetic, Array, Floats
from derivation.plate.benchmark.interface import BenchmarkCase, Call, Doubles, Method
from derivation.plate.benchmark.laws import SeriesLaw
from derivation.plate.benchmark.ready_methods import hertz_time, plate
from generated import contact_law, contact_series
from generated.contact_numbers import REACH
from generated.impact import _parts, _solve, impact
from generated.impact_shapes import time_rate
from generated.perturbation import PrintedMotion, printed_motion
from generated.ranges import product

MODES = 100
"""Number of modes of the divergent sums in the perturbation of the paper."""

LONGEST = 40.0
"""Contact time, relative to Hertz theory, up to which fixed time steps are used."""

MOST_STEPS = 80_000
"""Largest number of steps: twice 1000 steps per Hertz contact time up to LONGEST."""


def linear(modes: int) -> Method:
    """Return the method of the paper's linear term (15); its contact time is independent of v0."""

    def prepare(case: BenchmarkCase, ar: Arithmetic) -> Call:
        """Return pi sqrt(m gamma_2), gamma_2 = R/(4 E*) sum phi^3 K, for any speed."""
        h, b, m, lam, mu = (ar.number(x) for x in (case.h, case.b, case.m, case.lam, case.mu))
        j, slope = ar.zeros(modes)
        factors = (1 + ar.excess(2 * h * j / b)) / (j * slope * slope)
        modulus = 4 * mu * (lam + mu) / (lam + 2 * mu)
        time = ar.pi() * np.sqrt(m * (2 * factors.sum() / (modulus * ar.pi() * b)))
        return lambda v0: 0 * v0 + time

    return Method("impact", "paper's linear term", f"{modes} modes", prepare)


def paper_motion(case: BenchmarkCase, v0: float, *, corrected: bool) -> PrintedMotion:
    """Return the paper's motion in a test case at a speed [m/s]."""
    r = case
    return printed_motion(r.R, r.m, v0, r.h, r.b, r.lam, r.mu, MODES, corrected=corrected)


def perturbation(corrected: bool) -> Method:
    """Return the method of the paper's correction (16): twice the time of the turning point."""
    kind = "corrected" if corrected else "as published"

    def fails(case: BenchmarkCase) -> str:
        # In every test case, because both forms of xi_3 are sums of positive terms.
        fraction = paper_motion(case, case.speed, corrected=corrected).valid_fraction
        return f"(17), (18) not real after {100 * fraction:.4g} % of the time to the turning point"

    def prepare(case: BenchmarkCase, _: Arithmetic) -> Call:
        def one(v0: float) -> float:
            motion = paper_motion(case, v0, corrected=corrected)
            t = np.linspace(0, motion.contact_time / 2, 2001)
            return float(2 * t[int(np.nanargmax(motion.corrected(t)))])

        return lambda v0: np.array([one(float(v)) for v in v0])

    return Method("impact", f"paper's perturbation, {kind}", f"{MODES} modes", prepare,
                  split="units", fails=fails, scalar=True)  # fmt: skip


def gauss(nodes: int) -> Method:
    """Return the method of the generated integrand with another number of nodes."""

    def prepare(case: BenchmarkCase, ar: Arithmetic) -> Call:
        if ar is not DOUBLE:
            return SeriesLaw(case, ar).duration(nodes, ar)
        x, w = np.polynomial.legendre.leggauss(nodes)
        x, w, r = (1 + x) / 2, w / 2, case
        R, m, h, b, lam, mu = (np.asarray(y, float) for y in (r.R, r.m, r.h, r.b, r.lam, r.mu))

        def call(v0: Array) -> Array:
            with np.errstate(all="ignore"):  # as in `impact`
                extreme, _, depth, _, _ = _solve(R, m, v0, h, b, lam, mu)
                integral = np.empty_like(extreme.A)
                for part in _parts(extreme.A.size):
                    at = np.broadcast_to(x, (extreme.A[part].size, nodes))
                    integral[part] = (time_rate(at, extreme, part) * w).sum(axis=1)
                return product((2.0, *depth, integral), (v0,))

        return call

    return Method("impact", "Gauss-Legendre", f"{nodes} nodes", prepare)


# --- steps


def scalar_force(case: BenchmarkCase) -> Callable[[float], float]:
    """Return a function that computes the force [N] at one indentation [m] in plain Python.

    Newton's iteration for a/h starts from the last contact radius found, because steps are
    small.
    """
    plates = contact_series.plates_of(np.array([case.eta]))
    pieces = [(plates.first, float(plates.reach[0]))]
    if case.eta < 1 / REACH:
        pieces.append((contact_series.far_piece(plates.eta), float(plates.far[0])))
    rows = [
        (p.coefficients[::-1, 0].tolist(), float(p.middle[0]), 1 / float(p.half[0]), end)
        for p, end in pieces
    ]
    stiff = 4 * case.modulus * case.h**3 / (3 * case.R)
    last = 0.0

    def correction(A: float) -> tuple[float, float]:
        """Return F and A F'."""
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
        target = delta * case.R / case.h**2
        # Hertz's radius may lie beyond the end of the polynomials.
        A = last or min(math.sqrt(target), rows[-1][3])
        for _ in range(60):
            F, rise = correction(A)
            step = (A * A * (1 + F) - target) / (A * (2 * (1 + F) + rise))
            A = min(max(A - step, 0.3 * A), rows[-1][3])
            if abs(step) < 1e-15 * A:
                break
        last = A
        return stiff * A**3

    return force


def solver(name: str, rtol: float, largest_step: float | None = None, quick: bool = True) -> Method:
    """Return the method of SciPy's solve_ivp up to the turning point.

    `largest_step` is the largest time step over the contact time by Hertz's law; None is no limit.
    """
    limited = "" if largest_step is None else f", steps below T/{1 / largest_step:g}"

    def one(case: BenchmarkCase, v0: float) -> float:
        from scipy.integrate import solve_ivp

        r, force = case, scalar_force(case)
        time = float(impact(r.R, r.m, v0, r.h, r.b, r.lam, r.mu).contact_time)

        def rate(t: float, state: Doubles) -> tuple[float, float]:  # noqa: ARG001
            return state[1], -force(state[0]) / r.m

        def top(t: float, state: Doubles) -> float:  # noqa: ARG001
            return float(state[1])

        top.terminal = True  # type: ignore[attr-defined]
        solution = solve_ivp(
            rate, (0, 2 * time), (0.0, v0), method=name, rtol=rtol, events=top,
            atol=(1e-3 * rtol * v0 * time, 1e-3 * rtol * v0),
            max_step=np.inf if largest_step is None else largest_step * time,
        )  # fmt: skip
        return 2 * float(solution.t_events[0][0]) if solution.t_events[0].size else math.nan

    def prepare(case: BenchmarkCase, _: Arithmetic) -> Call:
        return lambda v0: np.array([one(case, float(v)) for v in v0])

    return Method("impact", f"solve_ivp {name}{limited}", f"rtol {rtol:g}", prepare,
                  split="units", scalar=True, quick=quick)  # fmt: skip


def verlet(steps: int, quick: bool = True, ar: Floats = DOUBLE) -> Method:
    """Return the method of velocity Verlet with the fixed step of Hertz's contact time/`steps`.

    All speeds advance together; the end is interpolated linearly in the last step.
    """

    def fails(case: BenchmarkCase) -> str | None:
        r = case
        time = impact(r.R, r.m, r.speed, r.h, r.b, r.lam, r.mu).contact_time
        longer = float(time / hertz_time(r, DOUBLE)(r.speed))
        if longer < LONGEST:
            return None
        return f"contact lasts {longer:.3g} times as long as Hertz's, which determines the step"

    def prepare(case: BenchmarkCase, _: Arithmetic) -> Call:
        free, others = hertz_time(case, ar), plate(case, ar)

        def force(delta: Any) -> Any:
            return contact_law.force(delta, *others)

        return lambda v0: _verlet(v0, free(v0) / steps, ar.number(case.m), force)

    return Method("impact", "velocity Verlet", f"Hertz's time/{steps}", prepare, ar, "units",
                  fails, quick=quick)  # fmt: skip


def _verlet(v0: Array, dt: Array, m: Any, force: Callable[[Array], Array]) -> Array:
    """Return contact times for speeds; NaN for contacts that last longer than MOST_STEPS."""
    v, x, acceleration, ended = v0, 0 * v0, 0 * v0, 0 * v0
    touching = np.ones(v0.shape, bool)
    for step in range(MOST_STEPS):
        ahead = x + dt * v + dt * dt * acceleration / 2
        pressed = ahead > 0
        load = np.where(pressed, force(np.where(pressed, ahead, dt * v0)), 0 * v0)
        v = v - dt * (load / m - acceleration) / 2
        over = touching & ~pressed
        fraction = x / np.where(over, x - ahead, 1)
        ended = np.where(over, dt * (step + fraction), ended)
        touching = touching & pressed
        x, acceleration = ahead, -load / m
        if not touching.any():
            return ended
    return np.where(touching, math.nan, ended)
