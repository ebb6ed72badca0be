"""From formulas to the written package, without a look at what is generated now.

A broken package can therefore always be written anew.
"""

from pathlib import Path

from derivation.derived import GROUND, formulas
from derivation.emit.freshness import Freshness, compare
from derivation.emit.render import render
from derivation.files import ROOT, cached, expect_folder, expect_writable, in_checkout, write_files
from derivation.rewrite.form import Form
from derivation.rewrite.forms import stable_forms

GENERATED = ROOT / "generated"


def forms() -> tuple[Form, ...]:
    """Stage 2: stable forms, proved equal to the formulas."""
    return cached("forms", (*GROUND, "rewrite"), lambda: stable_forms(formulas()))


def package() -> dict[str, str]:
    """Stage 3: the files of the generated package by name."""
    rooms = (*GROUND, "rewrite", "paper", "emit", "budgets.toml")
    return cached("package", rooms, lambda: render(formulas(), forms()))


def folder_for(out: Path | None, own: Path) -> Path:
    """Folder to write to: `out`, or the checkout's own.

    Raises
    ------
    ValueError
        If this is an installed copy and no folder is given.
    """
    if out is None and not in_checkout():
        raise ValueError("expected a folder, as this is an installed copy: add --out DIR")
    return own if out is None else out


def writable_folder(out: Path | None, own: Path) -> Path:
    """The same, refused before anything is computed if it cannot be written to.

    Raises
    ------
    OSError
        If it cannot be written to.
    """
    folder = folder_for(out, own)
    expect_folder(folder)
    return folder


def expect_recordable(path: Path) -> None:
    """Refuse to measure for minutes what cannot be kept among the project's measurements.

    Raises
    ------
    ValueError
        If this is an installed copy.
    OSError
        If the file cannot be written.
    """
    if not in_checkout():
        raise ValueError(
            "--record: expected a checkout, got an installed copy; keep the result by --json FILE"
        )
    expect_writable(path)


def generate(out: Path | None = None) -> tuple[Path, ...]:
    """Write the generated package; returns the files written.

    Raises
    ------
    OSError
        If the folder cannot be written to.
    """
    folder = writable_folder(out, GENERATED)
    return write_files({folder / name: text for name, text in package().items()})


def check_generated(out: Path | None = None) -> Freshness:
    """Compare the generated package with what would be written."""
    mend = "platecontact generate" + (f" --out {out}" if out else "")
    return compare(folder_for(out, GENERATED), package(), mend)
