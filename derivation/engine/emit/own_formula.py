"""Stable form of a formula given as text, as a tested NumPy module."""

import keyword

import sympy as sp

from derivation.engine.bounded import run_limited
from derivation.engine.emit.standalone import standalone
from derivation.engine.formula.parse import FUNCTIONS, FormulaError, parse
from derivation.engine.formula.size import terms_when_expanded
from derivation.engine.formula.vocabulary import NOTHING
from derivation.engine.rewrite.code_check import CodeCheck
from derivation.engine.rewrite.search import stabilised
from derivation.engine.rewrite.stabilise import Stable

MAX_TERMS = 5000
"""Largest estimated number of terms of an expanded formula that is rewritten."""
SECONDS = 30
"""Largest processor time [s] for rewriting a formula."""


def rewrite_text(text: str, variable: str = "x") -> tuple[Stable, str, CodeCheck]:
    """Return the stable form of a formula, its NumPy module, and the result of testing the module.

    Parameters
    ----------
    text
        The formula in SymPy syntax; it is parsed, not executed.
    variable
        Name of its variable, a positive number.

    Raises
    ------
    ValueError
        If the formula cannot be read, the rules do not find an accurate form, or a limit of time or
        memory is reached.
    """
    if not variable.isidentifier() or keyword.iskeyword(variable) or variable in FUNCTIONS:
        raise ValueError(f"variable: expected a name such as x, got {variable!r}; use another name")
    symbol = sp.Symbol(variable, positive=True)

    def work() -> tuple[Stable, str, CodeCheck]:
        expression = parse(text, NOTHING, {variable: symbol})
        if terms_when_expanded(expression) > MAX_TERMS:
            raise FormulaError(
                f"the formula has more than {MAX_TERMS} terms when expanded; simplify it"
            )
        stable = stabilised(expression, symbol)
        return stable, *standalone(stable)

    return run_limited(work, "rewriting the formula", SECONDS)
