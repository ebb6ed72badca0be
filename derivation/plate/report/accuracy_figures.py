"""Figures of the benchmark from its record: correct digits against run time, and scaling."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any, Literal

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, NullLocator

from derivation.engine.report.figures import STYLE

TASKS = {
    "law": "contact law",
    "inversion": "inversion",
    "impact": "impact",
}
KINDS = {"vector": "in arrays", "single": "by single calls"}
TICKS = (0, 3, 6, 9, 12, 15, 30, 100, 1000)
"""Tick marks of the axis of digits, which is linear up to `DOUBLE`."""

DOUBLE = 16.0
"""Digits of double precision; above this value the axis is logarithmic."""

MARKERS = {"float32": "s", "float64": "o", "long double": "D", "mpmath": "^", "Arb": "v"}
"""Markers by arithmetic; only those of doubles are filled and connected by lines."""

COLOURS = (*mpl.color_sequences["tab10"], *mpl.color_sequences["Dark2"])

Dash = Literal["-", "--", ":"]
DASHES: tuple[Dash, ...] = "-", "--", ":"

Row = Mapping[str, Any]


def accuracy_figures(data: Mapping[str, Any]) -> dict[str, Callable[[], Figure]]:
    """Return functions that draw the figures of the benchmark, by name."""
    figures = {
        f"work_precision_{task}_{kind}": partial(work_precision, data, task, kind)
        for task in TASKS
        for kind in KINDS
    }
    return {**figures, "scaling": partial(scaling, data)}


def work_precision(data: Mapping[str, Any], task: str, kind: str) -> Figure:
    """Draw digits against time per point, one panel for each test case, and the legend."""
    rows = [row for row in data["rows"] if row["task"] == task]
    families = list(dict.fromkeys(row["family"] for row in rows))
    colours = dict(zip(families, COLOURS, strict=False))
    with mpl.rc_context(STYLE | {"font.size": 8, "lines.linewidth": 1.0}):
        figure = Figure(figsize=(6.5, 4.5), layout="constrained")
        *axes, legend = figure.subplots(2, 3, sharex=True).flat
        for ax, case in zip(axes, data["cases"], strict=True):
            shown = [row for row in rows if row["case"] == case["name"] and is_plotted(row, kind)]
            draw_panel(ax, shown, kind, colours)
            ax.set_title(f"{case['name']}, h/b = {case['h'] / case['b']:g}", fontsize=8)
        for ax in axes[2:]:
            ax.tick_params(labelbottom=True)
        figure.supxlabel(f"time per point {KINDS[kind]} [s]", fontsize=8)
        figure.supylabel("correct digits", fontsize=8)
        legend.axis("off")
        legend.legend(
            handles=[*keys(rows, colours)],
            fontsize=6.5,
            loc="center",
            handlelength=2.4,
            labelspacing=0.15,
        )
    return figure


def is_plotted(row: Row, kind: str) -> bool:
    """Return whether a row has both digits and a time."""
    return row["fails"] is None and row["errors"] is not None and row[kind] is not None


def draw_panel(
    ax: Axes, rows: Sequence[Row], kind: str, colours: Mapping[str, Any]
) -> None:  # fmt: skip
    """Draw the results of each family of methods, and the Pareto front."""
    front = np.array(pareto_front(rows, kind))
    if front.size:
        ax.step(front[:, 0], front[:, 1], where="post", color="0.8", lw=3, zorder=0)
    for (family, arithmetic), points in series(rows, kind).items():
        x, y = np.array(points).T
        double = arithmetic == "float64"
        ax.plot(
            x, y, dash(family, colours) if double else " ", marker=MARKERS[arithmetic], ms=3,
            color=colours[family], mfc=colours[family] if double else "none",
        )  # fmt: skip
    most = max((row["errors"]["total"] for row in rows), default=0.0)
    top = 120 if most < 120 else 1200
    ax.set(xscale="log", ylim=(-0.5, top))
    ax.set_yscale("function", functions=(height, digits_at))
    ticks = [digits for digits in TICKS if digits < top]
    ax.yaxis.set_major_locator(FixedLocator(ticks))
    ax.yaxis.set_minor_locator(NullLocator())
    ax.set_yticks(ticks, [str(digits) for digits in ticks])


def dash(family: str, families: Iterable[str]) -> Dash:
    """Return the line style of a family of methods; neighbours in the legend differ in grey too."""
    return DASHES[[*families].index(family) % len(DASHES)]


def height(digits: Any) -> Any:
    """Transform digits to positions on the axis."""
    beyond = DOUBLE * (1 + np.log(np.maximum(digits, DOUBLE) / DOUBLE) / 2)
    return np.where(digits > DOUBLE, beyond, digits)


def digits_at(position: Any) -> Any:
    """Transform positions on the axis to digits; the inverse of `height`."""
    beyond = DOUBLE * np.exp(2 * (np.maximum(position, DOUBLE) / DOUBLE - 1))
    return np.where(position > DOUBLE, beyond, position)


def series(rows: Sequence[Row], kind: str) -> dict[tuple[str, str], list[tuple[float, float]]]:
    """Return times and digits by family and arithmetic, in the order of the record."""
    points: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for row in rows:
        arithmetic = row["arithmetic"].split(",")[0]
        point = row[kind]["seconds"], row["errors"]["total"]
        points.setdefault((row["family"], arithmetic), []).append(point)
    return points


def pareto_front(rows: Sequence[Row], kind: str) -> list[tuple[float, float]]:
    """Return times and digits of the methods that are more accurate than all faster ones."""
    front: list[tuple[float, float]] = []
    for time, digits in sorted((row[kind]["seconds"], row["errors"]["total"]) for row in rows):
        if not front or digits > front[-1][1]:
            front.append((time, digits))
    return front


def keys(rows: Sequence[Row], colours: Mapping[str, Any]) -> Iterator[Line2D]:
    """Yield the entries of the legend: families, kinds of arithmetic, and the Pareto front."""
    for family, colour in colours.items():
        line = dash(family, colours)
        yield Line2D([], [], color=colour, linestyle=line, marker="o", ms=3, label=family)
    used = {row["arithmetic"].split(",")[0] for row in rows}
    for name, marker in MARKERS.items():
        if name in used and name != "float64":
            yield Line2D([], [], color="0.3", marker=marker, ms=3, mfc="none", lw=0, label=name)
    yield Line2D([], [], color="0.8", lw=3, label="fastest at this accuracy")


def scaling(data: Mapping[str, Any]) -> Figure:
    """Draw run time against number of points, b/h, digits and number of scenes."""
    titles = list(dict.fromkeys(growth["quantity"] for growth in data["scaling"]))
    with mpl.rc_context(STYLE | {"font.size": 8}):
        figure = Figure(figsize=(6.5, 5.4), layout="constrained")
        for ax, quantity in zip(figure.subplots(2, 2).flat, titles, strict=True):
            for growth in data["scaling"]:
                if growth["quantity"] == quantity:
                    draw_growth(ax, growth)
            ax.set(xscale="log", yscale="log", xlabel=quantity, ylabel="time [s]")
            if quantity == "digits":  # tick labels at powers of ten would overlap with minor ones
                sizes = sorted(
                    {x for g in data["scaling"] if g["quantity"] == quantity for x in g["x"]}
                )
                ax.set_xticks(sizes, [f"{x:g}" for x in sizes])
                ax.xaxis.set_minor_locator(NullLocator())
            ax.legend(fontsize=7, loc="lower left", bbox_to_anchor=(-0.05, 1.0), borderaxespad=0.2)
    return figure


def _growth_label(growth: Mapping[str, Any]) -> str:
    """Return the name of a method; those of `simulate` have short names."""
    name = str(growth["method"])
    return f"method {name}" if growth["quantity"] == "scenes" else name


def draw_growth(ax: Axes, growth: Mapping[str, Any]) -> None:
    """Draw the times, and the power law fitted to the last three."""
    x, seconds = np.array(growth["x"]), np.array(growth["seconds"])
    middle = np.exp(np.log(seconds[-3:]).mean() - growth["slope"] * np.log(x[-3:]).mean())
    (line,) = ax.plot(x, seconds, "o-", ms=3, label=_growth_label(growth))
    ax.plot(x, middle * x ** growth["slope"], ":", lw=0.8, color=line.get_color())
