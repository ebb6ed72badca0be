"""Comparison of a folder with the files that it should contain: missing, edited, surplus."""

import difflib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Freshness:
    """Differences between the files of a folder and the expected ones.

    Parameters
    ----------
    folder
        The folder that was compared.
    missing, orphans
        Names of missing files, and of surplus files.
    diffs
        Unified diff of every edited file, by name.
    remedy
        The command that writes the folder again.
    """

    folder: Path
    missing: tuple[str, ...]
    orphans: tuple[str, ...]
    diffs: Mapping[str, str]
    remedy: str

    @property
    def fresh(self) -> bool:
        """Whether there is no difference."""
        return not (self.missing or self.orphans or self.diffs)

    def __str__(self) -> str:
        if self.fresh:
            return f"{self.folder} is up to date."
        lines = [f"missing:  {self.folder / name}" for name in self.missing]
        lines += [f"edited:   {self.folder / name}" for name in self.diffs]
        lines += [f"orphaned: {self.folder / name}" for name in self.orphans]
        lines += [diff.rstrip("\n") for diff in self.diffs.values()]
        if self.missing or self.diffs:
            lines.append(f"To update the files, run: {self.remedy}")
        if self.orphans:
            orphans = " ".join(str(self.folder / name) for name in self.orphans)
            lines.append(f"To remove the orphaned files, run: rm {orphans}")
        return "\n".join(lines)


def compare(
    folder: Path, expected: Mapping[str, str], remedy: str, pattern: str = "**/*"
) -> Freshness:
    """Compare a folder's files with the expected ones, by name and content.

    Parameters
    ----------
    folder
        Folder to be compared; it need not exist.
    expected
        File contents by name relative to the folder.
    remedy
        The command that writes the expected files.
    pattern
        Pattern of the files in the folder that are compared.
    """
    actual = {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.glob(pattern))
        if path.is_file() and "__pycache__" not in path.parts
    }
    edited = [name for name in expected if actual.get(name, b"") != expected[name].encode()]
    return Freshness(
        folder,
        tuple(sorted(expected.keys() - actual.keys())),
        tuple(sorted(actual.keys() - expected.keys())),
        {name: _diff(name, actual[name], expected[name]) for name in edited if name in actual},
        remedy,
    )


def _diff(name: str, current: bytes, expected: str) -> str:
    """Return the unified diff from the existing file to the expected one."""
    return "".join(
        difflib.unified_diff(
            current.decode(errors="replace").splitlines(keepends=True),
            expected.splitlines(keepends=True),
            f"{name} (current)",
            f"{name} (expected)",
        )
    )
