"""Accuracy against run time with plate inertia: integrators, modes, branches, tolerance.

All methods simulate one scene, an impact for which every method is feasible. Integrators use the
same modes and are compared with a Runge-Kutta method of tolerance `FINEST`. Numbers of modes of the
branch A0 are compared with the largest number; all branches and tolerances are compared with the
largest number of modes of all branches.
"""

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

from derivation.engine.activity import Progress, quiet
from derivation.engine.files import measurements, write_file
from derivation.engine.measure.clock import Candidate, interleaved
from derivation.engine.measure.record import provenance
from derivation.engine.outputs import recorded_in, sorted_json
from derivation.engine.threads import one_thread
from derivation.plate.benchmark.speed import machine
from derivation.plate.judge import PACKAGE
from derivation.scene.dynamic import contact_sequence, waves
from derivation.scene.dynamic.contact_tables import ContactSamples
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.dynamic.time_element import P
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.impact import selected_effects, simulate
from derivation.scene.scene import OUTPUTS, Scene, read
from generated.arrays import Double as Array

MEASURED: Path = measurements() / "moving.json"
SCENE: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.01, "material": "steel"},
    "plate": {"radius": 0.15, "thickness": 0.012, "material": "aluminium"},
    "impact": {"speed": 2.0},
    "effects": {"non_hertzian_pressure": False},
}
"""A steel sphere on an aluminium plate with the paper's edge."""
COMPARED_MODES, FINEST = 40, 1e-13
"""Number of modes of all integrators, and tolerance of the reference Runge-Kutta method."""
NODES, TOLERANCES = (6, 8, 10, 12, 16), (1e-3, 1e-5, 1e-7, 1e-9, 1e-11)
"""Nodes of a time element, at the program's tolerance; and tolerances, with 16 nodes."""
STEPS, RUNGE_KUTTA_RTOL = (8, 10, 12), (1e-3, 1e-5, 1e-7, 1e-9, 1e-11)
"""Binary logarithms of the number of Verlet steps; tolerances of the Runge-Kutta method."""
MODES, MOST_MODES = (5, 10, 20, 40, 80, 160), 320
ALL, MOST_ALL = (5, 10, 20, 40, 80), 160
REQUESTED_RTOL = ((1e-2, "A0"), (5e-3, "A0"), (1e-3, "all"), (3e-4, "all"))
ROUNDS = 5
SEPARATION_START = 0.1
"""Square root of the time from which separation is detected, in the units of the problem."""
PEAK_SAMPLES = 200
"""Number of times at which the force is sampled to locate its peak."""
PEAK_TOLERANCE = 1e-8
"""Tolerance of the time of the peak force, on which the force depends weakly."""
Numbers = tuple[float, ...]


class CostOutcome(NamedTuple):
    """Results, number of modes, and the stated error bound, if there is one."""

    numbers: Numbers
    modes: int
    bound: float | None = None


@dataclass(frozen=True)
class Trial:
    """A method at a setting, before it is timed.

    Attributes
    ----------
    study
        `integrator`, `modes`, `branches` or `rtol`.
    method, setting
        Method, and its parameter.
    call
        Function that simulates the scene.
    reference, names
        Function that returns the reference results, and their names; for integrators, the results
        of the first contact.
    """

    study: str
    method: str
    setting: float
    call: Callable[[], CostOutcome]
    reference: Callable[[], Numbers]
    names: Sequence[str]


COLUMNS = ("study", "method", "#modes", "#CPU time [ms]", "#largest error")
FIRST = ("contact_time", "max_force", "restitution")
"""Results of the first contact; the restitution refers to the speed after it."""


def measure(progress: Progress = quiet) -> dict[str, Any]:
    """Measure every row; return the rows with scene, machine and load as plain data.

    Run times are processor times of a simulation [s], measured in interleaved rounds; errors are
    relative [1].
    """
    trials = [*integrators(), *modes(), *branches(), *tolerances()]
    before, rows = os.getloadavg()[0], list[tuple[Trial, CostOutcome, dict[str, float]]]()
    for number, trial in enumerate(trials, start=1):
        progress(f"{trial.study}: {trial.method}", number, len(trials) + 1)
        outcome = trial.call()
        pairs = zip(trial.names, outcome.numbers, trial.reference(), strict=True)
        rows.append((trial, outcome, {n: abs(x / true - 1.0) for n, x, true in pairs}))
    progress("times", len(trials) + 1, len(trials) + 1)
    nothing = np.zeros(1)
    candidates = [Candidate(_timed(trial), nothing, 1) for trial in trials]
    with one_thread():  # like a simulation
        timings, spread = interleaved(candidates, ROUNDS)
    return {
        "provenance": provenance(16, PACKAGE),
        "machine": dict(machine()),
        "run": {"load_before": before, "load_after": os.getloadavg()[0], "spread": spread},
        "scene": SCENE,
        "reference": {"tolerance": FINEST, "modes": MOST_MODES, "modes of all branches": MOST_ALL},
        "rows": [
            {
                "study": t.study,
                "method": t.method,
                "setting": t.setting,
                "modes": out.modes,
                "seconds": spent.seconds,
                "errors": errors,
                "bound": out.bound,
            }
            for (t, out, errors), spent in zip(rows, timings, strict=True)
        ],
    }


