"""Work on a formula ends within limits of time and memory, whatever the formula asks for."""

import time

import flint
import pytest

from derivation.cli import main
from derivation.engine import bounded as module
from derivation.engine.bounded import LimitError, bounded


def test_results_and_errors_come_back() -> None:
    assert bounded(lambda: {"x": [1, 2.5]}, "this") == {"x": [1, 2.5]}
    with pytest.raises(KeyError, match="nothing"):
        bounded(lambda: {}["nothing"], "this")


def test_time_is_limited() -> None:
    def endless() -> None:
        while True:
            pass

    with pytest.raises(LimitError, match="this takes more than 1 s: simplify"):
        bounded(endless, "this", seconds=1)


def test_waiting_is_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "PATIENCE", 0.1)
    with pytest.raises(LimitError, match="more than 1 s"):
        bounded(lambda: time.sleep(100), "this", seconds=1)


def test_memory_is_limited_in_python_and_in_libraries() -> None:
    for greedy in (lambda: [0] * 10**9, lambda: flint.fmpz(3) ** (10**11) and None):
        with pytest.raises(LimitError, match="this takes more than 200 MB"):
            bounded(greedy, "this", megabytes=200)


def test_depth_is_limited() -> None:
    def deeper() -> None:
        deeper()

    with pytest.raises(LimitError, match="nest the formula less"):
        bounded(deeper, "this")


def test_what_cannot_be_limited_is_done_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(module.os, "fork")
    assert bounded(lambda: 3, "this") == 3


NESTED = "x"
for _ in range(20):
    NESTED = f"({NESTED} + 1)**9"
HARD = {
    "nested powers": NESTED,
    "wide powers": "(" + " + ".join(f"sin({k}*x)" for k in range(1, 40)) + ")**90",
    "a tower": "9**9**9**9",
    "nested functions": "sin(" * 45 + "x" + ")" * 45,
    "many factors": "*".join(f"(exp({k}*x) + x + {k})" for k in range(1, 9)) + "**99",
    "a product of sums": "*".join(["(1 + x + sin(x) + exp(x) + cos(2*x))"] * 30),
}


@pytest.mark.parametrize("what", HARD)
def test_hard_formulas_are_refused_in_one_message(
    what: str, capsys: pytest.CaptureFixture[str]
) -> None:
    for command in (["rewrite", HARD[what]], ["diagnose", "G", "--formula", HARD[what]]):
        if command[0] == "diagnose":
            command[-1] = command[-1].replace("exp", "EXP").replace("x", "T").replace("EXP", "exp")
        status = main(command)
        said = capsys.readouterr().err
        assert "Traceback" not in said
        assert status == 2 or (command[0] == "diagnose" and status == 1)
