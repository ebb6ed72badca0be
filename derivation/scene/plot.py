"""Draws an impact: time histories, force against indentation, the largest contact's pressure."""

import io
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from derivation.scene.quantity import common_prefix
from derivation.scene.result import Array, Result
from derivation.scene.scene import SceneError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

METADATA: dict[str, dict[str, None]] = {
    ".png": {},
    ".pdf": {"CreationDate": None},
    ".svg": {"Date": None},
}
"""Per suffix what is left out of the file, so that equal results give equal files."""
TITLE_DIGITS = 4
"""Most significant digits of the numbers in a title."""
BLUE, BROWN = "#1f4e79", "#b5651d"


def check_suffix(
    path: Path, suffixes: Collection[str] = METADATA.keys(), kind: str = "a plot file"
) -> None:
    """Refuse a file name that says no format.

    Raises
    ------
    SceneError
        If the name ends in none of the formats' suffixes.
    """
    if path.suffix.lower() not in suffixes:
        raise SceneError(
            f"{path}: expected {kind} ending in {', '.join(suffixes)}, "
            f"got {path.suffix or 'no suffix'}; change its name"
        )


def render(result: Result, suffix: str) -> bytes:
    """The drawing as the content of a file.

    Parameters
    ----------
    suffix
        Format: ``.png``, ``.svg`` or ``.pdf``.
    """
    return saved(figure(result), suffix)


def saved(made: "Figure", suffix: str) -> bytes:
    """A figure as the content of a file; equal figures give equal files."""
    import matplotlib as mpl

    suffix = suffix.lower()
    stream = io.BytesIO()
    # A fixed salt names the parts of an SVG alike in every run.
    with mpl.rc_context({"svg.hashsalt": "platecontact", "svg.fonttype": "none"}):
        made.savefig(stream, format=suffix[1:], dpi=150, metadata=METADATA[suffix] or None)
    return stream.getvalue()


def figure(result: Result) -> "Figure":
    """The drawing as a Matplotlib figure, to be shown or changed."""
    from matplotlib.figure import Figure

    if result.dynamics is not None:
        from derivation.scene import wave_plot

        return wave_plot.figure(result)
    history = result.history()
    time, t_label = scaled(history.time, "time $t$", "s")
    indentation, d_label = scaled(history.indentation, r"indentation $\delta$", "m")
    velocity, v_label = scaled(history.velocity, "sphere velocity $v$", "m/s")
    force, f_label = scaled(history.force, "contact force $P$", "N")
    profile = result.pressures()
    distance, r_label = scaled(profile.distance, "distance from the axis $r$", "m")
    (pressure, hertz), p_label = scaled(np.array(profile[1:]), "contact pressure $p$", "Pa")
    made = Figure(figsize=(8.0, 9.0), layout="constrained")
    panels = (
        (time, indentation, t_label, d_label),
        (time, velocity, t_label, v_label),
        (time, force, t_label, f_label),
        (indentation, force, d_label, f_label),
        (distance, pressure, r_label, p_label),
    )
    drawn = made.subplot_mosaic([["z", "v"], ["P", "law"], ["p", "p"]])
    for axes, (x, y, x_label, y_label) in zip(drawn.values(), panels, strict=True):
        axes.plot(x, y, color=BLUE, linewidth=1.5)
        frame(axes, x_label, y_label)
    lines = [
        drawn["p"].lines[0],
        *drawn["p"].plot(distance, hertz, color=BROWN, linewidth=1.2, linestyle="--"),
    ]
    drawn["p"].legend(lines, ["this contact", "Hertz's, at the same force"], frameon=False)
    titles = {
        "z": "Indentation",
        "v": "Velocity",
        "P": "Contact force",
        "law": "Force against indentation",
        "p": "Pressure at the largest contact radius",
    }
    for name, text in titles.items():
        drawn[name].set_title(text, fontsize=10)
    made.suptitle(title(result), fontsize=11)
    return made


def title(result: Result) -> str:
    """What is drawn: speed and sizes; first of all, whether the impact is incomplete."""
    model = result.model
    quantities = (model.v0, "m/s"), (model.R, "m"), (2 * model.h, "m"), (model.b, "m")
    speed, radius, thickness, plate = (_exact(value, unit) for value, unit in quantities)
    state = "" if result.complete else "INCOMPLETE: "
    return (
        f"{state}Impact at {speed}: sphere of radius {radius}, plate of thickness {thickness} "
        f"and radius {plate}"
    )


def _exact(value: float, unit: str) -> str:
    """A value of the scene in a handy multiple of its unit."""
    multiples, multiple = common_prefix(np.array([value]), unit)
    return f"{multiples[0]:.{TITLE_DIGITS}g} {multiple}"


def frame(axes: "Axes", x_label: str, y_label: str) -> None:
    """Labels, a thin grid, and no box."""
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.axhline(0.0, color="0.6", linewidth=0.6)
    axes.grid(visible=True, color="0.9", linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)


def scaled(values: Array, name: str, unit: str) -> tuple[Array, str]:
    """Values in a handy multiple of their unit, and the label that says so.

    Parameters
    ----------
    values
        Values in the unit.
    name
        What they are, with their symbol.
    unit
        SI unit without prefix.

    Raises
    ------
    SceneError
        If a value is not finite.
    """
    if not np.isfinite(values).all():
        quantity = name.partition(" $")[0]
        raise SceneError(
            f"plot: expected finite values of the {quantity}, got NaN or infinity; run it without "
            "--plot and --animate, and check the scene for extreme numbers"
        )
    multiples, multiple = common_prefix(values, unit)
    return multiples, f"{name} [{multiple}]"
