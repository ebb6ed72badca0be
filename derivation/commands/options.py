"""Options that several commands share: the paper, the record to renew, the random seed."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from derivation.engine.paper import Paper

PaperFolder = Annotated[
    Path | None,
    typer.Option("--paper", metavar="FOLDER", help="Work on the paper in this folder (see `new`)."),
]
SEED = 1
Seed = Annotated[int, typer.Option(help="Random seed.")]
Suggest = Annotated[
    bool,
    typer.Option("--suggest-budgets", help="Print tighter error budgets too; change no file."),
]


def update_option(name: str) -> Any:
    """Return the option that renews a committed measurement."""
    return typer.Option("--update", help=f"Save the result in reports/data/{name}.json.")


def chosen(folder: Path | None) -> "Paper":
    """The paper of a folder; without one the paper on the plate.

    Raises
    ------
    derivation.engine.load.PaperError
        If the folder holds no paper.
    """
    if folder is None:
        from derivation.plate.paper import PAPER

        return PAPER
    from derivation.engine.load import load

    return load(folder)


def alone(folder: Path | None, allowed: str, *others: object) -> None:
    """Refuse options that a paper in a folder has nothing for.

    Raises
    ------
    ValueError
        If one of the others is set too.
    """
    if folder is not None and any(others):
        raise ValueError(
            f"--paper can be combined with {allowed} only here; remove the other options"
        )
