"""Routines: printed functions with several steps and results, each result proved.

A `Form` is one value with one switch point in one argument. A routine is a list of statements with
any number of results, of choices on computed conditions, and of calls of functions with several
results. Its proof substitutes all statements, for every combination of choices that a result
depends on.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.printing.precedence import PRECEDENCE

from derivation.engine.emit.printer import to_math, to_numpy
from derivation.engine.formula.proof import Proof, prove

GUARDED = sp.Function("np.minimum")
"""Minimum with a limit that is not reached where the branch applies; it is ignored in proofs."""
RAISED = sp.Function("np.maximum")
"""Maximum with a limit that is not reached where the branch applies; it is ignored in proofs."""
Facts = Mapping[sp.Basic, sp.Expr]
"""Meanings of symbols, or equalities that are valid on one side of a choice."""


@dataclass(frozen=True)
class Let:
    """Assignment ``symbol = expression  # comment``.

    Parameters
    ----------
    symbol, expression, comment
        The line of code.
    opaque
        Whether the claim does not depend on this value, such as a common scale.
    means
        Exact value of the expression, which is proved separately and then used in other proofs.
    within
        Whether the expression is printed where the symbol is used, once, so that NumPy needs no
        further array.
    """

    symbol: sp.Symbol
    expression: sp.Expr
    comment: str = ""
    opaque: bool = False
    means: sp.Expr | None = None
    within: bool = False


@dataclass(frozen=True)
class Several:
    """Call ``a, b = name(*arguments)`` of a function with several results.

    Parameters
    ----------
    symbols
        The assigned names.
    name, arguments
        A function of the package, and its arguments.
    meanings
        The exact value of each result.
    """

    symbols: tuple[sp.Symbol, ...]
    name: str
    arguments: tuple[sp.Expr, ...]
    meanings: tuple[sp.Expr, ...]


@dataclass(frozen=True)
class Choice:
    """Choice ``symbol = np.where(condition, yes, no)``; equal conditions share one mask.

    Parameters
    ----------
    symbol, condition, yes, no
        The line of code.
    if_yes, if_no
        Equalities that are valid on each side; only the proof of that side uses them.
    safe_yes, safe_no
        Values of symbols, at the points of the other side, that cause no overflow or NaN.
    unclaimed
        "yes" or "no" if that side is not part of the claim.
    reason
        Why that side is not claimed.
    """

    symbol: sp.Symbol
    condition: sp.Basic
    yes: sp.Expr
    no: sp.Expr
    if_yes: Facts = field(default_factory=dict)
    if_no: Facts = field(default_factory=dict)
    safe_yes: Facts = field(default_factory=dict)
    safe_no: Facts = field(default_factory=dict)
    unclaimed: str = ""
    reason: str = ""

    def __post_init__(self) -> None:
        if self.unclaimed not in ("", "yes", "no") or bool(self.unclaimed) != bool(self.reason):
            raise ValueError(
                f"{self.symbol}: expected the side that is not claimed, yes or no, and the reason"
            )
        if self.condition in (sp.true, sp.false):
            raise ValueError(
                f"{self.symbol}: expected a condition that may fail, got {self.condition}"
            )


@dataclass(frozen=True)
class Sums:
    """Loop ``for items in rows:`` with some steps, and ``symbol += term`` for each symbol.

    Results must be linear in the totals; the proof then considers a single row.

    Parameters
    ----------
    symbols, terms
        The totals, and the contribution of a row to each.
    rows
        A table of the package, or an argument.
    items
        Names of the items of a row.
    steps
        Assignments at the beginning of each iteration.
    """

    symbols: tuple[sp.Symbol, ...]
    terms: tuple[sp.Expr, ...]
    rows: sp.Symbol
    items: tuple[sp.Symbol, ...]
    steps: tuple[Let, ...] = ()

    def of_one_row(self, value: sp.Expr) -> sp.Expr:
        """Return a value with the totals replaced by the terms of a single row."""
        value = value.xreplace(dict(zip(self.symbols, self.terms, strict=True)))
        for step in reversed(self.steps):
            value = value.xreplace({step.symbol: step.expression})
        return value


Statement = Let | Several | Choice | Sums


@dataclass(frozen=True)
class Routine:
    """A function to be printed, with the proof that its results equal the claims."""

    name: str
    arguments: tuple[sp.Symbol, ...]
    statements: tuple[Statement, ...]
    results: tuple[sp.Expr, ...]
    summary: str
    proof: Proof
    claims: tuple[sp.Expr | None, ...]
    meaning: Facts

    @property
    def calls(self) -> set[str]:
        """Names of the package's functions that it calls."""
        named = {s.name for s in self.statements if isinstance(s, Several)}
        applied = {str(f.func) for e in self._expressions() for f in e.atoms(AppliedUndef)}
        return named | {name for name in applied if "." not in name}

    @property
    def constants(self) -> set[str]:
        """Names that it uses and does not define."""
        known = {str(x) for s in self.statements for x in _assigned(s)}
        known |= {str(x) for x in self.arguments}
        return {str(x) for e in self._expressions() for x in e.free_symbols} - known

    def _expressions(self) -> Iterator[sp.Basic]:
        yield from self.results
        for s in self.statements:
            yield from _used(s)


