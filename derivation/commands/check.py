"""The command `platecontact check`: each of its parts makes one call, prints and gives a status."""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from derivation.commands.paper_option import PaperFolder, alone, chosen
from derivation.engine.console import (
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
        typer.Option(
            "--bounds", metavar="N", min=1, help="Test the stated error bounds on N impacts."
        ),
    ] = None,
    effects: Annotated[
        int | None,
        typer.Option(
            "--effects", metavar="N", min=1, help="Test the effect selection on N scenes."
        ),
    ] = None,
    inertia: Annotated[
        int | None,
        typer.Option(
            "--inertia", metavar="N", min=1, help="Test impacts with plate inertia on N scenes."
        ),
    ] = None,
    scenes: Annotated[
        int | None,
        typer.Option(
            "--scenes", metavar="N", min=1, help="Simulate N random realistic scenes: minutes."
        ),
    ] = None,
    elastodynamics: Annotated[
        bool,
        typer.Option("--elastodynamics", help="Compare with recorded finite-element impacts."),
    ] = False,
    propose: Annotated[
        bool, typer.Option("--propose", help="Print tighter error budgets; write nothing.")
    ] = False,
    search: Annotated[
        str | None,
        typer.Option(
            "--search", metavar="60s|5m|1h", help="Search for larger errors for this long."
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(help="Random seed for --search, --inertia and --scenes (default: 1)."),
    ] = None,
    kernel: Annotated[
        list[str] | None, typer.Option("--kernel", metavar="NAME", help="Search this one only.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="Write searched cases here.")
    ] = None,
    paper: PaperFolder = None,
    json: Json = None,
) -> None:
    """Measure every generated function against both oracles.

    Example: platecontact check --digits 100
    """
    from derivation import pipeline
    from derivation.engine import build
    from derivation.engine.measure.record import COLUMNS, as_data, cells, passed, worst

    others = (contact, speed, hard, bounds, effects, inertia, scenes, elastodynamics, propose)
    alone(paper, "--digits, --record and --json", *others, search, seed, kernel, out)
    own = chosen(paper)
    if search is not None:
        if any(others) or record:
            raise ValueError("--search stands alone: expected no other of check's options")
        raise typer.Exit(
            _check_search(search, 1 if seed is None else seed, kernel or [], out, json)
        )
    counts = bool(bounds), bool(effects), bool(inertia), bool(scenes)
    if contact + speed + hard + elastodynamics + sum(counts) > 1:
        raise ValueError(
            "expected one of --contact, --speed, --hard, --bounds, --effects, --inertia, "
            "--scenes and --elastodynamics: run them one after the other"
        )
    if scenes and record:
        raise ValueError("--record: expected a check whose result is kept; leave out --record")
    if kernel or out:
        raise ValueError("--kernel and --out belong to --search: add --search 60s")
    if seed is not None and not (inertia or scenes):
        raise ValueError("--seed belongs to --search, --inertia and --scenes: add --search 60s")
    if propose and (speed or hard or elastodynamics or any(counts)):
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
    if scenes:
        raise typer.Exit(_check_scenes(scenes, 1 if seed is None else seed, json))
    if elastodynamics:
        raise typer.Exit(_check_elastodynamics(record, json))
    with counted("check") as tell:
        if paper is None:
            rows = pipeline.check(digits, record, tell)
        else:
            rows = build.check(own, digits, record, tell)
    if put_json(lambda: as_data(rows, digits, own.package().target), json):
        table(f"Errors against {digits} digits", COLUMNS, [cells(row) for row in rows])
        listing("Worst arguments", [worst(row) for row in rows if row.passed is not None])
    if propose:
        _propose(rows)
    raise typer.Exit(0 if passed(rows) else 1)


def _propose(rows: Sequence[Any]) -> None:
    """Print the tighter budgets that a check's rows allow."""
    from derivation.plate.propose import proposals

    lines = proposals(rows) or ["# no budget can be tighter"]
    OUT.say("\n".join(lines))


def _check_contact(record: bool, json: str | None, propose: bool) -> int:
    """Measure contact law and impact; returns the exit status."""
    from derivation import pipeline

    with counted("check") as tell:
        rows = pipeline.check_contact(record, tell)
    if put_json(lambda: pipeline.contact_data(rows), json):
        columns, cells = pipeline.contact_table(rows)
        table("Errors of the contact law", columns, cells)
        listing("Worst arguments", [f"{r.kernel}: {' '.join(r.worst)}" for r in rows])
    if propose:
        _propose(rows)
    return 0 if all(r.passed for r in rows) else 1


def _check_hard(record: bool, json: str | None) -> int:
    """Check the hard cases; returns the exit status."""
    from derivation import pipeline
    from derivation.plate.hard.check import COLUMNS, as_data, cells

    with counted("check") as tell:
        rows = pipeline.check_hard(record, tell)
    failed = [row for row in rows if not row.kept]
    if put_json(lambda: as_data(rows), json):
        table("Hard cases, errors in ULP", COLUMNS, [cells(row) for row in rows])
        listing(
            f"{len(rows)} cases, {len(failed)} failed",
            [f"{row.case.key}: {row.problem}" for row in failed],
        )
    return 1 if failed else 0


def _check_bounds(count: int, record: bool, json: str | None) -> int:
    """Test the stated error bounds on random impacts; returns the exit status."""
    from derivation import pipeline
    from derivation.engine.measure.record import plain

    with counted("check") as tell:
        rows = pipeline.check_bounds(count, record, tell)
    if put_json(lambda: plain([asdict(row) for row in rows]), json):
        cells = [
            (r.method, r.runs, f"{r.ratio:.3f}", f"{r.error:.2g}", f"{r.bound:.2g}", r.quantity)
            for r in rows
        ]
        heads = ("method", "#runs", "#worst error/bound", "#error", "#bound", "of")
        table(f"Stated bounds in {count} scenes", heads, cells)
    return 0 if all(row.kept for row in rows) else 1


def _check_effects(count: int, record: bool, json: str | None) -> int:
    """Test the effect selection on random scenes; returns the exit status."""
    from derivation.checks.effects import check_effects
    from derivation.engine.measure.record import plain

    with counted("check") as tell:
        rows = check_effects(count, record, tell)
    if put_json(lambda: plain([asdict(row) for row in rows]), json):
        cells = [
            (f"{r.rtol:g}", r.scenes, f"{r.ratio:.3f}", f"{r.tightest:.3f}", r.quantity,
             f"{r.included:.2f}", f"{r.applicable:.2f}", r.refused)
            for r in rows
        ]  # fmt: skip
        heads = ("#rtol", "#scenes", "#worst error/rtol", "#error/bound", "of", "#effects in",
                 "#that apply", "#refused")  # fmt: skip
        table(f"Effects in {count} scenes", heads, cells)
    return 0 if all(row.kept for row in rows) else 1


def _check_inertia(count: int, seed: int, record: bool, json: str | None) -> int:
    """Test impacts with plate inertia on random scenes; returns the exit status."""
    from derivation.checks.inertia import check_inertia
    from derivation.checks.inertia_judged import COLUMNS, as_data, cells, sides

    with counted("check") as tell:
        found = check_inertia(count, seed, record, tell)
    if put_json(lambda: as_data(found, seed), json):
        table(f"Inertia in {count} of {found.drawn} scenes drawn", COLUMNS, cells(found))
        reasons = {"refused": found.refused, "passed over": found.passed_over}
        lines = [f"{n} {what}: {why}" for what, by in reasons.items() for why, n in by.items()]
        listing("The others", lines)
    return 0 if all(side.kept for side in sides(found.rows)) else 1


def _check_scenes(count: int, seed: int, json: str | None) -> int:
    """Simulate random realistic scenes; returns the exit status."""
    from derivation.checks.realistic_scenes import COLUMNS, as_data, cells, failures, passed
    from derivation.checks.scenes import check_scenes

    with counted("check") as tell:
        found = check_scenes(count, seed, tell)
    if put_json(lambda: as_data(found, seed), json):
        table(f"Runs of {count} realistic scenes, seed {seed}", COLUMNS, cells(found))
        listing("One of each that did not finish", failures(found))
    return 0 if passed(found) else 1


def _check_elastodynamics(record: bool, json: str | None) -> int:
    """Compare with recorded finite-element impacts; returns the exit status."""
    from derivation.checks.elastodynamics import COLUMNS, cells, compare
    from derivation.engine.measure.record import plain

    with counted("check") as tell:
        cases = compare(save=record, tell=tell)
    if put_json(lambda: plain([asdict(case) for case in cases]), json):
        table("Impacts against finite elements", COLUMNS, [cells(case) for case in cases])
        refused = [f"{case.name}: {case.refused}" for case in cases if case.refused]
        listing(f"{len(refused)} rejected", refused)
    return 0 if all(case.kept for case in cases) else 1


def _check_speed(record: bool, json: str | None) -> int:
    """Measure times; returns the exit status."""
    from derivation import pipeline
    from derivation.plate.benchmark.speed import as_data

    with counted("check") as tell:
        timings = pipeline.check_speed(record, tell)
    if put_json(lambda: as_data(timings), json):
        cells = [(t.name, f"{t.value:.3g} {t.unit}", f"{t.limit:g}", t.kept) for t in timings]
        table("Speed", ("what", "#measured", "#promise", "kept"), cells)
    return 0 if all(t.kept for t in timings) else 1


def _check_search(
    duration: str, seed: int, kernels: list[str], out: Path | None, json: str | None
) -> int:
    """Look for larger errors; returns the exit status."""
    from derivation import pipeline
    from derivation.plate.search.cases import COLUMNS, arguments, as_data, cells, kept

    with clocked("search") as tell:
        found, book = pipeline.search_worse(duration, seed, kernels, out, tell)
    if put_json(lambda: as_data(found), json):
        table(f"Search, seed {seed}", COLUMNS, [cells(k, found, book) for k in found.standings])
        listing("Worst arguments", [arguments(k, found) for k in found.standings])
    if book.written:
        NOTES.say(f"new worst cases in {book.path}")
    return INTERRUPTED if found.interrupted else 0 if kept(found) else 1
