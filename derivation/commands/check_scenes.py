"""Subcommands of `platecontact check` that test simulated scenes."""

from typing import Annotated

import typer

from derivation.commands.check_output import show_check
from derivation.commands.options import SEED, Seed, update_option
from derivation.engine.console import Json

Number = Annotated[
    int, typer.Option("-n", "--number", metavar="N", min=1, help="Number of random scenes.")
]


def error_bounds(
    number: Number, update: Annotated[bool, update_option("bounds")] = False, json: Json = None
) -> None:
    """Test the error bounds reported by `simulate`.

    Random impacts are simulated at several tolerances and compared with a reference. The exit
    status is 1 if an error exceeds its bound.

    Example: platecontact check error-bounds -n 200
    """
    from derivation.checks.bounds import check_bounds

    show_check(lambda progress: check_bounds(number, update, progress), json)


def effects(
    number: Number, update: Annotated[bool, update_option("effects")] = False, json: Json = None
) -> None:
    """Test the effect selection on random scenes.

    The automatic selection is compared with a quasi-static simulation that includes every
    applicable effect. The exit status is 1 if a difference exceeds the tolerance or its bound.

    Example: platecontact check effects -n 300
    """
    from derivation.checks import effects as check

    record = check.MEASURED if update else None
    show_check(lambda progress: check.check_effects(number, progress), json, record=record)


def inertia(
    number: Number,
    seed: Seed = SEED,
    update: Annotated[bool, update_option("inertia")] = False,
    json: Json = None,
) -> None:
    """Test impacts with plate inertia on random scenes.

    Each impact is compared with a simulation with twice as many modes and all wave branches. The
    exit status is 1 if a difference exceeds the tolerance or its bound.

    Example: platecontact check inertia -n 50 --seed 3
    """
    from derivation.checks.inertia import MEASURED, judge
    from derivation.checks.inertia_rows import result

    record = MEASURED if update else None
    show_check(lambda progress: result(judge(number, seed, progress), seed), json, record=record)


def scenes(number: Number, seed: Seed = SEED, json: Json = None) -> None:
    """Simulate random realistic scenes and count failures.

    The exit status is 1 if a simulation crashes, runs too long or returns NaN, if too many scenes
    are rejected, or if an error message states no remedy.

    Example: platecontact check scenes -n 20 --seed 5
    """
    from derivation.checks.realistic_scenes import result
    from derivation.checks.scenes import check_scenes

    show_check(lambda progress: result(check_scenes(number, seed, progress), number, seed), json)


def finite_elements(
    update: Annotated[
        bool,
        typer.Option(
            "--update",
            help="Save the simulated results in reports/data/elastodynamics.json; the "
            "finite-element results there are not changed.",
        ),
    ] = False,
    json: Json = None,
) -> None:
    """Compare impacts with recorded finite-element results.

    The exit status is 1 if a difference exceeds the sum of error bound, model error and
    finite-element error.

    Example: platecontact check finite-elements
    """
    from derivation.checks.elastodynamics import compare, result

    show_check(lambda progress: result(compare(save=update, progress=progress)), json)
