"""The command `platecontact`: each command unpacks its arguments and makes one call.

Exit status: 0 fine, 1 a check failed or formulas differ, 2 bad input, 141 nobody reads the output.
"""

import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from typer.exceptions import TyperException
from typer.main import get_command

from derivation.commands import check as check_command
from derivation.commands import formulas as formula_commands
from derivation.commands import paper as paper_commands
from derivation.commands import scenes as scene_commands
from derivation.commands.command import Command
from derivation.commands.groups import Grouped
from derivation.commands.options import PaperFolder, alone, chosen
from derivation.engine.console import (
    INTERRUPTED,
    NOTES,
    OUT,
    UNREAD,
    Json,
    UnreadError,
    counted,
    listing,
    put,
    put_json,
    silence,
    stage,
    table,
    warn,
)
from derivation.engine.failed import FailedError
from derivation.engine.files import ROOT, in_checkout
from derivation.engine.staging import recover

app = typer.Typer(
    cls=Grouped,
    no_args_is_help=True,
    add_completion=True,
    rich_markup_mode=None,
    help="Derive, generate, check and report the contact law of a sphere on an elastic plate.",
)

command = partial(app.command, cls=Command)
Out = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="Write here instead of the checkout.")
]


@command()
def derive(paper: PaperFolder = None, json: Json = None) -> None:
    """Derive all formulas from the equilibrium equations.

    Each is shown with how it was verified.

    Example: platecontact derive --json formulas.json
    """
    from derivation.engine import build

    own = chosen(paper)
    with stage("derive"):
        found = build.formulas(own)
    if put_json(lambda: [formula.to_json() for formula in found.values()], json):
        rows = [(f.name, f.unit, f.equation, f.proof.step, f.proof.method) for f in found.values()]
        table("Derived formulas", ("formula", "unit", "equation", "proof", "verified"), rows)


@command()
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
    paper: PaperFolder = None,
) -> None:
    """Write the NumPy package `generated`, or check that it is fresh.

    Example: platecontact generate --out mypackage/plate

    With --scene: one module that imports NumPy alone, with the contact law and the impact of a
    scene, of the effects that it calls for.

    Example: platecontact generate --scene glass_pane.toml --out glass_pane.py
    """
    alone(paper, "--check and --out", scene)
    if scene is not None:
        _scene_code(scene, out, check)
        return
    from derivation.engine import build
    from derivation.plate import package_pipeline

    own = chosen(paper)
    if check:
        with stage("compare"):
            mend = f"platecontact generate --paper {paper}" + (f" --out {out}" if out else "")
            freshness = (
                package_pipeline.check_generated(out)
                if paper is None
                else build.check_generated(own, out, mend)
            )
        OUT.say(str(freshness))
        raise typer.Exit(0 if freshness.fresh else 1)
    with stage("derive and generate"):
        written = package_pipeline.generate(out) if paper is None else build.generate(own, out)
    NOTES.say(f"{len(written)} files in {written[0].parent}")


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
    NOTES.say(f"{out}")


@command()
def misprints(paper: PaperFolder = None, json: Json = None) -> None:
    """Find what is wrong with the published formulas, and why.

    Example: platecontact misprints --json -
    """
    from derivation.engine import build

    own = chosen(paper)
    with stage("compare printed with derived"):
        findings = build.misprints(own)
    if put_json(lambda: [finding.to_json() for finding in findings], json):
        rows = [(f.printed.equation, f.printed.name, f.diagnosis.kind, f.repair) for f in findings]
        table("Published and derived formulas", ("equation", "formula", "finding", "fix"), rows)


app.add_typer(check_command.app, name="check")


@command("accuracy", hidden=True)  # its former name
@command()
def benchmark(
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
        typer.Option("--out", metavar="FILE", help="Write the result to this file."),
    ] = None,
    dynamic: Annotated[
        bool, typer.Option("--dynamic", help="Benchmark impacts with plate inertia instead.")
    ] = False,
    update: Annotated[
        bool,
        typer.Option(
            "--update",
            help="Replace the committed reports/data/accuracy.json (with --dynamic: moving.json).",
        ),
    ] = False,
) -> None:
    """Benchmark all methods: accuracy against run time.

    Takes minutes.

    Files are written only with --out or --update.

    Example: platecontact benchmark --quick --out accuracy.json
    """
    if dynamic:
        _dynamic(out, update, others=quick or bool(method) or scene is not None)
        return
    from derivation import pipeline
    from derivation.plate.benchmark.summary import COLUMNS, cells, headline

    with counted("benchmark") as tell:
        data, path = pipeline.accuracy(method or (), quick, scene, out, tell, update)
    table("Fastest methods for arrays", COLUMNS, cells(data))
    OUT.say(headline(data))
    _written(path)


def _written(path: Path | None) -> None:
    """Say where a measurement was written, or how to keep it."""
    said = f"written to {path}" if path else "not written: keep it with --out FILE or --update"
    NOTES.say(said)


