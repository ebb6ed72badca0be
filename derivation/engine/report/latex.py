"""Jinja2 for LaTeX: delimiters, and filters that escape text and keep its mathematics."""

import re
from pathlib import Path

import jinja2

from derivation.engine.formula.notation import convert_parts

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
    """Return plain text as LaTeX, with special characters escaped."""
    return "".join(SPECIAL.get(character, character) for character in str(text))


_NUMBER = re.compile(r"(?<![\w.])(\d+(?:\.\d+)?)e([+-]?\d+)(?![\w.]*\w)")


def prose(text: object) -> str:
    """Return a sentence as LaTeX: text between dollars is mathematics, other text is escaped.

    A number like 2.5e+20 is typeset as a power of ten.
    """
    return convert_parts(str(text), lambda words: _NUMBER.sub(_power, escape(words)), "${}$".format)


def _power(match: re.Match[str]) -> str:
    mantissa, power = match.groups()
    lead = "" if mantissa == "1" else rf"{mantissa}\cdot"
    return rf"${lead}10^{{{int(power)}}}$" if float(mantissa) else "0"


def unit(text: str) -> str:
    """Return a unit as LaTeX, with powers as superscripts."""
    return re.sub(r"\^(?:\(([^)]*)\)|(-?\d+(?:/\d+)?))", lambda m: f"$^{{{m[1] or m[2]}}}$", text)


def code(text: object) -> str:
    """Return a name or a command as LaTeX in typewriter type."""
    return rf"\texttt{{{escape(text).replace('--', '-{}-')}}}"


def columns(spec: str) -> str:
    """Return a table's column specification; `P{0.3}` is a paragraph of 0.3 line widths."""
    return re.sub(r"P\{([\d.]+)\}", r">{\\ragged}p{\1\\linewidth}", spec)


def environment(*folders: Path) -> jinja2.Environment:
    """Return a Jinja2 environment with delimiters that LaTeX does not use.

    An undefined variable is an error. Templates are searched in the given folders, then among the
    templates of the engine.
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
