"""The report as one self-contained HTML file, with formulas as MathML and figures as SVG.

Pandoc converts the same LaTeX from which the PDF is made. `page.tex` defines the report's own
commands for pandoc; `page.lua` adds numbers and references, and rejects unknown commands.
"""

import re
import shutil
import subprocess
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path

from derivation.engine.report.document import Text

TEMPLATES = Path(__file__).parent / "templates"
_PROLOG = re.compile(rb"^.*?(?=<svg)", re.DOTALL)
_METADATA = re.compile(r"<metadata>.*?</metadata>", re.DOTALL)
_OWN = re.compile(r'(\bid="|url\(#|href="#)')
_PLACE = re.compile(r'<embed\s+src="figures/([\w-]+)\.pdf"([^>]*?)\s*/>')


class HtmlError(ValueError):
    """The report cannot be converted to HTML; the message states the reason."""


def page(text: Text, title: str, figures: Mapping[str, bytes]) -> str:
    """Return the report as HTML.

    Parameters
    ----------
    text
        The report's LaTeX.
    title
        Title of the browser window.
    figures
        Figures as SVG files by name.

    Raises
    ------
    HtmlError
        If the LaTeX contains a command or a formula that cannot be converted, if a figure is not
        given, or if pandoc is not installed.
    """
    meanings = (TEMPLATES / "page.tex").read_text(encoding="utf-8")
    parts = (meanings, text.front, *text.sections, text.references)
    html = _converted("\n\n".join(parts), title)
    try:
        return _PLACE.sub(lambda at: drawing(at[1], figures[at[1]], f'role="img"{at[2]} '), html)
    except KeyError as error:
        raise HtmlError(f"expected a figure {error}, got none of this name") from None


def _converted(latex: str, title: str) -> str:
    run = subprocess.run(
        [
            _pandoc(),
            "--from=latex+raw_tex",
            "--to=html5",
            "--mathml",
            "--toc",
            "--section-divs",
            "--wrap=preserve",
            "--fail-if-warnings",
            f"--metadata=pagetitle={title}",
            f"--variable=style={(TEMPLATES / 'page.css').read_text(encoding='utf-8')}",
            f"--template={TEMPLATES / 'page.html'}",
            f"--lua-filter={TEMPLATES / 'page.lua'}",
        ],
        input=latex,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    if run.returncode:
        raise HtmlError(f"pandoc rejected the report: {run.stderr.strip()}")
    return run.stdout


def _pandoc() -> str:
    """Return the path of the pandoc program in the Python package `pypandoc_binary`."""
    package = find_spec("pypandoc")
    folder = Path(package.origin or "").parent / "files" if package else Path()
    program = shutil.which("pandoc", path=folder)
    if program is None:
        raise HtmlError(f"expected pandoc in {folder.resolve()}: pip install pypandoc_binary")
    return program


def drawing(name: str, content: bytes, attributes: str = "") -> str:
    """Return a figure's SVG element with the given attributes; its ids begin with its name."""
    text = _METADATA.sub("", _PROLOG.sub(b"", content, count=1).decode())
    text = text.replace("xlink:href", "href").replace("<svg ", f"<svg {attributes}", 1)
    return _OWN.sub(rf"\g<1>{name}-", text)
