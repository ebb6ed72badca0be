"""Check of the hard cases: generated functions and published formulas against references."""

import json
import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from derivation.engine.formula.ulp import spacing_exponent
from derivation.engine.measure.case import HardCase, call_arguments
from derivation.engine.measure.judge import judge, largest
from derivation.engine.measure.kernels import Kernel, Stating
from derivation.engine.measure.record import provenance
from derivation.engine.measure.result import CheckResult
from derivation.engine.measure.suite import Known, Suite, known_of
from derivation.engine.oracle.reference import DIGITS, Reference, reference_from_text
from derivation.engine.text import paragraph

COMMAND = "platecontact check hard-cases --update"
COLUMNS = ("group", "#cases", "#error/limit", "passed")
NOTE = (
    "error/limit: the largest in the group, of the generated functions. With --json FILE, each "
    "case is written with its cause, and with the error of the published formula."
)
"""Explanation of `COLUMNS`."""
_SIGNIFICANT = 3

Data = Mapping[str, Any]


@dataclass(frozen=True)
class HardRow:
    """The result of a case.

    Parameters
    ----------
    case
        The case.
    reference
        Its reference values and their origin.
    error, allowed
        Error of the generated function and its allowance, in ULP, where their ratio is largest. The
        error is infinite for NaN where the reference is finite, and vice versa, and if the call
        failed or gave results of another shape or type.
    printed
        Largest error of the published formula in ULP; None if there is none.
    problem
        Reason why the case failed; empty if it passed.
    """

    case: HardCase
    reference: Known
    error: float
    allowed: float
    printed: float | None
    problem: str

    @property
    def passed(self) -> bool:
        """Whether the case passed."""
        return not self.problem


def committed_references(data: Data, given: Sequence[HardCase]) -> dict[str, Known]:
    """Return the recorded reference values by the key of their case.

    Parameters
    ----------
    data
        Content of the record, ``hard.json``.
    given
        The cases.

    Raises
    ------
    ValueError
        If a case has none; the message states the first such case and the command that computes
        its reference values.
    """
    references = known_of(data)
    missing = [case.key for case in given if case.key not in references]
    if missing:
        raise ValueError(
            f"no reference for {len(missing)} hard cases, the first: {missing[0]}; run `{COMMAND}`"
        )
    return {case.key: references[case.key] for case in given}


def check(suite: Suite, references: Mapping[str, Known]) -> tuple[HardRow, ...]:
    """Compare generated functions and published formulas with reference values, case by case.

    Parameters
    ----------
    suite
        The cases and their functions.
    references
        Reference values by the key of their case.

    Returns
    -------
    tuple of HardRow
        A row for each case, in order.
    """
    return tuple(_row(suite, case, references[case.key]) for case in suite.cases)


def _row(suite: Suite, case: HardCase, known: Known) -> HardRow:
    kernel, count = suite.kernels[case.kernel], suite.results(case.kernel)
    true = [reference_from_text(row) for row in known.references]
    results, problem = _results(case, kernel, count, true)
    if not problem and results.shape[1:] != case.shape:
        problem = f"shape {results.shape[1:]}, expected {case.shape}"
    if not problem and str(results.dtype) != case.format.name:
        problem = f"{results.dtype}, expected {case.format.name}"
    values = results.ravel().tolist()
    if len(values) != len(true):
        problem = problem or f"{len(values)} results for {len(true)} references"
        values = [math.nan] * len(true)
    error, allowed = 0.0, kernel.budget or 0.0
    if true:
        judged = zip(values, true, _budgets(case, kernel, true), strict=True)
        worst = largest(judge(*one, case.format) for one in judged)
        error, allowed = worst.ulp, worst.allowed
    if problem:
        error = math.inf
    if not problem and not error <= allowed:
        problem = f"error of {error:.3g} ULP"
    shown, printed = None, suite.printed.get(case.kernel)
    if printed is not None and case.expect == "value" and true:
        with np.errstate(all="ignore"):
            values = _call(case, printed, count).ravel().tolist()
        pairs = zip(values, true, strict=True)
        shown = max(judge(got, one, 1.0, case.format).ulp for got, one in pairs)
    return HardRow(case, known, error, allowed, shown, problem)


