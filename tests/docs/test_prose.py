"""The check of prose finds what it is for, and leaves code alone."""

import pytest
from prose import findings


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("It stays at\nrest beside the plate.", "static or quasi-static"),
        ("This is very unique.", "unique"),
        ("The the plate.", "phrase is repeated"),
    ],
)
def test_it_finds(text: str, says: str) -> None:
    assert says in "\n".join(findings("page.md", f"# Title\n\n{text}\n"))


def test_code_headings_and_links_are_no_prose() -> None:
    text = "## Plate\n\nPlate `beside` [it](beside.md) ...\n\n```text\nat rest\n```\n"
    assert list(findings("page.md", text)) == []


def test_a_finding_has_its_line() -> None:
    [found] = findings("page.md", "One.\n\n```text\n\n```\nTwo beside.\n")
    assert found.startswith("page.md:6: ")
