"""The hard cases checked: generated and printed forms against the committed references."""

import importlib
import json
import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from typing import Any, Literal

import numpy as np

from derivation.engine.formula.ulp import Format, spacing_exponent, ulp_error
from derivation.engine.measure.evaluate import allowed_ulp
from derivation.engine.measure.kernels import Kernel
from derivation.engine.measure.record import provenance
from derivation.plate.cases.calls import Stating, others
from derivation.plate.cases.families import families
from derivation.plate.hard.case import HardCase, handed_over, written
from derivation.plate.hard.truth import DIGITS, Known, Stored, known_of, outputs, restored
from derivation.plate.judge import PACKAGE, generated_kernels, printed_kernels

COMMAND = "platecontact check hard-cases --update"
COLUMNS = ("group", "kernel", "cause", "#generated", "#printed", "#allowed", "kept")
_SIGNIFICANT = 3

Data = Mapping[str, Any]


@dataclass(frozen=True)
class HardRow:
    """What became of a case.

    Parameters
    ----------
    case
        The case.
    truth
        Its true values.
    error, allowed
        Error of the generated form and what is allowed, in ULP, where their ratio is
        largest. Infinite for NaN where the truth is finite, and the other way round.
    printed
        Largest error of the form as printed; None where there is none.
    problem
        Why the case failed; empty if it did not.
    """

    case: HardCase
    truth: Known
    error: float
    allowed: float
    printed: float | None
    problem: str

    @property
    def kept(self) -> bool:
        """Whether the case passed."""
        return not self.problem


def cases() -> tuple[HardCase, ...]:
    """Every hard case, those written by hand first.

    Raises
    ------
    ValueError
        For a case that stands there twice.
    """
    found = (*written(), *families())
    seen: set[str] = set()
    for case in found:
        if case.key in seen:
            raise ValueError(f"this hard case stands there twice: {case.key}")
        seen.add(case.key)
    return found


@cache
def kernels() -> dict[str, Kernel]:
    """Everything a hard case can be about, by name."""
    manifest = importlib.import_module("generated.manifest")
    found = {kernel.name: kernel for kernel in generated_kernels()}
    for row in manifest.CONTACT:
        call = getattr(importlib.import_module(f"generated.{row['module']}"), row["name"])
        found[row["name"]] = Kernel(
            row["name"], row["module"], tuple(row["arguments"]), call, float(row["budget"])
        )
    return found | {kernel.name: kernel for kernel in others()}


def committed(data: Data, given: Sequence[HardCase]) -> dict[str, Known]:
    """The references that were recorded.

    Raises
    ------
    ValueError
        Naming a case without one, and the command that finds it.
    """
    found = known_of(data)
    missing = [case.key for case in given if case.key not in found]
    if missing:
        raise ValueError(
            f"no reference for {len(missing)} hard cases, the first: {missing[0]}; run `{COMMAND}`"
        )
    return {case.key: found[case.key] for case in given}


def check(
    given: Sequence[HardCase],
    truth: Mapping[str, Known],
    known: Mapping[str, Kernel],
) -> tuple[HardRow, ...]:
    """Hold generated and printed forms to the references, case by case."""
    printed = {kernel.name: kernel for kernel in printed_kernels()}
    return tuple(
        _row(case, truth[case.key], known[case.kernel], printed.get(case.kernel)) for case in given
    )


def _row(case: HardCase, known: Known, kernel: Kernel, printed: Kernel | None) -> HardRow:
    stored = known.references
    results, problem = _results(case, kernel, stored)
    if not problem and results.shape[1:] != case.shape:
        problem = f"shape {results.shape[1:]}, expected {case.shape}"
    if not problem and str(results.dtype) != case.format.name:
        problem = f"{results.dtype}, expected {case.format.name}"
    values = results.ravel().tolist()
    if len(values) != len(stored):
        problem = problem or f"{len(values)} results for {len(stored)} references"
        values = [math.nan] * len(stored)
    error, allowed = 0.0, kernel.budget or 0.0
    if stored:
        budgets = _budgets(case, kernel, stored)
        error, allowed = _worst(values, stored, budgets, case.format)
    if problem:
        error = math.inf
    if not problem and not error <= allowed:
        problem = f"error of {error:.3g} ULP"
    shown = None
    if printed is not None and case.expect == "value" and stored:
        with np.errstate(all="ignore"):
            shown = _largest(_call(case, printed).ravel().tolist(), stored, case.format)
    return HardRow(case, known, error, allowed, shown, problem)


