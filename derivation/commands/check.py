"""The command `platecontact check`: what it does alone, and its subcommands."""

from collections.abc import Callable
from typing import Annotated, Any

import typer

from derivation.commands import check_functions, check_scenes
from derivation.commands.command import Command, Group
from derivation.commands.options import PaperFolder, Suggest, chosen
from derivation.commands.shown import shown
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
"""In the order of the help."""
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
    """The command, which names the subcommand that has replaced a former option."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Look for former options before anything is read."""
        names = [arg.partition("=")[0] for arg in self.own(args)]
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
        int, typer.Option(min=20, max=1000, metavar="N", help="Digits of the reference.")
    ] = 50,
    update: Annotated[
        bool, typer.Option("--update", help="Save the result as the paper's check.json.")
    ] = False,
    suggest_budgets: Suggest = False,
    paper: PaperFolder = None,
    json: Json = None,
) -> None:
    """Compare every generated function with both references.

    Without a subcommand: the error of each function in ULP. The exit status is 1 if an error is
    above its budget.

    Example: platecontact check --digits 100
    """
    if context.invoked_subcommand is not None:
        return
    from derivation.engine import build
    from derivation.engine.measure.record import result

    own = chosen(paper)
    shown(
        lambda tell: result(build.check(own, digits, update, tell), digits, own.package().target),
        json,
        suggest_budgets,
    )
