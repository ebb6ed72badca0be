"""From formulas to the written package, without a look at what is generated now.

A broken package can therefore always be written anew.
"""

from pathlib import Path

from derivation.engine.emit.freshness import Freshness, compare
from derivation.engine.files import (
    ROOT,
    expect_folder,
    expect_writable,
    in_checkout,
    real,
    write_folder,
)
from derivation.engine.package import Package, files_of, forms_of
from derivation.engine.rewrite.form import Form
from derivation.engine.staging import recover
from derivation.plate.derived import CHAIN
from derivation.plate.forms import AUTOMATIC, SCALES, stable_forms
from derivation.plate.render import render

GENERATED = ROOT / "generated"


PACKAGE = Package(
    "generated",
    GENERATED,
    stable_forms,
    render,
    ("plate/budgets.toml", "plate/*/budgets.toml", "plate/templates", "plate/*/*.j2"),
    AUTOMATIC,
    SCALES,
)


def forms() -> tuple[Form, ...]:
    """Stage 2: stable forms, proved equal to the formulas."""
    return forms_of(CHAIN, PACKAGE)


def package() -> dict[str, str]:
    """Stage 3: the files of the generated package by name."""
    return files_of(CHAIN, PACKAGE)


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


def recorded_in(committed: Path, record: bool, out: Path | None) -> Path | None:
    """The file that a measurement is written to: the committed one, `out`, or none.

    Raises
    ------
    ValueError
        If both are asked for, or this is an installed copy, which has no committed files.
    OSError
        If the file cannot be written.
    """
    if record and out is not None:
        raise ValueError("--record and --out cannot be combined; remove one of them")
    if record:
        expect_recordable(committed)
        return committed
    if out is not None:
        expect_writable(out)
    return out


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
    return write_folder(folder, package())


def check_generated(out: Path | None = None) -> Freshness:
    """Compare the generated package with what would be written."""
    mend = "platecontact generate" + (f" --out {out}" if out else "")
    folder = folder_for(out, GENERATED)
    recover(real(folder))
    return compare(folder, package(), mend)
