"""A paper's hard cases, and the computation and record of their reference values."""

import json
import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import flint
from flint import arb

from derivation.engine.activity import Progress, quiet
from derivation.engine.files import write_file
from derivation.engine.formula.ball import to_ball
from derivation.engine.measure.case import HardCase
from derivation.engine.measure.kernels import Kernel
from derivation.engine.measure.origin import of_expression, of_modules
from derivation.engine.oracle.oracle import Balls
from derivation.engine.oracle.reference import DIGITS, Reference, Stored, reference_text, value_only

SAVED_EVERY = 30.0
"""Time after which new reference values are saved [s]."""

_SPARE = 2
"""Number of digits of a reference beyond the written ones."""

_SLOPE_DIGITS, _SLOPE_STEP, _SLOPE_BITS = 15, Fraction(1, 2**20), 512
"""Digits, relative step and bits of difference quotients; a few digits suffice for allowances."""

Given = Sequence[Any]
Values = Callable[[Given, int], tuple[arb, ...]]
"""Function of arguments and digits that returns balls, one for each result."""


@dataclass(frozen=True)
class HardLaw:
    """The references of a function without a closed formula in the derivation.

    Parameters
    ----------
    values
        Function of arguments and digits that returns its results.
    sizes
        Function of arguments and results that returns the magnitude to which the budget of each
        result refers; by default that of the result.
    conditioned
        Whether the effect of rounding the arguments is allowed in addition; not for functions whose
        budget is a relative error.
    slopes
        Function of arguments and results that returns the sum of |x df/dx| over the arguments for
        each result; by default from differences.
    scale
        Function of arguments and first result that returns a factor of the budget; by default 1.
    results
        Number of results.
    oracle
        Names of the modules on which the results depend.
    """

    values: Values
    sizes: Callable[[Given, Sequence[arb]], tuple[arb, ...]] | None = None
    conditioned: bool = True
    slopes: Callable[[Given, Sequence[arb]], Sequence[arb]] | None = None
    scale: Callable[[Given, arb], float] | None = field(default=None, kw_only=True)
    results: int = field(default=1, kw_only=True)
    oracle: tuple[str, ...] = field(kw_only=True)


class Known(NamedTuple):
    """The reference values of a case, and the hash of their sources; see `Suite.origin`."""

    origin: str
    references: Sequence[Stored]