def _dynamic(out: Path | None, update: bool, others: bool) -> None:
    """Benchmark impacts with plate inertia."""
    from derivation.checks import moving_costs

    if others:
        raise typer.BadParameter(
            "--dynamic can be combined with --out or --update only; remove the other options"
        )
    with counted("benchmark") as tell:
        data, path = moving_costs.record(out, tell, update)
    table("An impact with plate inertia", moving_costs.COLUMNS, moving_costs.cells(data))
    _written(path)


command()(formula_commands.rewrite)


@command()
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
    paper: PaperFolder = None,
) -> None:
    """Write the report as LaTeX and HTML, and compile the PDF.

    Example: platecontact report --section misprints --section accuracy

    With --fragment: to the screen, or with --out into a folder, the bibliography beside it.

    Example: platecontact report --fragment K_j --fragment "contact split" --out pieces
    """
    alone(paper, "--no-pdf and --out", check, section, fragment)
    from derivation.engine import build

    own = chosen(paper)
    if paper is not None:
        with stage("report"):
            written = build.report(own, out, pdf)
        NOTES.say("\n".join(str(path) for path in written))
        return
    from derivation.plate import reporting

    if bool(check) + bool(section) + bool(fragment) > 1:
        raise ValueError("expected one of --check, --section and --fragment: run one by one")
    if check:
        with stage("compare"):
            freshness = reporting.check_report(out)
        OUT.say(str(freshness))
        raise typer.Exit(0 if freshness.fresh else 1)
    if fragment:
        if out is None:
            put(reporting.fragments(fragment))
            return
        written = reporting.write_fragments(fragment, out)
    else:
        with stage("report"):
            written = reporting.report(out, pdf, section or ())
    NOTES.say("\n".join(str(path) for path in written))


@command()
def build(out: Out = None, paper: PaperFolder = None) -> None:
    """Run the main job, from derivation to report.

    Example: platecontact build
    """
    if paper is not None:
        alone(paper, "no other option", out)
        raise typer.Exit(paper_commands.build(paper))
    from derivation.plate import derived, package_pipeline

    for room in ("generated", "reports"):
        package_pipeline.writable_folder(out / room if out else None, ROOT / room)
    with stage("derive"):
        derived.chain()
    with stage("rewrite"):
        package_pipeline.forms()
    with stage("generate"):
        package_pipeline.generate(out / "generated" if out else None)
    with stage("misprints"):
        derived.misprints()
    # Only now, as these import what has just been generated.
    from derivation import pipeline
    from derivation.engine.measure.record import passed
    from derivation.engine.report.pdf import TexError
    from derivation.plate import reporting

    with counted("check") as tell:
        rows = pipeline.check(tell=tell)
    with stage("report"):
        try:
            reporting.report(out / "reports" if out else None)
        except TexError as error:
            NOTES.say(f"no PDF, all else is there: {error}")
    for line in pipeline.verdict(rows):
        NOTES.say(line)
    raise typer.Exit(0 if passed(rows) else 1)


command()(formula_commands.diagnose)
command()(paper_commands.new)


@command()
def reference(
    scene: scene_commands.SceneFile,
    digits: Annotated[int, typer.Option(min=1, max=1000, help="Digits of every number.")] = 50,
    json: Json = None,
) -> None:
    """Compute contact law and impact of a scene to many digits.

    Both references, Arb and mpmath, have to agree.

    The scene's numbers are taken as the exact doubles they are read as. Exit status 1 if the
    oracles differ.

    Example: platecontact reference scene.toml --digits 100
    """
    from derivation import pipeline
    from derivation.scene import load

    scene_commands.check_outputs(scene, json)
    known = pipeline.in_doubles(load(scene))
    warn(known.warnings)
    NOTES.say(pipeline.time_of_reference(known, digits))
    with counted("reference") as tell:
        found = pipeline.reference(known, digits, tell)
    if put_json(found.to_json, json):
        listing(f"{scene.name} to {digits} digits, its numbers being exact doubles", found.lines())
    raise typer.Exit(0 if found.agrees else 1)


command()(scene_commands.simulate)
command()(scene_commands.explain)
command("map")(scene_commands.map_)
command()(scene_commands.indent)
command()(scene_commands.schema)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command; every error a user can cause is one message and status 2."""
    platecontact = get_command(app)
    try:
        if in_checkout():
            recover(ROOT / "generated")
        status = platecontact(args=argv, prog_name="platecontact", standalone_mode=False)
        put("")
    except TyperException as error:
        context = getattr(error, "ctx", None)
        command = context.command_path if context else "platecontact"
        NOTES.say(f"platecontact: {error.format_message()} (see `{command} --help`)")
        return 2
    except UnreadError:
        silence(sys.stdout)
        return UNREAD
    except (OSError, ValueError, FailedError) as error:
        NOTES.say(f"platecontact: {error}")
        return 1 if isinstance(error, FailedError) else 2
    if status == INTERRUPTED:
        NOTES.say("platecontact: interrupted; no file is half-written, so simply run it again")
        return 2
    return int(status or 0)


if __name__ == "__main__":
    sys.exit(main())
