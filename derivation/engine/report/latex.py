"""Jinja2 for LaTeX: its delimiters, and filters that escape text and set mathematics in it."""

import re
from pathlib import Path

import jinja2

from derivation.engine.formula.notation import mixed

TEMPLATES = Path(__file__).parent / "templates"

SPECIAL = {
    "\\": r"\textbackslash{}",
    "&": r"\&",
    "%": r"\%",
    "$": r"\$",
    "#": r"\#",
    "_": r"\_",
    "{": r"\{",
    "}": r"\}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
}


def escape(text: object) -> str:
    """Plain text as LaTeX."""
    return "".join(SPECIAL.get(character, character) for character in str(text))


_NUMBER = re.compile(r"(?<![\w.])(\d+(?:\.\d+)?)e([+-]?\d+)(?![\w.]*\w)")


def prose(text: object) -> str:
    """A sentence as LaTeX: mathematics where it stands between dollars, all else as it is.

    A number like 2.5e+20 is set as a power of ten.
    """
    return mixed(str(text), lambda words: _NUMBER.sub(_power, escape(words)), "${}$".format)


def _power(match: re.Match[str]) -> str:
    mantissa, power = match.groups()
    lead = "" if mantissa == "1" else rf"{mantissa}\cdot"
    return rf"${lead}10^{{{int(power)}}}$" if float(mantissa) else "0"


def unit(text: str) -> str:
    """A unit as LaTeX: m^2 raised."""
    return re.sub(r"\^(?:\(([^)]*)\)|(-?\d+(?:/\d+)?))", lambda m: f"$^{{{m[1] or m[2]}}}$", text)


def code(text: object) -> str:
    """A name or a command in typewriter, as it is typed."""
    return rf"\texttt{{{escape(text).replace('--', '-{}-')}}}"


def columns(spec: str) -> str:
    """A table's columns in LaTeX's own letters; `P{0.3}` is text in a share of the line."""
    return re.sub(r"P\{([\d.]+)\}", r">{\\ragged}p{\1\\linewidth}", spec)


def environment(*folders: Path) -> jinja2.Environment:
    """Jinja2 with delimiters that LaTeX leaves alone; what is not defined is an error.

    Templates are looked for in the folders, then among those of every report.
    """
    made = jinja2.Environment(
        loader=jinja2.FileSystemLoader([*folders, TEMPLATES]),
        undefined=jinja2.StrictUndefined,
        block_start_string=r"\BLOCK{",
        block_end_string="}",
        variable_start_string=r"\VAR{",
        variable_end_string="}",
        comment_start_string=r"\#{",
        comment_end_string="}",
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )
    made.filters["tex"] = escape
    made.filters["prose"] = prose
    made.filters["columns"] = columns
    return made
