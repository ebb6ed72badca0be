"""The gallery: each script of `docs/gallery` with the figure that it draws."""

import ast
import runpy
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure
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
    """Draw every figure and return small ones that link to sections, and the sections."""
    sections = [section(script) for script in scripts()]
    return "\n\n".join([thumbnails(), *sections])


def scripts() -> list[Path]:
    """Return the scripts in the order of their names."""
    return sorted(FOLDER.glob("*.py"))


def thumbnails() -> str:
    """Return a list of all figures with their titles, each a link to its section."""
    items = (
        f"- [![](/gallery/figures/{script.stem}.svg) {described(script)[0]}](#{script.stem})"
        for script in scripts()
    )
    return block("\n".join(items), "{rst-class} thumbnails")


def described(script: Path) -> tuple[str, str]:
    """Return the title of a script and the text about its figure."""
    said = ast.get_docstring(ast.parse(script.read_text(encoding="utf-8"))) or ""
    title, _, about = said.partition("\n\n")
    return title.rstrip("."), about


def section(script: Path) -> str:
    """Run a script, write its figure and return its section."""
    title, about = described(script)
    code = script.read_text(encoding="utf-8").partition('"""\n\n')[2]
    heading = f"({script.stem})=\n## {title}"
    picture = written(script.stem, drawn(script), title)
    return "\n\n".join([heading, about, picture, block(code, "python")])


def drawn(script: Path) -> Figure:
    """Return the figure of a script."""
    with mpl.rc_context(STYLE):
        figure: Figure = runpy.run_path(str(script))["figure"]
    return figure


def written(name: str, figure: Figure, title: str) -> str:
    """Write a figure as an SVG file and return the Markdown that shows it."""
    FIGURES.mkdir(exist_ok=True)
    with mpl.rc_context(STYLE):
        figure.savefig(FIGURES / f"{name}.svg", metadata=METADATA[".svg"])
    return f"![{title}](/gallery/figures/{name}.svg)"
