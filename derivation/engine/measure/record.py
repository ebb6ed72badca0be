"""The result of a check as JSON with provenance, and as a table."""

import hashlib
import importlib
import platform
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import flint
import mpmath
import numpy as np
import sympy as sp

from derivation.engine.measure.check import Row
from derivation.engine.measure.result import CheckResult
from derivation.engine.outputs import plain_rows, sorted_json
from derivation.engine.text import paragraph, with_items

COLUMNS = (
    "function",
    "#points",
    "#max ULP",
    "#p99 ULP",
    "#used",
    "#budget",
    "pass",
)
NOTE = (
    "p99: 99th percentile; used: largest error over the allowed error, which is the budget plus an "
    "allowance for conditioning."
)
"""Explanation of `COLUMNS`."""


def cells(row: Row) -> tuple[str, ...]:
    """Return a row's entries under `COLUMNS`, as text."""
    errors = row.double
    largest = "infinite" if errors.not_finite else f"{errors.max_ulp:.3g}"
    return (
        row.kernel if row.passed is not None else f"{row.module}.{row.kernel}",
        str(errors.points),
        largest,
        f"{errors.p99_ulp:.3g}",
        "" if errors.ratio is None else f"{errors.ratio:.2f}",
        "" if row.budget is None else f"{row.budget:g}",
        {True: "yes", False: "NO", None: ""}[row.passed],
    )


def worst(row: Row) -> str:
    """Return the arguments with the largest ratio of error to allowance, decimal and exact."""
    worst_row = row.double.worst
    arguments = [f"{name}={text} ({exact})" for name, exact, text in worst_row.arguments]
    modes = [f"modes={worst_row.modes}"] if worst_row.modes else []
    return with_items(f"{row.kernel}:", arguments + modes)


def unconfirmed(rows: Sequence[Row]) -> tuple[str, ...]:
    """Return a sentence about functions that no independent method confirms, if there are any."""
    names = [row.kernel for row in rows if row.budget is not None and not row.oracles]
    if not names:
        return ()
    return (f"No independent reference confirms {', '.join(names)}: add one to ROUTES.",)


def result(rows: Sequence[Row], digits: int, package: str) -> CheckResult:
    """Return the rows as a table, with the worst arguments of the functions that have a budget."""
    return CheckResult(
        f"Errors against {digits} digits",
        COLUMNS,
        [cells(row) for row in rows],
        lambda: as_data(rows, digits, package),
        all(row.passed is not False for row in rows),
        note=paragraph(" ".join((NOTE, *unconfirmed(rows))), 0),
        listings=[("Worst arguments", [worst(row) for row in rows if row.passed is not None])],
        budgeted=rows,
    )


def provenance(digits: int, package: str) -> dict[str, str | int]:
    """Return versions, hash of the package and digits; times and the machine are not included."""
    return {
        "digits": digits,
        "generated": generated_hash(package),
        "mpmath": mpmath.__version__,
        "numpy": np.__version__,
        "python": platform.python_version(),
        "python-flint": flint.__version__,
        "sympy": sp.__version__,
    }


def generated_hash(package: str) -> str:
    """Return the SHA-256 of a generated package: names and contents in the order of the names.

    Raises
    ------
    FileNotFoundError
        If the package has no file `__init__.py`.
    """
    origin = importlib.import_module(package).__file__
    if origin is None:
        raise FileNotFoundError(
            f"the package {package!r} has no files: run `platecontact generate`"
        )
    digest = hashlib.sha256()
    for path in sorted(Path(origin).parent.glob("*.py")):
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()


def as_data(rows: Sequence[Row], digits: int, package: str) -> dict[str, Any]:
    """Return rows and provenance as plain data; infinities as the text "inf"."""
    return {
        "provenance": provenance(digits, package),
        "rows": plain_rows(rows),
    }


def to_json(rows: Sequence[Row], digits: int, package: str) -> str:
    """Return the rows as JSON text; equal measurements give equal bytes."""
    return sorted_json(as_data(rows, digits, package))
