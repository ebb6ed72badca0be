"""A folder against the files it should hold: what is missing, edited or does not belong."""

import difflib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Freshness:
    """How a folder differs from what would be written into it.

    Parameters
    ----------
    folder
        The folder looked at.
    missing, orphans
        Names of files that should be there, and of files that should not.
    diffs
        Unified diff of every edited file, by name.
    mend
        The command that writes the folder anew.
    """

    folder: Path
    missing: tuple[str, ...]
    orphans: tuple[str, ...]
    diffs: Mapping[str, str]
    mend: str

    @property
    def fresh(self) -> bool:
        """Whether nothing differs."""
        return not (self.missing or self.orphans or self.diffs)

    def __str__(self) -> str:
        if self.fresh:
            return f"{self.folder} is up to date."
        lines = [f"missing:  {self.folder / name}" for name in self.missing]
        lines += [f"edited:   {self.folder / name}" for name in self.diffs]
        lines += [f"orphaned: {self.folder / name}" for name in self.orphans]
        lines += [diff.rstrip("\n") for diff in self.diffs.values()]
        if self.missing or self.diffs:
            lines.append(f"To update the files, run: {self.mend}")
        if self.orphans:
            orphans = " ".join(str(self.folder / name) for name in self.orphans)
            lines.append(f"To remove the orphaned files, run: rm {orphans}")
        return "\n".join(lines)


def compare(
    folder: Path, expected: Mapping[str, str], mend: str, pattern: str = "**/*"
) -> Freshness:
    """Compare a folder's files with the expected ones, by name and content.

    Parameters
    ----------
    folder
        Folder to look at; it need not exist.
    expected
        File contents by name relative to the folder.
    mend
        The command that would write them.
    pattern
        Which files of the folder count.
    """
    found = {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.glob(pattern))
        if path.is_file() and "__pycache__" not in path.parts
    }
    edited = [name for name in expected if found.get(name, b"") != expected[name].encode()]
    return Freshness(
        folder,
        tuple(sorted(expected.keys() - found.keys())),
        tuple(sorted(found.keys() - expected.keys())),
        {name: _diff(name, found[name], expected[name]) for name in edited if name in found},
        mend,
    )


def _diff(name: str, found: bytes, expected: str) -> str:
    """Unified diff from the file found to the one expected."""
    return "".join(
        difflib.unified_diff(
            found.decode(errors="replace").splitlines(keepends=True),
            expected.splitlines(keepends=True),
            f"{name} (found)",
            f"{name} (expected)",
        )
    )