def record(
    out: Path | None = None, progress: Progress = quiet, committed: bool = False
) -> tuple[dict[str, Any], Path | None]:
    """Measure, and write the result to a file or as the committed measurement.

    Returns
    -------
    dict, Path or None
        The result as plain data, and the file to which it was written.

    Raises
    ------
    ValueError
        If both `out` and `committed` are given, or the package is not a checkout.
    OSError
        If the file cannot be written.
    """
    path = recorded_in(MEASURED, committed, out)
    data = measure(progress)
    if path is not None:
        write_file(path, sorted_json(data))
    return data, path


def cells(data: dict[str, Any]) -> list[tuple[str, ...]]:
    """Return the rows of the table, as text."""
    return [
        (
            row["study"],
            f"{row['method']} {row['setting']:g}",
            str(row["modes"]),
            f"{1e3 * row['seconds']:.3g}",
            f"{max(row['errors'].values()):.1e}",
        )
        for row in data["rows"]
    ]


def _timed(trial: Trial) -> Callable[[Array], object]:
    """Return the call to be timed, without cached results."""

    def run(_: Array) -> object:
        waves.impact.cache_clear()
        return trial.call()

    return run


# --- integrators


def integrators() -> list[Trial]:
    """Return the trials for the first contact: time elements, Runge-Kutta, fixed steps."""
    reference = cache(lambda: by_runge_kutta(FINEST).numbers)
    settings: list[tuple[str, float, Callable[[], CostOutcome]]] = [
        ("elements, nodes", n, partial(by_time_elements, n, contact_sequence.TOLERANCE))
        for n in NODES
    ]
    settings += [("elements, tolerance", t, partial(by_time_elements, 16, t)) for t in TOLERANCES]
    settings += [("DOP853", t, partial(by_runge_kutta, t)) for t in RUNGE_KUTTA_RTOL]
    settings += [("velocity Verlet", 2**k, partial(by_verlet, 2**k)) for k in STEPS]
    return [Trial("integrator", name, x, call, reference, FIRST) for name, x, call in settings]


def by_time_elements(n: int, tolerance: float) -> CostOutcome:
    """Compute the first contact by time elements with n nodes."""
    problem = _problem()
    run = contact_sequence.contact(problem, n, problem.begin(), 0.0, 0.0, tolerance)
    peak = max(piece.element.largest(P) for piece in run.pieces)
    return CostOutcome((run.end, peak, -run.after.velocity), COMPARED_MODES)


def by_runge_kutta(rtol: float) -> CostOutcome:
    """Compute the first contact by SciPy's DOP853 in the square root of time.

    As a function of the square root, the motion is smooth at first contact.
    """
    problem = _problem()
    motion = _Motion(problem)

    def rate(s: float, state: Array) -> Array:
        return 2.0 * s * motion.rate(state)

    def indentation(s: float, state: Array) -> float:
        return motion.local_indentation(state) if s > SEPARATION_START else 1.0

    indentation.terminal, indentation.direction = True, -1  # type: ignore[attr-defined]
    solution = solve_ivp(
        rate, (0.0, 2.0), motion.begin(), "DOP853", events=indentation, rtol=rtol, atol=1e-3 * rtol,
        dense_output=True,
    )  # fmt: skip
    end = float(solution.t_events[0][0])

    def force(s: float) -> float:
        return motion.force(solution.sol(s))

    nearest_sample = max(np.linspace(0.0, end, PEAK_SAMPLES).tolist(), key=force)
    around = nearest_sample - end / PEAK_SAMPLES, nearest_sample + end / PEAK_SAMPLES
    near_enough = {"xatol": PEAK_TOLERANCE * end}
    top = minimize_scalar(lambda s: -force(s), bounds=around, method="bounded", options=near_enough)
    return CostOutcome((end * end, -float(top.fun), -float(solution.y[1, -1])), COMPARED_MODES)


def by_verlet(steps: int) -> CostOutcome:
    """Compute the first contact by velocity Verlet.

    `steps` is their number in the contact time on a plate that does not deflect.
    """
    motion = _Motion(_problem())
    state, dt = motion.begin(), 1.0 / steps
    half, times, forces = motion.accelerations(state), [0.0], [0.0]
    while True:
        before = motion.local_indentation(state)
        velocity = state[1::2] + 0.5 * dt * half
        state[::2] += dt * velocity
        after = motion.local_indentation(state)
        if after <= 0.0 and len(times) > 2:
            break
        half = motion.accelerations(state)
        state[1::2] = velocity + 0.5 * dt * half
        times.append(times[-1] + dt)
        forces.append(motion.force(state))
    end = times[-1] + dt * before / (before - after)
    peak = _peak(np.array(times), np.array(forces))
    return CostOutcome((end, peak, -float(velocity[0])), COMPARED_MODES)


