"""What a simulation returns: numbers in SI, their history, JSON, CSV and a notebook table."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from derivation.scene import kernels
from derivation.scene.choice import Accuracy, moved, moving
from derivation.scene.gate import Gate
from derivation.scene.html import html_table
from derivation.scene.law import WHOLE_PLATE
from derivation.scene.limits import INERTIA
from derivation.scene.model import Model
from derivation.scene.scene import Scene, SceneError

if TYPE_CHECKING:
    from derivation.scene.comparison import Comparison
    from derivation.scene.wave_motion import WaveMotion

Array = NDArray[np.float64]

POINTS = 201
"""Times of a history, if not said otherwise."""
SHOWN = 12
"""Rows of a history that a notebook shows."""
HISTORY_UNITS = {
    "time": "s",
    "indentation": "m",
    "velocity": "m/s",
    "contact_radius": "m",
    "force": "N",
    "deflection": "m",
    "plate_energy": "J",
}


class History(NamedTuple):
    """The course of an impact.

    Attributes
    ----------
    time
        Time since first contact [s].
    indentation, velocity
        Indentation [m] and its rate [m/s].
    contact_radius
        Contact radius [m].
    force
        Contact force [N].
    """

    time: Array
    indentation: Array
    velocity: Array
    contact_radius: Array
    force: Array

    def to_csv(self) -> str:
        """The history as CSV, one line per time, numbers to the last bit."""
        return _csv(self._asdict())

    def _repr_html_(self) -> str:
        """Some of its times as a table for a notebook."""
        return _some_rows(self._asdict())


class MovingHistory(NamedTuple):
    """The course of an impact on a plate that moves.

    Attributes
    ----------
    time
        Time since first contact [s].
    indentation, velocity
        Way of the sphere [m] and its rate [m/s].
    contact_radius
        Contact radius [m].
    force
        Contact force [N].
    deflection
        Of the plate's modes at the axis [m].
    plate_energy
        Energy of the plate's modes [J].
    """

    time: Array
    indentation: Array
    velocity: Array
    contact_radius: Array
    force: Array
    deflection: Array
    plate_energy: Array

    def to_csv(self) -> str:
        """The history as CSV, one line per time, numbers to the last bit."""
        return _csv(self._asdict())

    def _repr_html_(self) -> str:
        """Some of its times as a table for a notebook."""
        return _some_rows(self._asdict())


def _some_rows(columns: Mapping[str, Array]) -> str:
    """At most a dozen rows, evenly chosen, first and last among them, and how many there are."""
    count = len(columns["time"])
    chosen = np.unique(np.linspace(0, count - 1, min(count, SHOWN)).round().astype(int))
    heads = [f"{name.replace('_', ' ')} [{HISTORY_UNITS[name]}]" for name in columns]
    rows = ([f"{column[k]:.6g}" for column in columns.values()] for k in chosen)
    return f"{html_table(heads, rows)}<p>{len(chosen)} of {count} times</p>"


def _csv(columns: Mapping[str, Array]) -> str:
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    lines = [",".join(columns), *(",".join(map(repr, row)) for row in rows)]
    return "\n".join(lines) + "\n"


class Pressures(NamedTuple):
    """Pressure of a contact.

    Attributes
    ----------
    distance
        Distance from the axis [m].
    pressure, hertz
        Contact pressure and Hertz's of the same force [Pa], 0 outside the contact.
    """

    distance: Array
    pressure: Array
    hertz: Array


@dataclass(frozen=True)
class Result:
    """The outcome of an impact.

    Attributes
    ----------
    contact_time
        Time from first contact to release [s]; of a plate that moves to the first release.
    max_indentation
        Largest indentation [m]; of a plate that moves the sphere's largest way.
    max_force
        Largest contact force [N].
    max_contact_radius
        Largest contact radius [m].
    restitution
        Speed after over speed before [1]; 1 unless the contact is viscous or the plate moves.
    max_pressure
        Largest contact pressure, in the middle of the widest contact [Pa]; of a viscous contact
        that of its elastic part, beside which there is more while it grows.
    comparison
        The paper's own motion beside the result; None unless the scene asks for it.
    max_tension
        Largest tensile stress on the far face, under the axis [Pa]; below 0 if it is pressed.
    accuracy
        The method and the bound of its relative error.
    model_error
        Largest share of the indentation [1] that the edge's model may be off by, measured
        against a three-dimensional plate; beside the bound of `accuracy`, not in it.
    warnings
        What to know about the result.
    scene
        What was simulated.
    gate
        Which effects were computed, and why.
    times
        Times [s] asked for; none if the history is to cover the contact evenly.
    """

    contact_time: float
    max_indentation: float
    max_force: float
    max_contact_radius: float
    restitution: float
    max_pressure: float
    accuracy: Accuracy
    model_error: float
    warnings: tuple[str, ...]
    scene: Scene
    gate: Gate = field(repr=False)
    times: tuple[float, ...] | None = None

    @cached_property
    def max_tension(self) -> float:
        """Largest tensile stress on the far face, under the axis [Pa]; below 0 if it is pressed.

        That of the largest force, spread over the largest contact radius as Hertz's pressure
        is, in the plate at rest: of the whole plate, whatever effects are computed, on the
        scene's edge unless that effect is switched off. The tolerance is of the declared
        outputs; this follows from two of them, but is none. Solved for, the pressure of the same
        force and radius gives less: by up to 0.06 % at a/h = 1, 3 % at 2, 40 % at 4.
        """
        held = self.scene.effects.edge is not False
        return self.gate.law.max_tension(self.max_contact_radius, self.max_force, held)

    @property
    def verdict(self) -> str:
        """How far the far face is from breaking; empty without a strength, or if it breaks.

        Cracks that start on the loaded face, around the contact, are another matter.
        """
        strength = self.scene.plate.strength
        if strength is None or self.max_tension > strength:
            return ""
        if self.max_tension <= 0:
            return "the far face holds: it bears no tension under the axis"
        doubt = ", at rest under the largest force" if self.moving is not None else ""
        if any(text.startswith(INERTIA) for text in self.warnings):
            doubt = ", of a plate without inertia: see the warning"
        times = strength / self.max_tension
        return f"the far face holds: strength over its largest tension = {times:.3g}{doubt}"

    def pressures(self, points: int = POINTS) -> Pressures:
        """The largest contact's pressure over the distance from its axis, beside Hertz's.

        Hertz's is that of the same force, on the radius that belongs to it; of a viscous contact
        both are the elastic part at its widest.
        """
        law, a = self.gate.law, self.max_contact_radius
        force = float(law.force(np.array([a]), law.at(np.array([a])))[0])
        hertz = float(law.hertz_radius(np.array(force)))
        # Closer towards the edge, where the pressure ends like a root.
        r = max(a, hertz) * np.sin(np.linspace(0.0, np.pi / 2, points))
        inside = np.minimum(r, a)
        own = np.where(r < a, law.pressure(inside, a), 0.0)
        peak = 1.5 * force / (np.pi * hertz * hertz)
        return Pressures(r, own, peak * np.sqrt(np.maximum(1.0 - (r / hertz) ** 2, 0.0)))

    @cached_property
    def comparison(self) -> "Comparison | None":
        """The paper's own motion beside the result, if the scene asks for `perturbation`."""
        if not any(row.included for row in self.gate.rows if row.name == "perturbation"):
            return None
        from derivation.scene.comparison import compare

        return compare(self.model, self.contact_time, self.max_indentation)

    @cached_property
    def moving(self) -> "WaveMotion | None":
        """Contacts, energies and course on a plate that moves; None of a plate at rest."""
        if "inertia" not in self.gate.law.effects:
            return None
        found = moving(self.gate, self.accuracy.rtol)
        assert found is not None  # or there were no result
        return found

    @property
    def total_time(self) -> float:
        """From the first contact to the last release [s]."""
        if self.moving is None:
            return self.contact_time
        return self.moving.inertia.total_time

    @property
    def model(self) -> Model:
        """The scene in the kernels' numbers."""
        return self.gate.law.model

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

    def history(self, n: int | None = None) -> History | MovingHistory:
        """The course of the impact, of the same effects, by the full method.

        Parameters
        ----------
        n
            Number of times, evenly over the contact, both ends included; without it the
            times given to `simulate`, or 201.

        Raises
        ------
        SceneError
            If n is less than 2.
        """
        if n is not None and n < 2:
            raise SceneError(f"n: expected at least 2 times, got {n}; give 2 or more")
        law = self.gate.law
        if self.moving is not None:
            from derivation.scene.dynamics import A, E, P, V, W, Z

            times = self._times(n, self.total_time)
            return MovingHistory(times, *self.moving.rows(times)[[Z, V, A, P, W, E]])
        if law.effects == WHOLE_PLATE | {"hertz"}:
            end = float(kernels.impact(*self.model.numbers).contact_time)
            times = self._times(n, end)
            return History(times, *kernels.history(times, *self.model.numbers))
        whole = moved(law)
        assert whole is not None  # or there were no result
        times = self._times(n, whole.contact_time)
        return History(times, *whole.history(law, times))

    def _times(self, n: int | None, end: float) -> Array:
        """The times asked for [s], or such that cover the contact."""
        if n is None and self.times is not None:
            return np.array(self.times, dtype=np.float64)
        return np.linspace(0.0, end, n or POINTS)

    def to_json(self) -> dict[str, Any]:
        """The result in SI, with its accuracy, its warnings and the scene it belongs to."""
        numbers = {name: getattr(self, name) for name in UNITS}
        beside = {"perturbation": self.comparison.to_json()} if self.comparison else {}
        if self.moving is not None:
            beside["inertia"] = self.moving.to_json()
        return (
            numbers
            | {
                "accuracy": self.accuracy.to_json(),
                "model_error": self.model_error,
                "effects": [row.to_json() for row in self.gate.rows],
                "warnings": list(self.warnings),
                "scene": self.scene.to_json(),
            }
            | beside
        )

    @property
    def model_note(self) -> str:
        """The model error in a sentence; empty if there is none."""
        if not self.model_error:
            return ""
        return (
            f"beside this bound: the model of the {self.model.edge} edge is off by up to "
            f"{100 * self.model_error:.2g} % of the indentation (measured in three dimensions)"
        )

    def rows(self) -> list[tuple[str, str, str]]:
        """Quantity, value and unit, to be read by people."""
        return [
            (name.replace("_", " "), f"{getattr(self, name):.6g}", unit)
            for name, unit in UNITS.items()
        ]

    def _repr_html_(self) -> str:
        """Table for a notebook."""
        cells = (
            f"<tr><td>{name}</td><td style='text-align:right'>{value}</td><td>{unit}</td></tr>"
            for name, value, unit in self.rows()
        )
        notes = f"<p>{escape(str(self.accuracy))}</p><p>{escape(self.model_note)}</p>"
        notes += f"<p>{escape(self.verdict)}</p>"
        notes += "".join(f"<p><b>Warning:</b> {escape(text)}</p>" for text in self.warnings)
        beside = self.comparison.to_html() if self.comparison else ""
        if self.moving is not None:
            beside += self.moving.to_html()
        return f"<table>{''.join(cells)}</table>{notes}{self.gate.to_html()}{beside}"


UNITS = {
    "contact_time": "s",
    "max_indentation": "m",
    "max_force": "N",
    "max_contact_radius": "m",
    "restitution": "1",
    "max_pressure": "Pa",
    "max_tension": "Pa",
}
