"""Draws a study: curves over one key, maps over two keys, or sensitivity indices.

Names have no axis of numbers: they are labelled positions whose points are not connected or, if
another key varies too, each name has its own curve.
"""

import re
from collections.abc import Sequence
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from derivation.engine.nearest import did_you_mean
from derivation.engine.printable import one_line
from derivation.scene.errors import SceneError
from derivation.scene.input.keys import takes_names
from derivation.scene.input.messages import OWN_MATERIALS
from derivation.scene.output.plot import BLUE, BROWN, saved, scaled
from derivation.scene.result import UNITS
from derivation.scene.sweep import SYMBOLS
from derivation.sweep.dataset import labels
from derivation.sweep.plan import Array
from derivation.sweep.store import ERRORS

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

KEY_SYMBOLS = {
    "impact.gravity": "$g$",
    "impact.speed": "$v_0$",
    "plate.density": r"$\rho$",
    "plate.half_thickness": "$h$",
    "plate.lame_lambda": r"$\lambda$",
    "plate.lame_mu": r"$\mu$",
    "plate.poissons_ratio": r"$\nu$",
    "plate.radius": "$b$",
    "plate.thickness": "$H$",
    "plate.yield_stress": "$Y$",
    "plate.youngs_modulus": "$E$",
    "sphere.mass": "$m$",
    "sphere.poissons_ratio": r"$\nu_1$",
    "sphere.radius": "$R$",
    "sphere.youngs_modulus": "$E_1$",
}
"""Symbols of keys in axis labels."""
TEX = {"δ": r"\delta", "σ": r"\sigma"}
LARGEST_FIGURE = 3
"""Largest number of panels in a row."""
ROOM = 300.0
"""Ratio of the ends of a logarithmic axis up to which its numbers at 1, 2 and 5 do not overlap."""
WIDEST_LABEL = 34
"""Largest number of characters of a line beside bars."""
MOST_COLORS, MOST_LINES, LONGEST_NAME, MOST_LETTERS = 10, 18, 30, 30
"""Largest number of curves with clearly different colours, of names below each other in a legend,
of characters of a name, and of letters of all names side by side."""


def check_results(names: Sequence[str]) -> tuple[str, ...]:
    """Return the names of the results to draw, by default all.

    Raises
    ------
    SceneError
        If a name is unknown.
    """
    for name in names:
        if name not in UNITS:
            near = did_you_mean(name, UNITS) or "choose one "
            raise SceneError(
                f"--result: expected one of {', '.join(UNITS)}, got {name:.40}; {near.rstrip()}"
            )
    return tuple(names) or tuple(UNITS)


def check_plot(keys: int, sensitivity: bool) -> None:
    """Raise an error if a study cannot be drawn.

    Raises
    ------
    SceneError
        If more than two keys vary and there are no sensitivity indices.
    """
    if keys > 2 and not sensitivity:
        raise SceneError(
            f"plot: expected one or two varied keys, or --sensitivity, got {keys} keys; "
            "vary fewer, or add --sensitivity"
        )


def render(data: "xr.Dataset", keys: Sequence[str], results: Sequence[str], suffix: str) -> bytes:
    """Return the figure as the content of a file; the arguments are those of `figure`."""
    return saved(figure(data, keys, results), suffix)


