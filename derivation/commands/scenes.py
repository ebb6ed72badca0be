"""The commands that take a scene file: check the output files, make one call, show the result."""

import os
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from derivation.commands.options import TOLERANCE, VALUES
from derivation.engine.console import (
    NOTES,
    OUT,
    Json,
    json_text,
    progress_bar,
    progress_status,
    stage,
    warn,
    write_json_output,
)
from derivation.engine.files import expect_writable, real, write_file, write_files
from derivation.engine.printable import one_line
from derivation.engine.text import paragraph, wording

if TYPE_CHECKING:
    from derivation.scene.result import Result

OUTPUT_SUFFIXES = frozenset(
    (".json", ".csv", ".png", ".pdf", ".svg", ".gif", ".html", ".nc", ".zarr", ".parquet", ".xlsx")
)
"""Suffixes of output formats."""

SceneFile = Annotated[
    Path,
    typer.Argument(metavar="SCENE.toml", help="Scene file; - is standard input."),
]
SelectionTolerance = Annotated[
    float | None,
    typer.Option(
        metavar="X",
        help="Relative tolerance of the selection, 1e-13 to 1 (default: that of the scene, or "
        "1e-3).",
    ),
]


def simulate(
    scene: SceneFile,
    json: Json = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw the impact: .png, .svg or .pdf.")
    ] = None,
    csv: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write the time history as CSV, in SI units."),
    ] = None,
    animate: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Animate a plate with inertia: .gif or .html."),
    ] = None,
    rtol: Annotated[
        float | None,
        typer.Option(metavar="X", help=f"Relative tolerance of the results, {TOLERANCE}."),
    ] = None,
    sweep: Annotated[
        str | None,
        typer.Option(metavar="TABLE.KEY=VALUES", help=f"Simulate for each of the values {VALUES}."),
    ] = None,
    details: Annotated[
        bool, typer.Option("--details", help="Also print the tables of effects and contacts.")
    ] = False,
    quiet: Annotated[
        bool,
        typer.Option("--quiet", help="Print only name, value and SI unit; no warnings."),
    ] = False,
) -> None:
    """Simulate the impact of a scene file.

    Example: platecontact simulate scene.toml --plot impact.pdf --csv impact.csv

    Prints the results with their significant digits, the error bound and the included effects.

    With --sweep plate.thickness=1e-3:1e-2:50, the table, --csv and --json have a row per value.
    """
    _check_exclusive(details, quiet, sweep is not None)
    if sweep is not None:
        _sweep(scene, sweep, json, plot or animate, csv, rtol)
        return
    from derivation.scene import SceneError, load
    from derivation.scene import simulate as run
    from derivation.scene.output import answer

    check_outputs(scene, json, plot, csv, animate)
    with progress_status("simulate"):
        result = run(load(scene), rtol=rtol)
    # All results are computed before a file is written.
    files: dict[Path, str | bytes] = {}
    if csv is not None:
        files[csv] = result.history().to_csv()
    drawings, problems = _drawings(result, plot, animate)
    files.update(drawings)
    if _write(files, json, result.to_json):
        text_of = answer.plain if quiet else answer.details if details else answer.short
        OUT.say(text_of(result))
    if quiet:
        warn([result.incomplete_note] if result.incomplete_note else [])
    else:
        warn(result.warnings)
    if problems:
        raise SceneError("; ".join(problems))
    if not result.complete:
        raise typer.Exit(1)


def title(scene: Path) -> str:
    """Return the name of a scene file, or of the pipe it is read from, for a heading."""
    name = str(scene)
    if name in ("-", "/dev/stdin"):
        return "standard input"
    return one_line(name if name.startswith(("/dev/", "/proc/")) else scene.name)


def _check_exclusive(details: bool, quiet: bool, sweep: bool) -> None:
    """Reject options that exclude each other."""
    given = {"--details": details, "--quiet": quiet, "--sweep": sweep}
    names = [name for name, wanted in given.items() if wanted]
    if len(names) > 1:
        from derivation.scene import SceneError

        raise SceneError(f"{names[0]} cannot be combined with {names[1]}; remove one of them")