def _assigned(s: Statement) -> tuple[sp.Symbol, ...]:
    if isinstance(s, Sums):
        return (*s.symbols, *s.items, *(step.symbol for step in s.steps))
    return s.symbols if isinstance(s, Several) else (s.symbol,)


def _used(s: Statement) -> Iterator[sp.Basic]:
    """Yield the expressions of a statement's code."""
    if isinstance(s, Let):
        yield s.expression
    elif isinstance(s, Several):
        yield from s.arguments
    elif isinstance(s, Sums):
        yield from (s.rows, *(step.expression for step in s.steps), *s.terms)
    else:
        yield from (s.condition, s.yes, s.no, *s.safe_yes.values(), *s.safe_no.values())


def _check_arguments(
    name: str,
    arguments: tuple[sp.Symbol, ...],
    statements: tuple[Statement, ...],
    results: tuple[sp.Expr, ...],
) -> None:
    """Raise ValueError if there are arguments that no statement uses."""
    expressions = (*results, *(e for s in statements for e in _used(s)))
    used = {x for e in expressions for x in e.free_symbols}
    if idle := [str(x) for x in arguments if x not in used]:
        raise ValueError(f"{name}: expected arguments that are used, got {', '.join(idle)}")


def _check_sums(name: str, statements: tuple[Statement, ...], results: tuple[sp.Expr, ...]) -> None:
    """Raise ValueError if totals of sums occur in statements, or not linearly in results."""
    totals = {x for s in statements if isinstance(s, Sums) for x in s.symbols}
    later = {x for s in statements for e in _used(s) for x in e.free_symbols}
    slopes = (sp.diff(value, total) for value in results for total in totals)
    if totals & later or any(slope.free_symbols & totals for slope in slopes):
        raise ValueError(f"{name}: expected results that are linear in the totals")


def routine(
    name: str,
    arguments: tuple[sp.Symbol, ...],
    statements: Sequence[Statement],
    results: tuple[sp.Expr, ...],
    claims: tuple[sp.Expr | None, ...],
    summary: str,
    meaning: Facts,
    reduce: Callable[[sp.Expr], sp.Expr] = lambda e: e,
) -> Routine:
    """Build a routine and prove each result for every combination of choices.

    Parameters
    ----------
    name, arguments, statements, results, summary
        Name, arguments, statements, results and docstring of the function.
    claims
        Exact value of each result as an expression of the theory; None for a sign or a mask.
    meaning
        Expressions of the theory for the symbols of the routine.
    reduce
        Function that simplifies a residual; it must return 0 for a residual that vanishes.

    Returns
    -------
    Routine
        The routine with its proof.

    Raises
    ------
    ProofError
        If a result does not equal its claim; the message states the result and the choices.
    ValueError
        If an argument is not used, or results are not linear in the totals of a sum.
    """
    statements = tuple(statements)
    _check_arguments(name, arguments, statements, results)
    _check_sums(name, statements, results)
    residuals = {}
    for k, s in enumerate(statements):
        if isinstance(s, Let) and s.means is not None:
            for label, value, facts in _substituted(s.expression, statements[:k]):
                left = (value.subs(meaning) - s.means).subs(facts)
                residuals[f"{s.symbol} {label}".strip()] = reduce(left)
    for i, (result, claim) in enumerate(zip(results, claims, strict=True)):
        for label, value, facts in () if claim is None else _substituted(result, statements):
            left = (value.subs(meaning) - claim).subs(facts)
            residuals[f"{name}[{i}] {label}".strip()] = reduce(left)
    proof = prove(
        f"Routine {name}",
        "All statements are substituted, for every combination of choices.",
        residuals,
    )
    return Routine(name, arguments, statements, results, summary, proof, claims, meaning)


