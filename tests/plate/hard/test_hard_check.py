"""The check of hard cases: all are kept, damage is noticed, and what the command says."""

import dataclasses
import importlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derivation import pipeline
from derivation.cli import main
from derivation.plate.hard import check as hard_check
from derivation.plate.hard import origin as hard_origin
from derivation.plate.hard.case import HardCase
from derivation.plate.hard.truth import Known

# --- who keeps it


def test_generated_code_keeps_every_case(
    cases: tuple[HardCase, ...], truth: dict[str, Known]
) -> None:
    rows = hard_check.check(cases, truth, hard_check.kernels())
    failed = [f"{row.case.key}: {row.problem}" for row in rows if not row.kept]
    assert not failed, "\n".join(failed)


def test_printed_forms_stand_beside(cases: tuple[HardCase, ...], truth: dict[str, Known]) -> None:
    values = [case for case in cases if case.expect == "value" and case.form != "empty"]
    chosen = [case for case in values if case.kernel in ("K_j", "G")]
    rows = hard_check.check(chosen, truth, hard_check.kernels())
    assert all((row.printed is None) == (row.case.kernel == "G") for row in rows)
    assert max(row.printed for row in rows if row.printed is not None) > 1e12


@pytest.mark.parametrize(
    ("module", "name", "kernels"),
    [
        ("contact_kernels", "LINEAR", {"indentation", "stiffness", "contact_radius", "impact"}),
        ("contact_series", "REACH", {"indentation"}),
        ("bessel", "_INVERSE_ROOT_PI", {"bessel_j0"}),
        ("impact", "_WEIGHTS", {"impact"}),
        ("edge_kernels", "FIRST_THIRD", {"supported_edge", "supported_edge_slope"}),
        ("non_hertzian_pressure", "_WEIGHTS", {"contact"}),
        ("simple_impact", "_THIN_LINEAR", {"plate_of"}),
    ],
)
def test_a_tampered_constant_is_noticed(
    module: str,
    name: str,
    kernels: set[str],
    cases: tuple[HardCase, ...],
    truth: dict[str, Known],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    place = importlib.import_module(f"generated.{module}")
    chosen = [case for case in cases if case.kernel in kernels]
    with monkeypatch.context() as patched:
        patched.setattr(place, name, getattr(place, name) * 0.99)
        spoilt = hard_check.check(chosen, truth, hard_check.kernels())
    sound = hard_check.check(chosen, truth, hard_check.kernels())
    assert sum(row.kept for row in spoilt) < sum(row.kept for row in sound)


def one(kernel: str, call: Any, case: HardCase, truth: dict[str, Known]) -> hard_check.HardRow:
    known = hard_check.kernels()
    wrong = dataclasses.replace(known[kernel], call=call)
    (row,) = hard_check.check([case], truth, {**known, kernel: wrong})
    return row


def test_every_kind_of_damage_is_noticed(
    cases: tuple[HardCase, ...], truth: dict[str, Known]
) -> None:
    right = hard_check.kernels()["G"].call
    (case,) = (c for c in cases if c.kernel == "G" and c.form == "strided")
    refused = max(
        (c for c in cases if c.kernel == "G" and c.expect == "nan"), key=lambda c: len(c.points)
    )
    (short,) = (c for c in cases if c.kernel == "G" and c.form == "float32" and c.shape)

    def spoil(T: Any) -> Any:
        T[0] = 3.0
        return right(T)

    assert one("G", right, case, truth).kept
    assert "ULP" in one("G", lambda T: right(T) * (1 + 1e-14), case, truth).problem
    assert "shape" in one("G", lambda T: right(T)[:, None], case, truth).problem
    assert "written to" in one("G", spoil, case, truth).problem
    assert "FloatingPointError" in one("G", lambda T: right(T) + np.log(T * 0), case, truth).problem
    assert "float64" in one("G", lambda T: right(T).astype(np.float64), short, truth).problem
    assert not one("G", lambda T: right(np.abs(T) + 1.0), refused, truth).kept


def test_a_reference_is_of_the_modules_its_oracle_is_made_of(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Words about the code do not count; the code of those imported does."""
    place = hard_origin._file("derivation.plate.impact.oracle.quantities")
    before = {name: hard_origin.origin(name) for name in ("indentation", "force", "bessel_j0")}
    assert len(set(before.values())) == 3

    def origins(changed: str) -> dict[str, str]:
        read = Path.read_text
        with monkeypatch.context() as patched:
            patched.setattr(
                Path, "read_text", lambda path: changed if path == place else read(path)
            )
            hard_origin.origin.cache_clear()
            hard_origin._of_modules.cache_clear()
            return {name: hard_origin.origin(name) for name in before}

    text = place.read_text()
    assert origins(text + "\n# a remark\n") == before
    other = origins(text + "\nOTHER = 1\n")
    hard_origin.origin.cache_clear()
    hard_origin._of_modules.cache_clear()
    assert {name for name in before if other[name] != before[name]} == {"force"}


# --- how it is asked


def test_a_missing_reference_is_refused(
    cases: tuple[HardCase, ...],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    data, place = json.loads(pipeline.MEASURED_HARD.read_text()), tmp_path / "hard.json"
    monkeypatch.setattr(pipeline, "MEASURED_HARD", place)
    assert main(["check", "hard-cases"]) == 2
    assert "check hard-cases --update" in capsys.readouterr().err.replace("\n", " ")
    rows = [row for row in data["cases"] if row["key"] != cases[0].key]
    place.write_text(json.dumps({"cases": rows}))
    assert main(["check", "hard-cases"]) == 2
    message = capsys.readouterr().err
    assert "check hard-cases --update" in message
    assert cases[0].key[:20] in message


def test_command_shows_every_case(capsys: pytest.CaptureFixture[str]) -> None:
    status = main(["check", "hard-cases", "--json", "-"])
    shown = json.loads(capsys.readouterr().out)
    assert status == (0 if all(row["kept"] for row in shown["cases"]) else 1)
    assert shown == json.loads(pipeline.MEASURED_HARD.read_text())


def test_status_is_1_when_a_case_fails(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = pipeline.check_hard()
    broken = dataclasses.replace(rows[0], error=99.0, problem="error of 99 ULP")
    sound = dataclasses.replace(rows[1], problem="")
    for found, status in (((sound,), 0), ((sound, broken), 1)):
        monkeypatch.setattr(pipeline, "check_hard", lambda *_, found=found: found)
        assert main(["check", "hard-cases"]) == status
    assert "99 ULP" in capsys.readouterr().out.replace("\n", " ")