def _drawings(
    result: "Result", plot: Path | None, animate: Path | None
) -> tuple[dict[Path, bytes], list[str]]:
    """Return plot and animation, and an error message for each that could not be drawn."""
    made: dict[Path, bytes] = {}
    problems = []
    for option, path in (("--plot", plot), ("--animate", animate)):
        if path is None:
            continue
        from derivation.scene.output import animation
        from derivation.scene.output import plot as plots

        try:
            if path is animate:
                with stage("animate"):
                    made[path] = animation.render(result, path.suffix)
            else:
                made[path] = plots.render(result, path.suffix)
        except (ArithmeticError, ValueError, RuntimeError, MemoryError, OSError) as error:
            text = str(error) or type(error).__name__
            problems.append(f"{option} {path}: the figure could not be drawn ({text})")
    return made, problems


def _write(files: dict[Path, str | bytes], json: str | None, make: Callable[[], Any]) -> bool:
    """Write all files or none; return whether to print the result (see `write_json_output`)."""
    if json and json != "-":
        files[Path(json)] = json_text(make())
    write_files(files)
    return write_json_output(make, json if json == "-" else None)


def _sweep(
    scene: Path,
    text: str,
    json: str | None,
    plot: Path | None,
    csv: Path | None,
    rtol: float | None,
) -> None:
    """Simulate the scene once for each value of a key."""
    from derivation.scene import SceneError, load
    from derivation.scene import sweep as sweeps
    from derivation.scene.input.keys import written
    from derivation.scene.quantity import counted

    if plot is not None:
        raise SceneError(
            "--plot and --animate cannot be combined with --sweep; remove them, or use "
            "`platecontact sweep SCENE.toml --vary ... --plot FILE`"
        )
    check_outputs(scene, json, csv=csv)
    sweep = sweeps.parse(text)
    loaded = load(scene)
    with progress_bar("simulate") as progress:
        rows = sweeps.run(loaded, sweep, rtol, progress, workers=os.cpu_count() or 1)
    key = sweep.key
    if not any(row.results for row in rows):
        raise SceneError(
            f"--sweep: expected a value of {key} that can be simulated, but all {len(rows)} are "
            f"rejected; {key} = {written(rows[0].value)} is {rows[0].remark}"
        )
    files: dict[Path, str | bytes] = {}
    if csv is not None:
        files[csv] = sweeps.to_csv(sweep, rows)
    if _write(files, json, lambda: [asdict(row) for row in rows]) and csv is None:
        OUT.say(f"Sweep of {title(scene)} over {key}\n\n{sweeps.to_text(sweep, rows)}")
    notes, alike = list[str](), dict[str, list[sweeps.SweepRow]]()
    for row in rows:
        if row.remark:
            alike.setdefault(wording(row.remark), []).append(row)
    for first, *others in alike.values():
        more = f", and similarly at {counted(len(others), 'other value')}" if others else ""
        notes.append(f"at {key} = {written(first.value)}{more}: {first.remark}")
    warn(notes)


def explain(
    scene: SceneFile,
    json: Json = None,
    rtol: SelectionTolerance = None,
) -> None:
    """Show which effects a scene requires, and why.

    Example: platecontact explain scene.toml --rtol 1e-4
    """
    from derivation.scene import explain as run
    from derivation.scene import load

    check_outputs(scene, json)
    explanation = run(load(scene), rtol)
    if write_json_output(explanation.to_json, json):
        OUT.say(f"Effects in {title(scene)}\n\n{explanation.details()}")
        for note in explanation.notes:
            NOTES.say(paragraph(note, 0))


def map_(
    scene: SceneFile,
    plot: Annotated[
        Path, typer.Option("--plot", metavar="FILE", help="File to write: .png, .svg or .pdf.")
    ] = Path("map.pdf"),
    rtol: SelectionTolerance = None,
) -> None:
    """Draw for which a/h and h/b each effect matters.

    a is the contact radius, h half the plate thickness, b the plate radius. The scene is marked.

    Example: platecontact map scene.toml --plot map.pdf
    """
    from derivation.scene import load
    from derivation.scene import simulate as run
    from derivation.scene.output.map import render

    check_outputs(scene, None, plot)
    result = run(load(scene), rtol=rtol)
    write_file(plot, render(result, result.effects.rtol, plot.suffix))
    NOTES.say(f"{plot}")


