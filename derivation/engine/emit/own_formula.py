"""Stable form of a formula given as text, as a tested NumPy module."""

import keyword
import math
import re
from collections.abc import Sequence

import sympy as sp

from derivation.engine.bounded import run_limited
from derivation.engine.emit.several_variables import standalone_several
from derivation.engine.emit.standalone import standalone
from derivation.engine.formula.domain import comparison
from derivation.engine.formula.grid import inside, own_interval
from derivation.engine.formula.parse import (
    CONSTANTS,
    FUNCTIONS,
    NAME_HINTS,
    FormulaError,
    parse,
)
from derivation.engine.formula.size import terms_when_expanded
from derivation.engine.formula.vocabulary import Argument, Vocabulary, symbols_of
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
    text: str, variable: str = "x", where: Sequence[str] = ()
) -> tuple[Stable | ProductForm, str, CodeCheck | SeveralCheck]:
    """Return the stable form of a formula, its NumPy module, and the result of testing the module.

    Parameters
    ----------
    text
        The formula in SymPy syntax; it is parsed, not executed. All names in it are positive
        numbers, unless a condition allows others.
    variable
        Name of the variable of a formula that contains none.
    where
        Conditions on the variables, such as ``nu < 0.5`` or ``-1 < nu < 0.5``.

    Raises
    ------
    ValueError
        If the formula cannot be read, the rules do not find an accurate form, or a limit of time or
        memory is reached.
    """
    if not variable.isidentifier() or keyword.iskeyword(variable) or variable in FUNCTIONS:
        raise ValueError(f"variable: expected a name such as x, got {variable!r}; use another name")
    names = _names(text, where) or [variable]
    words = domain_of(names, where)
    symbols = {argument.name: argument.symbol for argument in words.arguments}
    domain = words if where else None

    def work() -> tuple[Stable | ProductForm, str, CodeCheck | SeveralCheck]:
        expression = parse(text, words).replace(_is_power_of_number, _by_exponential)
        if terms_when_expanded(expression) > MAX_TERMS:
            raise FormulaError(
                f"the formula has more than {MAX_TERMS} terms when expanded; simplify it"
            )
        variables = [symbol for symbol in symbols.values() if expression.has(symbol)]
        if domain is not None and variables:
            return standalone_several(expression, variables, domain)
        if len(variables) > 1:
            return standalone_several(expression, variables)
        stable = stabilised(expression, (variables or list(symbols.values()))[0])
        return stable, *standalone(stable)

    return run_limited(work, "rewriting the formula", SECONDS)


def _is_power_of_number(node: sp.Basic) -> bool:
    return isinstance(node, sp.Pow) and node.base.is_Rational and not node.exp.is_number


def _by_exponential(base: sp.Expr, exponent: sp.Expr) -> sp.Expr:
    return sp.exp(exponent * sp.log(base))


def _names(text: str, where: Sequence[str] = ()) -> list[str]:
    """Return the names in a formula that may be variables, in their order.

    E may be one, because it usually is Young's modulus, and so may a name in a condition.
    """
    names = re.findall(r"(?<![\w.])[A-Za-z_]\w*\b(?!\s*\()", text.replace("lambda", "lam"))
    stated = set[str]().union(*map(symbols_of, where))
    others = {*FUNCTIONS, *CONSTANTS, *NAME_HINTS} - {"E"} - (stated - {*FUNCTIONS, *CONSTANTS})
    return list(dict.fromkeys(name for name in names if name not in others))


def domain_of(names: Sequence[str], where: Sequence[str]) -> Vocabulary:
    """Return the variables of a formula with the conditions on them.

    A variable is positive unless conditions on it alone state a lower end, or an upper one that is
    not positive.

    Raises
    ------
    ValueError
        If a text is no condition, or contains a name that is no variable of the formula.
    """
    conditions = [part for text in where for part in _comparisons(text)]
    for condition in conditions:
        if others := symbols_of(condition) - set(names):
            raise ValueError(
                f"--where: expected a condition on {', '.join(names)}, got {condition!r} with "
                f"{', '.join(sorted(others))}; correct the name"
            )
    return Vocabulary(tuple(_variable(name, conditions) for name in names))


def _comparisons(text: str) -> list[str]:
    """Return the comparisons in a text such as ``-1 < nu < 0.5``."""
    parts = re.split(r"(<=|>=|<|>)", text)
    conditions = [
        "".join(parts[index : index + 3]).strip() for index in range(0, len(parts) - 2, 2)
    ]
    try:
        for condition in conditions:
            comparison(condition)
    except ValueError:
        conditions = []
    if not conditions or not symbols_of(text):
        raise ValueError(f"--where: expected a condition like 'nu < 0.5', got {text!r}; correct it")
    return conditions


def _variable(name: str, conditions: Sequence[str]) -> Argument:
    """Return a variable with the conditions on it, and the signs that they allow."""
    own = tuple(condition for condition in conditions if name in symbols_of(condition))
    low, high = own_interval(Argument(sp.Symbol(name), "1", name, "", own))
    if low == -math.inf and high > 0:
        low, own = 0.0, (f"{name} > 0", *own)
    alone = tuple(condition for condition in own if symbols_of(condition) == {name})
    zero = inside(Vocabulary((Argument(sp.Symbol(name), "1", name, "", alone),)), {name: 0.0})
    sign = {"real": True} if low < 0 else {"nonnegative": True} if zero else {"positive": True}
    return Argument(sp.Symbol(name, **sign), "1", name, "", own)
