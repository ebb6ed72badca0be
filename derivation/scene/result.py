"""The result of a simulation: numbers in SI units, time history and JSON."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from numbers import Integral
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from derivation.scene import kernels
from derivation.scene.effects.effect import NO_BOUND
from derivation.scene.errors import SceneError
from derivation.scene.measured import measured
from derivation.scene.model import Model
from derivation.scene.output import answer, result_errors, unusable
from derivation.scene.output.history import POINTS, DynamicHistory, History, Pressures, times_of
from derivation.scene.output.pressure_profile import pressure_profile
from derivation.scene.quantity import counted, digits_of, rounded_up
from derivation.scene.scene import Scene
from derivation.scene.selection.achieved_accuracy import AchievedAccuracy
from derivation.scene.selection.effect_selection import SelectedEffects
from derivation.scene.selection.method_selection import dynamic_impact, moved
from derivation.scene.tensile_stress import TensileStress, tensile_stress

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

    from derivation.scene.dynamic.wave_motion import DynamicImpact
    from derivation.scene.output.comparison import Comparison
    from derivation.scene.quasi_static.motion import EnergyBalance

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Result:
    """The results of a simulated impact, as `simulate` returns them.

    Attributes
    ----------
    contact_time
        Time from first contact to separation [s]; with plate inertia, that of the first contact.
    max_indentation
        Largest indentation [m]: displacement of the sphere since first contact, plate deflection
        included.
    max_force
        Largest contact force [N].
    max_contact_radius
        Largest contact radius [m].
    restitution
        Rebound speed, at the last separation, over impact speed [1]: 1 in an elastic contact on a
        quasi-static plate; above 1 if a plate deflected by the weight lifts the sphere; NaN if
        incomplete. A contact to which only the weight returns the sphere is another impact.
    max_pressure
        Largest contact pressure, at the centre of the widest contact [Pa]; at most 1.6 times the
        yield stress in a plastic contact, only the elastic part in a viscoelastic contact. Omitted
        effects may change it by up to three times as much as the other results, and an omitted
        yield more: its error includes by how much it exceeds 1.6 times the yield stress.
    accuracy
        Method, and bound of the relative error.
    model_error
        Largest relative error of the model itself [1], not included in the bound of `accuracy`.
        Without plate inertia: error of the edge relative to the indentation, measured against a
        three-dimensional elastic solution; 0 for the paper's edge. With plate inertia: error of the
        requested outputs, measured against explicit finite-element simulations. In both cases the
        errors by stretching, finite strains and the finite size of an elastic sphere are added.
    warnings
        Warnings about validity and accuracy.
    scene
        The simulated scene.
    effects
        The included effects, and the effects table.
    times
        Times [s] of the history; None for times evenly spaced over the impact.
    inertia_neglected
        Whether plate inertia is neglected although it may change the results (see `warnings`).
    model_errors
        Relative model errors of the results [1]; `model_error` is the largest of those requested.
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
    effects: SelectedEffects = field(repr=False, compare=False)  # follow from the scene
    times: tuple[float, ...] | None = None
    inertia_neglected: bool = False
    model_errors: Mapping[str, float] = field(kw_only=True, repr=False)

    @property
    def max_tensile_stress(self) -> float:
        """Largest tensile stress on the back face, on the axis [Pa]; below 0 if compressive.

        No tolerance applies to it. Its error, and whether it is static, are in `tensile_stress`.
        """
        return self.tensile_stress.value

    @cached_property
    def tensile_stress(self) -> TensileStress:
        """Largest tensile stress on the axis of the back face, with its error."""
        numbers = (
            self.contact_time, self.max_indentation, self.max_force, self.max_contact_radius,
            self.restitution)  # fmt: skip
        law, on_edge = self.effects.law, not self.effects.edge_disabled
        stress = tensile_stress(law, self.dynamics, numbers, on_edge)
        return stress._replace(error=stress.error + measured.model_error_of(self.scene))

    @property
    def strength_note(self) -> str:
        """Safety against failure on the back face; empty without a strength or if it is exceeded.

        Cone cracks, which start on the contact face around the contact, are not considered.
        """
        strength, bound = self.scene.plate.tensile_strength, self.bound_of("max_tensile_stress")
        if strength is None:
            return ""
        return self.tensile_stress.safety(strength, bound, self.inertia_neglected)

    def pressures(self, points: int = POINTS) -> Pressures:
        """Return the pressure at the largest contact radius, and Hertz's pressure for comparison.

        Hertz's pressure is that of the same force, with Hertz's contact radius. In a viscoelastic
        contact both are the elastic part, at the largest contact radius.

        Parameters
        ----------
        points
            Number of distances from the axis.
        """
        law, a, motion = self.effects.law, self.max_contact_radius, self.dynamics
        part = 1.0 if motion is None else motion.at_equal_radius
        elastic = part * float(law.force(np.array([a]), law.at(np.array([a])))[0])
        return pressure_profile(law, a, self.max_force if law.plastic else elastic, points)

    @cached_property
    def comparison(self) -> "Comparison | None":
        """The paper's motion; None unless `effects.compare_paper_motion` is true."""
        if not self.scene.effects.compare_paper_motion:
            return None
        from derivation.scene.output.comparison import compare

        return compare(self.model, self.contact_time, self.max_indentation)

    @cached_property
    def dynamics(self) -> "DynamicImpact | None":
        """Contacts, energies and history with plate inertia; None for a quasi-static plate."""
        if not self.effects.law.dynamic:
            return None
        return dynamic_impact(self.effects, self.accuracy.remaining)

    @cached_property
    def dent(self) -> float:
        """Depth of the dent after a plastic contact [m]; 0 for an elastic contact."""
        law = self.effects.law
        if not law.plastic:
            return 0.0
        return self.dynamics.dent if self.dynamics is not None else moved(law).dent

    @cached_property
    def energy_balance(self) -> "EnergyBalance | None":
        """Energy balance; None for an elastic contact on a quasi-static plate."""
        law = self.effects.law
        if self.dynamics is not None:
            return self.dynamics.energy_balance
        return moved(law).energy_balance if law.viscous or law.plastic else None

    @property
    def measured_note(self) -> str:
        """The constant that a measured restitution determines, in words; empty without one."""
        return measured.in_words(self.scene) if self.scene.measured else ""

    @property
    def total_time(self) -> float:
        """Time from first contact to last separation [s], of an incomplete impact to its end."""
        if self.dynamics is None:
            return self.contact_time
        return self.dynamics.inertia.total_time

    @property
    def model(self) -> Model:
        """The quantities of the scene, as the contact law uses them."""
        return self.effects.law.model

    def at(self, times: Iterable[float]) -> "Result":
        """Return the same result with other times [s] for its history.

        Raises
        ------
        SceneError
            If a time is not a number between 0 and `total_time`.
        """
        chosen = times_of(times)
        for time in chosen:
            if not 0 <= time <= self.total_time:
                raise SceneError(
                    "times: expected times from 0 to the end of the impact at "
                    f"{self.total_time:.6g} s, got {time:.6g} s; remove it"
                )
        return replace(self, times=chosen)

    def history(self, n: int | None = None) -> History | DynamicHistory:
        """Return the time history of the impact, with the same effects, by the full method.

        Parameters
        ----------
        n
            Number of times, evenly spaced over the impact, both ends included; by default the
            times given to `simulate`, or 201 times.

        Returns
        -------
        History or DynamicHistory
            One-dimensional arrays in SI units; `DynamicHistory` with plate inertia.

        Raises
        ------
        SceneError
            If n is less than 2, or a number of the history is not finite.
        """
        if n is not None and not (isinstance(n, Integral) and n >= 2):
            raise SceneError(f"n: expected a whole number of at least 2 times, got {n!r}")
        history = self._history(n)
        if not all(np.isfinite(column).all() for column in history):
            raise SceneError(
                "history: expected finite numbers at all times, got NaN or infinity; use other "
                "times, or less extreme values in the scene"
            )
        return history

    def _history(self, n: int | None) -> History | DynamicHistory:
        """Compute the time history."""
        law = self.effects.law
        if self.dynamics is not None:
            from derivation.scene.dynamic.time_element import C, E, P, V, W, Z

            times = self._times(n, self.total_time)
            return DynamicHistory(times, *self.dynamics.rows(times)[[Z, V, C, P, W, E]])
        if law.of_paper:
            end = float(kernels.impact(*self.model.numbers).contact_time)
            times = self._times(n, end)
            return History(times, *kernels.history(times, *self.model.numbers))
        motion = moved(law)
        times = self._times(n, motion.contact_time)
        return History(times, *motion.history(law, times))

    def _times(self, n: int | None, end: float) -> Array:
        """Return the chosen times [s], or times evenly spaced over the contact."""
        if n is None and self.times is not None:
            return np.array(self.times, dtype=np.float64)
        return np.linspace(0.0, end, n or POINTS)

    def to_json(self) -> dict[str, Any]:
        """Return the result in SI units, with accuracy, effects, warnings and the scene."""
        data = {name: getattr(self, name) for name in UNITS}
        # JSON has no NaN: unknown results of an incomplete impact are null.
        numbers = {name: x if math.isfinite(x) else None for name, x in data.items()}
        if self.effects.law.plastic:
            numbers["dent"] = self.dent
        if self.scene.measured is not None:
            numbers[self.scene.measured.solve_for] = measured.solved(self.scene)
        extra = {"paper_motion": self.comparison.to_json()} if self.comparison else {}
        if self.dynamics is not None:
            extra["dynamics"] = self.dynamics.to_json()
        return (
            numbers
            | {
                "accuracy": self.accuracy.to_json(),
                "model_error": self.model_error,
                "model_errors": dict(self.model_errors),
                "tensile_stress": self.tensile_stress.to_json(),
                "effects": [row.to_json() for row in self.effects.rows],
                "warnings": list(self.warnings),
                "scene": self.scene.to_json(),
            }
            | extra
        )

    def plot(self) -> "Figure":
        """Return the impact as a Matplotlib figure: history, contact law and pressure."""
        from derivation.scene.output.plot import figure

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
        from derivation.scene.output.export import data_frame

        return data_frame(self, n)

    def to_xarray(self, n: int | None = None) -> "xr.Dataset":
        """Return results and history, with `n` times if given, as a Dataset with units."""
        from derivation.scene.output.export import data_set

        return data_set(self, n)

    @property
    def complete(self) -> bool:
        """Whether the impact was computed up to the last separation."""
        return self.dynamics is None or self.dynamics.inertia.complete

    @property
    def incomplete_note(self) -> str:
        """Why the simulation ended early, and what to do; empty if it is complete."""
        if self.dynamics is None or self.complete:
            return ""
        inertia = self.dynamics.inertia
        return (
            f"INCOMPLETE: {inertia.end_reason}. The results cover the first "
            f"{counted(len(inertia.contacts), 'contact')}, up to {inertia.total_time:.6g} s; "
            f"the restitution is unknown. {inertia.remedy[0].upper()}{inertia.remedy[1:]}."
        )

    @cached_property
    def unusable_note(self) -> str:
        """Which results are not usable, and what to do; empty if all are usable."""
        return unusable.in_words(self)

    @property
    def disabled_note(self) -> str:
        """Bounds on the change by disabled effects, as a sentence; empty if there are none."""
        rows = [row for row in self.effects.rows if row.disabled]
        sizes = (
            f"at most {rounded_up(row.bound)}" if row.bound < NO_BOUND else "no bound"
            for row in rows
        )
        known = ", ".join(f"{row.name} ({x})" for row, x in zip(rows, sizes, strict=True))
        return f"Disabled by the scene, not included in this bound: {known}." if rows else ""

    @property
    def digits(self) -> int:
        """Number of significant digits of all requested results; 0 if one of them has none."""
        return digits_of(self.accuracy.bound + self.model_error)

    def bound_of(self, name: str) -> float:
        """Return the bound on the relative error of a result [1], without its model error.

        It is infinite if there is none. That of `max_tensile_stress` is the one of the force.
        """
        return result_errors.bound_of(self, name)

    def error_of(self, name: str) -> float:
        """Return the relative error of a result by bound and model [1]; infinite if unknown."""
        return result_errors.error_of(self, name)

    def digits_of_result(self, name: str) -> int:
        """Return the significant digits that bound and model error of a result support."""
        return result_errors.digits_of_result(self, name)

    def numbers(self) -> list[tuple[str, float, str]]:
        """Return name, value and SI unit of each result; with plate inertia also the total time."""
        rows = [(name, float(getattr(self, name)), unit) for name, unit in UNITS.items()]
        if self.dynamics is not None:
            rows.insert(1, ("total_time", self.total_time, "s"))
        if self.effects.law.plastic:
            rows.append(("dent", self.dent, "m"))
        return rows

    def __str__(self) -> str:
        """Return the summary, as the command line prints it, with the warnings."""
        return answer.with_warnings(answer.short(self), self)

    def details(self) -> str:
        """Return the summary with the parts of the error bound, the effects and the contacts."""
        return answer.with_warnings(answer.details(self), self)

    def _repr_html_(self) -> str:
        """Return the summary for a notebook."""
        return answer.html(self)


UNITS = {
    "contact_time": "s",
    "max_indentation": "m",
    "max_force": "N",
    "max_contact_radius": "m",
    "restitution": "1",
    "max_pressure": "Pa",
    "max_tensile_stress": "Pa",
}
