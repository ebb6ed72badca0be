"""Test the check of hard cases: all pass, defects are detected, and the command reports."""

import dataclasses
import importlib
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derivation.cli import main
from derivation.engine import build
from derivation.engine.measure import hard
from derivation.engine.measure import origin as hard_origin
from derivation.engine.measure.case import HardCase
from derivation.engine.measure.suite import Known, Suite
from derivation.engine.paper import Paper
from derivation.plate.paper import PAPER

# --- results of the check


def checked(
    suite: Suite, chosen: Iterable[HardCase], references: dict[str, Known]
) -> tuple[hard.HardRow, ...]:
    """Return the results of checking the chosen cases."""
    return hard.check(dataclasses.replace(suite, cases=tuple(chosen)), references)


def test_generated_code_passes_every_case(suite: Suite, references: dict[str, Known]) -> None:
    rows = hard.check(suite, references)
    failed = [f"{row.case.key}: {row.problem}" for row in rows if not row.passed]
    assert not failed, "\n".join(failed)


def test_published_forms_are_measured_too(suite: Suite, references: dict[str, Known]) -> None:
    values = [case for case in suite.cases if case.expect == "value" and case.form != "empty"]
    rows = checked(suite, (case for case in values if case.kernel in ("K_j", "G")), references)
    assert all((row.printed is None) == (row.case.kernel == "G") for row in rows)
    assert max(row.printed for row in rows if row.printed is not None) > 1e12


@pytest.mark.parametrize(
    ("module", "name", "kernels"),
    [
        ("contact_kernels", "LINEAR", {"indentation", "stiffness", "contact_radius", "impact"}),
        ("contact_series", "REACH", {"indentation"}),
        ("bessel_kernels", "INVERSE_ROOT_PI", {"bessel_j0"}),
        ("impact", "WEIGHTS", {"impact"}),
        ("edge_kernels", "FIRST_THIRD", {"supported_edge", "supported_edge_slope"}),
        ("non_hertzian_pressure", "WEIGHTS", {"contact"}),
        ("simple_impact_kernels", "THIN_LINEAR", {"plate_of"}),
    ],
)
def test_changed_constant_is_detected(
    module: str,
    name: str,
    kernels: set[str],
    suite: Suite,
    references: dict[str, Known],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    place = importlib.import_module(f"generated.{module}")
    chosen = [case for case in suite.cases if case.kernel in kernels]
    with monkeypatch.context() as patched:
        patched.setattr(place, name, getattr(place, name) * 0.99)
        spoilt = checked(suite, chosen, references)
    sound = checked(suite, chosen, references)
    assert sum(row.passed for row in spoilt) < sum(row.passed for row in sound)


def test_every_kind_of_defect_is_detected(suite: Suite, references: dict[str, Known]) -> None:
    whole, cases = suite.kernels["G"], [case for case in suite.cases if case.kernel == "G"]
    right = whole.call

    def one(call: Any, case: HardCase) -> hard.HardRow:
        kernels = {"G": dataclasses.replace(whole, call=call)}
        (row,) = checked(dataclasses.replace(suite, kernels=kernels), [case], references)
        return row

    (case,) = (c for c in cases if c.form == "strided")
    rejected = max((c for c in cases if c.expect == "nan"), key=lambda c: len(c.points))
    (short,) = (c for c in cases if c.form == "float32" and c.shape)

    def spoil(T: Any) -> Any:
        T[0] = 3.0
        return right(T)

    assert one(right, case).passed
    assert "ULP" in one(lambda T: right(T) * (1 + 1e-14), case).problem
    assert "shape" in one(lambda T: right(T)[:, None], case).problem
    assert "written to" in one(spoil, case).problem
    assert "FloatingPointError" in one(lambda T: right(T) + np.log(T * 0), case).problem
    assert "float64" in one(lambda T: right(T).astype(np.float64), short).problem
    assert not one(lambda T: right(np.abs(T) + 1.0), rejected).passed


def test_origin_includes_the_modules_of_the_reference(
    suite: Suite, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An origin ignores comments and includes the code of imported modules."""
    place = hard_origin._file("derivation.plate.contact.oracle.forces")
    before = {name: suite.origin(name) for name in ("indentation", "force", "bessel_j0")}
    assert len(set(before.values())) == 3

    def origins(changed: str) -> dict[str, str]:
        read = Path.read_text
        with monkeypatch.context() as patched:
            patched.setattr(
                Path,
                "read_text",
                lambda path, **options: changed if path == place else read(path, **options),
            )
            hard_origin.of_modules.cache_clear()
            return {name: suite.origin(name) for name in before}

    text = place.read_text()
    assert origins(text + "\n# a remark\n") == before
    other = origins(text + "\nOTHER = 1\n")
    hard_origin.of_modules.cache_clear()
    assert {name for name in before if other[name] != before[name]} == {"force"}


# --- the command


def test_missing_reference_is_rejected(
    cases: tuple[HardCase, ...],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    data, path = json.loads(PAPER.hard.read_text()), tmp_path / "hard.json"
    monkeypatch.setattr(Paper, "hard", path)
    assert main(["check", "hard-cases"]) == 2
    assert "check hard-cases --update" in capsys.readouterr().err.replace("\n", " ")
    rows = [row for row in data["cases"] if row["key"] != cases[0].key]
    path.write_text(json.dumps({"cases": rows}))
    assert main(["check", "hard-cases"]) == 2
    message = capsys.readouterr().err
    assert "check hard-cases --update" in message
    assert cases[0].key[:20] in message


def test_command_lists_every_case(capsys: pytest.CaptureFixture[str]) -> None:
    status = main(["check", "hard-cases", "--json", "-"])
    shown, known = json.loads(capsys.readouterr().out), json.loads(PAPER.hard.read_text())
    assert status == (0 if all(row["passed"] for row in shown["cases"]) else 1)
    assert all(row["passed"] for row in shown["cases"])
    # The rounding of NumPy's functions depends on the instructions of the processor, and that of
    # linear solvers on their library: errors and limits differ, and which of them are stated.
    for row in (*shown["cases"], *known["cases"]):
        for key in ("error", "allowed", "printed"):
            row[key] = row[key] is not None
    del shown["provenance"]["python"], known["provenance"]["python"]
    assert shown == known


def test_status_is_1_when_a_case_fails(
    suite: Suite,
    references: dict[str, Known],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    rows = checked(suite, suite.cases[:2], references)
    broken = dataclasses.replace(rows[0], error=99.0, problem="error of 99 ULP")
    sound = dataclasses.replace(rows[1], problem="")
    for actual, status in (((sound,), 0), ((sound, broken), 1)):
        monkeypatch.setattr(build, "check_hard", lambda *_, actual=actual: actual)
        assert main(["check", "hard-cases"]) == status
    assert "99 ULP" in capsys.readouterr().out.replace("\n", " ")
