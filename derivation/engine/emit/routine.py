"""Routines: printed functions of several steps and results, each result proved to be its claim.

A `Form` is one value with one switch in one argument. A routine is a list of statements with any
number of results and of choices on computed conditions, and with calls of functions that have
several results. Its proof puts all statements back, for every combination of choices that a
result depends on.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.printing.precedence import PRECEDENCE

from derivation.engine.emit.printer import to_math, to_numpy
from derivation.engine.formula.proof import Proof, prove

GUARDED = sp.Function("np.minimum")
"""A value held below a bound that it does not exceed where the branch counts."""
RAISED = sp.Function("np.maximum")
"""A value held above a bound that it is not below where the branch counts."""
Facts = Mapping[sp.Basic, sp.Expr]
"""What symbols stand for, or are equal to on one side of a choice."""


@dataclass(frozen=True)
class Let:
    """``symbol = expression  # comment``.

    Parameters
    ----------
    symbol, expression, comment
        The line of code.
    opaque
        The claim holds whatever this is, such as a common scale.
    means
        What it is exactly: a lemma, proved on its own and then used.
    within
        It has no line but is written where it is used, once, so that NumPy works in place.
    """

    symbol: sp.Symbol
    expression: sp.Expr
    comment: str = ""
    opaque: bool = False
    means: sp.Expr | None = None
    within: bool = False


@dataclass(frozen=True)
class Several:
    """``a, b = name(*arguments)``.

    Parameters
    ----------
    symbols
        What is assigned.
    name, arguments
        A function of the package, and what it is given.
    meanings
        What each of its results is exactly.
    """

    symbols: tuple[sp.Symbol, ...]
    name: str
    arguments: tuple[sp.Expr, ...]
    meanings: tuple[sp.Expr, ...]


@dataclass(frozen=True)
class Choice:
    """``symbol = np.where(condition, yes, no)``; equal conditions share one mask.

    Parameters
    ----------
    symbol, condition, yes, no
        The line of code.
    if_yes, if_no
        What holds on each side, which its proof alone may use.
    safe_yes, safe_no
        Harmless values of symbols for the points that a side is not for.
    unclaimed
        "yes" or "no" if that side is a guard and no part of the claim.
    reason
        Why it is not.
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
    """``for items in rows:`` some steps, then ``symbol += term`` for each symbol.

    A result may depend on the totals linearly, and is then proved for a single row.

    Parameters
    ----------
    symbols, terms
        The totals, and what a row adds to each.
    rows
        A table of the package, or an argument.
    items
        What a row holds.
    steps
        What is computed first of each row.
    """

    symbols: tuple[sp.Symbol, ...]
    terms: tuple[sp.Expr, ...]
    rows: sp.Symbol
    items: tuple[sp.Symbol, ...]
    steps: tuple[Let, ...] = ()

    def of_one_row(self, value: sp.Expr) -> sp.Expr:
        """A value with the totals of a single row."""
        value = value.xreplace(dict(zip(self.symbols, self.terms, strict=True)))
        for step in reversed(self.steps):
            value = value.xreplace({step.symbol: step.expression})
        return value


Statement = Let | Several | Choice | Sums


@dataclass(frozen=True)
class Routine:
    """A printed function, and the proof that its results are what is claimed."""

    name: str
    arguments: tuple[sp.Symbol, ...]
    statements: tuple[Statement, ...]
    results: tuple[sp.Expr, ...]
    summary: str
    proof: Proof

    @property
    def calls(self) -> set[str]:
        """Names of the package's functions that it needs."""
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
    """The expressions of a statement's code."""
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
    """Refuse arguments that no statement uses.

    Raises
    ------
    ValueError
        Naming them.
    """
    expressions = (*results, *(e for s in statements for e in _used(s)))
    used = {x for e in expressions for x in e.free_symbols}
    if idle := [str(x) for x in arguments if x not in used]:
        raise ValueError(f"{name}: expected arguments that count, got {', '.join(idle)}")


def _check_sums(name: str, statements: tuple[Statement, ...], results: tuple[sp.Expr, ...]) -> None:
    """Refuse totals that results do not depend on linearly.

    Raises
    ------
    ValueError
        Naming the routine.
    """
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
    """Build a routine, proving each result in every combination of choices.

    Parameters
    ----------
    name, arguments, statements, results, summary
        The function.
    claims
        What each result is, in the theory's expressions; None for a sign or a mask.
    meaning
        What the arguments stand for in the theory.
    reduce
        The subject's own way to a normal form, 0 for what vanishes.

    Raises
    ------
    ProofError
        Naming the result, and the choices taken, if it is not its claim.
    """
    statements = tuple(statements)
    _check_arguments(name, arguments, statements, results)
    _check_sums(name, statements, results)
    residuals = {}
    for k, s in enumerate(statements):
        if isinstance(s, Let) and s.means is not None:
            for label, value, facts in _undone(s.expression, statements[:k]):
                left = (value.subs(meaning) - s.means).subs(facts)
                residuals[f"{s.symbol} {label}".strip()] = reduce(left)
    for i, (result, claim) in enumerate(zip(results, claims, strict=True)):
        for label, value, facts in () if claim is None else _undone(result, statements):
            left = (value.subs(meaning) - claim).subs(facts)
            residuals[f"{name}[{i}] {label}".strip()] = reduce(left)
    proof = prove(
        f"Routine {name}", "All statements put back, for every combination of choices.", residuals
    )
    return Routine(name, arguments, statements, results, summary, proof)


def _undone(
    result: sp.Expr, statements: tuple[Statement, ...], sides: Mapping[sp.Basic, bool] | None = None
) -> Iterator[tuple[str, sp.Expr, dict[sp.Basic, sp.Expr]]]:
    """The result with every statement put back, for every combination of choices it depends on."""
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
                yield from _undone(result, statements, taken | {s.condition: side})
            return
    facts: dict[sp.Basic, sp.Expr] = {}
    for s in statements:
        if isinstance(s, Choice) and s.condition in taken:
            facts |= s.if_yes if taken[s.condition] else s.if_no
    label = ", ".join(f"{c if side else sp.Not(c)}" for c, side in taken.items())
    free = value.replace(GUARDED, lambda v, _: v).replace(RAISED, lambda v, _: v)
    yield label, free, facts


class _Written(sp.Symbol):
    """Code in place of a symbol, put in parentheses wherever an operation follows."""

    precedence = PRECEDENCE["Lambda"]


@dataclass(frozen=True)
class Dialect:
    """How expressions are written, and the type of numbers."""

    write: Callable[[sp.Basic], str]
    number: str

    @property
    def rows(self) -> str:
        """Type of a table."""
        return f"Sequence[tuple[{self.number}, ...]]"


ARRAYS = Dialect(to_numpy, "Double")
"""NumPy's functions of arrays."""
SCALARS = Dialect(to_math, "float")
"""Python's functions of single numbers, which are much faster on these."""
QUIET_SCALARS = Dialect(to_numpy, "float")
"""NumPy's functions of single numbers: they give NaN where Python's raise an error."""


def text(r: Routine, dialect: Dialect = ARRAYS) -> str:
    """Python source of the function."""
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
        yield from _chosen(s, masks)


def _chosen(s: Choice, masks: dict[sp.Basic, str]) -> Iterator[str]:
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
