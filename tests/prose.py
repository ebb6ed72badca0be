"""Check the prose of Markdown files: proselint, and the words of `[tool.prose]` in pyproject.toml.

Usage: python tests/prose.py FILE|FOLDER...
"""

import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

from proselint.checks import __register__
from proselint.config import DEFAULT, Config
from proselint.registry import CheckRegistry
from proselint.tools import LintFile

CODE = re.compile(r"^```.*?^```$|^    .*?$|`[^`]*`|\$[^$\n]+\$|<!--.*?-->|\]\([^)]*\)", re.M | re.S)
HEADING = re.compile(r"^#.*$", re.M)  # proselint would join a heading and the next sentence
SETTINGS = tomllib.loads((Path(__file__).parent.parent / "pyproject.toml").read_text())["tool"][
    "prose"
]


def blanked(text: str) -> str:
    """Return the text with dashes in place of code, formulas and addresses of links."""
    return CODE.sub(lambda match: re.sub(r"[^\n]", "-", match[0]), text)


def findings(name: str, text: str) -> Iterator[str]:
    """Yield each finding as `FILE:LINE: message`."""
    text = blanked(text)
    registry = CheckRegistry()
    if not registry.checks:
        registry.register_many(__register__)
    config = Config(
        max_errors=DEFAULT["max_errors"],
        checks={
            **dict.fromkeys(SETTINGS["ignored-checks"], False),
            **DEFAULT["checks"],
        },  # the first matching entry applies
    )
    file = LintFile(name, HEADING.sub(lambda match: "-" * len(match[0]), text))
    for problem in file.lint(config):
        line, _ = file.line_col_of(problem.check_result.span[0])
        yield f"{name}:{line}: {problem.check_result.message}"
    for word, remedy in SETTINGS["words"].items():
        for match in re.finditer(rf"\b{word}\b".replace(" ", r"\s+"), text, re.IGNORECASE):
            line = text.count("\n", 0, match.start()) + 1
            yield f"{name}:{line}: {' '.join(match[0].split())}: write {remedy}"


def pages(paths: list[Path]) -> Iterator[Path]:
    """Yield the Markdown files of files and folders."""
    for path in paths:
        yield from sorted(path.rglob("*.md")) if path.is_dir() else [path]


def main() -> int:
    """Print all findings; return 1 if there are any."""
    problems = [
        line
        for page in pages([Path(argument) for argument in sys.argv[1:]])
        for line in findings(str(page), page.read_text())
    ]
    print("\n".join(problems) or "prose: nothing found")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
