"""Error budgets never increase: below fixed limits, and compared with every committed version."""

import dataclasses
import subprocess
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from derivation.cli import main
from derivation.engine import build
from derivation.engine.emit.budgets import parse_budgets
from derivation.engine.files import ROOT
from derivation.engine.measure.check import Row
from derivation.engine.measure.judge import Errors, Worst
from derivation.engine.measure.suggest import LEAST, MARGIN, suggestions, tighter
from derivation.plate import budgets
from derivation.plate.budgets import BUDGETS, read_budgets, read_tables
from derivation.plate.modes.kernels.modal_sums import TESTED
from generated.manifest import CONTACT, KERNELS

REQUIRED = {
    **{f"Omega_{k}_scaled": 4.0 for k in (1, 2, 3, 4)},
    "sonine": 4.0,
    "G": 6.0,
    "G_minus_1": 6.0,
    "A_j": 8.0,
    "K_j": 8.0,
    "K_j_bottom": 8.0,
    **{row["name"]: 8.0 for row in CONTACT},
}
"""Largest budgets allowed."""

RELATIVE = 9.0
"""The relative error 2e-15 in ULP, the former budget of every function of the contact law."""


def git(*arguments: str) -> str | None:
    """Return the output of git, or None if git or the history is not available."""
    try:
        done = subprocess.run(
            ["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=False
        )
    except OSError:
        return None
    return done.stdout if done.returncode == 0 else None


DOMAINS = {row["name"]: row["domain"] for row in (*KERNELS, *CONTACT)}


def looser(
    now: dict[str, Any], before: dict[str, Any], domains: Mapping[str, str] = DOMAINS
) -> list[str]:
    """Return the functions with more ULP or a smaller domain than before, and larger impact errors.

    Conditions that only state the tested range (`TESTED`) do not count as a smaller domain.
    """
    actual = []
    former = {row["name"]: RELATIVE for row in CONTACT} | before["ulp"]
    for name, ulp in now["ulp"].items():
        old_domain = before.get("domain", {}).get(name)
        added = (
            set()
            if old_domain is None
            else set(domains[name].split(", ")) - set(old_domain.split(", "))
        )
        if ulp > former.get(name, ulp) or added - {"", *TESTED}:
            actual.append(name)
    measured = now["impact"]
    wider = [name for name, old in before.get("impact", {}).items() if measured[name] > old]
    return actual + wider


def test_budgets_are_within_the_fixed_limits() -> None:
    actual = read_budgets()
    assert {name for name, limit in REQUIRED.items() if actual[name].ulp > limit} == set()


@pytest.mark.parametrize(
    "file", [BUDGETS, *sorted(BUDGETS.parent.glob("*/budgets.toml"))], ids=lambda f: f.parent.name
)
def test_no_budget_has_increased(file: Path) -> None:
    versions = git("log", "--format=%H", "--", file.relative_to(ROOT).as_posix())
    if not versions:
        pytest.skip("no history to compare with")
    now = read_tables()
    for version in versions.split():
        text = git("show", f"{version}:{file.relative_to(ROOT).as_posix()}")
        if text:  # a version that deletes the file shows nothing
            assert looser(now, tomllib.loads(text)) == [], version


def test_second_budget_for_a_function_is_rejected(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(budgets, "BUDGETS", tmp_path / "budgets.toml")
    text = '[ulp]\nG = 4.0\n[domain]\nG = "T > 0"\n'
    (tmp_path / "budgets.toml").write_text(text)
    (tmp_path / "modes").mkdir()
    (tmp_path / "modes" / "budgets.toml").write_text(text)
    with pytest.raises(ValueError, match="modes: a second budget for G"):
        read_tables()


def test_increased_budgets_and_smaller_domains_are_found() -> None:
    now = read_tables()
    first = {"ulp": {name: u for name, u in now["ulp"].items() if name not in REQUIRED}}
    assert looser(now, first) == []
    for name in ("Omega_1", "impact"):
        wider = {**now, "ulp": {**now["ulp"], name: now["ulp"][name] + 1.25}}
        assert looser(wider, now) == [name]
    assert looser({**now, "ulp": {**now["ulp"], "force": 9.25}}, first) == ["force"]
    measured = {**now, "impact": {**now["impact"], "rounding": 2 * now["impact"]["rounding"]}}
    assert looser(measured, now) == ["rounding"]
    stated = {**now, "domain": DOMAINS}
    assert looser(now, stated, DOMAINS | {"G": "T > 0, T < 9"}) == ["G"]
    assert looser(now, {**now, "domain": DOMAINS | {"G": "T > 0, T >= 1e-151, T < 9"}}) == []


def test_tables_of_rules_are_optional_and_complete() -> None:
    without = parse_budgets({"ulp": {"f": 4}})["f"]
    assert without == parse_budgets({"ulp": {"f": 4}, "rule": {"value": {"share": 0.5}}})["f"]
    assert "0.5 times the sum of the arguments' condition numbers" in without.rule
    with pytest.raises(
        ValueError, match=r"expected a table \[rule\.zeros\] with a text or a share"
    ):
        parse_budgets({"ulp": {"f": 4}, "rule": {"zeros": {"kernels": ["f"]}}})


def test_every_function_has_a_budget_and_one_rule() -> None:
    data = read_tables()
    assert set(parse_budgets(data)) == {row["name"] for row in (*KERNELS, *CONTACT)}
    with pytest.raises(ValueError, match="correct delta"):
        parse_budgets({**data, "ulp": {k: v for k, v in data["ulp"].items() if k != "delta"}})
    twice = {**data["rule"], "new": {"text": "nothing", "kernels": ["delta"]}}
    with pytest.raises(ValueError, match="correct delta"):
        parse_budgets({**data, "rule": twice})


# --- suggestions


@dataclasses.dataclass(frozen=True)
class Measured:
    needed: float


@dataclasses.dataclass(frozen=True)
class Line:
    """The attributes of a row that a suggestion depends on."""

    kernel: str
    budget: float | None
    double: Measured
    single: Measured | None
    passed: bool | None


@pytest.mark.parametrize(
    ("budget", "needed", "suggested"),
    [(8.0, 3.0, 4.5), (8.0, 3.01, 4.75), (4.5, 3.0, None), (2.0, 9.0, None), (0.51, 0.1, 0.5),
     (4.0, 0.0, 0.5), (4.0, float("inf"), None)],
)  # fmt: skip
def test_suggested_budget_is_the_largest_error_with_a_margin(
    budget: float, needed: float, suggested: float | None
) -> None:
    assert tighter(budget, needed) == suggested
    assert suggested is None or needed * MARGIN <= suggested
    assert LEAST == 0.5


def test_suggestions_are_valid_toml_without_failed_functions() -> None:
    rows = [
        Line("G", 4.0, Measured(1.0), Measured(2.0), True),
        Line("P", 1.0, Measured(0.9), None, True),
        Line("C_top", 3.0, Measured(0.1), None, False),
        Line("K_j", None, Measured(0.1), None, None),
    ]
    assert tomllib.loads("\n".join(map(str, suggestions(rows)))) == {"G": 3.0}
    assert suggestions(rows[1:]) == []


def test_command_prints_suggestions_and_writes_no_file(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    worst = Worst((), None, ("", ""), "", 0.1, 1.0)
    errors = Errors(9, 0, 0, 0, 0.6, 0.5, 0.4, 0.2, 0.1, worst, "float64", ())
    rows = (Row("P", "pressure", 1.0, errors, errors, 2, passed=True),)
    monkeypatch.setattr(build, "check", lambda *_: rows)
    before = BUDGETS.read_bytes()
    assert main(["check", "--suggest-budgets"]) == 0
    printed = capsys.readouterr().out
    assert tomllib.loads(printed[printed.index("[ulp]") :]) == {"ulp": {"P": 0.5}}
    assert BUDGETS.read_bytes() == before
