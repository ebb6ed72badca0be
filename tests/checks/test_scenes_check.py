"""`check scenes`: realistic scenes, whose runs are counted by outcome."""

import json
from dataclasses import replace
from typing import Any

import pytest

from derivation.checks import scenes as scenes_check
from derivation.checks.realistic_scenes import (
    KINDS,
    Kind,
    Outcome,
    cells,
    cost,
    failures,
    one_line,
    passed,
    rejected,
    scenes,
)
from derivation.checks.scenes import check_scenes, run
from derivation.cli import main
from derivation.scene import SceneError, read
from derivation.scene.scene import IncompleteError

Captured = pytest.CaptureFixture[str]
DROP: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.01, "material": "steel"},
    "plate": {"radius": 0.5, "thickness": 0.2, "material": "steel"},
    "impact": {"speed": 0.1},
    "effects": {"inertia": False},
}


def outcome(kind: Kind, message: str = "key: wrong; correct it") -> Outcome:
    return Outcome(kind, "" if kind == "finished" else message, 1e-3, DROP)


def test_scenes_are_valid_reproducible_and_varied() -> None:
    actual = list(scenes(200, 3))
    assert actual == list(scenes(200, 3))
    assert actual[:20] != list(scenes(20, 4))
    for scene in actual:
        read(scene)
        assert 1e-3 <= scene["sphere"]["radius"] <= 0.1
        assert 5e-4 <= scene["plate"]["thickness"] <= 0.2
        assert scene["plate"]["radius"] <= 100.0 * scene["plate"]["thickness"]
        assert 0.01 <= scene["impact"]["speed"] <= 50.0
    inertia = sum(scene["effects"]["inertia"] for scene in actual)
    assert 70 < inertia < 130
    for key in ("gravity", "retardation_time", "mass", "non_hertzian_pressure"):
        assert any(key in str(scene) for scene in actual), key
    assert {scene["plate"]["edge"] for scene in actual} == {
        "paper", "simply-supported", "clamped",
    }  # fmt: skip


def test_run_is_classified_by_its_outcome(monkeypatch: pytest.MonkeyPatch) -> None:
    assert run(DROP, 1e-2) == ("finished", "")
    assert run({**DROP, "impact": {"speed": -1.0}}, None)[0] == "rejected"

    def raises(error: BaseException) -> Any:
        def simulate(*_: Any, **__: Any) -> Any:
            raise error

        return simulate

    known = {
        "incomplete": IncompleteError("b", "c"),
        "rejected": SceneError("a: b; c"),
        "traceback": ZeroDivisionError("x"),
    }
    for kind, error in known.items():
        monkeypatch.setattr(scenes_check, "simulate", raises(error))
        assert run(DROP, None)[0] == kind
    monkeypatch.undo()
    monkeypatch.setattr(scenes_check, "_finite", lambda _: False)
    assert run(DROP, None)[0] == "NaN"


def test_run_is_stopped_at_its_time_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    def forever(*_: Any, **__: Any) -> Any:
        while True:
            pass

    monkeypatch.setattr(scenes_check, "simulate", forever)
    assert run(DROP, None, limit=0.05)[0] == "overrun"


def test_outcomes_that_fail_the_check() -> None:
    many = [outcome("finished")] * 17
    assert passed([*many, outcome("rejected")])
    assert passed([*many, outcome("incomplete"), outcome("rejected")])
    assert not passed([*many, *[outcome("rejected")] * 4])
    # Runs without a tolerance repeat rejected scenes; they do not change the verdict.
    freed = [replace(outcome(kind), rtol=None) for kind in ("rejected", *["finished"] * 9)]
    assert passed([*many, *freed])
    assert not passed([*many, *[outcome("rejected")] * 4, *freed])
    assert rejected([*many, *freed]) == {1e-3: 0.0, None: 0.1}
    for kind in KINDS[3:]:
        assert not passed([*many, outcome(kind)]), kind
    assert not passed([*many, outcome("rejected", "key: wrong, with no remedy")])
    assert not passed([*many, outcome("rejected", "key: wrong; ")])


def test_every_group_is_listed_with_a_scene() -> None:
    actual = [outcome("finished"), outcome("rejected", "a: b; c"), outcome("rejected", "a: b; d"),
             outcome("incomplete", "e: f")]  # fmt: skip
    assert [row[1:3] for row in cells(actual)] == [
        ("finished", "1"), ("rejected", "2"), ("incomplete", "1"),
    ]  # fmt: skip
    lines = failures(actual)
    assert len(lines) == 4
    assert "(no remedy)" in lines[2]
    assert one_line(DROP) in lines[1]


def test_worker_processes_run_the_scenes() -> None:
    fast = {**DROP, "impact": {"speed": 1e6}}
    report = check_scenes(2, drawn=[DROP, fast])
    assert [o.kind for o in report] == ["finished", "rejected", "rejected"]
    assert [o.rtol for o in report] == [1e-3, 1e-3, None]
    assert all(o.states_remedy for o in report)
    assert report[0].seconds > 0.0  # a rejection may take less than a tick of the clock
    assert all(0.0 <= o.seconds < 60.0 for o in report)
    assert all(1e6 < o.memory < 2e9 for o in report)
    assert f"{max(o.seconds for o in report):.2g} s, " in cost(report)


def test_command_fails_if_a_result_is_nan(
    monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setattr(scenes_check, "check_scenes", lambda *_: (outcome("finished"),))
    assert main(["check", "scenes", "-n", "1", "--seed", "5"]) == 0
    assert "finished" in capsys.readouterr().out
    monkeypatch.setattr(scenes_check, "check_scenes", lambda *_: (outcome("NaN"),))
    assert main(["check", "scenes", "-n", "1", "--json", "-"]) == 1
    data = json.loads(capsys.readouterr().out)
    assert data["runs"][0]["kind"] == "NaN"
    assert data["passed"] is False
    assert main(["check", "scenes", "-n", "1", "--update"]) == 2
