"""The command `platecontact`: each command unpacks its arguments and makes one call.

Exit status: 0 fine, 1 a check failed or formulas differ, 2 bad input.
"""

import os
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer
from typer.exceptions import TyperException
from typer.main import get_command

from derivation import check_command
from derivation.files import ROOT
from derivation.scene import commands as scene_commands
from derivation.screen import (
    INTERRUPTED,
    NOTES,
    OUT,
    Json,
    counted,
    listing,
    put_json,
    stage,
    table,
)

app = typer.Typer(
    no_args_is_help=True,
    add_completion=True,
    rich_markup_mode=None,
    help="Derive, generate, check and report the contact law of a sphere on an elastic plate.",
)

Out = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="Write here instead of the checkout.")
]


@app.command()
def derive(json: Json = None) -> None:
    """Derive every formula from the equilibrium equations and show how it was proved.

    Example: platecontact derive --json formulas.json
    """
    from derivation import derived

    with stage("derive"):
        found = derived.formulas()
    if json != "-":
        rows = [(f.name, f.unit, f.equation, f.proof.step, f.proof.method) for f in found.values()]
        table("Derived formulas", ("formula", "unit", "equation", "proof", "decided"), rows)
    if json:
        put_json([formula.to_json() for formula in found.values()], json)


@app.command()
def generate(
    check: Annotated[
        bool, typer.Option("--check", help="Compare only: show what differs, write nothing.")
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="PATH", help="Write into this folder, or the code of a scene here."
        ),
    ] = None,
    scene: Annotated[
        Path | None,
        typer.Option("--scene", metavar="SCENE.toml", help="Write one module for this scene."),
    ] = None,
) -> None:
    """Write the NumPy package `generated`, or check that it is fresh.

    Example: platecontact generate --out mypackage/plate

    With --scene: one module that imports NumPy alone, with the contact law and the impact of a
    scene, of the effects that it calls for.

    Example: platecontact generate --scene glass_pane.toml --out glass_pane.py
    """
    if scene is not None:
        _scene_code(scene, out, check)
        return
    from derivation import produce

    if check:
        with stage("compare"):
            freshness = produce.check_generated(out)
        OUT.print(str(freshness), markup=False, highlight=False, soft_wrap=True)
        raise typer.Exit(0 if freshness.fresh else 1)
    with stage("derive and generate"):
        written = produce.generate(out)
    NOTES.print(f"{len(written)} files in {written[0].parent}")


def _scene_code(scene: Path, out: Path | None, check: bool) -> None:
    """Write the module of one scene."""
    from derivation.scene import SceneError, load
    from derivation.scene_code import write_scene_code

    if check:
        raise SceneError("--check: expected the package, got --scene; leave out one of them")
    if out is None:
        raise SceneError("--out: expected a file for the scene's code, got none; add --out FILE.py")
    scene_commands.check_outputs(scene, None, csv=out)
    write_scene_code(load(scene), out)
    NOTES.print(f"{out}", markup=False, highlight=False, soft_wrap=True)


@app.command()
def misprints(json: Json = None) -> None:
    """Compare the paper's printed formulas with the derived ones and diagnose what differs.

    Example: platecontact misprints --json -
    """
    from derivation import derived

    with stage("compare printed with derived"):
        findings = derived.misprints()
    if json != "-":
        rows = [(f.printed.equation, f.printed.name, f.diagnosis.kind, f.repair) for f in findings]
        table("Printed against derived", ("equation", "formula", "finding", "repair"), rows)
    if json:
        put_json([finding.to_json() for finding in findings], json)


app.command()(check_command.check)


@app.command()
def accuracy(
    quick: Annotated[bool, typer.Option("--quick", help="Fewer methods and rounds.")] = False,
    method: Annotated[
        list[str] | None,
        typer.Option("--method", metavar="NAME", help="Measure this family only; repeatable."),
    ] = None,
    scene: Annotated[
        Path | None,
        typer.Option("--scene", metavar="FILE", help="A scene instead of the paper's case."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="FILE", help="Write here instead of reports/data/accuracy.json."
        ),
    ] = None,
    moving: Annotated[
        bool,
        typer.Option("--moving", help="Of a plate that moves instead: reports/data/moving.json."),
    ] = False,
) -> None:
    """Measure what each digit costs in time with every method: minutes.

    Example: platecontact accuracy --quick --out accuracy.json
    """
    if moving:
        _moving(out, others=quick or bool(method) or scene is not None)
        return
    from derivation import pipeline
    from derivation.measure.accuracy.summary import COLUMNS, cells, headline

    with counted("accuracy") as tell:
        data, path = pipeline.accuracy(method or (), quick, scene, out, tell)
    table("Cheapest methods in arrays", COLUMNS, cells(data))
    OUT.print(headline(data), markup=False, highlight=False, soft_wrap=True)
    NOTES.print(f"written to {path}", markup=False, soft_wrap=True)


