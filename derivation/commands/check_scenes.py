"""The subcommands of `platecontact check` on simulated scenes."""

from dataclasses import asdict
from typing import Annotated

import typer

from derivation.commands.options import SEED, Seed, update_option
from derivation.engine.console import Json, counted, listing, put, put_json, table

Number = Annotated[
    int, typer.Option("-n", "--number", metavar="N", min=1, help="Number of random scenes.")
]


def error_bounds(
    number: Number, update: Annotated[bool, update_option("bounds")] = False, json: Json = None
) -> None:
    """Test the error bounds reported by `simulate`.

    Random impacts are simulated at several tolerances and compared with a reference. The exit
    status is 1 if an error is above its bound.

    Example: platecontact check error-bounds -n 200
    """
    from derivation import pipeline
    from derivation.engine.measure.record import plain

    with counted("check") as tell:
        rows = pipeline.check_bounds(number, update, tell)
    if put_json(lambda: plain([asdict(row) for row in rows]), json):
        cells = [
            (r.method, r.runs, f"{r.ratio:.3f}", f"{r.error:.2g}", f"{r.bound:.2g}", r.quantity)
            for r in rows
        ]
        heads = ("method", "#runs", "#worst error/bound", "#error", "#bound", "of")
        table(f"Stated bounds in {number} scenes", heads, cells)
    raise typer.Exit(0 if all(row.kept for row in rows) else 1)


def effects(
    number: Number, update: Annotated[bool, update_option("effects")] = False, json: Json = None
) -> None:
    """Test the effect selection on random scenes.

    The automatic selection is compared with a quasi-static simulation that includes every
    applicable effect. The exit status is 1 if a difference is above its bound.

    Example: platecontact check effects -n 300
    """
    from derivation.checks.effects import check_effects
    from derivation.engine.measure.record import plain

    with counted("check") as tell:
        rows = check_effects(number, update, tell)
    if put_json(lambda: plain([asdict(row) for row in rows]), json):
        cells = [
            (f"{r.rtol:g}", r.scenes, f"{r.ratio:.3f}", f"{r.tightest:.3f}", r.quantity,
             f"{r.included:.2f}", f"{r.applicable:.2f}", r.refused)
            for r in rows
        ]  # fmt: skip
        heads = ("#rtol", "#scenes", "#worst error/rtol", "#error/bound", "of", "#effects in",
                 "#that apply", "#refused")  # fmt: skip
        table(f"Effects in {number} scenes", heads, cells)
    raise typer.Exit(0 if all(row.kept for row in rows) else 1)


def inertia(
    number: Number,
    seed: Seed = SEED,
    update: Annotated[bool, update_option("inertia")] = False,
    json: Json = None,
) -> None:
    """Test impacts with plate inertia on random scenes.

    They are compared with simulations of twice the modes and all branches. The exit status is 1 if
    a difference is above its bound.

    Example: platecontact check inertia -n 50 --seed 3
    """
    from derivation.checks.inertia import check_inertia
    from derivation.checks.inertia_judged import COLUMNS, as_data, cells, sides

    with counted("check") as tell:
        found = check_inertia(number, seed, update, tell)
    if put_json(lambda: as_data(found, seed), json):
        table(f"Inertia in {number} of {found.drawn} scenes drawn", COLUMNS, cells(found))
        reasons = {"refused": found.refused, "passed over": found.passed_over}
        lines = [f"{n} {what}: {why}" for what, by in reasons.items() for why, n in by.items()]
        listing("The others", lines)
    raise typer.Exit(0 if all(side.kept for side in sides(found.rows)) else 1)


def scenes(number: Number, seed: Seed = SEED, json: Json = None) -> None:
    """Simulate random realistic scenes, and count failures.

    The exit status is 1 if a simulation crashes, runs too long, gives no number, or if too many
    scenes are rejected.

    Example: platecontact check scenes -n 20 --seed 5
    """
    from derivation.checks.realistic_scenes import COLUMNS, as_data, cells, cost, failures, passed
    from derivation.checks.scenes import check_scenes

    with counted("check") as tell:
        found = check_scenes(number, seed, tell)
    if put_json(lambda: as_data(found, seed), json):
        table(f"Runs of {number} realistic scenes, seed {seed}", COLUMNS, cells(found))
        put(f"{cost(found)}\n")
        listing("One of each that did not finish", failures(found))
    raise typer.Exit(0 if passed(found) else 1)


def finite_elements(
    update: Annotated[
        bool,
        typer.Option(
            "--update",
            help="Save the simulated results in reports/data/elastodynamics.json; the "
            "finite-element results stay.",
        ),
    ] = False,
    json: Json = None,
) -> None:
    """Compare impacts with recorded finite-element results.

    The exit status is 1 if a difference is above bound, model error and finite-element error
    together.

    Example: platecontact check finite-elements
    """
    from derivation.checks.elastodynamics import COLUMNS, cells, compare
    from derivation.engine.measure.record import plain

    with counted("check") as tell:
        cases = compare(save=update, tell=tell)
    if put_json(lambda: plain([asdict(case) for case in cases]), json):
        table("Impacts against finite elements", COLUMNS, [cells(case) for case in cases])
        refused = [f"{case.name}: {case.refused}" for case in cases if case.refused]
        listing(f"{len(refused)} rejected", refused)
    raise typer.Exit(0 if all(case.kept for case in cases) else 1)
