"""Style of a report's figures, and their conversion to files."""

import io
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure
from matplotlib.rcsetup import cycler

COLOURS = "#14295e", "#f0a030", "#1b9e77", "#b0125f", "#7b62c2"
"""Colours of lines in the order of use: each has a lightness of its own, so they differ in grey."""
STYLE: dict[Any, Any] = {
    "axes.prop_cycle": cycler(color=COLOURS),
    "font.family": "serif",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "legend.frameon": False,
    "lines.linewidth": 1.3,
    "pdf.fonttype": 42,
    "svg.hashsalt": "platecontact",
    "svg.fonttype": "none",
}
METADATA: dict[str, dict[str, Any]] = {
    ".pdf": {"CreationDate": None, "Producer": None},
    ".svg": {"Date": None, "Creator": None},
}
"""Metadata that are omitted from files because they differ from run to run."""


def figure_file(figure: Figure, suffix: str) -> bytes:
    """Return the content of a figure's file, `.pdf` or `.svg`; equal figures give equal bytes."""
    stream = io.BytesIO()
    with mpl.rc_context(STYLE):
        figure.savefig(stream, format=suffix[1:], transparent=True, metadata=METADATA[suffix])
        figure.set_layout_engine(None)  # keep this layout for other formats, without another search
    return stream.getvalue()
