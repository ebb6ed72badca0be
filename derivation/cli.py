"""The command `platecontact`: each command reads its arguments and makes one call.

Exit status: 0 success; 1 a check failed, formulas differ, or an impact is incomplete; 2 invalid
input, a file that cannot be written, or Ctrl-C; 141 the reader of the output has closed the pipe.
"""

import sys
from collections.abc import Sequence
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Annotated

import typer
from typer.exceptions import TyperException
from typer.main import get_command

from derivation.commands import check as check_command
from derivation.commands import derive as derive_command
from derivation.commands import examples as example_commands
from derivation.commands import formulas as formula_commands
from derivation.commands import materials as material_commands
from derivation.commands import paper as paper_commands
from derivation.commands import scenes as scene_commands
from derivation.commands import sweep as sweep_command
from derivation.commands.command import Command, SignedCommand
from derivation.commands.groups import GroupedHelp
from derivation.commands.options import PaperFolder, chosen_paper
from derivation.engine.console import (
    INTERRUPTED_STATUS,
    NOTES,
    OUT,
    UNREAD_STATUS,
    Json,
    UnreadError,
    listing,
    progress_bar,
    silence,
    stage,
    table,
    warn,
    warnings_as_notes,
    write_json_output,
    write_output,
)
from derivation.engine.failed import FailedError
from derivation.engine.files import ROOT, in_checkout
from derivation.engine.interruption import interruptions
from derivation.engine.staging import recover
from derivation.scene.input.old_names import OldNameWarning

app = typer.Typer(
    cls=GroupedHelp,
    add_completion=True,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Simulate the impact of a sphere on an elastic plate; derive, check and generate the "
    "formulas used. All quantities are in SI units.",
    epilog="To start: `platecontact examples glass_pane`, then `platecontact simulate "
    "glass_pane.toml`. To complete commands and options with the Tab key, run `platecontact "
    "--install-completion` once and open a new shell.",
)