def _substituted(
    result: sp.Expr, statements: tuple[Statement, ...], sides: Mapping[sp.Basic, bool] | None = None
) -> Iterator[tuple[str, sp.Expr, dict[sp.Basic, sp.Expr]]]:
    """Yield the result with all statements substituted, for every combination of its choices."""
    taken = dict(sides or {})
    value = result
    for s in reversed(statements):
        if value.free_symbols.isdisjoint(_assigned(s)):
            continue
        if isinstance(s, Let):
            exact = s.expression if s.means is None else s.means
            value = value if s.opaque else value.xreplace({s.symbol: exact})
        elif isinstance(s, Several):
            value = value.xreplace(dict(zip(s.symbols, s.meanings, strict=True)))
        elif isinstance(s, Sums):
            value = s.of_one_row(value)
        elif s.condition in taken:
            yes = taken[s.condition]
            if s.unclaimed == ("yes" if yes else "no"):
                return
            value = value.xreplace({s.symbol: s.yes if yes else s.no})
        else:
            for side in (True, False):
                yield from _substituted(result, statements, taken | {s.condition: side})
            return
    facts: dict[sp.Basic, sp.Expr] = {}
    for s in statements:
        if isinstance(s, Choice) and s.condition in taken:
            facts |= s.if_yes if taken[s.condition] else s.if_no
    label = ", ".join(f"{c if side else sp.Not(c)}" for c, side in taken.items())
    free = value.replace(GUARDED, lambda v, _: v).replace(RAISED, lambda v, _: v)
    yield label, free, facts


class _Written(sp.Symbol):
    """Code in place of a symbol, printed in parentheses inside an operation."""

    precedence = PRECEDENCE["Lambda"]


@dataclass(frozen=True)
class Dialect:
    """The function that prints expressions, and the type annotation of numbers."""

    write: Callable[[sp.Basic], str]
    number: str

    @property
    def rows(self) -> str:
        """Type annotation of a table."""
        return f"Sequence[tuple[{self.number}, ...]]"


ARRAYS = Dialect(to_numpy, "Double")
"""Functions of NumPy for arrays."""
SCALARS = Dialect(to_math, "float")
"""Functions of Python's `math` for single numbers, for which they are much faster."""
QUIET_SCALARS = Dialect(to_numpy, "float")
"""Functions of NumPy for single numbers, which return NaN where those of `math` raise an error."""


def text(r: Routine, dialect: Dialect = ARRAYS) -> str:
    """Return the Python source of the function."""
    tables = {s.rows for s in r.statements if isinstance(s, Sums)}
    types = (dialect.rows if a in tables else dialect.number for a in r.arguments)
    of = ", ".join(f"{a}: {kind}" for a, kind in zip(r.arguments, types, strict=True))
    several = f"tuple[{', '.join([dialect.number] * len(r.results))}]"
    returns = dialect.number if len(r.results) == 1 else several
    lines = [f"def {r.name}({of}) -> {returns}:", f'    """{r.summary}"""']
    masks: dict[sp.Basic, str] = {}
    written: dict[sp.Symbol, sp.Symbol] = {}

    def write(expression: sp.Basic) -> str:
        return dialect.write(expression.xreplace(written))

    for s in r.statements:
        if isinstance(s, Let) and s.within:
            written[s.symbol] = _Written(write(s.expression))
        else:
            lines += (f"    {line}" for line in _lines(s, masks, write))
    values = [write(v) for v in r.results]
    if len(values) == 1 and dialect is ARRAYS:
        lines += [f"    value: Double = {values[0]}", "    return value"]
    else:
        lines.append(f"    return {', '.join(values)}")
    return "\n".join(lines)


def _lines(
    s: Statement, masks: dict[sp.Basic, str], write: Callable[[sp.Basic], str]
) -> Iterator[str]:
    if isinstance(s, Let):
        yield f"{s.symbol} = {write(s.expression)}" + (f"  # {s.comment}" if s.comment else "")
    elif isinstance(s, Several):
        names, given = map(str, s.symbols), map(write, s.arguments)
        yield f"{', '.join(names)} = {s.name}({', '.join(given)})"
    elif isinstance(s, Sums):
        yield f"{' = '.join(map(str, s.symbols))} = 0.0"
        yield f"for {', '.join(map(str, s.items))} in {s.rows}:"
        for step in s.steps:
            yield from (f"    {line}" for line in _lines(step, masks, write))
        yield from (f"    {x} += {write(e)}" for x, e in zip(s.symbols, s.terms, strict=True))
    else:
        yield from _choice_lines(s, masks)


def _choice_lines(s: Choice, masks: dict[sp.Basic, str]) -> Iterator[str]:
    if s.condition not in masks:
        named = {c: sp.Symbol(name) for c, name in masks.items()}
        masks[s.condition] = f"of_{s.symbol}"
        yield f"of_{s.symbol} = {to_numpy(s.condition.xreplace(named))}"
    mask = masks[s.condition]
    sides = []
    for value, safe, yes in ((s.yes, s.safe_yes, True), (s.no, s.safe_no, False)):
        copies = {}
        for symbol, harmless in safe.items():
            copies[symbol] = sp.Symbol(f"{symbol}_{'yes' if yes else 'no'}", positive=True)
            pair = (str(symbol), to_numpy(harmless))[:: 1 if yes else -1]
            yield f"{copies[symbol]} = np.where({mask}, {pair[0]}, {pair[1]})"
        sides.append(to_numpy(value.xreplace(copies)))
    yield f"{s.symbol} = np.where({mask}, {sides[0]}, {sides[1]})"
