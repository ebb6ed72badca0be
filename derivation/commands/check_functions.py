"""Subcommands of `platecontact check` that test generated functions."""

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from derivation.commands.check_output import show_check
from derivation.commands.options import (
    SEED,
    PaperFolder,
    Seed,
    Suggest,
    chosen_paper,
    update_option,
)
from derivation.engine.console import (
    INTERRUPTED_STATUS,
    NOTES,
    Json,
    listing,
    search_clock,
    table,
    write_json_output,
)


def contact_law(
    update: Annotated[bool, update_option("contact")] = False,
    suggest_budgets: Suggest = False,
    json: Json = None,
) -> None:
    """Compare contact law and impact with both references.

    The check takes minutes. The exit status is 1 if an error exceeds its budget.

    Example: platecontact check contact-law --json contact.json
    """
    from derivation import pipeline

    record = pipeline.MEASURED_CONTACT if update else None
    show_check(pipeline.check_contact, json, suggest_budgets, record)


def hard_cases(
    update: Annotated[
        bool,
        typer.Option(
            "--update",
            help="Compute reference values that are missing or outdated (up to 15 minutes), and "
            "save all as the paper's hard.json.",
        ),
    ] = False,
    paper: PaperFolder = None,
    json: Json = None,
) -> None:
    """Compare functions with reference values at hard cases.

    Prints the largest error of each group of cases, as a fraction of its limit. The exit status is
    1 if an error exceeds its limit.

    Example: platecontact check hard-cases --json hard.json
    """
    from derivation.engine import build
    from derivation.engine.measure.hard import result

    chosen = chosen_paper(paper)
    show_check(
        lambda progress: result(
            build.check_hard(chosen, update, progress), chosen.package().target
        ),
        json,
    )


def search(
    time: Annotated[str, typer.Option(metavar="60s|5m|1h", help="Search for this long.")] = "60s",
    seed: Seed = SEED,
    function: Annotated[
        list[str] | None,
        typer.Option("--function", metavar="NAME", help="Search this function only; repeatable."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="FILE",
            help="Write new worst cases to this file (default: reports/search.toml).",
        ),
    ] = None,
    paper: PaperFolder = None,
    json: Json = None,
) -> None:
    """Search for larger errors at random arguments.

    The same seed gives the same arguments in the same order. The exit status is 1 if an error
    exceeds its limit.

    Example: platecontact check search --time 5m --function G --out worst.toml
    """
    from derivation.engine.measure.search_record import (
        COLUMNS,
        all_within_allowance,
        arguments,
        as_data,
        cells,
    )

    if paper is None:
        from derivation.pipeline import search_worse
    else:  # without the modules of the plate, which take seconds to load
        from derivation.engine.build import search as search_paper

        search_worse = partial(search_paper, chosen_paper(paper))
    with search_clock("search") as progress:
        results, book = search_worse(time, seed, function or [], out, progress)
    if write_json_output(lambda: as_data(results), json):
        table(f"Search, seed {seed}", COLUMNS, [cells(k, results, book) for k in results.states])
        listing("Worst arguments", [arguments(k, results) for k in results.states])
    if book.written:
        NOTES.say(f"new worst cases written to {book.path}")
    raise typer.Exit(
        INTERRUPTED_STATUS if results.interrupted else 0 if all_within_allowance(results) else 1
    )


def timing(update: Annotated[bool, update_option("speed")] = False, json: Json = None) -> None:
    """Compare run times on this machine with their limits.

    The exit status is 1 if a run time exceeds its limit.

    Example: platecontact check timing --json timing.json
    """
    from derivation import pipeline

    show_check(pipeline.check_speed, json, record=pipeline.MEASURED_SPEED if update else None)
