"""The commands that take a scene file: check the names, make one call, show the result."""

import os
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from derivation.files import expect_writable, write_file, write_files
from derivation.screen import NOTES, OUT, Json, counted, json_text, put_json, stage, table

SceneFile = Annotated[Path, typer.Argument(metavar="SCENE.toml", help="Scene file.")]


def simulate(
    scene: SceneFile,
    json: Json = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw the impact: .png, .svg or .pdf.")
    ] = None,
    csv: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write time, indentation, velocity, radius and force."),
    ] = None,
    animate: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Show the plate move: .gif or .html.")
    ] = None,
    rtol: Annotated[
        float | None,
        typer.Option(metavar="X", help="Relative tolerance, 1e-13 to 1: cheapest method."),
    ] = None,
    sweep: Annotated[
        str | None,
        typer.Option(metavar="TABLE.KEY=A:B:N", help="Simulate for N values from A to B."),
    ] = None,
) -> None:
    """Simulate the impact of a scene file.

    Example: platecontact simulate scene.toml --plot impact.pdf --csv impact.csv

    With --sweep plate.thickness=1e-3:1e-2:50 the table, --csv and --json have a row per value.
    """
    if sweep is not None:
        _sweep(scene, sweep, json, plot or animate, csv, rtol)
        return
    from derivation.scene import load
    from derivation.scene import simulate as run
    from derivation.scene.gate import HEADS

    check_outputs(scene, json, plot, csv, animate)
    result = run(load(scene), rtol=rtol)
    warn(result.warnings)
    # Everything is made before anything is written.
    files: dict[Path, str | bytes] = {}
    if csv is not None:
        files[csv] = result.history().to_csv()
    if plot is not None:
        from derivation.scene.plot import render

        files[plot] = render(result, plot.suffix)
    if animate is not None:
        from derivation.scene import animation

        with stage("animate"):
            files[animate] = animation.render(result, animate.suffix)
    if json != "-":
        table(f"Impact of {scene.name}", ("quantity", "#value", "unit"), result.rows())
        table("Effects", HEADS, result.gate.lines())
        OUT.print(str(result.accuracy), markup=False, highlight=False, soft_wrap=True)
        for note in filter(None, (result.model_note, result.verdict)):
            OUT.print(note, markup=False, highlight=False, soft_wrap=True)
        if result.moving is not None:
            from derivation.scene import wave_motion

            table("Contacts", wave_motion.HEADS, result.moving.lines())
            for note in result.moving.notes():
                OUT.print(note, markup=False, highlight=False, soft_wrap=True)
        if result.comparison:
            from derivation.scene import comparison

            table(result.comparison.title, comparison.HEADS, result.comparison.lines())
            OUT.print(result.comparison.note, markup=False, highlight=False, soft_wrap=True)
    _write(files, json, result.to_json())


def _write(files: dict[Path, str | bytes], json: str | None, result: object) -> None:
    """Write files and result, all or none; the result to standard output for `-`."""
    if json and json != "-":
        files[Path(json)] = json_text(result)
    write_files(files)
    if json == "-":
        put_json(result, json)


def _sweep(
    scene: Path,
    text: str,
    json: str | None,
    plot: Path | None,
    csv: Path | None,
    rtol: float | None,
) -> None:
    """Simulate once per value of a key."""
    from derivation.scene import SceneError, load
    from derivation.scene import sweep as sweeps
    from derivation.scene.result import UNITS

    if plot is not None:
        raise SceneError("--plot, --animate: expected none of a sweep; leave it out, or --sweep")
    check_outputs(scene, json, csv=csv)
    sweep = sweeps.parse(text)
    loaded = load(scene)
    with counted("simulate") as tell:
        rows = sweeps.run(loaded, sweep, rtol, tell, workers=os.cpu_count() or 1)
    key = f"{sweep.table}.{sweep.key}"
    warn([f"at {key} = {row.value:.6g}: {row.remark}" for row in rows if row.remark])
    files: dict[Path, str | bytes] = {}
    if csv is not None:
        files[csv] = sweeps.to_csv(sweep, rows)
    elif json != "-":
        heads = (f"#{key}", *(f"#{n} [{u}]" for n, u in UNITS.items()))
        cells = [
            [f"{row.value:.6g}"]
            + [f"{row.results[name]:.6g}" if row.results else "-" for name in UNITS]
            for row in rows
        ]
        table(f"Sweep of {scene.name}", heads, cells)
    _write(files, json, [asdict(row) for row in rows])


