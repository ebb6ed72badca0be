"""Jinja2 for LaTeX: its delimiters, an escape filter, and sums broken into lines."""

import re
from pathlib import Path

import jinja2
import sympy as sp

from derivation.formula.notation import to_latex

TEMPLATES = Path(__file__).parent / "templates"
LINE_WIDTH = 78
"""Characters, as typeset, after which a sum is broken."""

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


def environment() -> jinja2.Environment:
    """Jinja2 with delimiters that LaTeX leaves alone; what is not defined is an error."""
    made = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
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
    return made


def typeset_width(latex: str) -> int:
    """Rough width of a formula in characters, fractions as wide as their wider part."""
    text = latex
    fraction = re.compile(r"\\frac\{([^{}]*)\}\{([^{}]*)\}")
    text = re.sub(r"\\(left|right|displaystyle|,|;|quad)\b", "", text)
    text = re.sub(r"\\([a-zA-Z]+)", lambda m: m[0] if m[1] == "frac" else m[1][:4], text)
    for _ in range(8):
        text = re.sub(r"([\^_])\{([^{}]*)\}", r"\2", text)
        text, found = fraction.subn(lambda m: max(m[1], m[2], key=len), text)
        text = re.sub(r"\{((?:[^{}\\]|\\[{}])*)\}", r"\1", text) if not found else text
    return len(re.sub(r"[\s{}\\]", "", text))


def equation(left: str, expression: sp.Expr, prefix: str = "") -> str:
    """Body of a displayed equation, its sum broken over as many lines as it needs."""
    whole = f"{left} = {prefix}{to_latex(expression)}"
    if typeset_width(whole) <= LINE_WIDTH or not isinstance(expression, sp.Add):
        return whole
    lines = [f"{left} = {{}}& {prefix}"]
    for index, term in enumerate(_signed_terms(expression)):
        if index and typeset_width(lines[-1] + term) > LINE_WIDTH:
            lines.append(r"& \quad ")
        lines[-1] += f" {term}"
    return r"\begin{aligned}" + " \\\\\n".join(lines) + r"\end{aligned}"


def _signed_terms(expression: sp.Add) -> list[str]:
    """LaTeX of a sum's terms in printed order, each with its sign but the first's plus."""
    text: list[str] = []
    for term in expression.as_ordered_terms():
        negative = term.could_extract_minus_sign()
        sign = "-" if negative else "+" if text else ""
        text.append(f"{sign} {to_latex(-term if negative else term)}")
    return text
