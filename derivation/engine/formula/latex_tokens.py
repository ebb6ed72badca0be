"""Tokens of LaTeX formulas, and what to write instead of those that are not read."""

import re
from collections.abc import Iterable

from derivation.engine.formula.elementary import INSTEAD
from derivation.engine.formula.parse import FormulaError, check_nesting
from derivation.engine.formula.vocabulary import LATEX_SYMBOL, Argument

_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|\d+(?:\.\d+)?|[A-Za-z]|[{}()\[\]^_+\-*/,.;&|!]")
_SPACING = re.compile(
    r"\\(?:left|right|[bB]igg?[lr]?|displaystyle|textstyle|q?quad|limits)(?![A-Za-z])"
    r"|\\[,;:!>\\ ]|[&~\s]"
)
_DISPLAY = re.compile(
    r"\\(?:begin|end) *\{ *(?:align|aligned|equation|gather|gathered|split)\*? *\}"
    r"|\\(?:tag|label) *\{[^{}]*\}|\\[()\[\]]|^\s*\$+|\$+[\s.,;]*$"
)
_NUMBER = re.compile(r"\\q?quad *\( *\d+[a-z]? *\)[\s.,;]*$")
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
}
"""What to write instead of tokens that are not read."""


_NOTATION = re.compile(r"\\[A-Za-z]+|[^\s{}]")
_PRIMES = {"*": r"(?:\*|\\ast|\\star)", "'": r"(?:'|\^\s*\\prime|\^\s*\{\s*\\prime\s*\})"}


def with_plain_names(text: str, arguments: Iterable[Argument]) -> tuple[str, dict[str, str]]:
    """Return a formula in which symbols such as ``E^*`` have other names, and the symbols by name.

    Parameters
    ----------
    text
        The formula.
    arguments
        The symbols. Functions, and letters with or without subscript, keep their names.
    """
    others = [a for a in arguments if not LATEX_SYMBOL.fullmatch(a.latex) and "(" not in a.latex]
    names = {}
    for number, argument in enumerate(sorted(others, key=lambda a: -len(a.latex))):
        tokens = _NOTATION.findall(argument.latex)
        pattern = r"\s*\}?\s*\{?\s*".join(map(_pattern, tokens))
        names[f"Z_own{number}"] = argument.name
        text = re.sub(
            rf"(?<![A-Za-z\\]){pattern}(?:\s*\}})?",
            lambda match, n=number: _named(match.group(), n),  # type: ignore[misc]
            text,
        )
    return text, names


def _pattern(token: str) -> str:
    """Return a regular expression for a token; a letter may not follow a command."""
    end = r"(?![A-Za-z])" if token.startswith("\\") else ""
    return _PRIMES.get(token, re.escape(token)) + end


def _named(found: str, number: int) -> str:
    """Return the name of a symbol, and a closing brace that is not its own."""
    surplus = found.count("}") - found.count("{")
    return found if surplus < 0 else f"Z_{{own{number}}}" + "}" * surplus


def without_display(text: str) -> str:
    """Return a formula without environment, dollars, label and number of the equation."""
    return _NUMBER.sub("", _DISPLAY.sub(" ", text))


def tokens_of(text: str) -> list[str]:
    """Return the tokens of a formula, without spacing and styles."""
    text = without_display(text)
    check_nesting(text, "{", "}")
    check_nesting(text, "([", ")]")
    for bar, bracket in _BARS.items():
        text = text.replace(bar, bracket)
    text = _INDEX.sub(lambda match: f"_{{{match[1] or match[2]}}}", text)
    plain = _WORDS.sub(lambda match: rf"\{match[1]} " if len(match[1]) > 1 else match[1], text)
    rest = _SPACING.sub(" ", plain).rstrip(" .,;")
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
