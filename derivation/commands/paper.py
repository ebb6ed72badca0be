"""The commands for a paper in a folder: `platecontact new`, and `build` on it."""

from pathlib import Path
from typing import Annotated

import typer

from derivation.commands.options import chosen
from derivation.engine.console import NOTES, counted, stage


def build(folder: Path) -> int:
    """Run the main job on the paper of a folder; returns the exit status."""
    from derivation.engine import build as stages
    from derivation.engine.measure.record import passed
    from derivation.engine.report.pdf import TexError

    own = chosen(folder)
    for what, work in (
        ("derive", stages.derive),
        ("rewrite", stages.rewrite),
        ("generate", stages.generate),
        ("misprints", stages.misprints),
    ):
        with stage(what):
            work(own)
    with counted("check") as tell:
        rows = stages.check(own, update=True, tell=tell)
    with stage("report"):
        try:
            stages.report(own)
        except TexError as error:
            NOTES.say(f"no PDF, all else is there: {error}")
    failed = [row.kernel for row in rows if row.passed is False]
    NOTES.say(f"beyond their budget: {', '.join(failed)}" if failed else "all budgets kept")
    return 0 if passed(rows) else 1


def new(
    folder: Annotated[Path, typer.Argument(help="An empty folder, or one to be made.")],
) -> None:
    """Begin a paper of your own, from a small one that works.

    Example: platecontact new film
    """
    from derivation.engine.load import begin

    written = begin(folder)
    NOTES.say("\n".join(str(path) for path in written))
    NOTES.say(f"run it: platecontact build --paper {folder}")
