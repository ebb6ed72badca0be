"""The report as one HTML file that needs nothing beside it: formulas as MathML, figures as SVG."""

import re
from collections.abc import Mapping
from pathlib import Path

import jinja2
from markupsafe import Markup

from derivation.engine.report.document import Text
from derivation.engine.report.html_blocks import Blocks, numbers_of
from derivation.engine.report.html_text import Words
from derivation.engine.report.references import References

TEMPLATES = Path(__file__).parent / "templates"
_PROLOG = re.compile(rb"^.*?(?=<svg)", re.DOTALL)
_METADATA = re.compile(r"<metadata>.*?</metadata>", re.DOTALL)
_OWN = re.compile(r'(\bid="|url\(#|href="#)')


def page(text: Text, title: str, figures: Mapping[str, bytes], references: References) -> str:
    """The report as HTML.

    Parameters
    ----------
    text
        The report's LaTeX, which this reads.
    title
        Title of the window.
    figures
        Figures as SVG files by name.
    references
        The sources that are cited.

    Raises
    ------
    derivation.engine.report.html_text.HtmlError
        If the LaTeX holds a command that has no counterpart here.
    """
    drawings = {name: drawing(name, content) for name, content in figures.items()}
    words = Words(
        numbers_of(text.sections), {key: n for n, key in enumerate(references.entries, 1)}
    )
    blocks = Blocks(words, drawings)
    front = blocks.read(text.front)
    sections = [blocks.read(section) for section in (*text.sections, text.references)]
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        undefined=jinja2.StrictUndefined,
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    style = Markup((TEMPLATES / "page.css").read_text())
    return environment.get_template("page.html.j2").render(
        title=title, style=style, front=front, sections=sections, headings=blocks.headings
    )


def drawing(name: str, content: bytes) -> Markup:
    """A figure's SVG element, its ids its own."""
    text = _METADATA.sub("", _PROLOG.sub(b"", content, count=1).decode())
    text = text.replace("xlink:href", "href")
    return Markup(_OWN.sub(rf"\g<1>{name}-", text))