def _results(
    case: HardCase, kernel: Kernel, stored: Sequence[Stored]
) -> tuple[np.ndarray[Any, Any], str]:
    """Results, one output after the other, and what was wrong with the call.

    Any floating-point exception is an error but two: results may underflow, and those
    whose true value overflows may say so, or that a denominator has vanished.
    """
    overflown = any(row["value"] in ("inf", "-inf") for row in stored)
    beyond: Literal["ignore", "raise"] = "ignore" if overflown else "raise"
    try:
        with warnings.catch_warnings(), np.errstate(invalid="raise", under="ignore"):
            warnings.simplefilter("error")
            with np.errstate(over=beyond, divide=beyond):
                return _call(case, kernel), ""
    except Exception as error:  # whatever a kernel raises is a failure of the case
        return np.empty((0, *case.shape)), f"{type(error).__name__}: {error}"


def _call(case: HardCase, kernel: Kernel) -> np.ndarray[Any, Any]:
    """The kernel's results, of shape (outputs, *shape)."""
    if kernel.by_count:
        (count,) = case.numbers["count"]
        found = kernel.call(int(count))
        tables = found if outputs(kernel.name) > 1 else (found,)
        return np.stack([table[-1] for table in tables])
    arguments = handed_over(case, kernel.arguments)
    before = [np.array(x, copy=True) for x in arguments]
    modes = {} if case.modes is None else {"modes": case.modes}
    found = kernel.call(*arguments, **modes)
    for old, now in zip(before, arguments, strict=True):
        if not np.array_equal(old, now, equal_nan=True):
            raise ValueError("an argument was written to")
    results = found if outputs(kernel.name) > 1 else (found,)
    return np.stack([np.asarray(result) for result in results])


def _budgets(case: HardCase, kernel: Kernel, stored: Sequence[Stored]) -> list[float]:
    """What is allowed in ULP before conditioning, result by result."""
    if not isinstance(kernel, Stating):
        return [kernel.budget or 0.0] * len(stored)
    stated = np.ravel(kernel.stated(*handed_over(case, kernel.arguments))).tolist()
    units = (spacing_exponent(restored(row).value, case.format) for row in stored)
    return [error * 2.0**-unit for error, unit in zip(stated, units, strict=True)]


def _worst(
    values: Sequence[float], stored: Sequence[Stored], budgets: Sequence[float], fmt: Format
) -> tuple[float, float]:
    """Error and allowance in ULP where their ratio is largest."""
    pairs = [_judged(*row, fmt) for row in zip(values, stored, budgets, strict=True)]
    return max(pairs, key=lambda pair: pair[0] / pair[1])


def _judged(value: float, row: Stored, budget: float, fmt: Format) -> tuple[float, float]:
    if row["value"] in ("nan", "inf", "-inf"):
        true = float(row["value"])
        same = value == true or (math.isnan(value) and math.isnan(true))
        return (0.0 if same else math.inf), budget
    truth = restored(row)
    allowed = allowed_ulp(truth, budget * float(row["scale"]), fmt)
    return ulp_error(value, truth.value, fmt), allowed


def _largest(values: Sequence[float], stored: Sequence[Stored], fmt: Format) -> float:
    errors = (_judged(v, row, 1.0, fmt)[0] for v, row in zip(values, stored, strict=True))
    return max(errors)


def cells(row: HardRow) -> tuple[str, ...]:
    """A row's entries under `COLUMNS`, as text."""
    return (
        row.case.group,
        row.case.kernel,
        row.case.cause,
        f"{row.error:.3g}",
        "" if row.printed is None else f"{row.printed:.3g}",
        f"{row.allowed:.3g}",
        "yes" if row.kept else f"NO: {row.problem}",
    )


def as_data(rows: Sequence[HardRow]) -> dict[str, Any]:
    """Rows and provenance as plain data; infinities as text."""
    return {"provenance": provenance(DIGITS, PACKAGE), "cases": [_plain(row) for row in rows]}


def to_json(rows: Sequence[HardRow]) -> str:
    """The rows as JSON text, byte for byte the same for the same measurement."""
    return json.dumps(as_data(rows), indent=1, allow_nan=False) + "\n"


def _plain(row: HardRow) -> dict[str, Any]:
    case = {name: value for name, value in asdict(row.case).items() if value is not None}
    return case | {
        "inputs": {name: list(texts) for name, texts in row.case.inputs.items()},
        "key": row.case.key,
        "origin": row.truth.origin,
        "references": list(row.truth.references),
        "error": _rounded(row.error),
        "allowed": _rounded(row.allowed),
        "printed": None if row.printed is None else _rounded(row.printed),
        "kept": row.kept,
    }


def _rounded(number: float) -> float | str:
    return float(f"{number:.{_SIGNIFICANT}g}") if math.isfinite(number) else repr(number)
