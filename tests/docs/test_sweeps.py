"""The page of sweeps: its blocks print what it says."""

import doctest

import pytest

from derivation.engine.files import ROOT

PAGE = ROOT / "docs" / "sweeps.md"


def test_the_page_prints_what_it_says(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(ROOT))  # for the workers that it starts
    found = doctest.testfile(str(PAGE), module_relative=False, optionflags=doctest.ELLIPSIS)
    assert found.attempted > 20
    assert not found.failed


def test_the_readme_links_the_page() -> None:
    assert "](docs/sweeps.md)" in (ROOT / "README.md").read_text()
