"""Work on a formula is stopped at limits of time, memory and recursion depth."""

import time

import flint
import pytest

from derivation.cli import main
from derivation.engine import bounded as module
from derivation.engine.bounded import LimitError, run_limited
from derivation.engine.emit import own_formula


def test_results_and_errors_are_returned() -> None:
    assert run_limited(lambda: {"x": [1, 2.5]}, "this") == {"x": [1, 2.5]}
    with pytest.raises(KeyError, match="nothing"):
        run_limited(lambda: {}["nothing"], "this")


def test_time_is_limited() -> None:
    def loop() -> None:
        while True:
            pass

    with pytest.raises(LimitError, match="this takes more than 1 s: simplify"):
        run_limited(loop, "this", seconds=1)


def test_elapsed_time_is_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "PATIENCE", 0.1)
    with pytest.raises(LimitError, match="more than 1 s"):
        run_limited(lambda: time.sleep(100), "this", seconds=1)


def test_memory_is_limited_in_python_and_in_libraries() -> None:
    for allocate in (lambda: [0] * 10**9, lambda: flint.fmpz(3) ** (10**11) and None):
        with pytest.raises(LimitError, match="this takes more than 200 MB"):
            run_limited(allocate, "this", megabytes=200)


def test_depth_is_limited() -> None:
    def recursive() -> None:
        recursive()

    with pytest.raises(LimitError, match="nest the formula less"):
        run_limited(recursive, "this")


def test_work_is_done_without_limits_if_fork_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(module.os, "fork")
    assert run_limited(lambda: 3, "this") == 3


NESTED = "x"
for _ in range(20):
    NESTED = f"({NESTED} + 1)**9"
HARD = {
    "nested powers": NESTED,
    "wide powers": "(" + " + ".join(f"sin({k}*x)" for k in range(1, 40)) + ")**90",
    "power tower": "9**9**9**9",
    "nested functions": "sin(" * 45 + "x" + ")" * 45,
    "many factors": "*".join(f"(exp({k}*x) + x + {k})" for k in range(1, 9)) + "**99",
    "product of sums": "*".join(["(1 + x + sin(x) + exp(x) + cos(2*x))"] * 30),
}


@pytest.mark.parametrize("case", HARD)
def test_expensive_formulas_give_one_message(
    case: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(own_formula, "SECONDS", 5)
    for command in (["rewrite", HARD[case]], ["diagnose", "G", "--formula", HARD[case]]):
        if command[0] == "diagnose":
            command[-1] = command[-1].replace("exp", "EXP").replace("x", "T").replace("EXP", "exp")
        status = main(command)
        message = capsys.readouterr().err
        assert "Traceback" not in message
        assert status == 2 or (command[0] == "diagnose" and status == 1)
