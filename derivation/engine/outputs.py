"""Destinations of results: a given path, or the project's own in a checkout; JSON text."""

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from derivation.engine.files import ROOT, expect_folder, expect_writable, in_checkout


def folder_for(out: Path | None, default: Path) -> Path:
    """Return the folder to write to: `out`, or the project's own.

    Raises
    ------
    ValueError
        If `out` is None and the project's folder belongs to an installed copy.
    """
    if out is None and _installed(default):
        raise ValueError("expected a folder, as this is an installed copy: add --out DIR")
    return default if out is None else out


def writable_folder(out: Path | None, default: Path) -> Path:
    """Return the folder to write to, as `folder_for` does, after a test that it is writable.

    Raises
    ------
    ValueError
        If `out` is None and the project's folder belongs to an installed copy.
    OSError
        If it cannot be written to.
    """
    folder = folder_for(out, default)
    expect_folder(folder)
    return folder


def recorded_in(committed: Path, update: bool, out: Path | None) -> Path | None:
    """Return the file for a measurement: the committed one, `out`, or none.

    Raises
    ------
    ValueError
        If both are requested, or the committed one belongs to an installed copy.
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
    """Reject a measurement that takes minutes if its result could not be saved.

    Raises
    ------
    ValueError
        If the file belongs to an installed copy.
    OSError
        If the file cannot be written.
    """
    if _installed(path):
        raise ValueError(
            "--update: expected a checkout, got an installed copy; save the result with --json FILE"
        )
    expect_writable(path)


def plain(value: Any) -> Any:
    """Return data for JSON; infinities and NaN, which JSON does not allow, become text."""
    if isinstance(value, dict):
        return {key: plain(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [plain(part) for part in value]
    if isinstance(value, float) and not math.isfinite(value):
        return repr(value)
    return value


def plain_rows(rows: Iterable[Any]) -> list[dict[str, Any]]:
    """Return rows as plain data, field by field."""
    return [plain(asdict(row)) for row in rows]


def sorted_json(data: Any) -> str:
    """Return plain data as JSON; equal data give equal bytes."""
    return json.dumps(data, indent=1, sort_keys=True, allow_nan=False) + "\n"


def json_by_line(data: Mapping[str, Any], *lists: str) -> str:
    """Return plain data as JSON, one entry per line; for the named lists one row per line."""
    lines = []
    for key, value in data.items():
        text = json.dumps(value, allow_nan=False)
        if key in lists:
            rows = ",\n ".join(json.dumps(row, allow_nan=False) for row in value)
            text = f"[\n {rows}\n]"
        lines.append(f"{json.dumps(key)}: {text}")
    return "{" + ",\n".join(lines) + "}\n"


def _installed(path: Path) -> bool:
    """Return whether a path belongs to an installed copy, whose files are not changed."""
    return path.is_relative_to(ROOT) and not in_checkout()
