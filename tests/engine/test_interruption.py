"""Ctrl-C within an integrand of Arb, which reports another error, counts as an interruption."""

from typing import Any

import flint
import pytest
from shared_scenes import PAPER

from derivation import cli
from derivation.checks import many_digits
from derivation.engine.formula.chain import DerivationStep, _derive_step
from derivation.engine.interruption import interruptions


def interrupted_integral(*_: Any) -> Any:
    """Compute an integral during which Ctrl-C is pressed, once within another function of Arb."""

    def integrand(x: flint.acb, _: Any) -> flint.acb:
        return flint.acb.integral(pressed, 0, x)

    def pressed(*_: Any) -> flint.acb:
        raise KeyboardInterrupt

    return flint.acb.integral(integrand, 0, 1)


def test_error_that_arb_reports_instead_of_the_interruption_is_replaced() -> None:
    with pytest.raises(SystemError):
        interrupted_integral()
    with pytest.raises(KeyboardInterrupt), interruptions():
        interrupted_integral()


def test_other_errors_are_not_replaced() -> None:
    with pytest.raises(SystemError, match="another"), interruptions():
        raise SystemError("another")
    with pytest.raises(ZeroDivisionError), interruptions():
        _ = 1 // 0


def test_interrupted_step_is_no_failed_step() -> None:
    with pytest.raises(KeyboardInterrupt):
        _derive_step(DerivationStep("integral", interrupted_integral))


def test_command_says_that_it_was_interrupted(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(many_digits, "reference", interrupted_integral)
    assert cli.main(["reference", str(PAPER)]) == 2
    message = capsys.readouterr().err
    assert "interrupted; no file is incomplete" in message
    assert "Traceback" not in message