def _results(
    case: HardCase, kernel: Kernel, count: int, true: Sequence[Reference]
) -> tuple[np.ndarray[Any, Any], str]:
    """Return the results, one output after the other, and a description of an error in the call.

    Warnings and floating-point exceptions are errors, except underflow, and except overflow and
    division by zero if a reference value is infinite.
    """
    overflown = any(math.isinf(float(one.value)) for one in true)
    beyond: Literal["ignore", "raise"] = "ignore" if overflown else "raise"
    try:
        with warnings.catch_warnings(), np.errstate(invalid="raise", under="ignore"):
            warnings.simplefilter("error")
            with np.errstate(over=beyond, divide=beyond):
                return _call(case, kernel, count), ""
    except Exception as error:  # any exception of a function is a failure of the case
        return np.empty((0, *case.shape)), f"{type(error).__name__}: {error}"


def _call(case: HardCase, kernel: Kernel, count: int) -> np.ndarray[Any, Any]:
    """Return the function's results, of shape (count, *shape)."""
    if kernel.by_count:
        (last,) = case.numbers["count"]
        values = kernel.call(int(last))
        tables = values if count > 1 else (values,)
        return np.stack([table[-1] for table in tables])
    arguments = call_arguments(case, kernel.arguments)
    before = [np.array(x, copy=True) for x in arguments]
    modes = {} if case.modes is None else {"modes": case.modes}
    values = kernel.call(*arguments, **modes)
    for old, now in zip(before, arguments, strict=True):
        if not np.array_equal(old, now, equal_nan=True):
            raise ValueError("an argument was written to")
    results = values if count > 1 else (values,)
    return np.stack([np.asarray(result) for result in results])


def _budgets(case: HardCase, kernel: Kernel, true: Sequence[Reference]) -> list[float]:
    """Return the budgets in ULP, without conditioning, result by result."""
    if not isinstance(kernel, Stating):
        return [kernel.budget or 0.0] * len(true)
    stated = np.ravel(kernel.stated(*call_arguments(case, kernel.arguments))).tolist()
    units = (spacing_exponent(one.value, case.format) for one in true)
    return [error * 2.0**-unit for error, unit in zip(stated, units, strict=True)]


def cells(rows: Sequence[HardRow]) -> list[tuple[str, ...]]:
    """Return the entries of each group under `COLUMNS`, as text."""
    groups: dict[str, list[HardRow]] = {}
    for row in rows:
        groups.setdefault(row.case.group, []).append(row)
    return [
        (
            group,
            str(len(rows)),
            f"{max(_ratio(row) for row in rows):.2f}",
            "yes" if all(row.passed for row in rows) else "NO",
        )
        for group, rows in groups.items()
    ]


def _ratio(row: HardRow) -> float:
    """Return error over allowance; without an allowance 0 for no error, else infinity."""
    if row.allowed:
        return row.error / row.allowed
    return math.inf if row.error else 0.0


def as_data(rows: Sequence[HardRow], package: str) -> dict[str, Any]:
    """Return rows and provenance as plain data; infinities as text."""
    return {"provenance": provenance(DIGITS, package), "cases": [_plain(row) for row in rows]}


def result(rows: Sequence[HardRow], package: str) -> CheckResult:
    """Return the groups of cases as a table, and the cases that failed."""
    failed = [
        f"{row.case.key}: {row.problem} ({row.error:.3g} ULP, {row.allowed:.3g} allowed). "
        f"{row.case.cause}"
        for row in rows
        if not row.passed
    ]
    return CheckResult(
        "Hard cases",
        COLUMNS,
        cells(rows),
        lambda: as_data(rows, package),
        not failed,
        note=paragraph(NOTE, 0),
        listings=[(f"{len(rows)} cases, {len(failed)} failed", failed)],
    )


def to_json(rows: Sequence[HardRow], package: str) -> str:
    """Return the rows as JSON text; equal measurements give equal bytes."""
    return json.dumps(as_data(rows, package), indent=1, allow_nan=False) + "\n"


def _plain(row: HardRow) -> dict[str, Any]:
    case = {name: value for name, value in asdict(row.case).items() if value is not None}
    return case | {
        "inputs": {name: list(texts) for name, texts in row.case.inputs.items()},
        "key": row.case.key,
        "origin": row.reference.origin,
        "references": list(row.reference.references),
        "error": _rounded(row.error),
        "allowed": _rounded(row.allowed),
        "printed": None if row.printed is None else _rounded(row.printed),
        "passed": row.passed,
    }


def _rounded(number: float) -> float | str:
    return float(f"{number:.{_SIGNIFICANT}g}") if math.isfinite(number) else repr(number)
