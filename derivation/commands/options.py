"""Options that several commands share: the paper, the measurement to update, the random seed."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from derivation.engine.paper import Paper

PaperFolder = Annotated[
    Path | None,
    typer.Option("--paper", metavar="FOLDER", help="Use the paper in this folder (see `new`)."),
]
SEED = 1
TOLERANCE = "1e-13 to 1 (default: that of the scene)"
"""Range and default of a tolerance, in the help."""
VALUES = (
    "A:B:N (evenly spaced from A to B), A:B:N:log (spaced by a factor) or A,B,C (numbers or names)"
)
"""Forms of the values of a key, in the help."""
Seed = Annotated[int, typer.Option(metavar="N", help="Random seed.")]
Suggest = Annotated[
    bool,
    typer.Option("--suggest-budgets", help="Also print tighter error budgets; no file is changed."),
]


def update_option(name: str) -> Any:
    """Return the option `--update`, which replaces a committed measurement."""
    return typer.Option("--update", help=f"Save the result in reports/data/{name}.json.")


def chosen_paper(folder: Path | None) -> "Paper":
    """Return the paper in a folder; without a folder, the paper on plates.

    Raises
    ------
    derivation.engine.load.PaperError
        If the folder contains no paper, or a module in it cannot be imported.
    """
    if folder is None:
        from derivation.plate.paper import PAPER

        return PAPER
    from derivation.engine.load import load

    return load(folder)


def expect_no_other_options(folder: Path | None, allowed: str, *others: object) -> None:
    """Reject options that cannot be combined with --paper; `allowed` names the others.

    Raises
    ------
    ValueError
        If one of the others is also given.
    """
    if folder is not None and any(others):
        raise ValueError(
            f"--paper: this command accepts it together with {allowed} only; remove the other "
            "options"
        )