def indent(
    scene: SceneFile,
    more: Annotated[list[str] | None, typer.Argument(metavar="V", hidden=True)] = None,
    contact_radius: Annotated[
        list[str] | None, typer.Option(metavar="V...", help="Contact radii [m].")
    ] = None,
    force: Annotated[
        list[str] | None, typer.Option(metavar="V...", help="Contact forces [N].")
    ] = None,
    indentation: Annotated[
        list[str] | None, typer.Option(metavar="V...", help="Indentations [m].")
    ] = None,
    json: Json = None,
) -> None:
    """Compute static contacts for given radii, forces or indentations.

    Example: platecontact indent scene.toml --force 10 100 1000
    """
    from derivation.scene import SceneError, load
    from derivation.scene import indent as run

    check_outputs(scene, json)
    loaded = load(scene)
    given = {"contact_radius": contact_radius, "force": force, "indentation": indentation}
    chosen = {name: _numbers(name, texts, more) for name, texts in given.items() if texts}
    if len(chosen) != 1:
        got = " and ".join(f"--{name.replace('_', '-')}" for name in chosen) or "none"
        raise SceneError(
            "expected exactly one of --contact-radius, --force and --indentation, "
            f"got {got}; {'remove all but one' if chosen else 'add one of them'}"
        )
    contacts = run(loaded, **chosen)
    if write_json_output(lambda: [contact.to_json() for contact in contacts], json):
        OUT.say(f"Static contact in {title(scene)}\n\n{contacts.to_text()}")
    warn(contacts.warnings)


def schema(
    out: Annotated[
        str, typer.Option(metavar="FILE|-", help="Write to this file; - is standard output.")
    ] = "-",
) -> None:
    """Print the JSON schema of scene files.

    Editors use it to check scene files and to complete their keys.

    Example: platecontact schema --out scene.schema.json
    """
    from derivation.scene import schema as made

    write_json_output(made, out)


def _numbers(name: str, texts: Sequence[str], more: Sequence[str] | None) -> list[float]:
    """Return the numbers of an option: `--force 1 2`, `--force 1,2` or `--force 1 --force 2`."""
    from derivation.scene import SceneError

    numbers = []
    for text in ",".join([*texts, *(more or [])]).split(","):
        try:
            numbers.append(float(text))
        except ValueError:
            option = name.replace("_", "-")
            raise SceneError(
                f"--{option}: expected numbers, got {text!r}; "
                f"write for example --{option} 1e-3 2e-3, after the scene file"
            ) from None
    return numbers


def _expect_suffix(kind: str, files: Sequence[Path]) -> None:
    """Reject JSON and CSV files with the suffix of another format.

    Raises
    ------
    SceneError
        If a file has such a suffix.
    """
    from derivation.scene import SceneError

    for path in files:
        if path.suffix.lower() in OUTPUT_SUFFIXES - {f".{kind}"}:
            raise SceneError(
                f"--{kind}: expected a file name with the suffix .{kind}, got {path.name}; "
                "change the file name, or use the option for that format"
            )


def check_outputs(
    scene: Path,
    json: str | None,
    plot: Path | None = None,
    csv: Path | None = None,
    animate: Path | None = None,
    out: Path | None = None,
    distributions: Path | None = None,
) -> None:
    """Reject output files that are figures of unknown format, not writable, or named twice.

    A name is taken if it is that of an input or of another output. JSON and CSV files must not have
    the suffix of another format; the caller checks the suffix of `out`.

    Raises
    ------
    SceneError
        If a name cannot be used.
    OSError
        If a file cannot be written.
    """
    from derivation.scene import SceneError

    if plot is not None:
        from derivation.scene.output.plot import check_suffix

        check_suffix(plot)
    if animate is not None:
        from derivation.scene.output.animation import SUFFIXES
        from derivation.scene.output.plot import check_suffix

        check_suffix(animate, SUFFIXES, "an animation")
    paths = [Path(json)] if json and json != "-" else []
    for kind, names in (("json", paths), ("csv", [csv] if csv else [])):
        _expect_suffix(kind, names)
    paths += [path for path in (plot, csv, animate, out) if path is not None]
    taken = {real(scene): "the scene file"}
    if distributions is not None:
        taken[real(distributions)] = "the file of the distributions"
    for place in paths:
        if place == Path("-"):
            raise SceneError("-: expected a file name; only --json accepts - for standard output")
        expect_writable(place)
        if real(place) in taken:
            raise SceneError(
                f"{place}: expected a separate file for each output, "
                f"got {taken[real(place)]}; choose another name"
            )
        taken[real(place)] = "the file of another output"
