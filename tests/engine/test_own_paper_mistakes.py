"""Mistakes in a user's paper: one message that states the position and the remedy."""

import re
from importlib import import_module
from pathlib import Path

import mpmath
import pytest

from derivation.cli import main

MISTAKES = {
    "a proof that fails": (
        "theory.py",
        ("(sp.cosh(T) - 1) / (sp.sinh(T) + T)", "(sp.cosh(T) - 1) / (sp.sinh(T) - T)"),
        r"Film, slipping: closed form leaves the residual",
        1,
    ),
    "an exception in a derivation step": (
        "theory.py",
        ("    U, W = shapes()\n    normal", "    1 / 0\n    U, W = shapes()\n    normal"),
        r"derivation step 'film': theory\.py, line 62: ZeroDivisionError: division by zero",
        2,
    ),
    "an unknown symbol": (
        "theory.py",
        ('deflection, "m/Pa",', 'deflection * sp.Symbol("q") / sp.Symbol("q2"), "m/Pa",'),
        r"derivation step 'film': theory\.py, line \d+: KeyError: .*q",
        2,
    ),
    "a solution that does not exist": (
        "theory.py",
        ("*CONSTANTS)\n    back", "*CONSTANTS[:3])\n    back"),
        r"derivation step 'film': theory\.py, line \d+: \w+Error: ",
        2,
    ),
    "no budget": (
        "budgets.toml",
        ("F_bonded = 6\n", ""),
        r"budgets\.toml: expected an error budget for F_bonded; add for example `F_bonded = 4`",
        2,
    ),
    "a copied module that needs SymPy": (
        "kernels.py",
        (
            "PACKAGE = PackageSettings(\n",
            (
                "from derivation.engine.emit.modules import CopiedModule\n"
                "PACKAGE = PackageSettings(\n"
                '    handwritten=(CopiedModule("own", Path(__file__)),),\n'
            ),
        ),
        r"kernels\.py: expected imports from NumPy, the standard library, or `\.generated` .*sympy",
        2,
    ),
    "an exception in a function of the paper": (
        "kernels.py",
        (
            '    difference, kappa = known["sinh_minus"]',
            '    difference, kappa = known["sinhminus"]',
        ),
        r"kernels\.py, line \d+: KeyError: 'sinhminus'; correct it",
        2,
    ),
    "an unknown unit": (
        "vocabulary.py",
        ('Argument(G, "Pa"', 'Argument(G, "psi"'),
        r"vocabulary\.py, line \d+: ValueError: argument G: expected a unit .* got 'psi'",
        2,
    ),
    "two conditions in one": (
        "vocabulary.py",
        ('("z >= 0", "z <= H")', '("z >= 0 and z <= H",)'),
        r"condition 'z >= 0 and z <= H' of z is not one comparison",
        2,
    ),
    "a condition with an unknown symbol": (
        "vocabulary.py",
        ('"z <= H"', '"z <= HH"'),
        r"'z <= HH' of z contains the unknown symbol HH: did you mean H\?",
        2,
    ),
    "a sample value outside the domain": (
        "vocabulary.py",
        ('"s": "0.4"', '"s": "4"'),
        r"the sample value s = 4 does not satisfy s < 3",
        2,
    ),
    "a sample value that is no text": (
        "vocabulary.py",
        ('"s": "0.4"', '"s": 0.4'),
        r'the sample value of s is not a text; write it as "0\.4"',
        2,
    ),
    "formulas in place of a step": (
        "paper.py",
        ('"film": film,', '"film": film(),'),
        r"derivation step 'film': expected a function that returns formulas, got a tuple",
        2,
    ),
    "two formulas with the same name": (
        "theory.py",
        ('f"F_{name}", f"F_{letter}"', '"F_bonded", f"F_{letter}"'),
        r"step 'film': expected another name than F_bonded, which a formula of step 'film' has",
        2,
    ),
    "a formula in place of a tuple": (
        "theory.py",
        ("    return tuple(\n        formula\n", "    return next(\n        formula\n"),
        r"derivation step 'film': expected a tuple of formulas, got a Formula; end",
        2,
    ),
    "a decimal number in a formula": (
        "theory.py",
        ("(sp.cosh(T) - 1) / (sp.sinh(T) + T)", "(sp.cosh(T) - 1) / (sp.sinh(T) + 1.0 * T)"),
        r"theory\.py, line \d+: DecimalError: expected exact numbers, got 2\.0; write sp\.Rat",
        2,
    ),
    "a decimal number in a stated form": (
        "kernels.py",
        ("expm1(-2 * x)\n    below", "expm1(-2.0 * x)\n    below"),
        r"expected exact numbers, got -2\.0; write sp\.Rational\('-2\.0'\)",
        2,
    ),
    "a decimal number that the proof does not contain": (
        "theory.py",
        (
            'f"F_{letter}", f"deflection over a half-space\'s {said}", shape',
            'f"F_{letter}", "", shape * 0.5',
        ),
        r"F_bonded: expected exact numbers, got 0\.5; write sp\.Rational\('0\.5'\)",
        2,
    ),
    "a domain that is wider than the assumptions of a proof": (
        "vocabulary.py",
        ('("T >= 1e-100",)', '("T != 0",)'),
        r"F_bonded: the symbol T is positive in proofs, but its domain \(T != 0\) contains -",
        2,
    ),
    "a symbol with other assumptions": (
        "theory.py",
        ('said}", shape, "1"', 'said}", shape.subs(T, sp.Symbol("T")), "1"'),
        r"F_bonded: expected the symbol T of the vocabulary, got another one .*; import it",
        2,
    ),
    "a module that every package has": (
        "kernels.py",
        ('FormulaModule("film", ', 'FormulaModule("arrays", '),
        r"expected modules with different Python names other than arrays, .* got 'arrays'; rename",
        2,
    ),
    "a condition of a formula with an unknown symbol": (
        "theory.py",
        ('(f"C_{name}",), proof,', '(f"C_{name}",), proof, where=("U > 1",),'),
        r"F_bonded: the condition 'U > 1' contains the unknown symbol U, expected some of z, k",
        2,
    ),
    "an integer as argument": (
        "vocabulary.py",
        (
            'sp.symbols("k H G s T", positive=True)',
            '*sp.symbols("k H G s", positive=True), sp.Symbol("T", integer=True, positive=True)',
        ),
        r"F_bonded: the symbol T is integer in proofs, but its domain .* contains",
        2,
    ),
    "no file of budgets": (
        "kernels.py",
        ('"budgets.toml"', '"budget.toml"'),
        r"expected a file .*budget\.toml; write a table \[ulp\]",
        2,
    ),
    "a budget that is no number": (
        "budgets.toml",
        ("F_bonded = 6", 'F_bonded = "two"'),
        r"expected a positive number of ULP for F_bonded, got 'two'",
        2,
    ),
    "a name with a space": (
        "theory.py",
        ('f"F_{name}", f"F_{letter}"', 'f"F {name}", f"F_{letter}"'),
        r"expected a Python name for a formula, got 'F bonded'",
        2,
    ),
    "an unknown formula of a module": (
        "kernels.py",
        ('"F_slipping", "C_slipping"\n', '"F_slipping", "C_slippng"\n'),
        r"no formula 'C_slippng': did you mean C_slipping\?",
        2,
    ),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_stops_generation_with_one_message(
    mistake: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    file, (old, new), message, status = MISTAKES[mistake]
    folder = tmp_path / "film"
    assert main(["new", str(folder)]) == 0
    text = (folder / file).read_text()
    assert text.count(old) == 1
    (folder / file).write_text(text.replace(old, new))
    capsys.readouterr()
    assert main(["generate", "--paper", str(folder)]) == status
    said = " ".join(capsys.readouterr().err.split())
    assert "Traceback" not in said
    assert not (folder / "generated").exists()
    assert re.search(message, said), said


ROUTINE = '''
def slope() -> Routine:
    """The coefficient of a film on a frictionless base, and its derivative."""
    ratio = closed_forms()["slipping"]
    code = sp.tanh(T / 2) / (1 + T / sp.sinh(T)), sp.diff(ratio, T)
    return routine("slipping", (T,), (), code, (ratio, sp.diff(ratio, T)), "F_s and slope.", {})


PACKAGE = PackageSettings(
    routines=(Routines("slopes", "A coefficient with its slope.", (slope(),), {}),),
'''
"""A routine of the skeleton's paper; its first result is written in another way."""


WRONG_ROUTINES = {
    "": ("", "", ""),
    "a formula": ("1 + T / sp.sinh", "1 - T / sp.sinh", r"slipping.*leaves the residual"),
    "a limit that is reached": (
        "sp.tanh(T / 2)",
        "GUARDED(sp.tanh(T / 2), sp.Rational(1, 2))",
        r"Routine slipping: result 0 is .* at T = .*, and its claim is",
    ),
}


@pytest.mark.parametrize("wrong", WRONG_ROUTINES)
def test_a_routine_of_a_paper_is_proved_tested_and_printed(
    wrong: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    folder = tmp_path / "film"
    assert main(["new", str(folder)]) == 0
    text = (folder / "kernels.py").read_text()
    right, mistake, message = WRONG_ROUTINES[wrong]
    routine = ROUTINE.replace(right, mistake)
    text = text.replace("PACKAGE = PackageSettings(\n", routine.lstrip())
    head = "from derivation.engine.emit.modules import Routines\n"
    head += "from derivation.engine.emit.routine import GUARDED, Routine, routine\n"
    head += "from .theory import closed_forms\n"
    text = text.replace("from .vocabulary", f"{head}from .vocabulary")
    (folder / "kernels.py").write_text(text)
    capsys.readouterr()
    assert main(["generate", "--paper", str(folder)]) == (1 if wrong else 0)
    said = capsys.readouterr()
    if wrong:
        assert re.search(message, " ".join(said.err.split()))
        assert not (folder / "generated").exists()
        return
    monkeypatch.syspath_prepend(str(tmp_path))
    actual = import_module("film.generated.slopes").slipping(1.5)
    ratio = lambda t: (mpmath.cosh(t) - 1) / (mpmath.sinh(t) + t)  # noqa: E731
    exact = [mpmath.diff(ratio, 1.5, order) for order in (0, 1)]
    assert [float(x) for x in actual] == pytest.approx([float(x) for x in exact], rel=1e-14)
