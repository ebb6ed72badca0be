"""The summary of a simulation: printed first, short, in prefixed SI units, fitting a screen."""

import json
import math
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shared_scenes import EXAMPLES, PAPER, TWO_CONTACTS, result_of

from derivation.cli import main
from derivation.engine.files import ROOT
from derivation.engine.text import WIDTH, aligned, paragraph
from derivation.scene import explain, indent, load, read, simulate, sweep
from derivation.scene.dynamic import contact_sequence, waves
from derivation.scene.output.answer import quantities
from derivation.scene.quantity import IN_FRONT, PREFIXES, common_prefix, prefixed
from derivation.scene.quasi_static.motion import EnergyBalance
from derivation.scene.result import Result
from derivation.scene.selection.achieved_accuracy import Part

Captured = pytest.CaptureFixture[str]
POWERS = {prefix: 10.0**power for power, prefix in PREFIXES.items()}
LINES = 27
"""Largest number of lines of a summary with its warnings, without `NOTE_LINES`."""
NOTE_LINES = 6
"""Largest number of lines of the note before results that are not usable."""
every_example = pytest.mark.parametrize(
    "example", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem
)


def value_of(text: str, unit: str, plain: str) -> float:
    """Convert a number with a prefixed unit to the unit without prefix."""
    return float(text) * POWERS[unit.removesuffix(plain)]


# --- values


@pytest.mark.parametrize("speed", [0.05, 0.2, 1.0])
def test_printed_energies_are_the_kinetic_energy_and_the_work_of_the_weight(speed: float) -> None:
    scene = tomllib.loads((EXAMPLES / "ball_drop.toml").read_text())
    scene["impact"]["speed"] = speed
    balance = simulate(read(scene)).energy_balance
    assert balance is not None
    energies, _, weight = balance.in_words().partition("; the weight contributes")
    final = sum(map(float, re.findall(r"([\d.]+) %", energies)))
    added = sum(map(float, re.findall(r"([\d.]+) %", weight)))
    assert final == pytest.approx(100.0 + added, abs=0.6 if not added else 0.2)


def test_a_small_energy_of_the_sphere_has_digits_of_its_own() -> None:
    """An earlier version showed "below 10 %" for a restitution of 0.067 with an error of 20 %."""
    balance = EnergyBalance(
        initial_kinetic=2.0, gravity_work=0.0, rebound_kinetic=0.00910, viscous_loss=0.0,
        unrecovered_elastic=0.0, plate=1.0215, plastic_loss=0.9694,
    )  # fmt: skip
    words = "% sphere, {} % plate vibration, {} % plastic deformation"
    assert balance.in_words(0.2) == "0.5 " + words.format(50, 50)
    assert balance.in_words(0.02) == "0.46 " + words.format(51, 48)
    assert balance.in_words(1e-3) == "0.5 " + words.format(51.1, 48.5)


@pytest.mark.parametrize("error", [0.62, 1.2, 2.5])
def test_energy_of_a_sphere_that_hardly_rebounds_has_a_bound(error: float) -> None:
    """An earlier version showed "unknown" for hail on a bonnet, whose restitution is about 0.1."""
    balance = EnergyBalance(
        initial_kinetic=2.0, gravity_work=0.0, rebound_kinetic=0.02, viscous_loss=0.0,
        unrecovered_elastic=0.0, plate=1.98,
    )  # fmt: skip
    words = balance.in_words(error)
    stated = re.fullmatch(r"up to (\S+) % sphere, the rest plate vibration", words)
    assert stated
    assert 1.0 <= float(stated[1]) / (1.0 + error) ** 2 <= 2.0
    both = replace(balance, plate=1.0, damping_loss=0.98)
    assert both.in_words(error) == "unknown"  # the shares of these two are unknown
    assert replace(balance, rebound_kinetic=1.9, plate=0.1).in_words(error) == "unknown"


@given(
    st.floats(1e-12, 1e12) | st.floats(-1e12, -1e-12),
    st.integers(2, 12),
)
def test_value_with_a_prefix_keeps_its_digits(value: float, digits: int) -> None:
    text, unit = prefixed(value, "Pa", digits)
    assert value_of(text, unit, "Pa") == pytest.approx(float(f"{value:.{digits - 1}e}"), rel=1e-14)
    if "e" not in text:
        whole = text.lstrip("-").partition(".")[0]
        assert len(whole) <= min(digits, IN_FRONT)
        shown = text.lstrip("-").replace(".", "").lstrip("0")
        assert len(shown) == digits


