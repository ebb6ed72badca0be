"""Formulas in LaTeX -> MathML, which browsers set without help."""

import re
from functools import cache

from latex2mathml.converter import convert
from markupsafe import Markup

_ALIGNED = re.compile(r"\\begin\{aligned\}(.*)\\end\{aligned\}", re.DOTALL)
_FIT = re.compile(r"\\fit(?:\[[\d.]+\])?(?=\{)")
_OUTER = re.compile(r"^<math[^>]*>(.*)</math>$", re.DOTALL)
_FUNCTION = re.compile(r"(<mi>(?:arctan|cosh|coth|cos|exp|ln|log|sinh|sin|tanh|tan)</mi>)")
_SPACED = r'<mspace width="0.17em"></mspace>\1<mo>&#x2061;</mo>'
"""A function's name apart from what stands before it; applied to what follows."""


class MathError(ValueError):
    """A formula holds something that MathML is not made of here."""


@cache
def mathml(latex: str, display: bool = False) -> Markup:
    """A formula as a `math` element.

    Raises
    ------
    MathError
        If a command has no counterpart.
    """
    text = unwrapped(_FIT.sub("", latex).strip())  # in braces a sum would lose its display
    aligned = _ALIGNED.search(text)
    inner = _table(aligned[1]) if aligned else _element(text, display)
    kind = ' display="block"' if display else ""
    return Markup(f"<math{kind}>{inner}</math>")


def unwrapped(text: str) -> str:
    """A formula without braces around all of it."""
    inner = text[1:-1] if text.startswith("{") and text.endswith("}") else ""
    return inner if inner and _balanced(inner) else text


def _balanced(text: str) -> bool:
    depth = 0
    for brace in re.findall(r"(?<!\\)[{}]", text):
        depth += 1 if brace == "{" else -1
        if depth < 0:
            return False
    return depth == 0


def _table(text: str) -> str:
    """Lines that are aligned at their ampersands."""
    lines = (line.split("&") for line in re.split(r"\\\\", text))
    rows = (
        "".join(f"<mtd>{_element(cell, display=True)}</mtd>" for cell in cells) for cells in lines
    )
    return f"<mtable displaystyle='true'>{''.join(f'<mtr>{row}</mtr>' for row in rows)}</mtable>"


def _element(text: str, display: bool) -> str:
    if not text.strip():
        return "<mrow></mrow>"
    made = convert(text, display="block" if display else "inline")
    found = _OUTER.match(made)
    left = re.search(r"\\[A-Za-z]+|<mi>&(?!#)", made)
    if found is None or left:
        raise MathError(f"no MathML for {left[0] if left else 'it'} in {text:.60}")
    return _FUNCTION.sub(_SPACED, found[1])
