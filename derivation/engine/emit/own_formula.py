"""Stable form of a formula given as text, as a tested NumPy module."""

import keyword
import re

import sympy as sp

from derivation.engine.bounded import run_limited
from derivation.engine.emit.several_variables import standalone_several
from derivation.engine.emit.standalone import standalone
from derivation.engine.formula.parse import (
    CONSTANTS,
    FUNCTIONS,
    NAME_HINTS,
    FormulaError,
    parse,
)
from derivation.engine.formula.size import terms_when_expanded
from derivation.engine.formula.vocabulary import NOTHING
from derivation.engine.rewrite.code_check import CodeCheck
from derivation.engine.rewrite.products import ProductForm
from derivation.engine.rewrite.search import stabilised
from derivation.engine.rewrite.several_variables import SeveralCheck
from derivation.engine.rewrite.stabilise import Stable

MAX_TERMS = 5000
"""Largest estimated number of terms of an expanded formula that is rewritten."""
SECONDS = 30
"""Largest processor time [s] for rewriting a formula."""


def rewrite_text(
    text: str, variable: str = "x"
) -> tuple[Stable | ProductForm, str, CodeCheck | SeveralCheck]:
    """Return the stable form of a formula, its NumPy module, and the result of testing the module.

    Parameters
    ----------
    text
        The formula in SymPy syntax; it is parsed, not executed. All names in it are positive
        numbers.
    variable
        Name of the variable of a formula that contains none.

    Raises
    ------
    ValueError
        If the formula cannot be read, the rules do not find an accurate form, or a limit of time or
        memory is reached.
    """
    if not variable.isidentifier() or keyword.iskeyword(variable) or variable in FUNCTIONS:
        raise ValueError(f"variable: expected a name such as x, got {variable!r}; use another name")
    symbols = {name: sp.Symbol(name, positive=True) for name in _names(text) or [variable]}

    def work() -> tuple[Stable | ProductForm, str, CodeCheck | SeveralCheck]:
        expression = parse(text, NOTHING, symbols)
        if terms_when_expanded(expression) > MAX_TERMS:
            raise FormulaError(
                f"the formula has more than {MAX_TERMS} terms when expanded; simplify it"
            )
        variables = [symbol for symbol in symbols.values() if expression.has(symbol)]
        if len(variables) > 1:
            return standalone_several(expression, variables)
        stable = stabilised(expression, (variables or list(symbols.values()))[0])
        return stable, *standalone(stable)

    return run_limited(work, "rewriting the formula", SECONDS)


def _names(text: str) -> list[str]:
    """Return the names in a formula that may be variables, in their order.

    E may be one, because it usually is Young's modulus.
    """
    names = re.findall(r"(?<![\w.])[A-Za-z_]\w*\b(?!\s*\()", text.replace("lambda", "lam"))
    others = {*FUNCTIONS, *CONSTANTS, *NAME_HINTS} - {"E"}
    return list(dict.fromkeys(name for name in names if name not in others))
