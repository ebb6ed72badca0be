"""Checks and benchmarks of the plate code in addition to the stages of a build."""

import os
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from derivation.engine.activity import Progress, quiet
from derivation.engine.files import PACKAGE, measurements, write_file
from derivation.engine.measure.judge import Errors
from derivation.engine.measure.point import in_both_forms
from derivation.engine.measure.record import provenance
from derivation.engine.measure.result import CheckResult, all_passed
from derivation.engine.measure.search import Progress as SearchProgress
from derivation.engine.measure.search import Search
from derivation.engine.measure.search_record import (
    SearchRecord,
    recorded,
    search_and_record,
    seconds_of,
)
from derivation.engine.outputs import folder_for, plain, recorded_in, sorted_json
from derivation.engine.text import with_items
from derivation.plate.benchmark import run as accuracy_run
from derivation.plate.benchmark import speed, user_calls
from derivation.plate.contact.cases.check import KERNELS, LIMIT, ContactRow
from derivation.plate.contact.cases.check import check as measure_contact
from derivation.plate.contact.cases.reference_values import DIGITS
from derivation.plate.judge import PACKAGE as GENERATED
from derivation.plate.paper import PAPER
from derivation.plate.search.targets import targets
from derivation.scene.impact import selected_effects
from derivation.scene.model import NUMBERS, model_of
from derivation.scene.scene import load
from generated import contact_law, impact

MEASURED_CONTACT = measurements() / "contact.json"
MEASURED_SPEED = measurements() / "speed.json"
MEASURED_ACCURACY = measurements() / "accuracy.json"
EXAMPLE = PACKAGE / "scene" / "examples" / "paper.toml"


def check_contact(progress: Progress = quiet) -> CheckResult:
    """Compare contact law, its inversion and impact with both references; this takes minutes.

    Raises
    ------
    derivation.engine.oracle.agreement.OracleError
        If the two references contradict each other.
    """
    kernels: dict[str, Callable[..., Any]] = {
        name: impact.impact if name == "impact" else getattr(contact_law, name) for name in KERNELS
    }
    rows = measure_contact(kernels, processes=os.cpu_count() or 1, progress=progress)
    cells = [
        (r.kernel, r.points, r.digits, f"{r.double.max_ulp:.3g}",
         f"{r.double.ratio:.2f}", f"{r.budget:g}", "yes" if r.passed else "NO")
        for r in rows
    ]  # fmt: skip
    worst = [with_items(f"{row.kernel}:", [*map(in_both_forms, row.worst)]) for row in rows]
    return CheckResult(
        "Errors of the contact law",
        (
            "function",
            "#points",
            "#agreeing digits",
            "#max ULP",
            "#fraction of budget",
            "#budget",
            "passed",
        ),
        cells,
        lambda: contact_data(rows),
        all(row.passed for row in rows),
        listings=[("Worst arguments", worst)],
        budgeted=rows,
    )


def contact_data(rows: tuple[ContactRow, ...]) -> dict[str, Any]:
    """Return the rows of the contact law as plain data, with their provenance."""
    data = [
        asdict(row) | {"double": _short(row.double), "single": row.single and _short(row.single)}
        for row in rows
    ]
    return {"provenance": provenance(DIGITS, GENERATED), "limit": LIMIT, "rows": plain(data)}


def _short(errors: Errors) -> dict[str, Any]:
    """Return the recorded part of a function's errors in one floating-point format."""
    kept = ("points", "max_ulp", "needed", "ratio", "dtype")
    worst = [exact for _, exact, _ in errors.worst.arguments]
    return {name: getattr(errors, name) for name in kept} | {"worst": worst}


def check_speed(progress: Progress = quiet) -> CheckResult:
    """Measure run times of contact law, impact and program start, and compare with limits."""
    examples = sorted(EXAMPLE.parent.glob("*.toml"))
    solved = [path for path in examples if selected_effects(load(path))[1].law.solved]
    timings = speed.measure(examples, solved, progress, user_calls.comparisons())
    columns = ("measurement", "#measured", "#limit", "passed")
    cells = [
        (t.name, f"{t.value:.3g} {t.unit}", f"{t.limit:g}", "yes" if t.passed else "NO")
        for t in timings
    ]
    return CheckResult(
        "Run times", columns, cells, lambda: speed.as_data(timings), all_passed(timings)
    )


def accuracy(
    methods: Sequence[str] = (),
    quick: bool = False,
    scene: Path | None = None,
    out: Path | None = None,
    progress: Progress = quiet,
    update: bool = False,
) -> tuple[dict[str, Any], Path | None]:
    """Measure accuracy against run time; save the result with `out` or `update`.

    Parameters
    ----------
    methods
        Families of methods; all if empty.
    quick
        Whether to run fewer methods and rounds.
    scene
        A scene file instead of the paper's case.
    out
        File for the result.
    progress
        Called at each step.
    update
        Whether to replace the committed measurement.

    Returns
    -------
    dict, Path or None
        The result as plain data, and the file to which it was written.

    Raises
    ------
    ValueError
        If a method is unknown, the scene cannot be used, or `update` is combined with `methods`,
        `quick`, `scene` or `out`.
    OSError
        If the file cannot be written.
    """
    if update and (methods or quick or scene is not None or out is not None):
        raise ValueError(
            "--update replaces the whole committed measurement and cannot be combined with "
            "--method, --quick, --scene or --out; remove --update, or these options"
        )
    path = recorded_in(MEASURED_ACCURACY, update, out)
    case = None
    if scene is not None:
        model = model_of(load(scene), quasi_static=True)
        case = accuracy_run.scene_case(**dict(zip(NUMBERS, model.numbers, strict=True)))
    data = accuracy_run.measure(methods, quick, case, progress)
    if path is not None:
        write_file(path, sorted_json(data))
    return data, path


def search_worse(
    duration: str,
    seed: int = 1,
    functions: Sequence[str] = (),
    out: Path | None = None,
    progress: SearchProgress | None = None,
) -> tuple[Search, SearchRecord]:
    """Search for larger errors for some time, and write each new worst case to a file.

    Parameters
    ----------
    duration
        Duration of the search, such as ``60s``, ``5m`` or ``1h``.
    seed
        Random seed.
    functions
        Names of the functions; all if empty.
    out
        File for the worst cases; by default ``search.toml`` in the paper's report folder.
    progress
        Called at each function's turn.

    Returns
    -------
    Search, Book
        The search with its results, and the file of worst cases.

    Raises
    ------
    ValueError
        If the duration or a function name is invalid, or the file is not one of worst cases.
    OSError
        If the file cannot be written.
    """
    seconds = seconds_of(duration)
    known = recorded(PAPER.measured, MEASURED_CONTACT)
    path = folder_for(None, PAPER.report_folder) / "search.toml" if out is None else out
    return search_and_record(targets(functions), known, seconds, seed, path, progress)
