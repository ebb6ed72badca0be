"""Where results are written: the place that is named, or the project's own in a checkout."""

from pathlib import Path

from derivation.engine.files import ROOT, expect_folder, expect_writable, in_checkout


def folder_for(out: Path | None, own: Path) -> Path:
    """Return the folder to write to: `out`, or the project's own.

    Raises
    ------
    ValueError
        If no folder is given and the own one belongs to an installed copy.
    """
    if out is None and _installed(own):
        raise ValueError("expected a folder, as this is an installed copy: add --out DIR")
    return own if out is None else out


def writable_folder(out: Path | None, own: Path) -> Path:
    """Return the same, before anything is computed.

    Raises
    ------
    ValueError
        If no folder is given and the own one belongs to an installed copy.
    OSError
        If it cannot be written to.
    """
    folder = folder_for(out, own)
    expect_folder(folder)
    return folder


def recorded_in(committed: Path, update: bool, out: Path | None) -> Path | None:
    """Return the file that a measurement is written to: the committed one, `out`, or none.

    Raises
    ------
    ValueError
        If both are asked for, or the committed one belongs to an installed copy.
    OSError
        If the file cannot be written.
    """
    if update and out is not None:
        raise ValueError("--update and --out cannot be combined; remove one of them")
    if update:
        expect_recordable(committed)
        return committed
    if out is not None:
        expect_writable(out)
    return out


def expect_recordable(path: Path) -> None:
    """Reject a measurement that takes minutes and cannot be kept.

    Raises
    ------
    ValueError
        If the file belongs to an installed copy.
    OSError
        If the file cannot be written.
    """
    if _installed(path):
        raise ValueError(
            "--update: expected a checkout, got an installed copy; keep the result by --json FILE"
        )
    expect_writable(path)


def _installed(path: Path) -> bool:
    """Whether a path belongs to an installed copy, whose files stay as they are."""
    return path.is_relative_to(ROOT) and not in_checkout()
