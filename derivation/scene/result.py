"""What a simulation returns: numbers in SI, their history, and JSON; `answer` puts it in words."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from derivation.scene import answer, kernels, measured
from derivation.scene.effect_selection import SelectedEffects
from derivation.scene.effects.effect import NO_BOUND
from derivation.scene.history import POINTS, DynamicHistory, History, Pressures
from derivation.scene.method_selection import AchievedAccuracy, dynamic_impact, moved
from derivation.scene.model import Model
from derivation.scene.scene import Scene, SceneError

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

    from derivation.scene.comparison import Comparison
    from derivation.scene.motion import EnergyBalance
    from derivation.scene.wave_motion import DynamicImpact

Array = NDArray[np.float64]

FEWEST_DIGITS, MOST_DIGITS = 2, 12
"""Significant digits of a result that are shown."""


@dataclass(frozen=True)
class Result:
    """The outcome of an impact.

    Attributes
    ----------
    contact_time
        Time from first contact to release [s]; of a plate with inertia that of the first contact.
    max_indentation
        Largest indentation [m]: displacement of the sphere since first contact, plate deflection
        included.
    max_force
        Largest contact force [N].
    max_contact_radius
        Largest contact radius [m].
    restitution
        Rebound speed over impact speed [1]; 1 unless the contact is viscoelastic or the plate has
        inertia.
    max_pressure
        Largest contact pressure, in the middle of the widest contact [Pa]; of a viscous contact
        that of its elastic part, beside which there is more while it grows.
    comparison
        The paper's own motion beside the result; None unless the scene asks for it.
    max_tensile_stress
        Largest tensile stress on the back face, under the axis [Pa]; below 0 if compressive.
    accuracy
        The method and the bound of its relative error.
    model_error
        Largest relative error of the model itself [1], not included in the bound of `accuracy`:
        of the edge, as a share of the indentation, measured against a three-dimensional plate;
        with plate inertia of all outputs, measured against explicit finite elements.
    warnings
        What to know about the result.
    scene
        What was simulated.
    effects
        The effects included, and the effects table.
    times
        Times [s] asked for; none if the history is to cover the contact evenly.
    inertia_neglected
        Whether the plate's inertia is neglected and may matter, as a warning says.
    """

    contact_time: float
    max_indentation: float
    max_force: float
    max_contact_radius: float
    restitution: float
    max_pressure: float
    accuracy: AchievedAccuracy
    model_error: float
    warnings: tuple[str, ...]
    scene: Scene
    effects: SelectedEffects = field(repr=False)
    times: tuple[float, ...] | None = None
    inertia_neglected: bool = False

    @cached_property
    def max_tensile_stress(self) -> float:
        """Largest tensile stress on the back face, under the axis [Pa]; below 0 if compressive.

        Quasi-static, of the plate without inertia under the peak force, spread over the largest
        contact radius as Hertz's pressure is: of the whole plate, on the scene's edge unless that
        effect is switched off. The tolerance is of the declared outputs; this follows from two of
        them, but is none. Solved for, the pressure of the same force and radius gives less: by up
        to 0.06 % at a/h = 1, 3 % at 2, 40 % at 4.
        """
        held = not self.effects.edge_disabled
        return self.effects.law.max_tensile_stress(self.max_contact_radius, self.max_force, held)

    @property
    def strength_note(self) -> str:
        """How far the back face is from failure; empty without a strength, or if it is predicted.

        Cracks that start on the contact face, around the contact, are another matter.
        """
        strength = self.scene.plate.tensile_strength
        if strength is None or self.max_tensile_stress > strength:
            return ""
        if self.max_tensile_stress <= 0:
            return "no failure predicted on the back face: no tensile stress under the axis"
        times = strength / self.max_tensile_stress
        doubt = "; plate inertia is neglected but may matter" if self.inertia_neglected else ""
        return (
            "no failure predicted on the back face: strength / largest tensile stress = "
            f"{times:.3g} (quasi-static, under the peak force{doubt})"
        )

    def pressures(self, points: int = POINTS) -> Pressures:
        """The largest contact's pressure over the distance from its axis, beside Hertz's.

        Hertz's is that of the same force, on the radius that belongs to it; of a viscous contact
        both are the elastic part at its widest.
        """
        law, a = self.effects.law, self.max_contact_radius
        force = float(law.force(np.array([a]), law.at(np.array([a])))[0])
        if law.plastic:
            force = self.max_force
        hertz = float(law.hertz_radius(np.array(force)))
        # Closer towards the edge, where the pressure ends like a root.
        r = max(a, hertz) * np.sin(np.linspace(0.0, np.pi / 2, points))
        inside = np.minimum(r, a)
        own = np.where(r < a, np.minimum(law.pressure(inside, a), law.pressure_limit), 0.0)
        peak = 1.5 * force / (np.pi * hertz * hertz)
        return Pressures(r, own, peak * np.sqrt(np.maximum(1.0 - (r / hertz) ** 2, 0.0)))

    @cached_property
    def comparison(self) -> "Comparison | None":
        """The paper's motion, to compare with the result; None unless the scene asks for it."""
        if not self.scene.effects.compare_paper_motion:
            return None
        from derivation.scene.comparison import compare

        return compare(self.model, self.contact_time, self.max_indentation)

    @cached_property
    def dynamics(self) -> "DynamicImpact | None":
        """Contacts, energies and history with plate inertia; None of a quasi-static plate."""
        if not self.effects.law.dynamic:
            return None
        return dynamic_impact(self.effects, self.accuracy.rtol)

    @cached_property
    def dent(self) -> float:
        """Depth of the dent that remains where the contact yields [m]; 0 of an elastic one."""
        law = self.effects.law
        if not law.plastic:
            return 0.0
        return self.dynamics.dent if self.dynamics is not None else moved(law).dent

    @cached_property
    def energy_balance(self) -> "EnergyBalance | None":
        """Where the sphere's energy went; None of an elastic contact on a quasi-static plate."""
        law = self.effects.law
        if self.dynamics is not None:
            return self.dynamics.energy_balance
        return moved(law).energy_balance if law.viscous or law.plastic else None

    @property
    def measured_note(self) -> str:
        """The value that a measured restitution tells, in a sentence; empty without one."""
        return measured.in_words(self.scene) if self.scene.measured else ""

    @property
    def total_time(self) -> float:
        """From the first contact to the last release [s]."""
        if self.dynamics is None:
            return self.contact_time
        return self.dynamics.inertia.total_time

    @property
    def model(self) -> Model:
        """The scene in the kernels' numbers."""
        return self.effects.law.model

    def at(self, times: Iterable[float]) -> "Result":
        """The same result with the times [s] at which its history is wanted.

        Raises
        ------
        SceneError
            If a time lies outside the contact.
        """
        wanted = tuple(float(time) for time in np.atleast_1d(cast(Any, times)))
        for time in wanted:
            if not 0 <= time <= self.total_time:
                raise SceneError(
                    f"times: expected times from 0 to the contact time {self.total_time:.6g} s, "
                    f"got {time:.6g} s; leave it out"
                )
        return replace(self, times=wanted)

    def history(self, n: int | None = None) -> History | DynamicHistory:
        """Return the time history of the impact, of the same effects, by the full method.

        Parameters
        ----------
        n
            Number of times, evenly over the contact, both ends included; without it the
            times given to `simulate`, or 201.

        Raises
        ------
        SceneError
            If n is less than 2, or a number of the history is not finite.
        """
        if n is not None and n < 2:
            raise SceneError(f"n: expected at least 2 times, got {n}; give 2 or more")
        found = self._history(n)
        if not all(np.isfinite(column).all() for column in found):
            raise SceneError(
                "history: expected finite numbers at all times, got NaN or infinity; give other "
                "times, or a scene of less extreme numbers"
            )
        return found

    def _history(self, n: int | None) -> History | DynamicHistory:
        """The time history as it is computed."""
        law = self.effects.law
        if self.dynamics is not None:
            from derivation.scene.time_element import A, E, P, V, W, Z

            times = self._times(n, self.total_time)
            return DynamicHistory(times, *self.dynamics.rows(times)[[Z, V, A, P, W, E]])
        if law.of_paper:
            end = float(kernels.impact(*self.model.numbers).contact_time)
            times = self._times(n, end)
            return History(times, *kernels.history(times, *self.model.numbers))
        whole = moved(law)
        times = self._times(n, whole.contact_time)
        return History(times, *whole.history(law, times))

    def _times(self, n: int | None, end: float) -> Array:
        """The times asked for [s], or such that cover the contact."""
        if n is None and self.times is not None:
            return np.array(self.times, dtype=np.float64)
        return np.linspace(0.0, end, n or POINTS)

    def to_json(self) -> dict[str, Any]:
        """The result in SI, with its accuracy, its warnings and the scene it belongs to."""
        found = {name: getattr(self, name) for name in UNITS}
        # JSON has no NaN: what is not known of an incomplete impact is null.
        numbers = {name: x if math.isfinite(x) else None for name, x in found.items()}
        if self.effects.law.plastic:
            numbers["dent"] = self.dent
        if self.scene.measured is not None:
            numbers[self.scene.measured.solve_for] = measured.solved(self.scene)
        beside = {"paper_motion": self.comparison.to_json()} if self.comparison else {}
        if self.dynamics is not None:
            beside["dynamics"] = self.dynamics.to_json()
        return (
            numbers
            | {
                "accuracy": self.accuracy.to_json(),
                "model_error": self.model_error,
                "effects": [row.to_json() for row in self.effects.rows],
                "warnings": list(self.warnings),
                "scene": self.scene.to_json(),
            }
            | beside
        )

    def plot(self) -> "Figure":
        """Return the impact as a Matplotlib figure: history, contact law and pressure."""
        from derivation.scene.plot import figure

        return figure(self)

    def to_pandas(self, n: int | None = None) -> "pd.DataFrame":
        """Return the history as a DataFrame over time, with `n` times if given.

        Examples
        --------
        >>> import platecontact as pc
        >>> sphere, impact = pc.Sphere(radius=0.01, material="steel"), pc.Impact(speed=1.0)
        >>> plate = pc.Plate(radius=0.3, thickness=0.05, material="glass")
        >>> frame = pc.simulate(pc.Scene(sphere=sphere, plate=plate, impact=impact)).to_pandas()
        >>> print(f"{frame['force'].idxmax():.2g} s, force in {frame.attrs['units']['force']}")
        4.6e-05 s, force in N
        """
        from derivation.scene.export import data_frame

        return data_frame(self, n)

    def to_xarray(self, n: int | None = None) -> "xr.Dataset":
        """Return results and history, with `n` times if given, as a Dataset with units."""
        from derivation.scene.export import data_set

        return data_set(self, n)

    @property
    def model_note(self) -> str:
        """The model error in a sentence; empty if there is none."""
        if not self.model_error:
            return ""
        size = f"up to {100 * self.model_error:.2g} %"
        if self.dynamics is not None:
            return (
                f"Not included in this bound: model error of plate and edge, {size} (measured "
                "against explicit finite-element simulations)"
            )
        return (
            f"Not included in this bound: model error of the {self.model.edge} edge, {size} of the "
            "indentation (measured against a 3-D elastic solution)"
        )

    @property
    def complete(self) -> bool:
        """Whether the sphere has left the plate for good."""
        return self.dynamics is None or self.dynamics.inertia.complete

    @property
    def incomplete_note(self) -> str:
        """Why the simulation ended before the sphere left, and what to do; empty if it did not."""
        if self.dynamics is None or self.complete:
            return ""
        inertia = self.dynamics.inertia
        return (
            f"INCOMPLETE: {inertia.end_reason}. The results cover the first "
            f"{len(inertia.contacts)} contact(s), up to {inertia.total_time:.6g} s; "
            "the restitution is not known. "
            f"{inertia.remedy[0].upper()}{inertia.remedy[1:]}."
        )

    @property
    def disabled_note(self) -> str:
        """What the effects that the scene disables would change; empty if there are none."""
        rows = [row for row in self.effects.rows if row.disabled]
        known = ", ".join(
            f"{row.name} ({f'at most {row.bound:.1e}' if row.bound < NO_BOUND else 'no bound'})"
            for row in rows
        )
        return f"Disabled by the scene, not included in this bound: {known}." if rows else ""

    @property
    def digits(self) -> int:
        """Number of significant digits that the bound and the model error support."""
        error = self.accuracy.bound + self.model_error
        if not math.isfinite(error):
            return FEWEST_DIGITS
        return min(MOST_DIGITS, max(FEWEST_DIGITS, math.ceil(-math.log10(max(error, 1e-300)))))

    def numbers(self) -> list[tuple[str, float, str]]:
        """Name, value and SI unit of each result; with plate inertia the total time too."""
        found = [(name, float(getattr(self, name)), unit) for name, unit in UNITS.items()]
        if self.dynamics is not None:
            found.insert(1, ("total_time", self.total_time, "s"))
        if self.effects.law.plastic:
            found.append(("dent", self.dent, "m"))
        return found

    def rows(self) -> list[tuple[str, str, str]]:
        """Name, value with the digits that hold, and SI unit of each result, as text."""
        return [
            (name.replace("_", " "), _shown(value, self.digits), unit)
            for name, value, unit in self.numbers()
        ]

    def __str__(self) -> str:
        """The short answer, as the command line prints it."""
        return answer.short(self)

    def details(self) -> str:
        """The long answer: also the parts of the error bound, the effects table, the contacts."""
        return answer.details(self)

    def _repr_html_(self) -> str:
        """The answer for a notebook."""
        return answer.html(self)


def _shown(value: float, digits: int) -> str:
    """A number to so many significant digits."""
    return f"{value:#.{digits}g}".removesuffix(".") if math.isfinite(value) else "unknown"


UNITS = {
    "contact_time": "s",
    "max_indentation": "m",
    "max_force": "N",
    "max_contact_radius": "m",
    "restitution": "1",
    "max_pressure": "Pa",
    "max_tensile_stress": "Pa",
}