@pytest.mark.parametrize(
    ("value", "unit", "digits", "shown"),
    [
        (9.9996e2, "N", 4, ("1.000", "kN")),
        (374.6, "N", 2, ("0.37", "kN")),
        (374.6, "N", 3, ("375", "N")),
        (96.3e-6, "s", 3, ("96.3", "µs")),
        (1e-30, "m", 3, ("1.00e-30", "m")),
        (0.0, "Pa", 3, ("0", "Pa")),
        (0.32149, "1", 3, ("0.321", "")),
        (math.nan, "1", 2, ("unknown", "")),
    ],
)
def test_values_have_a_prefix_an_exponent_or_are_unknown(
    value: float, unit: str, digits: int, shown: tuple[str, str]
) -> None:
    assert prefixed(value, unit, digits) == shown


@given(st.lists(st.floats(1e-9, 1e11), min_size=1), st.integers(2, 12))
def test_values_of_a_column_have_the_same_prefix(values: list[float], digits: int) -> None:
    multiples, unit = common_prefix(np.array(values), "m", digits)
    for value, multiple in zip(values, multiples, strict=True):
        assert multiple * POWERS[unit.removesuffix("m")] == pytest.approx(value, rel=1e-14)
    assert multiples.max() < 10.0 ** min(digits, IN_FRONT) * (1.0 + 1e-14)


# --- the summary


def test_printed_results_include_the_warnings() -> None:
    """A script that prints a result has no other place where it would show them."""
    result = result_of(EXAMPLES / "ball_drop.toml")
    contacts = indent(result.scene, force=1e5)
    for shown, warnings in (
        (str(result), result.warnings),
        (result.details(), result.warnings),
        (str(contacts), contacts.warnings),
    ):
        assert warnings
        assert " ".join(shown.split()).endswith(f"Warning: {warnings[-1]}")


@every_example
def test_summary_is_short_and_at_most_80_columns_wide(example: Path) -> None:
    result = result_of(example)
    lines = str(result).splitlines()
    note = paragraph(result.unusable_note).splitlines()
    assert len(lines) <= LINES + len(note)
    assert len(note) <= NOTE_LINES
    assert max(map(len, lines)) <= WIDTH
    for line in (*result.details().splitlines(), *explain(load(example)).details().splitlines()):
        assert len(line) <= WIDTH


@every_example
def test_summary_has_the_results_with_their_significant_digits(example: Path) -> None:
    result = result_of(example)
    table = str(result).split("\n\n")[1 if result.unusable_note else 0]
    shown = dict(line.split("  ", 1) for line in table.splitlines())
    for name, value, unit in result.numbers():
        label = next((key for key in shown if key.startswith(name.replace("_", " "))), None)
        if name == "total_time" and label is None:
            assert value == result.contact_time
            continue
        assert label is not None
        text, _, multiple = shown[label].strip().partition(" ")
        if text == "unknown":
            assert math.isnan(value)
            continue
        actual = value_of(text, multiple, unit) if multiple else float(text)
        assert actual == pytest.approx(
            value, rel=0.5001 * 10.0 ** (1 - result.digits_of_result(name))
        )


@every_example
def test_summary_states_accuracy_and_effects(example: Path) -> None:
    result = result_of(example)
    output = " ".join(str(result).split())
    assert result.accuracy.summary in output
    assert result.effects.summary in output
    bound = float(re.search(r"at most (\S+)", result.accuracy.summary)[1])  # type: ignore[index]
    assert result.accuracy.bound <= bound <= 1.1 * result.accuracy.bound
    assert ("model error" in output) == bool(result.model_error)
    for row in result.effects.rows:
        assert not row.disabled or row.name in output
    assert set(result.effects.included) == {r.name for r in result.effects.rows if r.included}


@every_example
def test_notebook_shows_the_summary_and_hides_details(example: Path) -> None:
    result = result_of(example)
    page = result._repr_html_()
    marks = ["<table>", "Accuracy: ", "Effects: "]
    marks += ["<b>Warning:</b>"] if result.warnings else []
    marks += ["<details>", "max. change if omitted"]
    positions = [page.index(mark) for mark in marks]
    assert positions == sorted(positions)
    assert page.endswith("</details>")


# --- the commands


def shown(*arguments: str, **places: str) -> str:
    """Return what a command writes to a pipe."""
    run = subprocess.run(
        [sys.executable, "-m", "derivation.cli", *arguments], capture_output=True, text=True,
        check=True, env={**os.environ, "PYTHONPATH": str(ROOT), **places},
    )  # fmt: skip
    return run.stdout


@pytest.mark.parametrize("option", [[], ["--details"]])
def test_summary_does_not_depend_on_the_terminal_width(option: list[str]) -> None:
    wanted = ["simulate", str(PAPER), *option]
    narrow, *others = (shown(*wanted, COLUMNS=columns) for columns in ("80", "100", "200"))
    assert others == [narrow, narrow]
    assert narrow == (result_of(PAPER).details() if option else str(result_of(PAPER))) + "\n"


