"""The point at which both formulas of a comparison are evaluated: exact values by symbol."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction

import sympy as sp

from derivation.engine.errata.relations import Point, Relations
from derivation.engine.formula.domain import violated_conditions
from derivation.engine.formula.parse import FormulaError, number
from derivation.engine.formula.vocabulary import Argument, Vocabulary, symbols_of
from derivation.engine.nearest import did_you_mean, one_of

_CANDIDATES = ("0.5", "0.1", "0.01", "1", "2", "10", "-1")
"""Values tried in turn for a symbol without a sample value."""

_SCALES = ("10", "0.1", "100", "0.01")
"""Factors of a default value, tried in turn if a formula has no real value."""

GivenPoint = str | Mapping[str, object]
"""A point as a user gives it: ``phi=2.5,h=0.1``, or a mapping from names to values."""


def default_value(argument: Argument, values: Mapping[str, str]) -> str:
    """Return a value [SI] inside the symbol's own domain.

    Raises
    ------
    FormulaError
        If none is known.
    """
    if argument.name in values:
        return values[argument.name]
    for literal in _CANDIDATES:
        if not violated_conditions(argument.domain, {argument.symbol: Fraction(literal)}):
            return literal
    raise FormulaError(f"no default value of {argument.name} is known: add it to the point")


def parse_point(given: GivenPoint) -> dict[str, str]:
    """Return values by symbol name, from ``phi=2.5,h=0.1`` or a mapping such as ``{"phi": 2.5}``.

    Raises
    ------
    FormulaError
        If an entry is not a name and a value, or a symbol is given twice.
    """
    point: dict[str, str] = {}
    if isinstance(given, Mapping):
        return {str(name): str(value) for name, value in given.items()}
    if not isinstance(given, str):
        raise FormulaError(f"--at: expected a point like phi=2.5,h=0.1, got {given!r:.60}")
    for entry in filter(None, (part.strip() for part in given.split(","))):
        name, equals, literal = (part.strip() for part in entry.partition("="))
        if not equals or not name or not literal:
            raise FormulaError(f"--at: expected a point like phi=2.5,h=0.1, got {entry!r:.60}")
        if name in point:
            raise FormulaError(f"--at: expected {name:.40} once, got it twice; remove one value")
        point[name] = literal
    return point


def exact_values(at: Mapping[str, str], vocabulary: Vocabulary, relations: Relations) -> Point:
    """Return literals and exact values by symbol name; additional symbols are converted.

    Raises
    ------
    FormulaError
        If a name is unknown or given twice under two names, or a value is not a decimal number.
    """
    known = vocabulary.names | vocabulary.guest_names
    result: Point = {}
    for name, literal in at.items():
        symbol = known.get("lam" if name == "lambda" else name)
        if symbol is None:
            raise FormulaError(
                f"--at: unknown symbol {name!r:.40}: "
                f"{did_you_mean(name, vocabulary.by_name)}expected one of "
                f"{one_of(vocabulary.by_name)}"
            )
        symbol_name = str(symbol.name)
        if symbol_name in result:
            raise FormulaError(
                f"--at: expected {symbol_name} once, got it twice (also as {name}); "
                "remove one value"
            )
        bare = str(literal).strip()
        try:
            value = number(bare.lstrip("+-") if bare[:1] in ("+", "-") else bare)
        except FormulaError as error:
            raise FormulaError(f"--at: {name:.40}: {error}") from None
        sign = -1 if bare.startswith("-") else 1
        result[symbol_name] = bare, sign * Fraction(int(value.p), int(value.q))
    return relations.point(result)


def completed_point(
    chosen: Point,
    names: Sequence[str],
    relations: Mapping[sp.Symbol, sp.Expr],
    conditions: Iterable[str],
    vocabulary: Vocabulary,
) -> Point:
    """Return the given point with default values for the other symbols, inside the domain.

    Parameters
    ----------
    chosen
        Values given by the caller.
    names
        Independent symbols of the comparison.
    relations
        Symbols that follow from others in this comparison.
    conditions
        The domain of the comparison.
    vocabulary
        The symbols, with sample values.

    Raises
    ------
    FormulaError
        If a value is given for a dependent symbol or one that does not occur, or the point is
        outside the domain.
    """
    for symbol, meaning in relations.items():
        if symbol.name in chosen:
            others = ", ".join(sorted(map(str, meaning.free_symbols)))
            raise FormulaError(f"--at: {symbol} follows from {others} here; remove it")
    unused = [name for name in chosen if name not in names]
    if unused:
        raise FormulaError(
            f"--at: expected symbols of the two formulas ({', '.join(names) or 'none'}), "
            f"got {', '.join(unused)}; remove what does not occur"
        )
    known = vocabulary.by_name
    literals = {n: default_value(known[n], vocabulary.values) for n in names if n not in chosen}
    defaults = {name: (literal, Fraction(literal)) for name, literal in literals.items()}
    point = {name: (chosen | defaults)[name] for name in names}
    values = {known[name].symbol: value for name, (_, value) in point.items()}
    for condition in violated_conditions(conditions, values):
        at = ", ".join(f"{n} = {point[n][0]}" for n in sorted(symbols_of(condition)))
        open_ = sorted(n for n in symbols_of(condition) if n not in chosen)
        remedy = f"give {', '.join(open_)} too, or change it" if open_ else "change it"
        raise FormulaError(f"--at: expected a point with {condition}, got {at}; {remedy}")
    return point


def other_points(
    point: Point, chosen: Iterable[str], conditions: Iterable[str], vocabulary: Vocabulary
) -> Iterator[Point]:
    """Yield points in the domain at which one default value is larger or smaller."""
    conditions = tuple(conditions)
    free = [name for name in point if name not in set(chosen)]
    for scale in _SCALES:
        for name in free:
            literal = f"{Decimal(point[name][0]) * Decimal(scale):f}"
            other = point | {name: (literal, Fraction(literal))}
            values = {vocabulary.by_name[n].symbol: v for n, (_, v) in other.items()}
            if not violated_conditions(conditions, values):
                yield other