def _peak(t: Array, force: Array) -> float:
    """Return the maximum of a parabola through the largest force and its neighbours."""
    k = min(max(int(np.argmax(force)), 1), force.size - 2)
    parabola = np.polynomial.Polynomial.fit(t[k - 1 : k + 2], force[k - 1 : k + 2], 2)
    return max(float(parabola(top)) for top in (*parabola.deriv().roots().real, t[k]))


class _Motion:
    """The equations of motion: state z, z', q_1, q_1', ... in the units of the problem."""

    def __init__(self, problem: DynamicProblem) -> None:
        self.problem, self.radius = problem, 1e-3

    def begin(self) -> Array:
        """Return the state at first contact."""
        state = np.zeros(2 + 2 * self.problem.omega.size)
        state[1] = 1.0
        return state

    def local_indentation(self, state: Array) -> float:
        """Return the local indentation: displacement of the sphere minus that of the plate."""
        return float(state[0] - np.sum(state[2::2]))

    def rate(self, state: Array) -> Array:
        """Return velocities and accelerations."""
        rates = np.empty_like(state)
        rates[::2], rates[1::2] = state[1::2], self.accelerations(state)
        return rates

    def accelerations(self, state: Array) -> Array:
        """Return the accelerations of the sphere and the modes."""
        problem, q = self.problem, state[2::2]
        own = -(problem.omega**2) * q
        if self.local_indentation(state) <= 0.0:
            return np.concatenate(([0.0], own))
        at, unit = self._touching(state), problem.force
        return np.concatenate(
            (-at.force / unit, own + problem.inverse_modal_mass * at.modal_forces[0] / unit)
        )

    def force(self, state: Array) -> float:
        """Return the contact force."""
        if self.local_indentation(state) <= 0.0:
            return 0.0
        return float(self._touching(state).force[0]) / self.problem.force

    def _touching(self, state: Array) -> ContactSamples:
        """Return the contact with the local indentation of a state, by Newton's method."""
        problem, q, deep = self.problem, state[2::2], self.local_indentation(state)
        a = self.radius
        for _ in range(50):
            at = problem.contact.at(np.array([problem.a * a]))
            depth = at.depth[0] / problem.depth + at.weights_less_one[0] @ q
            slope = problem.a * (at.depth_a[0] / problem.depth + at.less_a[0] @ q)
            step = (depth - deep) / slope
            a = min(max(a - step, 0.1 * a), problem.contact.top / problem.a)
            if abs(step) <= 1e-14 * a:
                break
        self.radius = float(a)
        return at


# --- modes, branches, tolerance


def modes() -> list[Trial]:
    """Return the trials for numbers of modes of A0, compared with the largest number."""
    reference = cache(lambda: _simulated(modes=MOST_MODES).numbers)
    return [
        Trial("modes", "A0", n, partial(_simulated, modes=n), reference, OUTPUTS) for n in MODES
    ]


def branches() -> list[Trial]:
    """Return the trials for numbers of modes of all branches, and one with A0 only."""
    reference = cache(lambda: _simulated(modes=MOST_ALL, branches="all").numbers)
    trials = [
        Trial(
            "branches", "all", n, partial(_simulated, modes=n, branches="all"), reference, OUTPUTS
        )
        for n in ALL
    ]
    alone = partial(_simulated, modes=ALL[-1])
    return [*trials, Trial("branches", "A0", ALL[-1], alone, reference, OUTPUTS)]


def tolerances() -> list[Trial]:
    """Return the trials for tolerances; the two smallest ones are met with all branches."""
    reference = cache(lambda: _simulated(modes=MOST_ALL, branches="all").numbers)
    return [
        Trial("rtol", name, x, partial(_simulated, rtol=x, branches=name), reference, OUTPUTS)
        for x, name in REQUESTED_RTOL
    ]


def _simulated(rtol: float | None = None, branches: str = "A0", **inertia: Any) -> CostOutcome:
    """Return the results of `simulate` with these branches, and the number of modes."""
    result = simulate(_scene(branches=branches, **inertia), rtol=rtol)
    count = result.dynamics.inertia.modes if result.dynamics else 0
    numbers = tuple(getattr(result, name) for name in OUTPUTS)
    return CostOutcome(numbers, count, None if rtol is None else result.accuracy.bound)


def _scene(**inertia: Any) -> Scene:
    wanted = SCENE["effects"] | ({"inertia": True} if inertia else {})
    return read({**SCENE, "effects": wanted, **({"inertia": inertia} if inertia else {})})


def _problem() -> DynamicProblem:
    """Return the scene as a dynamic problem with the modes of the integrators."""
    return problem_of(selected_effects(_scene(modes=COMPARED_MODES))[1].law, COMPARED_MODES)