@dataclass(frozen=True, eq=False)
class Suite:
    """A paper's hard cases and their references.

    Parameters
    ----------
    cases
        The cases.
    kernels
        Their functions, by name.
    printed
        The formulas as published, by the name of the derived one.
    balls
        References of formulas, functions and numbers by index.
    laws
        References of other kernels, by name.
    numbers
        Names of the modules on which the functions, and numbers by index, of `balls` depend.
    outwards
        Arguments that are increased for a difference quotient, while all others are decreased, so
        that no point lies outside the domain.

    Raises
    ------
    ValueError
        If a case appears twice.
    """

    cases: tuple[HardCase, ...]
    kernels: Mapping[str, Kernel]
    printed: Mapping[str, Kernel]
    balls: Balls
    laws: Mapping[str, HardLaw] = field(default_factory=dict)
    numbers: tuple[str, ...] = ()
    outwards: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        seen: set[str] = set()
        for case in self.cases:
            if case.key in seen:
                raise ValueError(f"expected each hard case once, got {case.key} twice; remove one")
            seen.add(case.key)

    def results(self, kernel: str) -> int:
        """Return the number of results of a function."""
        return self.laws[kernel].results if kernel in self.laws else 1

    def origin(self, kernel: str) -> str:
        """Return the hash of a function's derived expression, or of its oracle with its imports.

        A reference with another hash must be computed again.
        """
        if kernel in self.laws:
            return of_modules(self.laws[kernel].oracle)
        try:
            _, expression = self.balls.stated(kernel)
        except KeyError:  # a function or numbers by index
            return of_modules(self.numbers)
        return of_expression(expression)

    def references(self, case: HardCase) -> list[Stored]:
        """Compute the reference values of a case, for every result and every point."""
        results = range(self.results(case.kernel))
        if case.expect != "value":
            values = {"nan": "nan", "zero": "0"}
            return [value_only(values[case.expect])] * (len(results) * len(case.points))
        kernel, law = self.kernels[case.kernel], self.laws.get(case.kernel)
        rows = []
        for point in case.points:
            given = {name: point[name] for name in kernel.arguments}
            if law is not None:
                by_law = self._by_law(law, given)
            elif all(map(math.isfinite, given.values())):
                by_law = [self.balls.reference(kernel.name, given, DIGITS + _SPARE, case.modes)]
            else:
                rows.append([value_only("nan")])
                continue
            rows.append([reference_text(reference, case.format) for reference in by_law])
        return [row[result] for result in results for row in rows]

    def _by_law(self, law: HardLaw, point: Mapping[str, float]) -> list[Reference]:
        given = list(point.values())
        values = law.values(given, DIGITS + _SPARE)
        slopes: Sequence[arb] = [arb(0)] * len(values)
        if law.conditioned:
            slopes = law.slopes(given, values) if law.slopes else self._differences(law, point)
        sizes = law.sizes(given, values) if law.sizes else [abs(value) for value in values]
        scale = law.scale(given, values[0]) if law.scale else 1.0
        return [
            Reference(value, {"all": slope}, size, scale)
            for value, slope, size in zip(values, slopes, sizes, strict=True)
        ]

    def _differences(self, law: HardLaw, point: Mapping[str, float]) -> list[arb]:
        """Return the sum of |x df/dx| over the arguments, for every result."""
        given = list(point.values())
        here = law.values(given, _SLOPE_DIGITS)
        totals = [arb(0)] * len(here)
        for index, name in enumerate(point):
            step = _SLOPE_STEP if name in self.outwards else -_SLOPE_STEP
            moved: list[Any] = list(given)
            moved[index] = Fraction(given[index]) * (1 + step)
            changed = law.values(moved, _SLOPE_DIGITS)
            with flint.ctx.workprec(_SLOPE_BITS):
                totals = [
                    total + abs(new - old) / to_ball(_SLOPE_STEP)
                    for total, new, old in zip(totals, changed, here, strict=True)
                ]
        return totals


# --- the record


def known_of(data: Mapping[str, Any]) -> dict[str, Known]:
    """Return the recorded reference values by the key of their case."""
    return {row["key"]: Known(row["origin"], row["references"]) for row in data["cases"]}


def find_references(
    suite: Suite, recorded: Path, part: Path, progress: Progress = quiet
) -> dict[str, Known]:
    """Return the reference values of all cases by key; this takes minutes.

    Reference values whose sources have not changed are reused; the others are computed.

    Parameters
    ----------
    suite
        The cases.
    recorded
        The file with the recorded reference values.
    part
        File in which reference values are saved during the run, so that a stopped run can be
        continued.
    progress
        Called after every case with its function, its number and the number of cases.
    """
    known = _saved(recorded) | _saved(part)
    references: dict[str, Known] = {}
    saved = time.monotonic()
    try:
        for number, case in enumerate(suite.cases, start=1):
            here, old = suite.origin(case.kernel), known.get(case.key)
            stands = old is not None and old.origin == here and case.expect == "value"
            references[case.key] = old if old and stands else Known(here, suite.references(case))
            if time.monotonic() - saved > SAVED_EVERY:
                _save(part, references)
                saved = time.monotonic()
            progress(case.kernel, number, len(suite.cases))
    finally:
        _save(part, references)
    return references


def _saved(path: Path) -> dict[str, Known]:
    return known_of(json.loads(path.read_text())) if path.is_file() else {}


def _save(part: Path, references: Mapping[str, Known]) -> None:
    rows = [{"key": key, **known._asdict()} for key, known in references.items()]
    write_file(part, json.dumps({"cases": rows}))
