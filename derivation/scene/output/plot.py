"""Draws an impact: time histories, force against indentation, pressure at the largest radius."""

import io
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from derivation.scene.errors import SceneError
from derivation.scene.quantity import common_prefix
from derivation.scene.result import Array, Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

METADATA: dict[str, dict[str, None]] = {
    ".png": {},
    ".pdf": {"CreationDate": None},
    ".svg": {"Date": None},
}
"""Metadata that is removed from each format, so that equal results give equal files."""
TITLE_DIGITS = 4
"""Largest number of significant digits in a title."""
BLUE, BROWN = "#1f4e79", "#b5651d"


def check_suffix(
    path: Path, suffixes: Collection[str] = METADATA.keys(), kind: str = "a plot file"
) -> None:
    """Reject a file name without the suffix of a known format.

    Raises
    ------
    SceneError
        If the suffix is not one of the given ones.
    """
    if path.suffix.lower() not in suffixes:
        raise SceneError(
            f"{path}: expected {kind} with one of the suffixes {', '.join(suffixes)}, "
            f"got {path.suffix or 'no suffix'}; change the file name"
        )


def render(result: Result, suffix: str) -> bytes:
    """Return the figure as the content of a file.

    Parameters
    ----------
    suffix
        Format: ``.png``, ``.svg`` or ``.pdf``.
    """
    return saved(figure(result), suffix)


def saved(made: "Figure", suffix: str) -> bytes:
    """Return a figure as the content of a file; equal figures give equal files."""
    import matplotlib as mpl

    suffix = suffix.lower()
    stream = io.BytesIO()
    # A fixed salt gives the elements of an SVG the same names in every run.
    with mpl.rc_context({"svg.hashsalt": "platecontact", "svg.fonttype": "none"}):
        made.savefig(stream, format=suffix[1:], dpi=150, metadata=METADATA[suffix] or None)
    return stream.getvalue()


def figure(result: Result) -> "Figure":
    """Return the impact as a Matplotlib figure, which can be shown or changed."""
    from matplotlib.figure import Figure

    if result.dynamics is not None:
        from derivation.scene.output import wave_plot

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
    drawn["p"].legend(lines, ["this contact", "Hertz's law, same force"], frameon=False)
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
    """Return the title: speed and dimensions, marked if the impact is incomplete."""
    model = result.model
    quantities = (model.v0, "m/s"), (model.R, "m"), (2 * model.h, "m"), (model.b, "m")
    speed, radius, thickness, plate = (_exact(value, unit) for value, unit in quantities)
    state = "" if result.complete else "INCOMPLETE: "
    return (
        f"{state}Impact at {speed}: sphere of radius {radius}, plate of thickness {thickness} "
        f"and radius {plate}"
    )


def _exact(value: float, unit: str) -> str:
    """Return a value of the scene with an SI prefix."""
    multiples, multiple = common_prefix(np.array([value]), unit)
    return f"{multiples[0]:.{TITLE_DIGITS}g} {multiple}"


def frame(axes: "Axes", x_label: str, y_label: str) -> None:
    """Set labels and a thin grid, and remove the top and right border."""
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.axhline(0.0, color="0.6", linewidth=0.6)
    axes.grid(visible=True, color="0.9", linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)


def scaled(values: Array, name: str, unit: str) -> tuple[Array, str]:
    """Return values in a suitable multiple of their unit, and the axis label.

    Parameters
    ----------
    values
        Values in the unit.
    name
        Name and symbol of the quantity.
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
            f"plot: expected finite values of the {quantity}, got NaN or infinity; check the scene "
            "for extreme values, or remove --plot and --animate"
        )
    multiples, multiple = common_prefix(values, unit)
    return multiples, f"{name} [{multiple}]"
