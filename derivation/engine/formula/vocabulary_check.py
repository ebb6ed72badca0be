"""Checks of a paper's vocabulary: names, conditions and sample values that cannot be meant.

A domain that is wider than the assumptions of proofs is rejected too.
"""

from collections.abc import Iterator
from fractions import Fraction
from keyword import iskeyword

import sympy as sp

from derivation.engine.formula.domain import holds
from derivation.engine.formula.grid import joint_points
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Vocabulary, symbols_of
from derivation.engine.nearest import did_you_mean

DECADES, COUNT = 3, 200
"""Exponent of ten of the largest arguments, and number of points, of a domain that is checked."""


def check_vocabulary(vocabulary: Vocabulary) -> None:
    """Reject a vocabulary with mistakes.

    Raises
    ------
    ValueError
        If a name occurs twice or is no Python name, a condition is not one comparison of known
        symbols, or a sample value is not a number in its domain.
    """
    for problem in _problems(vocabulary):
        raise ValueError(f"vocabulary: {problem}")


def expect_assumed_signs(formula: Record) -> None:
    """Reject a formula whose domain contains numbers that its proof excludes by assumptions.

    Raises
    ------
    ValueError
        If an argument may have a sign that the assumptions of its symbol exclude, or need not be an
        integer although its symbol is one.
    """
    words = formula.vocabulary.with_conditions(formula.where)
    arguments = words.arguments_of(formula.expression)
    names = [argument.name for argument in arguments]
    for point in joint_points(formula.name, names, words, DECADES, COUNT):
        for argument in arguments:
            value, symbol = point[argument.name], argument.symbol
            negative, positive = symbol.is_nonnegative and value < 0, value > 0
            if negative or (symbol.is_nonpositive and positive) or symbol.is_integer:
                kind = "integer" if symbol.is_integer else "positive" if negative else "negative"
                raise ValueError(
                    f"{formula.name}: the symbol {symbol} is {kind} in proofs, but its domain "
                    f"({', '.join(argument.domain)}) contains {value:.3g}; correct its domain, or "
                    f"declare it as sp.Symbol({argument.name!r}, real=True)"
                )


def _problems(vocabulary: Vocabulary) -> Iterator[str]:
    arguments = (*vocabulary.arguments, *vocabulary.guests)
    names = [argument.name for argument in arguments]
    for argument in arguments:
        name, domain = argument.name, argument.domain
        if not name.isidentifier() or iskeyword(name):
            yield f"expected symbols whose names are Python names, got {name!r}; rename it"
        if names.count(name) > 1:
            yield f"{name} occurs {names.count(name)} times; give each symbol one Argument"
        if isinstance(domain, str):
            yield f'the domain of {name} is a text; write a tuple of texts, such as ("{domain}",)'
        for condition in domain:
            yield from _of_condition(condition, name, names)
    yield from _of_values(vocabulary)


def _of_condition(condition: str, name: str, names: list[str]) -> Iterator[str]:
    """Yield what is wrong with a condition in the domain of a symbol."""
    what = f"the condition {condition!r} of {name}"
    unknown = sorted(symbols_of(condition) - set(names))
    if "and" in unknown or "or" in unknown:
        yield f"{what} is not one comparison; write each comparison as a text of its own"
    if unknown:
        near = did_you_mean(unknown[0], names)
        yield f"{what} contains the unknown symbol {unknown[0]}: {near}expected some of {names}"
    try:
        holds(condition, {sp.Symbol(other): Fraction(1, 3) for other in symbols_of(condition)})
    except ZeroDivisionError:
        return
    except ValueError as error:
        yield f"{what}: {error}"


def _of_values(vocabulary: Vocabulary) -> Iterator[str]:
    """Yield what is wrong with the sample values."""
    known, values = vocabulary.by_name, vocabulary.values
    for name, text in values.items():
        if not isinstance(text, str):
            yield f'the sample value of {name} is not a text; write it as "{text}"'
        if name not in known:
            near = did_you_mean(name, known)
            yield f"a sample value is given for {name}, which is no argument: {near}remove it"
        try:
            Fraction(text)
        except ValueError:
            yield f"expected a number as the sample value of {name}, got {text!r}"
    exact = {known[name].symbol: Fraction(text) for name, text in values.items()}
    for name in values:
        for condition in known[name].domain:
            if symbols_of(condition) <= set(values) and not holds(condition, exact):
                yield f"the sample value {name} = {values[name]} does not satisfy {condition}"
