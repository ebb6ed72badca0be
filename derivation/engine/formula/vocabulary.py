"""The vocabulary of a paper: symbols with units, domains, notation and sample values."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache, cached_property

import sympy as sp

from derivation.engine.formula.dimension import Dimension, unit

LATEX_SYMBOL = re.compile(r"\\?([A-Za-z]+)(?:_(?:\{(\w+)\}|(\w)))?(?:\^\{\(\w+\)\})?")


@dataclass(frozen=True)
class Argument:
    """A symbol on which formulas depend.

    Parameters
    ----------
    symbol
        The SymPy symbol; proofs may use its assumptions.
    unit
        SI unit, as `derivation.engine.formula.dimension.unit` reads it.
    latex
        LaTeX of the symbol.
    meaning
        Meaning of the symbol, in a few words.
    domain
        Conditions under which formulas that contain it are valid, each a comparison in Python
        syntax. A condition with another symbol applies to formulas that contain this one too.
    """

    symbol: sp.Symbol
    unit: str
    latex: str
    meaning: str
    domain: tuple[str, ...]

    def __post_init__(self) -> None:
        try:
            unit(self.unit)
        except ValueError as error:
            raise ValueError(f"argument {self.symbol}: {error}") from None

    @property
    def name(self) -> str:
        """The symbol's name in formulas typed by hand and in generated code."""
        return str(self.symbol.name)


@dataclass(frozen=True, eq=False)
class Vocabulary:
    """All symbols that the formulas of a paper may contain.

    Parameters
    ----------
    arguments
        The symbols, in the order in which functions take them.
    unknowns
        Units of the functions that the paper's equations determine.
    aliases
        Further names under which symbols may be typed.
    guests
        Symbols that a user's formula may contain although no derived formula does.
    short
        Expressions that are replaced by a symbol, and that symbol.
    per_term
        Symbols with a different value in each term of a summed formula.
    indices
        Letters for the index of these terms.
    values
        Sample values [SI] by name, as decimal text, inside the domain.
    within
        Factors by which random values of symbols are multiplied to lie inside the domain.
    """

    arguments: tuple[Argument, ...] = ()
    unknowns: Mapping[sp.Basic, str] = field(default_factory=dict)
    aliases: Mapping[str, sp.Symbol] = field(default_factory=dict)
    guests: tuple[Argument, ...] = ()
    short: Mapping[sp.Expr, sp.Symbol] = field(default_factory=dict)
    per_term: frozenset[sp.Symbol] = frozenset()
    indices: str = ""
    values: Mapping[str, str] = field(default_factory=dict)
    within: Mapping[sp.Symbol, Fraction] = field(default_factory=dict)

    @cached_property
    def by_name(self) -> dict[str, Argument]:
        """The arguments by name."""
        return {argument.name: argument for argument in self.arguments}

    @cached_property
    def names(self) -> dict[str, sp.Symbol]:
        """The symbols by name, aliases included."""
        symbols = {name: argument.symbol for name, argument in self.by_name.items()}
        return {**symbols, **self.aliases}

    @cached_property
    def guest_names(self) -> dict[str, sp.Symbol]:
        """The symbols of `guests` by name."""
        return {argument.name: argument.symbol for argument in self.guests}

    @cached_property
    def latex(self) -> dict[sp.Symbol, str]:
        """LaTeX of each symbol."""
        return {argument.symbol: argument.latex for argument in self.arguments}

    def index(self, term: sp.Expr) -> str:
        """Return the letter that counts the terms of a sum: the index of the term's symbols."""
        latex = {self.latex[s] for s in term.free_symbols & self.per_term if s in self.latex}
        used = (i for i in self.indices if any(text.endswith(f"_{i}") for text in latex))
        return next(used, self.indices[:1])

    def in_full(self, expression: sp.Expr) -> sp.Expr:
        """Return an expression with the functions for which it has a symbol, of its own symbols."""
        present = expression.free_symbols
        full = {s: f for f, s in self.short.items() if s in present and f.free_symbols <= present}
        return expression.xreplace(full)

    @cached_property
    def name_of_latex(self) -> dict[str, str]:
        """The name of each symbol by its LaTeX without backslashes and braces."""
        return names_by_latex(self.arguments)

    @cached_property
    def applied(self) -> dict[str, tuple[str, ...]]:
        """Argument names of each unknown function, by its name."""
        functions = (unknown for unknown in self.unknowns if unknown.args)
        return {str(f.func.__name__): tuple(map(str, f.args)) for f in functions}

    @cached_property
    def dimensions(self) -> dict[sp.Basic, Dimension]:
        """Dimensions of all symbols and unknown functions."""
        units = {argument.symbol: argument.unit for argument in (*self.arguments, *self.guests)}
        return {symbol: unit(text) for symbol, text in {**units, **self.unknowns}.items()}

    @cached_property
    def numbers(self) -> frozenset[sp.Symbol]:
        """The dimensionless symbols."""
        return frozenset(argument.symbol for argument in self.arguments if argument.unit == "1")

    def with_conditions(self, conditions: Iterable[str]) -> "Vocabulary":
        """Return the vocabulary with further conditions, each in the domain of one argument."""
        further: dict[str, tuple[str, ...]] = {}
        for condition in conditions:
            own = next((a.name for a in self.arguments if a.name in symbols_of(condition)), "")
            further[own] = (*further.get(own, ()), condition)
        if not further:
            return self
        arguments = (replace(a, domain=a.domain + further.get(a.name, ())) for a in self.arguments)
        return replace(self, arguments=tuple(arguments))

    def arguments_of(self, expression: sp.Expr) -> tuple[Argument, ...]:
        """Return the arguments on which an expression depends, in the order of the vocabulary.

        Raises
        ------
        KeyError
            If a free symbol is not one of the paper's.
        """
        names = {str(symbol) for symbol in expression.free_symbols}
        unknown = names - set(self.by_name)
        if unknown:
            raise KeyError(f"symbols without unit and domain: {', '.join(sorted(unknown))}")
        return tuple(argument for argument in self.arguments if argument.name in names)


def names_by_latex(arguments: Iterable[Argument]) -> dict[str, str]:
    """Return the name of each symbol by its LaTeX without backslashes and braces."""
    matches = ((a.name, LATEX_SYMBOL.fullmatch(a.latex)) for a in arguments)
    return {"_".join(filter(None, match.groups())): name for name, match in matches if match}


NOTHING = Vocabulary()
"""A vocabulary without symbols."""


@cache
def symbols_of(condition: str) -> frozenset[str]:
    """Return the names of the symbols in a condition."""
    return frozenset(re.findall(r"(?<![\w.])[A-Za-z]\w*", condition)) - {"abs"}


def applicable(conditions: Iterable[str], names: set[str]) -> tuple[str, ...]:
    """Return the conditions that contain no other names than the given ones."""
    return tuple(c for c in conditions if symbols_of(c) <= names)
