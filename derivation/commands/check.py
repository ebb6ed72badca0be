"""The command `platecontact check` and its subcommands."""

from collections.abc import Callable
from typing import Annotated, Any

import typer

from derivation.commands import check_functions, check_scenes
from derivation.commands.check_output import show_check
from derivation.commands.command import Command, Group
from derivation.commands.options import PaperFolder, Suggest, chosen_paper
from derivation.engine.console import Json

SUBCOMMANDS: dict[str, Callable[..., None]] = {
    "contact-law": check_functions.contact_law,
    "hard-cases": check_functions.hard_cases,
    "search": check_functions.search,
    "timing": check_functions.timing,
    "error-bounds": check_scenes.error_bounds,
    "effects": check_scenes.effects,
    "inertia": check_scenes.inertia,
    "scenes": check_scenes.scenes,
    "finite-elements": check_scenes.finite_elements,
}
"""Subcommands by name, in the order of the help."""
MOVED = {
    "--contact": "contact-law",
    "--speed": "timing",
    "--hard": "hard-cases",
    "--bounds": "error-bounds -n N",
    "--effects": "effects -n N",
    "--inertia": "inertia -n N",
    "--scenes": "scenes -n N",
    "--elastodynamics": "finite-elements",
    "--search": "search --time 60s",
}
"""Former options of `check`, each with the subcommand that has replaced it."""


class CheckGroup(Group):
    """The command `check`, which rejects former options and names the subcommand to use instead."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Reject former options before the arguments are parsed."""
        names = [arg.partition("=")[0] for arg in self.own_arguments(args)]
        for name in (name for name in names if name in MOVED):
            ctx.fail(f"{name} is now a subcommand: run `platecontact check {MOVED[name]}`")
        return super().parse_args(ctx, args)


app = typer.Typer(
    cls=CheckGroup, rich_markup_mode=None, subcommand_metavar="[SUBCOMMAND [OPTIONS]]"
)
for subcommand, function in SUBCOMMANDS.items():
    app.command(subcommand, cls=Command)(function)


@app.callback(invoke_without_command=True)
def check(
    context: typer.Context,
    digits: Annotated[
        int,
        typer.Option(
            min=20, max=1000, metavar="N", help="Number of digits of the reference values."
        ),
    ] = 50,
    update: Annotated[
        bool, typer.Option("--update", help="Save the result as the paper's check.json.")
    ] = False,
    suggest_budgets: Suggest = False,
    paper: PaperFolder = None,
    json: Json = None,
) -> None:
    """Compare every generated function with both references.

    Prints the largest error of each function in ULP (units in the last place). The exit status is
    1 if an error exceeds its budget. The subcommands run other checks.

    Example: platecontact check --digits 100
    """
    if context.invoked_subcommand is not None:
        return
    from derivation.engine import build
    from derivation.engine.measure.record import result

    chosen = chosen_paper(paper)
    show_check(
        lambda progress: result(
            build.check(chosen, digits, update, progress), digits, chosen.package().target
        ),
        json,
        suggest_budgets,
    )
