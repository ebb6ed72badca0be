"""The gallery: each script of `docs/gallery` with the figure that it draws."""

import ast
import io
import runpy
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.rcsetup import cycler

from derivation.engine.report.figures import COLOURS, METADATA
from docs.generators.markdown import block

FOLDER = Path(__file__).parent.parent / "gallery"
FIGURES = FOLDER / "figures"
"""Where figures are written when the site is built; no file of it is committed."""
STYLE: dict[Any, Any] = {
    "svg.hashsalt": "platecontact",
    "axes.prop_cycle": cycler(color=COLOURS),
    "axes.grid": True,
    "grid.alpha": 0.3,
}


def text() -> str:
    """Draw every figure and return a section for each."""
    return "\n\n".join(map(section, scripts()))


def scripts() -> list[Path]:
    """Return the scripts in the order of their names."""
    return sorted(FOLDER.glob("*.py"))


def section(script: Path) -> str:
    """Run a script, write its figure and return its section."""
    FIGURES.mkdir(exist_ok=True)
    (FIGURES / f"{script.stem}.svg").write_bytes(drawn(script))
    source = script.read_text(encoding="utf-8")
    said = ast.get_docstring(ast.parse(source)) or ""
    title, _, about = said.partition("\n\n")
    code = source.partition('"""\n\n')[2]
    return "\n\n".join(
        [
            f"## {title.rstrip('.')}",
            about,
            f"![{title}](figures/{script.stem}.svg)",
            block(code, "python"),
        ]
    )


def drawn(script: Path) -> bytes:
    """Return the figure of a script as an SVG file."""
    stream = io.BytesIO()
    with mpl.rc_context(STYLE):
        figure = runpy.run_path(str(script))["figure"]
        figure.savefig(stream, format="svg", metadata=METADATA[".svg"])
    return stream.getvalue()
