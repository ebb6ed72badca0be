"""Simulates the measurement of a restitution with trial values of a material constant.

On a thick block the solution is unique: restitution decreases with decreasing yield stress and with
increasing retardation time. On a plate that bends, an infinite retardation time leaves an elastic
plate; there may be two solutions, and the one with the smaller retardation time is returned. If the
sphere is hit again, there may be more of them (see `scan`).
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from derivation.scene.effects import BY_NAME
from derivation.scene.errors import HeldError, SceneError, Slower, WideContactError
from derivation.scene.input.body_materials import body_of, own_materials
from derivation.scene.input.settings import BODIES, TIGHTEST
from derivation.scene.measured.constant import EFFECTS, UNITS, name_of, with_constant
from derivation.scene.measured.narrowing import ROUGH, near_solution, solution
from derivation.scene.measured.trial import (
    ExceedsError,
    IncompleteTrialError,
    Point,
    Trial,
    UnreachedError,
    WideTrialError,
    vertex,
)

if TYPE_CHECKING:
    from derivation.scene.scene import Scene

EARLY = 1e-2
"""First trial value of the retardation time over the contact time without viscosity [1]."""
UNDERESTIMATE = 0.8
"""Part of the retardation time for which a loss proportional to it gives the restitution [1]: it is
below the solution, because the loss grows more slowly."""
YIELDS, POWER = 0.47, 1.6
"""First trial value of the yield stress over the largest elastic pressure [1]: this multiple of a
power of the restitution, which is about that of a contact far above yield."""
STEPS, FACTOR = 40, 2.0
"""Largest number of steps until two trial values enclose the solution, and ratio of a step."""
SHORTEST = 0.05
"""Shortest such step in the logarithm of the value, beyond which a contact is too wide."""
RISING = 3
"""Number of steps in which restitution increases, from which it has passed its smallest value."""
OF_LOSS, LEAST = 0.2, 1e-4
"""Relative difference from the measured restitution that ends a rough search, over that between the
measured restitution and the one without loss, which is small if the restitution hardly determines
the constant; the smallest such difference."""
CLEARLY = 1.01
"""Contact radius over the largest one above which the contact is too wide with more modes, too."""
STATIC_RTOL = 1e-9
"""Relative tolerance of measurements without plate inertia [1]."""


@dataclass(frozen=True)
class Measurement:
    """The measurement of a restitution.

    Attributes
    ----------
    tables
        The tables of its scene.
    key
        The constant to determine.
    goal
        The measured restitution [1].
    part
        Part of the modes that the first of the usual simulations has [1]: with plate inertia, the
        only simulation then has these modes, and its error is assumed to be `ROUGH`. 0 for usual
        simulations with an error bound.
    work
        Largest work of each of these, in the units of `contact_sequence.WORK` [1].
    body
        Which bodies have it: "plate", "sphere" or "both".
    """

    tables: Mapping[str, Any]
    key: str
    goal: float
    part: float = 0.0
    work: float = math.inf
    body: str = "plate"
    _trials: dict[tuple[float | None, bool], Trial] = field(
        init=False, default_factory=dict, repr=False, compare=False
    )

    @property
    def name(self) -> str:
        """The name of the constant in messages."""
        return name_of(self.key, self.body)

    @property
    def static(self) -> bool:
        """Whether plate inertia is disabled."""
        wanted = self.tables.get("effects", {})
        return any(one.dynamic and wanted.get(one.name) is False for one in BY_NAME.values())

    def to(self, rtol: float) -> "Measurement":
        """Return the measurement with another tolerance of the restitution [1]."""
        accuracy = {"rtol": max(TIGHTEST, rtol), "outputs": ["restitution"]}
        return replace(self, tables=dict(self.tables) | {"accuracy": accuracy})

    def simulated(self, value: float | None, within: bool = False) -> Trial:
        """Simulate the impact with a trial value; without one, no energy is lost by the constant.

        Parameters
        ----------
        within
            Whether the tolerance must be met with plate inertia, too.

        Raises
        ------
        SceneError
            If the simulation fails or is incomplete.
        """
        if (value, within) not in self._trials:
            self._trials[value, within] = self._simulated(value, within)
        return self._trials[value, within]

    def trials(self) -> dict[float, Trial]:
        """Return the results of all simulations with values of the constant until now."""
        return {value: trial for (value, _), trial in self._trials.items() if value is not None}

    def _simulated(self, value: float | None, within: bool) -> Trial:
        from derivation.scene.contact_law.limits import check_radius
        from derivation.scene.dynamic.runs import with_few_modes
        from derivation.scene.impact import selected_effects
        from derivation.scene.model_errors import deflections_in, model_errors
        from derivation.scene.selection.method_selection import dynamic_impact, solve_selected

        rtol, selected = selected_effects(self.scene(value))
        law, bound, errors, contacts = selected.law, ROUGH, dict[str, float](), 1
        if self.part and law.dynamic:
            few = with_few_modes(law, self.part, self.work)
            numbers, contacts = few.numbers, len(few.inertia.contacts)
        else:
            within = within or self.static
            numbers, accuracy = solve_selected(selected, rtol, within=within)
            bound = accuracy.bound
            motion = dynamic_impact(selected, rtol, within) if law.dynamic else None
            contacts = len(motion.inertia.contacts) if motion else 1
            errors = model_errors(law, numbers, deflections_in(law, numbers, motion), motion)
        if math.isnan(numbers[-1]):
            raise IncompleteTrialError(
                "measured.target: expected an impact that can be computed up to the last "
                "separation, got one with too many contacts or time steps; use a thicker plate or "
                'a lighter sphere, or set measured.target = "block"'
            )
        check_radius(law, a := numbers[3], "impact.speed", "reduce the speed")
        pressure = min(law.max_pressure(a), law.pressure_limit)
        return Trial(numbers, pressure, bound, errors, contacts)

    def scene(self, value: float | None) -> "Scene":
        """Return the scene with a trial value; without one, no energy is lost by the constant."""
        from derivation.scene.scene import read

        tables = with_constant(self.tables, self.key, self.body, value)
        scene = read(tables)
        own = own_materials(scene.materials)
        bodies = {"sphere": body_of(scene.sphere, own), "plate": body_of(scene.plate, own)}
        others = (getattr(bodies[one], self.key) for one in bodies.keys() - BODIES[self.body])
        lossy = value is not None or any(other not in (0.0, math.inf) for other in others)
        effects = self.tables.get("effects", {}) | {EFFECTS[self.key]: lossy}
        return read(tables | {"effects": effects})

    def lossless(self, margin: float = 0.0) -> Trial:
        """Return the measurement without energy loss by the constant.

        Parameters
        ----------
        margin
            Factor on the error bound by which the measured restitution may exceed that one.

        Raises
        ------
        SceneError
            If its restitution does not exceed the measured one.
        """
        trial = self.simulated(None)
        self.check_below(trial, margin * trial.bound)
        return trial

    def check_below(self, lossless: Trial, margin: float) -> None:
        """Raise an error if the measured restitution is not below that without energy loss.

        Parameters
        ----------
        lossless
            The measurement without energy loss by the constant.
        margin
            Relative difference by which the measured restitution may exceed that one [1].
        """
        most = lossless.restitution * (1.0 + margin)
        if self.goal < most:
            return
        named, how = f"{most:.{3 if margin else 6}g}", ""
        if self.part:
            named, how = f"about {lossless.restitution:.3g}", " (estimated with few modes)"
        raise ExceedsError(
            f"measured.restitution: expected less than {named}, the restitution without a "
            f"{self.name}{how}, got {self.goal:.6g}; correct measured.restitution or "
            "measured.target"
        )

    def rough_value(self, lossless: Trial) -> float:
        """Return a value at which the restitution is about the measured one.

        The relative difference is `ROUGH`, or less if the constant reduces the restitution only
        little.

        Parameters
        ----------
        lossless
            The measurement without energy loss by the constant.

        Raises
        ------
        UnreachedError
            If no trial value encloses it; perhaps only because the tolerance is large.
        """
        if not self.goal < lossless.restitution:  # it may be unknown
            raise UnreachedError("", -math.inf, 0.0)
        close = self.close_enough(lossless)
        low, high = self._bracket(lossless, close)
        return math.exp(near_solution(self.point, low, high, close * self.goal).x)

    def close_enough(self, lossless: Trial) -> float:
        """Return the relative difference from the measured restitution that ends a rough search."""
        reduced = abs(1.0 - self.goal / lossless.restitution)
        return max(LEAST, min(ROUGH, OF_LOSS * reduced))

    def value(self, close: float) -> float:
        """Return a value at which the restitution agrees with the measured one within its error.

        Parameters
        ----------
        close
            Relative accuracy of the value that suffices [1].
        """
        low, high = self._bracket(self.lossless())
        return solution(self.point, low, high, self.goal, close)

    def point(self, x: float) -> Point:
        """Simulate with the trial value exp(x)."""
        try:
            trial = self.simulated(math.exp(x))
            least = trial.restitution * (1.0 - trial.bound)
            return Point(x, trial.restitution - self.goal, least)
        except HeldError:
            return Point(x, -self.goal, 0.0)  # the constant is beyond the solution
        except SceneError as error:
            incomplete = isinstance(error, IncompleteTrialError)
            kind, remedy = IncompleteTrialError if incomplete else SceneError, ""
            if isinstance(error, WideContactError):
                kind = WideTrialError if error.ratio > CLEARLY else SceneError
                # The speed in this message is that for a given constant, not for the restitution.
                of_goal = error.remedy
                if isinstance(of_goal, Slower):
                    of_goal = replace(of_goal, speed=0.0)
                remedy = f"{of_goal}, or "
            raise kind(
                "measured.restitution: expected a value that can be computed, got "
                f"{self.goal:.6g}, for which the simulation of the measurement fails with "
                f"{self.name} = {math.exp(x):.6g} {UNITS[self.key]} "
                f"({str(error).partition(';')[0]}); {remedy}correct measured.restitution or "
                "measured.target"
            ) from None

    def _first(self, lossless: Trial) -> float:
        """Return the logarithm of the first trial value, with a larger restitution if possible."""
        ratio = self.goal / lossless.restitution
        if self.key == "yield_stress":
            return math.log(YIELDS * lossless.max_pressure * min(ratio, 1.0) ** POWER)
        early = math.log(EARLY * lossless.contact_time)
        loss = 1.0 - (self.point(early).above + self.goal) / lossless.restitution
        if ratio >= 1.0 or not 0.0 < loss < 1.0:
            return early
        return early + max(0.0, math.log(UNDERESTIMATE * math.log(ratio) / math.log1p(-loss)))

    def _bracket(self, lossless: Trial, close: float = 0.0) -> tuple[Point, Point]:
        """Return two trial values that enclose the solution, the smaller one first.

        Parameters
        ----------
        lossless
            The measurement without energy loss by the constant.
        close
            Relative difference of the restitution that suffices: both are then the first value.

        Raises
        ------
        SceneError
            If no trial value encloses the solution.
        """
        first = self._first(lossless)
        more = -math.log(FACTOR) if self.key == "yield_stress" else math.log(FACTOR)
        now, rising = self.point(first), 0
        if abs(now.above) < close * self.goal:
            return now, now
        # Towards a larger energy loss if the restitution is too large, else towards a smaller one.
        falling, back = now.above > 0.0, False
        step = more if falling else -more
        points = [now]
        for _ in range(STEPS):
            points.append(now := self._next(points, step, lossless))
            if (now.above <= 0.0) if falling else (now.above >= 0.0):
                if back and falling:
                    falling = False  # to the smaller solution
                    continue
                low, high = sorted(points[-2:])
                return low, high
            if not falling or now.above <= points[-2].above:
                rising = 0
                continue
            # If the contact hardly deforms, the elastic plate returns the energy, and restitution
            # increases.
            rising += 1
            if rising == 1 and len(points) > 2:
                lowest = self.point(vertex(*points[-3:]))
                if lowest.above <= 0.0:
                    low, high = sorted((now if back else points[-3], lowest))
                    return low, high
                points.insert(-1, lowest)
            # With several contacts, restitution is not a monotonic function of the yield stress.
            beyond_errors = now.least > points[-2].above + self.goal
            if rising < RISING and not (beyond_errors and self.key == "retardation_time"):
                continue
            if back or len(points) > 2:
                raise self._unreached(points, lossless)
            # The first value is already beyond that of the smallest restitution.
            points, step, rising, back = points[::-1], -step, 0, True
        raise SceneError(
            f"measured.restitution: expected a value that some {self.name} gives, got "
            f"{self.goal:.6g}, which none of the values tried from {math.exp(first):.6g} to "
            f"{math.exp(now.x):.6g} {UNITS[self.key]} gives; correct it, or change "
            "measured.solve_for"
        )

    def _next(self, points: list[Point], step: float, lossless: Trial) -> Point:
        """Return the point after others, from which it differs by a step.

        The step is shorter if the contact would be too wide.

        Raises
        ------
        UnreachedError
            If it cannot be computed, with the smallest restitution of the others.
        """
        try:
            return self.point(points[-1].x + step)
        except WideTrialError:
            if abs(step) < SHORTEST:
                raise
            return self._next(points, 0.5 * step, lossless)
        except SceneError as error:
            risen = points[-1] is not min(points, key=lambda point: point.above)
            if risen and self.key == "retardation_time":
                raise self._unreached(points, lossless) from None
            if isinstance(error, IncompleteTrialError):
                raise
            raise UnreachedError(str(error), min(p.least for p in points), 0.0) from None

    def _unreached(self, points: list[Point], lossless: Trial) -> UnreachedError:
        """Return the error of a restitution below those of all points."""
        lowest = min(points, key=lambda point: point.above)
        least, smallest = min(point.least for point in points), self.goal + lowest.above
        if smallest < lossless.restitution:
            return self.below(smallest, least, math.exp(lowest.x))
        return UnreachedError(
            f"measured.restitution: expected about {lossless.restitution:.3g}, the restitution "
            f"without a {self.name}, which none of the tried values reduces, got "
            f"{self.goal:.6g}; correct measured.restitution or measured.target, or change "
            "measured.solve_for",
            least,
            math.exp(lowest.x),
        )

    def check_reached(self, value: float, margin: float = 0.0) -> None:
        """Raise `UnreachedError` if a constant for the smallest restitution gives a larger one.

        It is larger by more than its error bound and the relative difference `margin` [1].
        """
        trial = self.simulated(value)
        least = trial.restitution * (1.0 - trial.bound)
        if self.goal < (1.0 - margin) * least:
            raise self.below(trial.restitution, least, value)

    def below(self, smallest: float, least: float, value: float) -> UnreachedError:
        """Return the error of a restitution below the smallest one, which a constant gives."""
        return UnreachedError(
            f"measured.restitution: expected at least about {smallest:.3g}, the smallest "
            f"restitution that a {self.name} was found to give, at about {value:.2g} "
            f"{UNITS[self.key]}, got {self.goal:.6g}; correct measured.restitution or "
            "measured.target",
            least,
            value,
        )