def test_terminal_without_greek_letters_is_supported() -> None:
    wanted = ["simulate", str(PAPER), "--sweep", "impact.speed=0.5:1:2"]
    assert "t_c" in shown(*wanted, PYTHONIOENCODING="ascii")


def test_quiet_output_has_only_name_value_and_unit(tmp_path: Path, capsys: Captured) -> None:
    file = tmp_path / "thin.toml"
    file.write_text(PAPER.read_text().replace("half_thickness = 0.1", "half_thickness = 0.01"))
    result = result_of(file)
    assert result.warnings
    assert main(["simulate", str(file), "--quiet"]) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    words = [line.split(" ") for line in printed.out.splitlines()]
    for (name, text, unit), (wanted, value, si) in zip(words, result.numbers(), strict=True):
        assert (name, unit) == (wanted, si)
        assert float(text) == pytest.approx(value, rel=10.0 ** (1 - result.digits))


@pytest.mark.parametrize(
    "options",
    [
        ["--details", "--quiet"],
        ["--quiet", "--sweep", "impact.speed=1:2:2"],
        ["--details", "--sweep", "impact.speed=1:2:2"],
    ],
)
def test_mutually_exclusive_options_are_rejected(options: list[str], capsys: Captured) -> None:
    assert main(["simulate", str(PAPER), *options]) == 2
    output = capsys.readouterr().err
    assert "cannot be combined with" in output
    assert all(option in output for option in options if option.startswith("--"))


def test_summary_of_an_incomplete_impact_states_it_first(
    monkeypatch: pytest.MonkeyPatch, capsys: Captured, tmp_path: Path
) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(TWO_CONTACTS)
    waves.impact.cache_clear()
    monkeypatch.setattr(contact_sequence, "CONTACTS", 1)
    try:
        result = simulate(load(file))
        assert not result.complete
        assert str(result).startswith("INCOMPLETE: ")
        assert result.details().startswith("INCOMPLETE: ")
        assert result._repr_html_().startswith("<p><b>INCOMPLETE: ")
        assert re.search(r"^restitution +unknown$", str(result), re.M)
        assert "no error bound is known" in str(result)
        assert main(["simulate", str(file)]) == 1
        assert capsys.readouterr().out.startswith("INCOMPLETE: ")
        assert main(["simulate", str(file), "--quiet"]) == 1
        assert "INCOMPLETE: " in capsys.readouterr().err
        assert main(["simulate", str(file), "--json", "-"]) == 1
        data = json.loads(capsys.readouterr().out)
        assert not data["dynamics"]["complete"]
        assert data["restitution"] is None
        assert data["accuracy"]["bound"] is None
        assert data["max_force"] > 0.0
    finally:
        waves.impact.cache_clear()


def test_number_of_contacts_is_stated(tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(TWO_CONTACTS)
    result = simulate(load(file))
    assert result.dynamics is not None
    contacts = len(result.dynamics.inertia.contacts)
    assert contacts == 2
    labels = [name for name, _, _ in quantities(result)]
    assert labels[:2] == ["contact time (first of 2)", "total time"]
    assert "contact time" in [name for name, _, _ in quantities(result_of(PAPER))]


def tables() -> dict[str, Callable[[], str]]:
    """Return functions that print tables of several rows with wide numbers."""
    pane = load(EXAMPLES / "glass_pane.toml")
    span = sweep.parse("plate.half_thickness=0.1:0.2:3")
    compared = PAPER.read_text().replace("[effects]", "[effects]\ncompare_paper_motion = true")
    return {
        "indent": lambda: str(indent(pane, force=[1.23456e-7, 12.3456, 123456.0])),
        "sweep": lambda: sweep.to_text(span, sweep.run(load(PAPER), span)),
        "comparison": lambda: str(_simulated(compared)),
    }


def _simulated(text: str) -> Result:
    return simulate(read(tomllib.loads(text)))


@pytest.mark.parametrize("name", ["indent", "sweep", "comparison"])
def test_tables_are_at_most_80_columns_wide(name: str) -> None:
    assert all(len(line) <= WIDTH for line in tables()[name]().splitlines())


def test_table_does_not_wrap_short_cells() -> None:
    rows = [["a b", "1"], ["a long cell of many words", "-12.5"]]
    lines = aligned(["name", "#value [m]"], rows).splitlines()
    assert lines == [
        "name                       value [m]",
        "-------------------------  ---------",
        "a b                                1",
        "a long cell of many words      -12.5",
    ]


def test_summary_says_why_every_result_is_unknown() -> None:
    result = simulate(load(PAPER))
    assert "Unknown:" not in str(result)
    loose = replace(result, accuracy=replace(result.accuracy, law=Part(2.0, "estimated")))
    assert re.search(r"^max force +unknown$", str(loose), re.M)
    assert "Unknown: the error by omitted terms or modes may be as large as" in str(loose)
