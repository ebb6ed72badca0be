"""The command line: results, exit status, and one message for each error."""

import json
from pathlib import Path

import pytest
from interrupted import interrupted
from shared_scenes import EXAMPLES

from derivation import diagnose, formula
from derivation.cli import main
from derivation.plate.vocabulary import Formula

CORRECT = "(2*T + sinh(2*T))/(2*(sinh(T) - T)*(sinh(T) + T))"


def test_formula_and_diagnose_can_be_imported() -> None:
    record = formula("G")
    assert isinstance(record, Formula)
    assert record._repr_latex_().startswith("$")
    assert diagnose("G", CORRECT, at="T=3").verdict == "equal"
    with pytest.raises(KeyError, match="nonsense"):
        formula("nonsense")


def test_diagnose_exits_with_1_for_a_different_formula(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["diagnose", "G", "--formula", CORRECT, "--at", "T=3", "--json", "-"]) == 0
    equal = json.loads(capsys.readouterr().out)
    assert equal["verdict"] == "equal"
    assert equal["given"] == equal["derived"]
    assert len(equal["given"].replace(".", "").lstrip("0")) == 50
    wrong = CORRECT.replace("2*T +", "2*T -")
    assert main(["diagnose", "G", "--formula", wrong, "--json", "-"]) == 1
    different = json.loads(capsys.readouterr().out)
    assert {"verdict", "repair", "ratio", "given", "derived"} <= different.keys()
    assert different["verdict"] == "different"


def test_a_formula_may_begin_with_a_minus_sign(capsys: pytest.CaptureFixture[str]) -> None:
    """It is the same formula wherever it stands, and unknown options are still named."""
    results = []
    for before, text, after in (
        ((), "-x + sqrt(x**2 + 1)", ("--json", "-")),
        (("--json", "-", "--where", "x < 9"), "-x + sqrt(x**2 + 1)", ()),
        ((), "sqrt(x**2 + 1) - x", ("--json", "-")),
    ):
        assert main(["rewrite", *before, text, *after]) == 0
        results.append(json.loads(capsys.readouterr().out)["source"].splitlines()[-1])
    assert len(set(results)) == 1
    assert main(["rewrite", "x", "--formul"]) == 2
    assert "No such option: --formul" in capsys.readouterr().err


@pytest.mark.parametrize("values", [["-5"], ["5", "-5"], ["-5", "5"], ["-.5"]])
def test_negative_numbers_are_rejected_as_numbers(
    values: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    scene = str(EXAMPLES / "glass_pane.toml")
    assert main(["indent", scene, "--force", *values]) == 2
    [negative] = [float(value) for value in values if value.startswith("-")]
    assert f"expected positive numbers [N], got {negative:g}; " in capsys.readouterr().err


def test_diagnose_reads_latex(capsys: pytest.CaptureFixture[str]) -> None:
    text = r"-\frac{\sinh(\phi_j h)}{2\mu(\sinh(2\phi_j h) + 2\phi_j h)}"
    assert main(["diagnose", "Omega_3", "--latex", "--formula", text]) == 0
    assert "equal" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["diagnose", "Omega_9", "--formula", "phi"], "Omega_4"),
        (["diagnose", "G", "--formula", "sinh(T"], "platecontact:"),
        (["diagnose", "G", "--formula", "__import__('os').getcwd()"], "platecontact:"),
        (["diagnose", "G", "--formula", "9**9**9"], "platecontact:"),
        (["diagnose", "G", "--formula", "T", "--at", "T"], "phi=2.5"),
        (["diagnose", "G", "--formula", "T", "--at", "T=nan"], "platecontact:"),
        (["diagnose", "G", "--formula", "T", "--digits", "0"], "digits"),
        (["generate", "--out", "/proc/nowhere"], "/proc/nowhere"),
        (["misprints", "--json", "/proc/nowhere/x.json"], "/proc/nowhere"),
        (["nonsense"], "nonsense"),
        (["check", "--digits", "3"], "digits"),
        (["report", "--no-pdf", "--out", "/proc/nowhere"], "/proc/nowhere"),
        (["report", "--section", "misprint"], "misprints?"),
        (["report", "--fragment", "Kj"], "K_j"),
    ],
)
def test_invalid_input_gives_one_message_and_status_2(
    arguments: list[str], expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2
    captured = capsys.readouterr()
    message = captured.err
    assert expected in message
    assert "Traceback" not in message + captured.out


def test_generate_check_compares_the_folder_given_by_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["generate", "--check"]) == 0
    out = tmp_path / "plate"
    assert main(["generate", "--check", "--out", str(out)]) == 1
    assert f"platecontact generate --out {out}" in capsys.readouterr().out
    assert main(["generate", "--out", str(out)]) == 0
    assert main(["generate", "--check", "--out", str(out)]) == 0
    (out / "unknown.py").write_text("")
    assert main(["generate", "--check", "--out", str(out)]) == 1


def test_derive_and_misprints_as_json(tmp_path: Path) -> None:
    assert main(["derive", "--json", str(tmp_path / "f.json")]) == 0
    formulas = json.loads((tmp_path / "f.json").read_text())
    assert {"K_j", "A_j", "delta"} <= {f["name"] for f in formulas}
    assert all(f["proof"]["residuals"] for f in formulas)
    assert main(["misprints", "--json", str(tmp_path / "m.json")]) == 0
    findings = json.loads((tmp_path / "m.json").read_text())
    assert {f["verdict"] for f in findings} == {"equal", "different"}


def test_interrupted_command_leaves_no_incomplete_files(tmp_path: Path) -> None:
    """Ctrl-C during `derive` gives a message and status 2, and no file is written."""
    program = """
import sys, time
from derivation import cli
from derivation.plate import derived
from derivation.engine.formula.chain import DerivationStep
def wait():
    print("deriving", flush=True)
    time.sleep(300)
object.__setattr__(derived.CHAIN, "steps", (DerivationStep("wait", wait),))
sys.exit(cli.main(["derive", "--json", sys.argv[1]]))
"""
    out = tmp_path / "formulas.json"
    interrupted(program, out, "deriving", {"XDG_CACHE_HOME": str(tmp_path / "cache")})
    assert not out.exists()


def test_ctrl_c_while_modules_load_gives_one_message() -> None:
    program = """
import sys, time
class Slow:
    def find_spec(self, name, *_):
        if name == "derivation.cli":
            print("loading", flush=True)
            time.sleep(300)
sys.meta_path.insert(0, Slow())
from derivation.start import main
sys.exit(main())
"""
    _, message = interrupted(program, "--version", "loading")
    assert message == "platecontact: interrupted before it began; run the command again\n"