def figure(data: "xr.Dataset", keys: Sequence[str], results: Sequence[str]) -> "Figure":
    """Return a study as a Matplotlib figure.

    Parameters
    ----------
    data
        The results of the study; sensitivity indices are drawn if it contains them.
    keys
        The varied keys.
    results
        Names of the results, each of which has a panel.
    """
    from matplotlib.figure import Figure

    columns = min(LARGEST_FIGURE, len(results))
    rows = -(-len(results) // columns)
    made = Figure(figsize=(0.6 + 4.2 * columns, 0.6 + 3.2 * rows), layout="constrained")
    panels = made.subplots(rows, columns, squeeze=False).ravel()
    for axes in panels[len(results) :]:
        axes.remove()
    for name, axes in zip(results, panels[: len(results)], strict=True):
        if "first_order" in data:
            _bars(axes, data, name)
            axes.tick_params("y", labelleft=axes.get_subplotspec().is_first_col())
        elif len(keys) == 1 or any(map(takes_names, keys)):
            _curves(axes, data, keys, name)
        else:
            _map(made, axes, data, keys, name)
        axes.set_title(name.replace("_", " "), fontsize=10)
    _legend(made, panels[0], "" if "first_order" in data else _roles(keys)[1])
    notes = _notes(data)
    if notes:
        made.suptitle(notes, fontsize=9)
    return made


def _notes(data: "xr.Dataset") -> str:
    """Return the title: omitted points and unknown errors, or the kind of the intervals."""
    if "first_order" in data:
        return "Sensitivity indices with 95 % confidence intervals (bootstrap)"
    status = data["status"].values
    wrong = int(np.sum(status != "finished"))
    unknown = int(np.isinf(data["bound"].values).sum())
    notes = [f"{wrong} of {status.size} points without a result are omitted"] if wrong else []
    notes += [f"{unknown} of {status.size} points have no error bound"] if unknown else []
    return "; ".join(notes)


def _roles(keys: Sequence[str]) -> tuple[str, str]:
    """Return the key of the axis, a number if there is one, and the key with a curve per name."""
    axis, *others = sorted(keys, key=takes_names)
    return axis, others[0] if others else ""


def _legend(made: "Figure", panel: "Axes", other: str) -> None:
    """Add the legend of all panels: in the first one, or next to them if each name has a curve."""
    handles, texts = panel.get_legend_handles_labels()
    if not handles:  # maps have none
        return
    if other:
        made.legend(
            handles, texts, title=_words(other), loc="outside right upper", frameon=False,
            fontsize=8, title_fontsize=8, ncols=-(-len(texts) // MOST_LINES),
        )  # fmt: skip
    else:
        panel.legend(handles, texts, frameon=False, fontsize=8)


def _curves(axes: "Axes", data: "xr.Dataset", keys: Sequence[str], name: str) -> None:
    """Draw a result over one key, with its error if it is known, and gaps without a result.

    A second key has names, each with its own curve or, in a sample, its own points.
    """
    axis, other = _roles(keys)
    raw, error = (data[one].values.ravel() for one in (name, ERRORS[name]))
    bounded = np.isfinite(error)
    finite = np.isfinite(raw)
    y = np.full_like(raw, np.nan)
    y[finite], y_label = _result(raw[finite], name)
    band = np.abs(y) * np.where(bounded, error, np.nan)
    given = {key: data[key].broadcast_like(data[name]).values.ravel() for key in keys}
    ticks = list(dict.fromkeys(given[axis].tolist())) if takes_names(axis) else []
    x, x_label = _key(given[axis], axis)
    if ticks:
        x = np.array([ticks.index(each) for each in given[axis].tolist()], dtype=float)
    curves = list(dict.fromkeys(given[other].tolist())) if other else [""]
    for number, curve in enumerate(curves):
        chosen = np.flatnonzero(given[other] == curve) if other else np.arange(x.size)
        chosen = chosen[np.argsort(x[chosen], kind="stable")]
        shift = 0.6 * ((number + 0.5) / len(curves) - 0.5) if ticks else 0.0
        points = x[chosen] + shift, y[chosen], band[chosen]
        color = _color(number, len(curves)) if other else BLUE
        label = _label(curve) if other else "error: bound and model" if bounded.any() else ""
        _draw(axes, points, color, label, bool(ticks) or (bool(other) and "sample" in data.dims))
    axes.set(xlabel=x_label, ylabel=y_label)
    if finite.any() and np.ptp(y[finite]) == 0.0:  # otherwise its error would fill the panel
        axes.set_ylim(*sorted((0.95 * y[finite][0], 1.05 * y[finite][0])))
    axes.ticklabel_format(axis="y", useOffset=False)
    _frame(axes)
    if ticks:
        axes.set_xticks(range(len(ticks)), [_label(each) for each in ticks])
        axes.set_xlim(-0.5, len(ticks) - 0.5)
        axes.tick_params("x", labelrotation=0 if sum(map(len, ticks)) <= MOST_LETTERS else 90)
    elif _logarithmic(np.unique(x)):
        _scale(axes.xaxis, x)


def _draw(
    axes: "Axes", points: tuple[Array, Array, Array], color: Any, label: str, apart: bool
) -> None:
    """Draw positions, values and half-widths of the error as points, or as a curve with a band."""
    x, y, band = points
    if apart:
        axes.errorbar(x, y, band, color=color, fmt="o", markersize=3, capsize=2, label=label)
        return
    filled = axes.fill_between(x, y - band, y + band, color=color, alpha=0.25, linewidth=0)
    few = len(x) <= 40
    [line] = axes.plot(x, y, color=color, linewidth=1.5, marker="o" if few else None, markersize=3)
    (filled if color == BLUE else line).set_label(label)


def _color(number: int, count: int) -> Any:
    """Return the colour of a curve."""
    from matplotlib import colormaps

    if count <= MOST_COLORS:
        return colormaps["tab10"](number)
    return colormaps["turbo"](number / (count - 1))


def _label(name: str) -> str:
    """Return a name for a figure: short, and not as a formula or as a hidden label."""
    short = one_line(name, LONGEST_NAME).replace("$", r"\$")
    return f" {short}" if short.startswith("_") else short


def _map(made: "Figure", axes: "Axes", data: "xr.Dataset", keys: Sequence[str], name: str) -> None:
    """Draw a result over two keys: an area for each grid point, a dot for each sample point."""
    raw = data[name].values
    finite = np.isfinite(raw)
    values = np.full_like(raw, np.nan)
    values[finite], label = _result(raw[finite], name)
    (y, y_label), (x, x_label) = (_key(data[key].values, key) for key in keys)
    if values.ndim == 2:
        drawn: Any = axes.pcolormesh(x, y, values, shading="nearest", cmap="viridis")
    else:
        drawn = axes.scatter(x, y, c=values, s=8, cmap="viridis")
    if finite.any() and np.ptp(values[finite]) == 0.0:
        same = f"{values[finite][0]:.4g} everywhere"
        axes.text(0.5, 0.5, same, transform=axes.transAxes, ha="center", va="center", color="1")
    made.colorbar(drawn, ax=axes, label=label)
    axes.set(xlabel=x_label, ylabel=y_label)
    if _logarithmic(x):
        _scale(axes.xaxis, x)
    if _logarithmic(y):
        _scale(axes.yaxis, y)


def _bars(axes: "Axes", data: "xr.Dataset", name: str) -> None:
    """Draw first-order and total indices of a result, a pair of bars for each key."""
    one = data.sel(result=name)
    keys = [str(key) for key in data["key"].values]
    positions = np.arange(len(keys))
    orders = (("first_order", -0.2, BLUE), ("total_order", 0.2, BROWN))
    for order, shift, color in orders:
        index = one[order].values
        error = np.abs(np.array([one[f"{order}_low"].values, one[f"{order}_high"].values]) - index)
        axes.barh(
            positions + shift, index, 0.36, xerr=error, color=color, ecolor="0.3", capsize=2,
            label=order.replace("_", " "),
        )  # fmt: skip
    if np.isnan(one["first_order"].values).all():
        axes.text(0.5, 0.5, "no scatter", transform=axes.transAxes, ha="center", va="center")
        axes.set_xlim(0.0, 1.0)
    axes.set_yticks(positions, [fill(_words(key), WIDEST_LABEL) for key in keys], fontsize=8)
    axes.set_ylim(len(keys) - 0.5, -0.5)
    axes.set_xlabel("fraction of the variance [1]")
    _frame(axes)


def _frame(axes: "Axes") -> None:
    """Set a thin grid without a box, and without a line at zero, which may be far away."""
    axes.grid(visible=True, color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _scale(axis: Any, values: Array) -> None:
    """Set a logarithmic axis with plain numbers at 1, 2 and 5; at 1 only if there is no room."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    axis.axes.set(**{f"{axis.axis_name}scale": "log"})
    few = values.max() > ROOM * values.min()
    axis.set_major_locator(LogLocator(subs=(1.0,) if few else (1.0, 2.0, 5.0)))
    axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_formatter(NullFormatter())


def _logarithmic(values: Array) -> bool:
    """Return whether there are three or more positive values with a constant ratio."""
    if len(values) < 3 or values.min() <= 0:
        return False
    ratios = values[1:] / values[:-1]
    return bool(np.allclose(ratios, ratios[0], rtol=1e-6) and abs(np.log(ratios[0])) > 1e-6)


def _words(key: str) -> str:
    """Return the label of a key: its body if the description omits it, meaning and symbol."""
    table = key.rpartition(".")[0]
    text = re.split("[,;]", labels(key)["long_name"])[0]
    if table.startswith(f"{OWN_MATERIALS}."):
        return text.replace("the material", _label(table.removeprefix(f"{OWN_MATERIALS}.")))
    if table in ("plate", "sphere") and table not in text:
        text = f"{table}: {text}"
    symbol = KEY_SYMBOLS.get(key, "")
    return f"{text} {symbol}".strip()


def _key(values: Array, key: str) -> tuple[Array, str]:
    """Return values of a key in a suitable multiple of their unit, and the axis label."""
    if takes_names(key):
        return values, _words(key)
    unit = labels(key).get("units", "1")
    if unit == "1" or unit.startswith("kg"):
        return values, f"{_words(key)} [{unit}]"
    return scaled(values, _words(key), unit)


def _result(values: Array, name: str) -> tuple[Array, str]:
    """Return values of a result in a suitable multiple of their unit, and the axis label."""
    symbol = SYMBOLS[name]
    words = f"{name.replace('_', ' ')} ${TEX.get(symbol, symbol)}$"
    unit = UNITS[name]
    return (values, f"{words} [1]") if unit == "1" else scaled(values, words, unit)