def _moving(out: Path | None, others: bool) -> None:
    """Measure what accuracy costs where the plate moves."""
    from derivation import moving_costs

    if others:
        raise typer.BadParameter("expected --moving with --out alone; leave the others out")
    with counted("accuracy") as tell:
        data, path = moving_costs.record(out, tell)
    table("An impact on a plate that moves", moving_costs.COLUMNS, moving_costs.cells(data))
    NOTES.print(f"written to {path}", markup=False, soft_wrap=True)


@app.command()
def rewrite(
    formula: Annotated[
        str, typer.Argument(help="A formula of one variable; none for the paper's own.")
    ] = "",
    variable: Annotated[str, typer.Option(help="Its variable, positive.")] = "x",
    record: Annotated[
        bool, typer.Option("--record", help="Keep the paper's as reports/data/rewrite.json.")
    ] = False,
    json: Json = None,
) -> None:
    """Find a stable form of a formula and print it as NumPy, or say what was done to the paper's.

    Example: platecontact rewrite "(x - sin(x))/x**3"
    """
    from derivation import pipeline
    from derivation.measure.record import plain

    if formula:
        if record:
            raise ValueError("--record keeps the paper's formulas: leave out the formula, or it")
        with stage("rewrite"):
            stable, source = pipeline.rewritten(formula, variable)
        found = [("", applied) for applied in stable.applied]
        data: object = {"source": source, "applied": [asdict(a) for a in stable.applied]}
    else:
        with counted("rewrite") as tell:
            accounts = pipeline.rewriting(record, tell)
        found = [(account.name, applied) for account in accounts for applied in account.applied]
        data, source = {"rows": [asdict(account) for account in accounts]}, ""
    if json != "-":
        rows = [
            (name, a.rule, a.cause, *(f"{x:.3g}" for x in (*a.operations, *a.worst)))
            for name, a in found
        ]
        heads = ("formula", "rule", "against", "#operations", "#with it", "#worst ULP", "#with it")
        table("Without and with each rule", heads, rows)
        OUT.print(source, markup=False, highlight=False, soft_wrap=True)
    if json:
        put_json(plain(data), json)


@app.command()
def report(
    pdf: Annotated[bool, typer.Option("--pdf/--no-pdf", help="Compile the PDF too.")] = True,
    check: Annotated[
        bool, typer.Option("--check", help="Compare the committed files only, write nothing.")
    ] = False,
    section: Annotated[
        list[str] | None,
        typer.Option("--section", metavar="NAME", help="This section only; repeatable."),
    ] = None,
    fragment: Annotated[
        list[str] | None,
        typer.Option(
            "--fragment",
            metavar="NAME",
            help="Print a formula, or all of a link of the chain, as LaTeX to paste; repeatable.",
        ),
    ] = None,
    out: Out = None,
) -> None:
    """Write the report as LaTeX and HTML, and compile the PDF.

    Example: platecontact report --section misprints --section accuracy

    With --fragment: to the screen, or with --out into a folder, the bibliography beside it.

    Example: platecontact report --fragment K_j --fragment "contact split" --out pieces
    """
    from derivation import reporting

    if bool(check) + bool(section) + bool(fragment) > 1:
        raise ValueError("expected one of --check, --section and --fragment: run one by one")
    if check:
        with stage("compare"):
            freshness = reporting.check_report(out)
        OUT.print(str(freshness), markup=False, highlight=False, soft_wrap=True)
        raise typer.Exit(0 if freshness.fresh else 1)
    if fragment:
        if out is None:
            print(reporting.fragments(fragment), end="")
            return
        written = reporting.write_fragments(fragment, out)
    else:
        with stage("report"):
            written = reporting.report(out, pdf, section or ())
    NOTES.print("\n".join(str(path) for path in written), markup=False)