def explain(
    scene: SceneFile,
    json: Json = None,
    rtol: Annotated[
        float | None, typer.Option(metavar="X", help="Relative tolerance, 1e-13 to 1.")
    ] = None,
) -> None:
    """Say which effects a scene file calls for, and why; simulate nothing.

    Example: platecontact explain scene.toml --rtol 1e-4
    """
    from derivation.scene import explain as run
    from derivation.scene import load
    from derivation.scene.explanation import COLUMNS

    check_outputs(scene, json)
    found = run(load(scene), rtol)
    if json != "-":
        table(f"Effects in {scene.name}", COLUMNS, found.lines())
        OUT.print(str(found), markup=False, highlight=False, soft_wrap=True)
        for note in found.notes:
            NOTES.print(note, markup=False, highlight=False, soft_wrap=True)
    if json:
        put_json(found.to_json(), json)


def map_(
    scene: SceneFile,
    plot: Annotated[
        Path, typer.Option("--plot", metavar="FILE", help="Where to: .png, .svg or .pdf.")
    ] = Path("map.pdf"),
    rtol: Annotated[
        float | None, typer.Option(metavar="X", help="Relative tolerance, 1e-13 to 1.")
    ] = None,
) -> None:
    """Draw where each effect matters over a/h and h/b, with the scene marked.

    Example: platecontact map scene.toml --plot map.pdf
    """
    from derivation.scene import load
    from derivation.scene import simulate as run
    from derivation.scene.map import render

    check_outputs(scene, None, plot)
    result = run(load(scene), rtol=rtol)
    write_file(plot, render(result, result.gate.rtol, plot.suffix))
    NOTES.print(f"{plot}", markup=False, highlight=False, soft_wrap=True)


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
    """Press the sphere of a scene file in, at rest, by one of the three quantities.

    Example: platecontact indent scene.toml --force 10 100 1000
    """
    from derivation.scene import indent as run
    from derivation.scene import load

    check_outputs(scene, json)
    loaded = load(scene)
    given = {"contact_radius": contact_radius, "force": force, "indentation": indentation}
    chosen = {name: _numbers(name, texts, more) for name, texts in given.items() if texts}
    contacts = run(loaded, **chosen)
    warn([text for contact in contacts for text in contact.warnings])
    if json != "-":
        columns = ("#radius [m]", "#indentation [m]", "#force [N]", "#stiffness [N/m]")
        rows = [
            [
                f"{value:.6g}"
                for value in (c.contact_radius, c.indentation, c.force, c.stiffness, c.max_pressure)
            ]
            for c in contacts
        ]
        table(f"Contact in {scene.name}", (*columns, "#max. pressure [Pa]"), rows)
    if json:
        put_json([contact.to_json() for contact in contacts], json)


def schema(
    out: Annotated[
        str, typer.Option(metavar="FILE|-", help="Write here; standard output without it.")
    ] = "-",
) -> None:
    """Print the JSON schema of scene files, for editors that check and complete TOML.

    Example: platecontact schema --out scene.schema.json
    """
    from derivation.scene import schema as made

    put_json(made(), out)


def _numbers(name: str, texts: Sequence[str], more: Sequence[str] | None) -> list[float]:
    """Numbers after an option: `--force 1 2`, `--force 1,2` and `--force 1 --force 2` alike."""
    from derivation.scene import SceneError

    numbers = []
    for text in ",".join([*texts, *(more or [])]).split(","):
        try:
            numbers.append(float(text))
        except ValueError:
            option = name.replace("_", "-")
            raise SceneError(
                f"--{option}: expected numbers, got {text!r}; "
                f"write for instance --{option} 1e-3 2e-3, after the scene file"
            ) from None
    return numbers


def check_outputs(
    scene: Path,
    json: str | None,
    plot: Path | None = None,
    csv: Path | None = None,
    animate: Path | None = None,
) -> None:
    """Refuse output names that say no format or would overwrite the scene or each other."""
    from derivation.scene import SceneError

    if plot is not None:
        from derivation.scene.plot import check_suffix

        check_suffix(plot)
    if animate is not None:
        from derivation.scene.animation import SUFFIXES
        from derivation.scene.plot import check_suffix

        check_suffix(animate, SUFFIXES, "an animation")
    places = [Path(json)] if json and json != "-" else []
    places += [path for path in (plot, csv, animate) if path is not None]
    taken = {scene.resolve(): "the scene file"}
    for place in places:
        if place == Path("-"):
            raise SceneError("-: expected a file to write; only --json takes standard output as -")
        expect_writable(place)
        if place.resolve() in taken:
            raise SceneError(
                f"{place}: expected a file of its own for each output, "
                f"got {taken[place.resolve()]}; choose another name"
            )
        taken[place.resolve()] = "one that another output takes"


def warn(warnings: Sequence[str]) -> None:
    """Show each warning once, apart from the results."""
    for text in dict.fromkeys(warnings):
        NOTES.print(f"warning: {text}", markup=False, highlight=False, soft_wrap=True)
