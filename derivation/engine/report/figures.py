"""The look of a report's figures, and figures as the content of files."""

import io
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

STYLE: dict[Any, Any] = {
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
"""What is left out of a file, as it differs from run to run."""


def saved(figure: Figure, suffix: str) -> bytes:
    """A figure as the content of a file, `.pdf` or `.svg`, the same bytes for the same drawing."""
    stream = io.BytesIO()
    with mpl.rc_context(STYLE):
        figure.savefig(stream, format=suffix[1:], transparent=True, metadata=METADATA[suffix])
    figure.set_layout_engine("none")  # it is laid out, for every format that follows
    return stream.getvalue()
