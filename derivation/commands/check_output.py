"""Runs a check and shows its result: progress, JSON, tables, tighter budgets, exit status."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import typer

from derivation.engine.activity import Progress
from derivation.engine.console import (
    OUT,
    listing,
    progress_bar,
    table,
    write_json_output,
    write_output,
)
from derivation.engine.files import write_file
from derivation.engine.outputs import expect_recordable

if TYPE_CHECKING:
    from derivation.engine.measure.result import CheckResult


def show_check(
    measure: Callable[[Progress], "CheckResult"],
    json: str | None,
    suggest_budgets: bool = False,
    record: Path | None = None,
) -> NoReturn:
    """Run a check, save its result if `record` is given, and exit: 0 if it passed, 1 if not."""
    if record:
        expect_recordable(record)
    with progress_bar("check") as progress:
        result = measure(progress)
    if record:
        write_file(record, result.record())
    budgets = []
    if suggest_budgets:
        from derivation.engine.measure.suggest import suggestions

        budgets = suggestions(result.budgeted)
    tighter = {"suggested_budgets": {budget.name: budget.ulp for budget in budgets}}
    if write_json_output(
        lambda: result.data() | tighter if suggest_budgets else result.data(), json
    ):
        if result.columns:
            table(result.title, result.columns, result.cells)
        if result.note:
            write_output(f"{result.note}\n")
        for title, lines in result.listings:
            listing(title, lines)
        if suggest_budgets:
            lines = ["[ulp]", *map(str, budgets)] if budgets else ["# no budget can be tightened"]
            OUT.say("\n".join(lines))
    raise typer.Exit(0 if result.passed else 1)
