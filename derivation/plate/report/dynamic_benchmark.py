"""Error over run time for a plate with inertia, from the committed measurement."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

from derivation.engine.report.figures import STYLE
from derivation.engine.report.latex import escape
from derivation.engine.report.numbers import rounded

LINES = {
    "elements, tolerance": "time elements",
    "elements, nodes": "time elements, fewer nodes",
    "DOP853": "Runge-Kutta 8(5,3)",
    "velocity Verlet": "velocity Verlet",
}
"""Integrators by their name in the data."""
NAMES = {
    "integrator": "integrator, first contact",
    "modes": "modes",
    "branches": "branches",
    "rtol": "tolerance",
}
SETTINGS = {
    "elements, nodes": "{} nodes", "elements, tolerance": "tolerance {}",
    "DOP853": "tolerance {}", "velocity Verlet": "{} steps",
}  # fmt: skip
"""The setting of an integrator in words."""


def worst(row: Mapping[str, Any]) -> float:
    """Return the largest error of a row's results."""
    return max(map(float, row["errors"].values()))


def dynamic_benchmark_figure(data: Mapping[str, Any]) -> Figure:
    """Draw error over time of integrators, and of modes and branches."""
    rows = data["rows"]
    with mpl.rc_context(STYLE | {"font.size": 8, "lines.linewidth": 1.0}):
        figure = Figure(figsize=(6.5, 2.9), layout="constrained")
        left, right = figure.subplots(1, 2, sharey=True)
        for (name, label), mark in zip(LINES.items(), "os^v", strict=True):
            _line(left, [row for row in rows if row["method"] == name], f"{mark}-", label)
        _line(right, [row for row in rows if row["study"] == "modes"], "o-", "A0 alone")
        every = [row for row in rows if row["study"] == "branches" and row["method"] == "all"]
        _line(right, every, "s-", "all branches")
        alone = [row for row in rows if row["study"] == "branches" and row["method"] == "A0"]
        _line(right, alone, "D", "A0 relative to all branches")
        for ax, title in ((left, "integrators, first contact"), (right, "modes and branches")):
            ax.set(xscale="log", yscale="log", xlabel="time of an impact [s]", title=title)
            ax.legend(fontsize=7)
        left.set_ylabel("largest relative error")
    return figure


def _line(ax: Any, rows: Sequence[Mapping[str, Any]], style: str, label: str) -> None:
    ax.plot(
        [row["seconds"] for row in rows], [worst(row) for row in rows], style, ms=3, label=label
    )


def dynamic_benchmark_context(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of the section: scene, rows, and relative times."""
    shared = next(row for row in data["rows"] if row["study"] == "integrator")
    plate, sphere = data["scene"]["plate"], data["scene"]["sphere"]
    return {
        "scene": (
            f"A {sphere['material']} sphere of {2e3 * sphere['radius']:g}\\,mm diameter strikes "
            f"a plate of {plate['material']}, {1e3 * plate['thickness']:g}\\,mm thick and "
            f"{2 * plate['radius']:g}\\,m in diameter, "
            f"at {data['scene']['impact']['speed']:g}\\,m/s"
        ),
        "modes": shared["modes"],
        "finest": rounded(data["reference"]["tolerance"]),
        "most": data["reference"]["modes"],
        "all": data["reference"]["modes of all branches"],
        "gain": gain(data),
        "rows": [
            " & ".join(_typeset(cell) for cell in row.values()) for row in benchmark_rows(data)
        ],
    }


def gain(data: Mapping[str, Any]) -> str:
    """Return the times of other integrators relative to elements, at their smallest errors."""
    every = (row for row in data["rows"] if row["method"] == "elements, tolerance")
    elements = min(every, key=worst)
    parts = []
    for method in ("DOP853", "velocity Verlet"):
        best = min((row for row in data["rows"] if row["method"] == method), key=worst)
        times = best["seconds"] / elements["seconds"]
        error = rounded(worst(best))
        parts.append(f"{LINES[method]} takes {times:.0f} times as long with an error of {error}")
    reached = f"Time elements reach an error of {rounded(worst(elements))}"
    return f"{reached}; {'; '.join(parts)}."


def _typeset(cell: str) -> str:
    """Return a cell of the table, with errors as powers of ten."""
    return rounded(float(cell)) if "e-" in cell and " " not in cell else escape(cell)


def benchmark_rows(data: Mapping[str, Any]) -> Iterator[dict[str, str]]:
    """Yield the rows of the table: study, method, modes, milliseconds, error and bound."""
    for row in data["rows"]:
        method, setting = row["method"], f"{row['setting']:g}"
        if row["study"] == "integrator":
            name = LINES[method].removesuffix(", fewer nodes")
            what = f"{name}, {SETTINGS[method].format(setting)}"
        elif row["study"] == "rtol":
            what = f"{_branches(method)}, rtol {setting}"
        else:
            what = f"{_branches(method)}, {setting} modes"
        yield {
            "study": NAMES[row["study"]],
            "method": what,
            "modes": str(row["modes"]),
            "milliseconds": f"{1e3 * row['seconds']:.0f}",
            "error": f"{worst(row):.1e}",
            "bound": "" if row["bound"] is None else f"{row['bound']:.1e}",
        }


def _branches(name: str) -> str:
    return "all branches" if name == "all" else name
