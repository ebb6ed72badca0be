"""Tokens of LaTeX formulas, and what to write instead of those that are not read."""

import re

from derivation.engine.formula.elementary import INSTEAD
from derivation.engine.formula.parse import FormulaError, check_nesting

_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|\d+(?:\.\d+)?|[A-Za-z]|[{}()\[\]^_+\-*/,.;&|]")
_SPACING = re.compile(
    r"\\(?:left|right|[bB]igg?[lr]?|displaystyle|textstyle|q?quad|limits)(?![A-Za-z])"
    r"|\\[,;:!>\\ ]|[&~\s]"
)
_BARS = {r"\left|": r"\lvert ", r"\right|": r"\rvert ", r"\left\vert": r"\lvert",
         r"\right\vert": r"\rvert"}  # fmt: skip
_STYLE = r"\\(?:text|textrm|textit|mathrm|mathit|rm|operatorname\*?) *"
_WORDS = re.compile(rf"{_STYLE}\{{ *([A-Za-z]+) *\}}")
_INDEX = re.compile(rf"_ *(?:\{{ *{_STYLE}\{{ *(\w+) *\}} *\}}|{_STYLE}\{{ *(\w+) *\}})")
_INSTEAD = {
    **{rf"\{name}": text for name, text in INSTEAD.items()},
    **dict.fromkeys((r"\sum", r"\prod", r"\partial", r"\nabla"), INSTEAD["sum"]),
    **dict.fromkeys(
        (r"\bar", r"\hat", r"\tilde", r"\dot", r"\ddot", r"\vec", r"\overline", r"\prime", "'"),
        "use the symbol without accent",
    ),
    **dict.fromkeys(
        (r"\mathbf", r"\boldsymbol", r"\mathcal", r"\mathbb", r"\text", r"\textbf"),
        "write the symbol without a style",
    ),
    **dict.fromkeys(
        ("=", "<", ">", r"\leq", r"\geq", r"\le", r"\ge", r"\approx", r"\equiv"),
        "give only the right-hand side",
    ),
    r"\pm": "give the formula with one of the two signs",
    r"\mp": "give the formula with one of the two signs",
    r"\infty": "formulas are finite: leave it out",
    r"\over": r"write \frac{...}{...}",
    r"\begin": "give one formula without environments",
    r"\|": r"write \left| ... \right|",
    "!": INSTEAD["factorial"],
}
"""What to write instead of tokens that are not read."""


def tokens_of(text: str) -> list[str]:
    """Return the tokens of a formula, without spacing and styles."""
    check_nesting(text, "{", "}")
    check_nesting(text, "([", ")]")
    for bar, bracket in _BARS.items():
        text = text.replace(bar, bracket)
    text = _INDEX.sub(lambda match: f"_{{{match[1] or match[2]}}}", text)
    plain = _WORDS.sub(lambda match: rf"\{match[1]} " if len(match[1]) > 1 else match[1], text)
    rest = _SPACING.sub(" ", plain.strip("$")).rstrip(" .,;")
    tokens: list[str] = []
    position = 0
    while position < len(rest):
        if rest[position] == " ":
            position += 1
            continue
        match = _TOKEN.match(rest, position)
        if match is None:
            raise unknown(rest[position])
        tokens.append(match.group())
        position = match.end()
    if not tokens:
        raise FormulaError(r"expected a formula in LaTeX, got nothing: write for instance \phi_j h")
    return tokens


def unknown(token: str) -> FormulaError:
    """Return the error for a token that is not read."""
    instead = _INSTEAD.get(token, "write it another way")
    return FormulaError(f"LaTeX token {token!r} is not known here: {instead}")
