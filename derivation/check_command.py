"""The command `platecontact check`: each of its parts makes one call, prints and gives a status."""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from derivation.screen import (
    INTERRUPTED,
    NOTES,
    OUT,
    Json,
    clocked,
    counted,
    listing,
    put_json,
    table,
)


def check(
    digits: Annotated[int, typer.Option(min=20, max=1000, help="Digits of the reference.")] = 50,
    record: Annotated[
        bool, typer.Option("--record", help="Keep the result as reports/data/check.json.")
    ] = False,
    contact: Annotated[
        bool, typer.Option("--contact", help="Measure contact law and impact instead: minutes.")
    ] = False,
    speed: Annotated[
        bool, typer.Option("--speed", help="Measure speed instead, on this machine.")
    ] = False,
    hard: Annotated[
        bool, typer.Option("--hard", help="Check the hard cases instead: seconds.")
    ] = False,
    bounds: Annotated[
        int | None,
        typer.Option("--bounds", metavar="N", min=1, help="Hold stated bounds to N scenes."),
    ] = None,
    effects: Annotated[
        int | None,
        typer.Option("--effects", metavar="N", min=1, help="Hold the gate to N random scenes."),
    ] = None,
    inertia: Annotated[
        int | None,
        typer.Option("--inertia", metavar="N", min=1, help="Hold plates that move to N scenes."),
    ] = None,
    propose: Annotated[
        bool, typer.Option("--propose", help="Print tighter error budgets; write nothing.")
    ] = False,
    search: Annotated[
        str | None,
        typer.Option("--search", metavar="60s|5m|1h", help="Look for worse, for so long."),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(help="Of the search or of --inertia, which repeat by it; 1 if none is given."),
    ] = None,
    kernel: Annotated[
        list[str] | None, typer.Option("--kernel", metavar="NAME", help="Search this one only.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="Write searched cases here.")
    ] = None,
    json: Json = None,
) -> None:
    """Measure every generated function against both oracles.

    Example: platecontact check --digits 100
    """
    from derivation import pipeline
    from derivation.measure.record import COLUMNS, as_data, cells, passed, worst

    if search is not None:
        if contact or speed or hard or bounds or effects or inertia or record or propose:
            raise ValueError("--search stands alone: expected no other of check's options")
        raise typer.Exit(
            _check_search(search, 1 if seed is None else seed, kernel or [], out, json)
        )
    if contact + speed + hard + bool(bounds) + bool(effects) + bool(inertia) > 1:
        raise ValueError(
            "expected one of --contact, --speed, --hard, --bounds, --effects and --inertia: "
            "run them one after the other"
        )
    if kernel or out:
        raise ValueError("--kernel and --out belong to --search: add --search 60s")
    if seed is not None and not inertia:
        raise ValueError("--seed belongs to --search and --inertia: add --search 60s")
    if propose and (speed or hard or bounds or effects or inertia):
        raise ValueError("--propose: expected alone or with --contact; leave the others out")
    if contact:
        raise typer.Exit(_check_contact(record, json, propose))
    if speed:
        raise typer.Exit(_check_speed(record, json))
    if hard:
        raise typer.Exit(_check_hard(record, json))
    if bounds:
        raise typer.Exit(_check_bounds(bounds, record, json))
    if effects:
        raise typer.Exit(_check_effects(effects, record, json))
    if inertia:
        raise typer.Exit(_check_inertia(inertia, 1 if seed is None else seed, record, json))
    with counted("check") as tell:
        rows = pipeline.check(digits, record, tell)
    if json != "-":
        table(f"Errors against {digits} digits", COLUMNS, [cells(row) for row in rows])
        listing("Worst arguments", [worst(row) for row in rows if row.passed is not None])
    if json:
        put_json(as_data(rows, digits), json)
    if propose:
        _propose(rows)
    raise typer.Exit(0 if passed(rows) else 1)


def _propose(rows: Sequence[Any]) -> None:
    """Print the tighter budgets that a check's rows allow."""
    from derivation.measure.propose import proposals

    lines = proposals(rows) or ["# no budget can be tighter"]
    OUT.print("\n".join(lines), markup=False, highlight=False, soft_wrap=True)


def _check_contact(record: bool, json: str | None, propose: bool) -> int:
    """Measure contact law and impact; returns the exit status."""
    from derivation import pipeline

    with counted("check") as tell:
        rows = pipeline.check_contact(record, tell)
    if json != "-":
        columns, cells = pipeline.contact_table(rows)
        table("Errors of the contact law", columns, cells)
        listing("Worst arguments", [f"{r.kernel}: {' '.join(r.worst)}" for r in rows])
    if json:
        put_json(pipeline.contact_data(rows), json)
    if propose:
        _propose(rows)
    return 0 if all(r.passed for r in rows) else 1


def _check_hard(record: bool, json: str | None) -> int:
    """Check the hard cases; returns the exit status."""
    from derivation import pipeline
    from derivation.measure.hard_check import COLUMNS, as_data, cells

    with counted("check") as tell:
        rows = pipeline.check_hard(record, tell)
    failed = [row for row in rows if not row.kept]
    if json != "-":
        table("Hard cases, errors in ULP", COLUMNS, [cells(row) for row in rows])
        listing(
            f"{len(rows)} cases, {len(failed)} failed",
            [f"{row.case.key}: {row.problem}" for row in failed],
        )
    if json:
        put_json(as_data(rows), json)
    return 1 if failed else 0


def _check_bounds(count: int, record: bool, json: str | None) -> int:
    """Hold stated error bounds to random scenes; returns the exit status."""
    from derivation import pipeline
    from derivation.measure.record import plain

    with counted("check") as tell:
        rows = pipeline.check_bounds(count, record, tell)
    if json != "-":
        cells = [
            (r.method, r.runs, f"{r.ratio:.3f}", f"{r.error:.2g}", f"{r.bound:.2g}", r.quantity)
            for r in rows
        ]
        heads = ("method", "#runs", "#worst error/bound", "#error", "#bound", "of")
        table(f"Stated bounds in {count} scenes", heads, cells)
    if json:
        put_json(plain([asdict(row) for row in rows]), json)
    return 0 if all(row.kept for row in rows) else 1


def _check_effects(count: int, record: bool, json: str | None) -> int:
    """Hold the gate to random scenes; returns the exit status."""
    from derivation.effects_check import check_effects
    from derivation.measure.record import plain

    with counted("check") as tell:
        rows = check_effects(count, record, tell)
    if json != "-":
        cells = [
            (f"{r.rtol:g}", r.scenes, f"{r.ratio:.3f}", f"{r.tightest:.3f}", r.quantity,
             f"{r.included:.2f}", f"{r.applicable:.2f}", r.refused)
            for r in rows
        ]  # fmt: skip
        heads = ("#rtol", "#scenes", "#worst error/rtol", "#error/bound", "of", "#effects in",
                 "#that apply", "#refused")  # fmt: skip
        table(f"Effects in {count} scenes", heads, cells)
    if json:
        put_json(plain([asdict(row) for row in rows]), json)
    return 0 if all(row.kept for row in rows) else 1


def _check_inertia(count: int, seed: int, record: bool, json: str | None) -> int:
    """Hold plates that move to random scenes; returns the exit status."""
    from derivation.inertia_check import check_inertia
    from derivation.measure.inertia import COLUMNS, as_data, cells, sides

    with counted("check") as tell:
        found = check_inertia(count, seed, record, tell)
    if json != "-":
        table(f"Inertia in {count} of {found.drawn} scenes drawn", COLUMNS, cells(found))
        reasons = {"refused": found.refused, "passed over": found.passed_over}
        lines = [f"{n} {what}: {why}" for what, by in reasons.items() for why, n in by.items()]
        listing("The others", lines)
    if json:
        put_json(as_data(found, seed), json)
    return 0 if all(side.kept for side in sides(found.rows)) else 1


def _check_speed(record: bool, json: str | None) -> int:
    """Measure times; returns the exit status."""
    from derivation import pipeline
    from derivation.measure.speed import as_data

    with counted("check") as tell:
        timings = pipeline.check_speed(record, tell)
    if json != "-":
        cells = [(t.name, f"{t.value:.3g} {t.unit}", f"{t.limit:g}", t.kept) for t in timings]
        table("Speed", ("what", "#measured", "#promise", "kept"), cells)
    if json:
        put_json(as_data(timings), json)
    return 0 if all(t.kept for t in timings) else 1


def _check_search(
    duration: str, seed: int, kernels: list[str], out: Path | None, json: str | None
) -> int:
    """Look for larger errors; returns the exit status."""
    from derivation import pipeline
    from derivation.measure.search_cases import COLUMNS, arguments, as_data, cells, kept

    with clocked("search") as tell:
        found, book = pipeline.search_worse(duration, seed, kernels, out, tell)
    if json != "-":
        table(f"Search, seed {seed}", COLUMNS, [cells(k, found, book) for k in found.standings])
        listing("Worst arguments", [arguments(k, found) for k in found.standings])
    if json:
        put_json(as_data(found), json)
    if book.written:
        NOTES.print(f"new worst cases in {book.path}", markup=False, soft_wrap=True)
    return INTERRUPTED if found.interrupted else 0 if kept(found) else 1
