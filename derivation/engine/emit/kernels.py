"""Descriptions of generated functions (rows), from formulas, forms and budgets."""

import re
import textwrap
from collections.abc import Callable, Mapping, Set
from dataclasses import dataclass, field

import sympy as sp

from derivation.engine.emit.budgets import Budget
from derivation.engine.emit.printer import to_numpy
from derivation.engine.formula.notation import to_plain
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, applicable
from derivation.engine.rewrite.form import Branch, Form, Step, Switch


@dataclass(frozen=True)
class Style:
    """Conditions and text that a paper adds to its generated functions.

    Parameters
    ----------
    tested
        Conditions that limit a domain to the tested range, each with names of arguments: it applies
        to the functions that have all of them.
    remark
        Function from an expression to a text that is appended to the formula in the docstring.
    package
        Import name of the package in the examples; if it is empty, they import nothing.
    """

    tested: Mapping[str, Set[str]] = field(default_factory=dict)
    remark: Callable[[sp.Expr], str] = lambda _: ""
    package: str = ""


@dataclass(frozen=True)
class Line:
    """A line of code: a name, its value and a comment."""

    name: str
    code: str
    comment: str = ""


@dataclass(frozen=True)
class BranchText:
    """One side of a switch point as text."""

    guards: tuple[Line, ...]
    steps: tuple[Line, ...]
    value: str


@dataclass(frozen=True)
class SwitchText:
    """A choice between two branches as text."""

    mask: str
    variable: str
    at: str
    branches: tuple[BranchText, BranchText]


@dataclass(frozen=True)
class ArgumentText:
    """An argument as described in the docstring and the manifest."""

    name: str
    unit: str
    meaning: str
    domain: str


@dataclass(frozen=True)
class EmittedKernel:
    """A generated function: all data for its source code and the manifest."""

    name: str
    module: str
    summary: str
    meaning: str
    symbol: str
    latex: str
    unit: str
    equation: str
    formula: tuple[str, ...]
    original: tuple[str, ...]
    arguments: tuple[ArgumentText, ...]
    conditions: tuple[str, ...]
    budget: Budget
    modes: bool
    steps: tuple[Line, ...] = ()
    value: str = ""
    switch: SwitchText | None = None
    example: tuple[str, ...] = ()
    decades: int = 0

    @property
    def carried(self) -> tuple[str, ...]:
        """Last argument that is used, and the unused ones; empty if all are used."""
        code = set(re.findall(r"\w+", repr((self.value, self.steps, self.switch))))
        idle = [x.name for x in self.arguments if x.name not in code and not self.modes]
        return ([x.name for x in self.arguments if x.name in code][-1], *idle) if idle else ()

    @property
    def notes(self) -> tuple[str, ...]:
        """Lines of the docstring about error budget and domain."""
        return self.budget.notes(self.domain, self.decades)

    @property
    def domain(self) -> str:
        """Conditions outside which the function returns NaN."""
        return ", ".join(self.conditions)


def kernel_of_form(stable: Form, formula: Record, budget: Budget, style: Style) -> EmittedKernel:
    """Return the row of a function that evaluates a stable form."""
    switch = switch_text(stable.value, whole=True) if isinstance(stable.value, Switch) else None
    return kernel(
        formula,
        formula.arguments,
        stable.module,
        budget,
        style,
        steps=lines(stable.steps),
        value="" if switch else to_numpy(stable.value),
        switch=switch,
        decades=stable.decades,
    )


def kernel(
    formula: Record,
    arguments: tuple[Argument, ...],
    module: str,
    budget: Budget,
    style: Style,
    *,
    steps: tuple[Line, ...] = (),
    value: str,
    switch: SwitchText | None = None,
    modes: int = 0,
    result: sp.Expr | None = None,
    decades: int = 0,
) -> EmittedKernel:
    """Return the row of a function of the given arguments.

    `result` is the exact value of the example in the docstring, by default that of the formula;
    `modes` is the number of modes that the example sums, and 0 if the function is no modal sum;
    `decades` is that of the form.
    """
    names = {x.name for x in arguments}
    where = conditions(arguments, formula.where, style)
    meaning = to_plain(formula.meaning)
    total = "sum over j of " if modes else ""
    stated = formula.expression if formula.stated is None else formula.stated
    return EmittedKernel(
        name=formula.name,
        module=module,
        summary=meaning[0].upper() + meaning[1:] + ".",
        meaning=meaning,
        symbol=formula.latex,
        latex=f"{formula.latex} = {formula.right_hand_side}",
        unit=formula.unit,
        equation=formula.equation,
        formula=_wrap(f"{formula.name} = {total}{sp.sstr(stated)}{style.remark(stated)}"),
        original=() if stated == formula.expression else _wrap(sp.sstr(formula.expression)),
        arguments=tuple(argument_text(x, names) for x in arguments),
        conditions=where,
        budget=budget,
        modes=bool(modes),
        steps=steps,
        value=value,
        switch=switch,
        example=_example(
            formula,
            arguments,
            style.package,
            formula.expression if result is None else result,
            modes,
        ),
        decades=decades,
    )


