"""The commands `platecontact rewrite` and `platecontact diagnose`, for formulas of the user."""

from dataclasses import asdict
from typing import Annotated

import typer

from derivation.commands.options import PaperFolder, chosen_paper, expect_no_other_options
from derivation.engine.console import OUT, Json, progress_bar, stage, table, write_json_output


def rewrite(
    formula: Annotated[
        str,
        typer.Argument(
            metavar="FORMULA",
            help="A formula of positive variables (default: the paper's).",
        ),
    ] = "",
    variable: Annotated[
        str,
        typer.Option(metavar="NAME", help="Variable of the code if the formula contains none."),
    ] = "x",
    where: Annotated[
        list[str] | None,
        typer.Option(
            metavar="CONDITION",
            help="Condition on the variables, such as '-1 < nu < 0.5'; repeatable.",
        ),
    ] = None,
    update: Annotated[
        bool, typer.Option("--update", help="Save the paper's result as its rewrite.json.")
    ] = False,
    paper: PaperFolder = None,
    json: Json = None,
) -> None:
    """Find a numerically stable form of a formula, as NumPy code.

    The code is tested; its docstring states the tested range and the largest error found.

    Without a formula: show which rules were applied to the paper's formulas.

    Example: platecontact rewrite "(x - sin(x))/x**3"
    """
    from derivation.engine import build
    from derivation.engine.emit.own_formula import rewrite_text
    from derivation.engine.outputs import plain
    from derivation.engine.rewrite.products import ProductForm

    if formula:
        expect_no_other_options(paper, "--update and --json (and no formula)", formula)
        if update:
            raise ValueError(
                "--update applies to the paper's formulas and cannot be combined with FORMULA; "
                "remove one of them"
            )
        with stage("rewrite"):
            stable, source, tested = rewrite_text(formula, variable, where or ())
        several = isinstance(stable, ProductForm)
        transformations = [("", rule) for rule in stable.applied]
        applied = [asdict(rule) for rule in stable.applied]
        data: object = {"source": source, "tested": asdict(tested), "applied": applied}
    else:
        if where:
            raise ValueError("--where applies to a formula; add FORMULA, or remove --where")
        with progress_bar("rewrite") as progress:
            accounts = build.rewriting_effects(chosen_paper(paper), update, progress)
        transformations = [
            (account.name, applied) for account in accounts for applied in account.applied
        ]
        data, source, several = {"rows": [asdict(account) for account in accounts]}, "", False
    if write_json_output(lambda: plain(data), json):
        rows = [
            (name, a.rule, a.cause, *(f"{without:.3g}/{with_:.3g}" for without, with_ in
             (a.operations, a.worst)))
            for name, a in transformations
        ]  # fmt: skip
        heads = ("formula", "rule", "prevents", "#operations", "#error [ULP]")
        first = 1 if formula else 0
        title = "Each rule: operations and largest error without/with it"
        if rows:
            table(title, heads[first:], [row[first:] for row in rows])
        elif several:
            OUT.say("For a formula of several variables, the rules are not compared one by one.\n")
        else:
            OUT.say("No rule reduces the error of this formula.\n")
        OUT.say(source)


def diagnose(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="Name of a derived formula, for example K_j.")
    ],
    formula: Annotated[
        str,
        typer.Option(
            metavar="FORMULA", help="Your version of the formula, or the equation, in SymPy syntax."
        ),
    ],
    latex: Annotated[bool, typer.Option("--latex", help="Read the formula as LaTeX.")] = False,
    at: Annotated[
        str,
        typer.Option(
            metavar="phi=2.5,h=0.1,...", help="Evaluate both formulas at this point, in SI units."
        ),
    ] = "",
    digits: Annotated[
        int, typer.Option(metavar="N", min=1, max=1000, help="Number of digits of both values.")
    ] = 50,
    paper: PaperFolder = None,
    json: Json = None,
) -> None:
    """Compare your formula with the derived one.

    The exit status is 1 if they differ.

    E and nu are Young's modulus and Poisson's ratio. For a sum over the modes, such as delta, one
    term of the sum is compared; of another sum without end, the terms of the derived formula.

    Example: platecontact diagnose G --formula "1 + 4*T*exp(-2*T)" --at T=3
    """
    from derivation.engine import build

    chosen = chosen_paper(paper)
    with stage("compare"):
        diagnosis = build.diagnose(chosen, name, formula, latex, at, digits)
    if write_json_output(diagnosis.to_json, json):
        given = {key: value for key, value in diagnosis.to_json().items() if value is not None}
        point = given.get("point")
        if isinstance(point, dict):
            given["point"] = ", ".join(f"{symbol} = {value}" for symbol, value in point.items())
        table(f"{name}: {diagnosis.verdict}", ("item", "value"), list(given.items()))
    raise typer.Exit(0 if diagnosis.verdict == "equal" else 1)
