"""The command `derive`: the table of all formulas, and the details of one formula."""

import json

import pytest

from derivation.cli import main
from derivation.engine.build import formulas
from derivation.engine.formula.notation import to_plain
from derivation.engine.formula_details import formula_details
from derivation.plate.paper import PAPER

Captured = pytest.CaptureFixture[str]


def test_table_has_every_formula_with_its_meaning(
    capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    assert main(["derive"]) == 0
    shown = capsys.readouterr().out
    lines = shown.splitlines()
    assert max(map(len, lines)) <= 80
    start = lines[0].index("meaning")
    cells = " ".join(line[start:].strip() for line in lines[2:])
    for formula in formulas(PAPER).values():
        assert sum(line.startswith(f"{formula.name} ") for line in lines) == 1
        # A line may end after a hyphen.
        assert to_plain(formula.meaning).replace(" ", "") in cells.replace(" ", "")


def test_printed_formula_is_accepted_by_diagnose(capsys: Captured) -> None:
    """The equation printed as text is equal to the derived one."""
    assert main(["derive", "K_j"]) == 0
    shown = capsys.readouterr().out
    formula = formulas(PAPER)["K_j"]
    [text] = [line for line in shown.splitlines() if line.startswith("K_j = 4*")]
    assert main(["diagnose", "K_j", "--formula", text.removeprefix("K_j = ")]) == 0
    assert f"{formula.latex} = {formula.right_hand_side}" in shown.splitlines()
    assert "K_j [m]: " in shown
    assert formula.proof.step in shown
    for name in (*formula.sources, *formula.domain, *formula.proof.residuals):
        assert name in shown


def test_sources_and_uses_of_a_formula_are_in_the_json(capsys: Captured) -> None:
    assert main(["derive", "K_j", "--json", "-"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["name"] == "K_j"
    assert data["step"] == "contact law"
    assert data["unit"] == "m"
    for name in data["sources"]:
        assert "K_j" in formula_details(PAPER, name).used_by
    for name in data["used_by"]:
        assert "K_j" in formulas(PAPER)[name].sources


@pytest.mark.parametrize("name", ["delta", "restitution_weak", "damped_motion", "radial_ode"])
def test_formulas_of_every_kind_are_shown(name: str, capsys: Captured) -> None:
    assert main(["derive", name]) == 0
    shown = capsys.readouterr().out
    details = formula_details(PAPER, name)
    assert f": {details.step}\n" in shown
    assert all(source.partition(",")[0] in shown for source in details.references)
    assert ("is the sum of" in shown) is details.formula.summed


def test_similar_name_is_suggested_for_an_unknown_formula(capsys: Captured) -> None:
    assert main(["derive", "Kj"]) == 2
    shown = capsys.readouterr()
    assert "K_j" in shown.err.replace("Kj", "")
    assert shown.out == ""