def _show_version(wanted: bool) -> None:
    """Print the version and exit, if the option is given."""
    if wanted:
        OUT.say(f"platecontact {version('platecontact')}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _program(
    context: typer.Context,
    version: Annotated[  # noqa: ARG001
        bool,
        typer.Option(
            "--version", callback=_show_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
) -> None:
    """Show the help if no command is given."""
    if context.invoked_subcommand is None:
        OUT.say(context.get_help())


command = partial(app.command, cls=Command)


command()(derive_command.derive)
command()(paper_commands.generate)


@command()
def misprints(paper: PaperFolder = None, json: Json = None) -> None:
    """Compare the published formulas with the derived ones.

    For each formula the misprints are listed, with the correction.

    Example: platecontact misprints --json -
    """
    from derivation.engine import build

    chosen = chosen_paper(paper)
    with stage("compare published with derived"):
        findings = build.misprints(chosen)
    if write_json_output(lambda: [finding.to_json() for finding in findings], json):
        rows = [(f.printed.equation, f.printed.name, f.kind, f.repair) for f in findings]
        table("Published and derived formulas", ("equation", "formula", "finding", "fix"), rows)


app.add_typer(check_command.app, name="check")


@command("accuracy", hidden=True)  # its former name
@command()
def benchmark(
    quick: Annotated[bool, typer.Option("--quick", help="Run fewer methods and rounds.")] = False,
    method: Annotated[
        list[str] | None,
        typer.Option(
            "--method", metavar="NAME", help="Benchmark this family of methods only; repeatable."
        ),
    ] = None,
    scene: Annotated[
        Path | None,
        typer.Option(
            "--scene", metavar="FILE", help="Benchmark this scene instead of the paper's case."
        ),
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

    The benchmark takes minutes. It writes files only with --out or --update.

    Example: platecontact benchmark --quick --out accuracy.json
    """
    if dynamic:
        _dynamic(out, update, others=quick or bool(method) or scene is not None)
        return
    from derivation import pipeline
    from derivation.plate.benchmark.summary import COLUMNS, cells, headline

    with progress_bar("benchmark") as progress:
        data, path = pipeline.accuracy(method or (), quick, scene, out, progress, update)
    table("Fastest methods for arrays", COLUMNS, cells(data))
    OUT.say(headline(data))
    _written(path)


def _written(path: Path | None) -> None:
    """Print where a measurement was written, or how to save it."""
    NOTES.say(f"written: {path}" if path else "not saved; to save it, add --out FILE or --update")


def _dynamic(out: Path | None, update: bool, others: bool) -> None:
    """Benchmark impacts with plate inertia."""
    from derivation.checks import dynamic_benchmark

    if others:
        raise typer.BadParameter(
            "--dynamic can be combined with --out or --update only; remove the other options"
        )
    with progress_bar("benchmark") as progress:
        data, path = dynamic_benchmark.record(out, progress, update)
    table("Impact with plate inertia", dynamic_benchmark.COLUMNS, dynamic_benchmark.cells(data))
    _written(path)


app.command(cls=SignedCommand)(formula_commands.rewrite)
command()(paper_commands.report)
command()(paper_commands.build)
command()(formula_commands.diagnose)
command()(paper_commands.new)


@command()
def reference(
    scene: scene_commands.SceneFile,
    digits: Annotated[
        int, typer.Option(metavar="N", min=1, max=1000, help="Number of digits.")
    ] = 50,
    json: Json = None,
) -> None:
    """Compute contact law and impact of a scene to many digits.

    Two independent methods (Arb and mpmath) must agree; the exit status is 1 if they do not. Each
    number of the scene is read as a double, and the reference is computed for exactly that double.

    Example: platecontact reference scene.toml --digits 100
    """
    from derivation.checks.paper_law import in_doubles
    from derivation.scene import load

    scene_commands.check_outputs(scene, json)
    known = in_doubles(load(scene))

    from derivation.checks import many_digits  # imports SymPy: slow, so scenes are rejected first

    warn(known.warnings)
    NOTES.say(many_digits.time_of_reference(known, digits))
    with progress_bar("reference") as progress:
        result = many_digits.reference(known, digits, progress)
    if write_json_output(result.to_json, json):
        listing(f"{scene_commands.title(scene)} to {digits} digits", result.lines())
    raise typer.Exit(0 if result.agrees else 1)


command()(scene_commands.simulate)
command()(sweep_command.sweep)
command()(scene_commands.explain)
command("map")(scene_commands.map_)
app.command(cls=SignedCommand)(scene_commands.indent)
command()(material_commands.materials)
command()(example_commands.examples)
command()(scene_commands.schema)


def _sentence(error: TyperException) -> str:
    """Return the message of the parser without a full stop and without pydantic's details."""
    sentence = error.format_message().partition(", unable to parse")[0].rstrip(".")
    invalid = getattr(error.__cause__, "errors", None)  # pydantic's, with the value
    return f"{sentence}, got {invalid()[0]['input']}" if invalid else sentence


def _reason(error: Exception) -> str:
    """Return the message of an error; that of the operating system without its number."""
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename or 'standard output'}: {error.strerror}"
    return str(error)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command and return its exit status; an error of the user is shown as one message."""
    platecontact = get_command(app)
    try:
        if in_checkout():
            recover(ROOT / "generated")
        with warnings_as_notes(OldNameWarning), interruptions():
            status = platecontact(args=argv, prog_name="platecontact", standalone_mode=False)
        write_output("")
    except KeyboardInterrupt:
        status = INTERRUPTED_STATUS
    except TyperException as error:
        context = getattr(error, "ctx", None)
        command = context.command_path if context else "platecontact"
        NOTES.say(f"platecontact: {_sentence(error)} (see `{command} --help`)")
        return 2
    except UnreadError:
        silence(sys.stdout)
        return UNREAD_STATUS
    except (OSError, ValueError, FailedError) as error:
        NOTES.say(f"platecontact: {_reason(error)}")
        return 1 if isinstance(error, FailedError) else 2
    except Exception as error:
        from derivation.engine.load import location_in_paper  # imports SymPy: slow

        place = location_in_paper(error)
        if not place:
            raise
        NOTES.say(f"platecontact: {place}{type(error).__name__}: {error}; correct it")
        return 2
    if status == INTERRUPTED_STATUS:
        NOTES.say(
            "platecontact: interrupted; no file is incomplete, so the command can be run again"
        )
        return 2
    return int(status or 0)


if __name__ == "__main__":
    sys.exit(main())