@app.command()
def build(out: Out = None) -> None:
    """Run the main job: derive, generate, find misprints, check, report.

    Example: platecontact build
    """
    from derivation import derived, produce

    for room in ("generated", "reports"):
        produce.writable_folder(out / room if out else None, ROOT / room)
    with stage("derive"):
        derived.chain()
    with stage("rewrite"):
        produce.forms()
    with stage("generate"):
        produce.generate(out / "generated" if out else None)
    with stage("misprints"):
        derived.misprints()
    # Only now, as these import what has just been generated.
    from derivation import pipeline, reporting
    from derivation.measure.record import passed
    from derivation.report.pdf import TexError

    with counted("check") as tell:
        rows = pipeline.check(tell=tell)
    with stage("report"):
        try:
            reporting.report(out / "reports" if out else None)
        except TexError as error:
            NOTES.print(f"no PDF, all else is there: {error}", markup=False, highlight=False)
    for line in pipeline.verdict(rows):
        NOTES.print(line, markup=False, highlight=False)
    raise typer.Exit(0 if passed(rows) else 1)


@app.command()
def diagnose(
    name: Annotated[str, typer.Argument(help="Quantity, for instance K_j.")],
    formula: Annotated[str, typer.Option(help="Your formula for it, in SymPy syntax.")],
    latex: Annotated[bool, typer.Option("--latex", help="The formula is LaTeX.")] = False,
    at: Annotated[
        str, typer.Option(metavar="phi=2.5,h=0.1,...", help="Point to evaluate both at.")
    ] = "",
    digits: Annotated[int, typer.Option(min=1, max=1000, help="Digits of the values.")] = 50,
    json: Json = None,
) -> None:
    """Compare a formula of your own with the derived one; exit status 1 if they differ.

    Example: platecontact diagnose G --formula "1 + 4*T*(1+T)*exp(-2*T)" --at T=3
    """
    from derivation import derived

    with stage("compare"):
        found = derived.diagnose(name, formula, latex, at, digits)
    if json != "-":
        rows = [(key, value) for key, value in found.to_json().items() if value is not None]
        table(f"{name}: {found.verdict}", ("what", "value"), rows)
    if json:
        put_json(found.to_json(), json)
    raise typer.Exit(0 if found.verdict == "equal" else 1)


@app.command()
def reference(
    scene: scene_commands.SceneFile,
    digits: Annotated[int, typer.Option(min=1, max=1000, help="Digits of every number.")] = 50,
    json: Json = None,
) -> None:
    """Give contact law and impact of a scene file to many digits, by both oracles.

    The scene's numbers are taken as the exact doubles they are read as. Exit status 1 if the
    oracles differ.

    Example: platecontact reference scene.toml --digits 100
    """
    from derivation import pipeline

    scene_commands.check_outputs(scene, json)
    known = pipeline.in_doubles(scene)
    scene_commands.warn(known.warnings)
    NOTES.print(pipeline.time_of_reference(known, digits), highlight=False)
    with counted("reference") as tell:
        found = pipeline.reference(known, digits, tell)
    if json != "-":
        listing(f"{scene.name} to {digits} digits, its numbers being exact doubles", found.lines())
    if json:
        put_json(found.to_json(), json)
    raise typer.Exit(0 if found.agrees else 1)


app.command()(scene_commands.simulate)
app.command()(scene_commands.explain)
app.command("map")(scene_commands.map_)
app.command()(scene_commands.indent)
app.command()(scene_commands.schema)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command; every error a user can cause is one message and status 2."""
    command = get_command(app)
    try:
        status = command(args=argv, prog_name="platecontact", standalone_mode=False)
        sys.stdout.flush()
    except TyperException as error:
        advice = "see `platecontact --help`"
        text = f"platecontact: {error.format_message()} ({advice})"
        NOTES.print(text, markup=False, highlight=False, soft_wrap=True)
        return 2
    except BrokenPipeError:  # whoever reads has had enough, like `head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 2
    except (OSError, ValueError) as error:
        NOTES.print(f"platecontact: {error}", markup=False, highlight=False, soft_wrap=True)
        return 2
    if status == INTERRUPTED:
        NOTES.print("platecontact: interrupted; no file is half-written, so simply run it again")
        return 2
    return int(status or 0)


if __name__ == "__main__":
    sys.exit(main())
