"""The figure of the README: force of an impact, and digits of the contact law over run time."""

from collections.abc import Mapping
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from derivation.engine.report.figures import STYLE
from derivation.plate.report.accuracy import shown_case
from derivation.plate.report.accuracy_figures import pareto_front
from derivation.scene.impact import simulate
from derivation.scene.scene import Scene, read

POINTS, PLACES = 161, 4
"""Number of times of a history, and digits of drawn numbers: equal on all machines."""
SHOWN = {
    "published sum": "as published",
    "direct sum": "sum over modes",
    "generated code": "generated law",
}
"""Families of methods of the law."""


def overview(pane: Scene, data: Mapping[str, Any]) -> Figure:
    """Draw contact force over time, and digits over time per point."""
    with mpl.rc_context(STYLE | {"font.size": 8}):
        figure = Figure(figsize=(7.2, 2.7), layout="constrained")
        left, right = figure.subplots(1, 2)
        _draw_force(left, pane)
        _draw_digits(right, data)
    return figure


def _draw_force(ax: Any, pane: Scene) -> None:
    """Draw the force for a half-space, a quasi-static plate and a plate with inertia."""
    stiff = dict.fromkeys(("bending", "finite_thickness", "finite_radius", "edge"), False)
    for label, effects in (
        ("half-space (Hertz)", stiff | {"inertia": False}),
        ("quasi-static pane", {"inertia": False}),
        ("pane with inertia", {}),
    ):
        scene = read({**pane.to_json(), "effects": effects})
        history = simulate(scene).history(POINTS)
        time, force = (
            rounded(scale * x) for scale, x in ((1e6, history.time), (1e-3, history.force))
        )
        ax.plot(time, force, label=label)
    ax.set(xlabel="time [µs]", ylabel="contact force [kN]")
    ax.set_title("impact of a steel sphere on a glass pane")
    ax.set_xlim(0.0, 600.0)
    ax.legend(fontsize=7)


def _draw_digits(ax: Any, data: Mapping[str, Any]) -> None:
    """Draw correct digits of the contact law over time per point, in arrays."""
    paper = shown_case(data)
    rows = [
        row
        for row in data["rows"]
        if row["task"] == "law" and row["case"] == paper and row["arithmetic"] == "float64"
        and row["errors"] is not None and row["vector"] is not None
    ]  # fmt: skip
    for family, label in SHOWN.items():
        mine = sorted(
            (row["vector"]["seconds"], row["errors"]["total"])
            for row in rows
            if row["family"] == family
        )
        ax.plot(*np.array(mine).T, "o-", ms=4, label=label)
    front = np.array(pareto_front(rows, "vector")).T
    ax.step(*front, "k:", where="post", label="fastest at each accuracy")
    ax.set(xscale="log", xlabel="time per point [s]", ylabel="correct digits [1]")
    ax.set_title("contact law, paper's case")
    ax.legend(fontsize=7)


def rounded(values: Any) -> Any:
    """Return numbers rounded to PLACES digits after the leading digit of the largest."""
    unit = 10.0 ** (np.floor(np.log10(np.max(np.abs(values)))) - PLACES)
    return np.round(values / unit) * unit