def _example(
    formula: Record,
    arguments: tuple[Argument, ...],
    module: str,
    value: sp.Expr,
    modes: int = 0,
) -> tuple[str, ...]:
    """Return lines of a doctest at the vocabulary's sample values; empty if an argument has none.

    The expected number is evaluated by SymPy from `value`, not by the generated code. `module` is
    imported from, unless it is empty.
    """
    samples = formula.vocabulary.values
    if not all(x.name in samples for x in arguments):
        return ()
    exact = {x.symbol: sp.Float(samples[x.name], 40) for x in arguments}
    number = float(sp.N(value.xreplace(exact), 20))
    given = [*(samples[x.name] for x in arguments), *([f"modes={modes}"] if modes else [])]
    start = [f">>> from {module} import {formula.name}"] if module else []
    call = f"{formula.name}({', '.join(given)})"
    return (*start, f'>>> print(f"{{{call}:.10g}}")', f"{number:.10g}")


def _wrap(text: str) -> tuple[str, ...]:
    """Split a text into lines of at most 88 characters, at spaces only."""
    return tuple(
        textwrap.wrap(
            text, 88, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False
        )
    )


def argument_text(argument: Argument, names: set[str]) -> ArgumentText:
    """Return the text of an argument, with those of its conditions that apply."""
    domain = ", ".join(applicable(argument.domain, names))
    return ArgumentText(argument.name, argument.unit, argument.meaning, domain)


def conditions(
    arguments: tuple[Argument, ...], extra: tuple[str, ...], style: Style
) -> tuple[str, ...]:
    """Return the conditions that contain no other names than those of the arguments."""
    own = (condition for x in arguments for condition in x.domain)
    names = {x.name for x in arguments}
    tested = (text for text, used in style.tested.items() if used <= names)
    return (*applicable((*own, *extra), names), *tested)


def lines(steps: tuple[Step, ...]) -> tuple[Line, ...]:
    """Return steps as lines of code."""
    return tuple(Line(str(s.symbol), to_numpy(s.expression), s.comment) for s in steps)


def switch_text(switch: Switch, *, whole: bool = False) -> SwitchText:
    """Return a switch point as text.

    The branch above is evaluated at all points, with the variable limited to the switch point. The
    branch below is evaluated at its own points only: it selects them, unless it is part of a whole
    function, which is called with these points.
    """
    name = str(switch.variable)
    clamped = {switch.variable: f"np.maximum({name}, {float(switch.at)})"}
    below = _branch_text(switch.below, {} if whole else _guarded_inputs(switch.below), "low")
    return SwitchText(
        "below", name, to_numpy(switch.at), (below, _branch_text(switch.above, clamped, "high"))
    )


def _guarded_inputs(branch: Branch) -> dict[sp.Symbol, str]:
    """Return the inputs of a branch, restricted to its own points."""
    used = sp.Tuple(branch.value, *(step.expression for step in branch.steps)).free_symbols
    given = sorted(used - {step.symbol for step in branch.steps}, key=str)
    return {symbol: f"np.asarray({symbol})[below]" for symbol in given}


def _branch_text(branch: Branch, guards: Mapping[sp.Symbol, str], suffix: str) -> BranchText:
    copies = {symbol: sp.Symbol(f"{symbol}_{suffix}", real=True) for symbol in guards}
    own = tuple(Line(str(copies[symbol]), code) for symbol, code in guards.items())
    steps = tuple(Step(s.symbol, s.expression.xreplace(copies), s.comment) for s in branch.steps)
    return BranchText(own, lines(steps), to_numpy(branch.value.xreplace(copies)))


@dataclass(frozen=True)
class AsPrinted:
    """A published formula as a function: all data for its source code."""

    name: str
    summary: str
    equation: str
    formula: tuple[str, ...]
    unit: str
    arguments: tuple[ArgumentText, ...]
    value: str
    example: tuple[str, ...]


def as_printed(
    formula: Record,
    equation: str,
    expression: sp.Expr,
    arguments: tuple[Argument, ...],
    module: str,
) -> AsPrinted:
    """Return the row of a published formula, with meaning and unit of the derived formula.

    `expression` is the published right-hand side; `module` is the module of the function.
    """
    meaning = to_plain(formula.meaning)
    return AsPrinted(
        name=formula.name,
        summary=f"{meaning[0].upper()}{meaning[1:]}, as published.",
        equation=equation,
        formula=_wrap(f"{formula.name} = {sp.sstr(expression)}"),
        unit=formula.unit,
        arguments=tuple(argument_text(x, {x.name for x in arguments}) for x in arguments),
        value=to_numpy(expression),
        example=_example(formula, arguments, module, expression),
    )


def rows_by_module(kernels: tuple[EmittedKernel, ...]) -> Mapping[str, list[EmittedKernel]]:
    """Return rows grouped by module, in order of first appearance."""
    grouped: dict[str, list[EmittedKernel]] = {}
    for kernel in kernels:
        grouped.setdefault(kernel.module, []).append(kernel)
    return grouped
