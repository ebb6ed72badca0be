"""The worked examples of `docs/development`, written into the files that they name."""

import re
from pathlib import Path

from derivation.engine.files import ROOT

PAGES = ("effect", "formula", "subject", "function", "rule_and_case", "paper")
"""The pages, in the order in which their examples are written."""
GUIDE = "\n".join((ROOT / "docs" / "development" / f"{page}.md").read_text() for page in PAGES)
BLOCK = re.compile(r"```(?:python|toml|jinja)\n# (.+?)\n(.*?)```", re.DOTALL)
PAPER = "FOLDER/"
"""Beginning of the file name of a block that belongs to another paper."""


def apply_examples(root: Path, *, paper: bool) -> int:
    """Apply all blocks for the sources, or for another paper, to a folder; return their number."""
    blocks = [block for block in BLOCK.findall(GUIDE) if block[0].startswith(PAPER) is paper]
    for target, text in blocks:
        _apply(target.removeprefix(PAPER), text, root)
    return len(blocks)


def _apply(target: str, text: str, root: Path) -> None:
    """Write a block to the file, and at the position, that its first line states."""
    if target.startswith("new file: "):
        path = root / target.removeprefix("new file: ")
        assert not path.exists(), f"{path.name} exists already"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return
    places = r", (new file|below|above|at the end)"
    name, where, line = (*re.split(places, target, maxsplit=1), "")[:3]
    if where == "new file":
        (root / name).write_text(text)
        return
    old = (root / name).read_text()
    if where == "at the end":
        (root / name).write_text(old + text)
        return
    line = line.removeprefix(": ") + "\n"
    assert f"\n{old}".count(f"\n{line}") == 1, f"{name} must have exactly one line {line}"
    both = line + text if where == "below" else f"{text}\n\n{line}"
    (root / name).write_text(old.replace(line, both))
