"""The check of prose finds listed words and repeated phrases, but ignores code."""

import pytest
from prose import findings


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("It stays at\nrest beside the plate.", "static or quasi-static"),
        ("This is very unique.", "unique"),
        ("The the plate.", "phrase is repeated"),
    ],
)
def test_listed_words_and_repetitions_are_found(text: str, expected: str) -> None:
    assert expected in "\n".join(findings("page.md", f"# Title\n\n{text}\n"))


def test_code_headings_and_links_are_ignored() -> None:
    text = "## Plate\n\nPlate `beside` [it](beside.md) ...\n\n```text\nat rest\n```\n"
    assert list(findings("page.md", text)) == []


def test_finding_states_its_line() -> None:
    [actual] = findings("page.md", "One.\n\n```text\n\n```\nTwo beside.\n")
    assert actual.startswith("page.md:6: ")
