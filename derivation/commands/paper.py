"""The commands that write the files of a paper: build, generate, report and new."""

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from shlex import quote
from typing import Annotated

import typer

from derivation.commands.options import PaperFolder, chosen_paper, expect_no_other_options
from derivation.commands.scenes import check_outputs
from derivation.engine.console import NOTES, OUT, progress_bar, stage, write_output

MANY_FILES = 20
"""Number of files in a folder above which `build` lists only their number."""

Out = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Write into this folder instead of the checkout."),
]


def build(out: Out = None, paper: PaperFolder = None) -> None:
    """Derive the formulas, generate and check the code, and write the report.

    At the end, the written files are listed, or their number if a folder has many. The exit
    status is 1 if an error exceeds its budget.

    Example: platecontact build
    """
    from derivation.engine import build as stages

    expect_no_other_options(paper, "no other option", out)
    built = stages.build(chosen_paper(paper), out, progress_bar)
    NOTES.say("\n".join([*built.notes, "files written:", *_listed(built.files)]))
    raise typer.Exit(0 if built.passed else 1)


def _listed(files: Sequence[Path]) -> Iterator[str]:
    """Yield the paths of files, or of a folder with more than `MANY_FILES` the number."""
    for folder, count in Counter(path.parent for path in files).items():
        if count > MANY_FILES:
            yield f"{folder}: {count} files"
        else:
            yield from (str(path) for path in files if path.parent == folder)


def generate(
    check: Annotated[
        bool,
        typer.Option(
            "--check",
            help="Only compare: list the files that differ, write nothing. The exit status is 1 if "
            "a file differs.",
        ),
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="PATH", help="Write into this folder; with --scene, into this file."
        ),
    ] = None,
    scene: Annotated[
        Path | None,
        typer.Option(
            "--scene", metavar="SCENE.toml", help="Write one module with the code of this scene."
        ),
    ] = None,
    paper: PaperFolder = None,
) -> None:
    """Write the NumPy package `generated`, or check that it is up to date.

    Example: platecontact generate --out mypackage/plate

    With --scene: write one module that imports only NumPy. It contains the contact law and the
    impact of the scene, with the effects that its tolerance requires.

    Example: platecontact generate --scene paper.toml --out paper_law.py
    """
    expect_no_other_options(paper, "--check and --out", scene)
    if scene is not None:
        _scene_code(scene, out, check)
        return
    from derivation.engine import build

    chosen = chosen_paper(paper)
    if check:
        with stage("compare"):
            freshness = build.check_generated(chosen, out, _repeated("generate", paper, out))
        OUT.say(str(freshness))
        raise typer.Exit(0 if freshness.fresh else 1)
    with stage("derive and generate"):
        written = build.generate(chosen, out)
    NOTES.say(f"{len(written)} files written to {written[0].parent}")


def _scene_code(scene: Path, out: Path | None, check: bool) -> None:
    """Write the module of one scene."""
    from derivation.scene import SceneError, load
    from derivation.scene_code import write_scene_code

    if check:
        raise SceneError(
            "--check compares the whole package and cannot be combined with --scene; "
            "remove one of them"
        )
    if out is None:
        raise SceneError(
            "--out: expected a file for the code of the scene, got none; add --out FILE.py"
        )
    check_outputs(scene, None, out=out)
    write_scene_code(load(scene), out)
    NOTES.say(f"{out}")


def report(
    pdf: Annotated[bool, typer.Option("--pdf/--no-pdf", help="Also compile the PDF.")] = True,
    check: Annotated[
        bool,
        typer.Option(
            "--check",
            help="Only compare with the committed files, write nothing. The exit status is 1 if a "
            "file differs.",
        ),
    ] = False,
    section: Annotated[
        list[str] | None,
        typer.Option("--section", metavar="NAME", help="Write only this section; repeatable."),
    ] = None,
    fragment: Annotated[
        list[str] | None,
        typer.Option(
            "--fragment",
            metavar="NAME",
            help="Print a formula, or all formulas of a derivation step, as LaTeX to paste; "
            "repeatable.",
        ),
    ] = None,
    out: Out = None,
    force: Annotated[
        bool, typer.Option("--force", help="With --fragment: replace files with other content.")
    ] = False,
    paper: PaperFolder = None,
) -> None:
    """Write the report as LaTeX and HTML, and compile the PDF.

    Example: platecontact report --section misprints --section accuracy

    With --fragment: print formulas as LaTeX to paste, or write them, with the bibliography, into
    the folder of --out.

    Example: platecontact report --fragment K_j --fragment G --out pieces
    """
    if bool(check) + bool(section) + bool(fragment) > 1:
        raise ValueError(
            "--check, --section and --fragment cannot be combined; run the command once for each"
        )
    if force and not (fragment and out):
        raise ValueError("--force applies to --fragment with --out; remove it, or add them")
    from derivation.engine import report_files

    chosen = chosen_paper(paper)
    if check:
        with stage("compare"):
            freshness = report_files.freshness(chosen, out, _repeated("report", paper, out))
        OUT.say(str(freshness))
        raise typer.Exit(0 if freshness.fresh else 1)
    if fragment and out is None:
        write_output(report_files.fragments(chosen, fragment))
        return
    if fragment and out is not None:
        written = report_files.write_fragments(chosen, fragment, out, force)
    else:
        with stage("report"):
            written = report_files.write(chosen, out, pdf, section or ())
    NOTES.say("\n".join(str(path) for path in written))


def new(
    folder: Annotated[
        Path, typer.Argument(metavar="FOLDER", help="A folder that is empty or does not exist yet.")
    ],
) -> None:
    """Create a small working paper of your own to start from.

    Example: platecontact new film
    """
    from derivation.engine.load import create_paper

    written = create_paper(folder)
    NOTES.say("\n".join(str(path) for path in written))
    NOTES.say(f"To build it, run: platecontact build --paper {quote(str(folder))}")


def _repeated(command: str, paper: Path | None, out: Path | None) -> str:
    """Return the command that writes the compared files."""
    options = {"--paper": paper, "--out": out}
    given = [f" {name} {quote(str(value))}" for name, value in options.items() if value]
    return f"platecontact {command}{''.join(given)}"
