"""A suite of hard cases: what a paper hands in, and the references, found one by one and kept."""

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

from derivation.engine.activity import Tell, quiet
from derivation.engine.files import write_file
from derivation.engine.formula.ball import to_ball
from derivation.engine.measure.case import HardCase
from derivation.engine.measure.kernels import Kernel
from derivation.engine.measure.origin import of_expression, of_modules
from derivation.engine.oracle.oracle import Balls
from derivation.engine.oracle.reference import DIGITS, Reference, Stored, bare, stored

SAVED_EVERY = 30.0
"""Seconds."""

_SPARE = 2
"""Digits of a reference beyond those written."""

_SLOPE_DIGITS, _SLOPE_STEP, _SLOPE_BITS = 15, Fraction(1, 2**20), 512
"""Sensitivities only set allowances: a difference quotient to a few digits will do."""

Given = Sequence[Any]
Values = Callable[[Given, int], tuple[arb, ...]]
"""Arguments and digits -> balls, one for each result."""


@dataclass(frozen=True)
class HardLaw:
    """What a kernel without a closed formula of the chain is compared with.

    Parameters
    ----------
    values
        Its results.
    sizes
        From arguments and results, what the budget counts in units of; the results' own
        magnitudes if there is nothing else to say.
    conditioned
        Whether what rounding the arguments does is allowed on top; not where a kernel
        promises a relative error.
    slopes
        From arguments and results, the sum of |x df/dx| over the arguments, of each result;
        found by differences if there is no quicker way.
    scale
        From arguments and first result, what multiplies the budget; nothing if left out.
    results
        How many results the kernel has.
    oracle
        Modules that the results follow from.
    """

    values: Values
    sizes: Callable[[Given, Sequence[arb]], tuple[arb, ...]] | None = None
    conditioned: bool = True
    slopes: Callable[[Given, Sequence[arb]], Sequence[arb]] | None = None
    scale: Callable[[Given, arb], float] | None = field(default=None, kw_only=True)
    results: int = field(default=1, kw_only=True)
    oracle: tuple[str, ...] = field(kw_only=True)


class Known(NamedTuple):
    """The references of a case, and the hash of what they follow from, see `Suite.origin`."""

    origin: str
    references: Sequence[Stored]


@dataclass(frozen=True, eq=False)
class Suite:
    """A paper's hard cases and what they are compared with.

    Parameters
    ----------
    cases
        The cases.
    kernels
        What they are about, by name.
    printed
        The formulas as printed, by the name of the derived one.
    balls
        References of formulas, functions and numbers by index.
    laws
        References of other kernels, by name.
    numbers
        Modules that the functions and numbers by index among the `balls` follow from.
    outwards
        Arguments that are moved upwards for a difference quotient, all others downwards, so that
        no point comes to lie outside the domain.

    Raises
    ------
    ValueError
        For a case that stands there twice.
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
                raise ValueError(f"this hard case stands there twice: {case.key}")
            seen.add(case.key)

    def results(self, kernel: str) -> int:
        """How many results a kernel has."""
        return self.laws[kernel].results if kernel in self.laws else 1

    def origin(self, kernel: str) -> str:
        """Hash of a kernel's derived expression, or of its oracle: the modules and all they import.

        A reference with another one has to be found anew.
        """
        if kernel in self.laws:
            return of_modules(self.laws[kernel].oracle)
        try:
            _, expression = self.balls.stated(kernel)
        except KeyError:  # a function or numbers by index
            return of_modules(self.numbers)
        return of_expression(expression)

    def references(self, case: HardCase) -> list[Stored]:
        """The truth of a case: for every result, and of each for every point."""
        results = range(self.results(case.kernel))
        if case.expect != "value":
            values = {"nan": "nan", "zero": "0"}
            return [bare(values[case.expect])] * (len(results) * len(case.points))
        kernel, law = self.kernels[case.kernel], self.laws.get(case.kernel)
        rows = []
        for point in case.points:
            given = {name: point[name] for name in kernel.arguments}
            if law is not None:
                found = self._by_law(law, given)
            elif all(map(math.isfinite, given.values())):
                found = [self.balls.reference(kernel.name, given, DIGITS + _SPARE, case.modes)]
            else:
                rows.append([bare("nan")])
                continue
            rows.append([stored(reference, case.format) for reference in found])
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
        """Of every result, the sum of |x df/dx| over the arguments."""
        given = list(point.values())
        here = law.values(given, _SLOPE_DIGITS)
        totals = [arb(0)] * len(here)
        for place, name in enumerate(point):
            step = _SLOPE_STEP if name in self.outwards else -_SLOPE_STEP
            moved: list[Any] = list(given)
            moved[place] = Fraction(given[place]) * (1 + step)
            there = law.values(moved, _SLOPE_DIGITS)
            with flint.ctx.workprec(_SLOPE_BITS):
                totals = [
                    total + abs(new - old) / to_ball(_SLOPE_STEP)
                    for total, new, old in zip(totals, there, here, strict=True)
                ]
        return totals


# --- the record


def known_of(data: Mapping[str, Any]) -> dict[str, Known]:
    """What is recorded, by key."""
    return {row["key"]: Known(row["origin"], row["references"]) for row in data["cases"]}


def find_references(
    suite: Suite, recorded: Path, part: Path, tell: Tell = quiet
) -> dict[str, Known]:
    """The truth of every case by its key, from the original expressions: minutes.

    Those that stand are kept, all saved as they come.

    Parameters
    ----------
    suite
        The cases.
    recorded
        The record so far. References that follow from what they would follow from now are
        taken over.
    part
        Where references are saved while others are sought, for a run after one that was stopped.
    tell
        Told about every case that is done: its kernel, its number, and how many there are.
    """
    known = _standing(recorded) | _standing(part)
    found: dict[str, Known] = {}
    saved = time.monotonic()
    try:
        for number, case in enumerate(suite.cases, start=1):
            here, old = suite.origin(case.kernel), known.get(case.key)
            stands = old is not None and old.origin == here and case.expect == "value"
            found[case.key] = old if old and stands else Known(here, suite.references(case))
            if time.monotonic() - saved > SAVED_EVERY:
                _save(part, found)
                saved = time.monotonic()
            tell(case.kernel, number, len(suite.cases))
    finally:
        _save(part, found)
    return found


def _standing(path: Path) -> dict[str, Known]:
    return known_of(json.loads(path.read_text())) if path.is_file() else {}


def _save(part: Path, found: Mapping[str, Known]) -> None:
    rows = [{"key": key, **known._asdict()} for key, known in found.items()]
    write_file(part, json.dumps({"cases": rows}))
