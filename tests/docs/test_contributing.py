"""The worked examples of `docs/development`, applied to a copy of the sources and executed."""

import inspect
import json
import math
import os
import pickle
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from guide import apply_examples

from derivation.engine import build
from derivation.engine.cache import cache_folder
from derivation.engine.files import ROOT
from derivation.plate import derived
from derivation.plate.blocks import blocks
from derivation.plate.cases.families import families
from derivation.plate.modules import computed_modules
from derivation.plate.paper import PAPER

SCENE = ROOT / "derivation" / "scene" / "examples" / "paper.toml"
NEW = ("p_mean", "imprint_volume", "dynamic_hardness", "rayleigh_speed")
"""Functions that the examples add."""


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a copy of the sources to which all examples are applied."""
    root = tmp_path_factory.mktemp("copy")
    for folder in ("derivation", "generated", "reports/data"):
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / folder, root / folder, ignore=ignored)
    shutil.copy(ROOT / "pyproject.toml", root)
    assert apply_examples(root, paper=False) >= 30
    # Cached results are valid for subjects whose sources no example changes.
    if (cached := cache_folder()) is not None:
        (root / "cache" / cached.name).mkdir(mode=0o700, parents=True)
        for file in cached.glob("derivation.plate.*"):
            shutil.copy(file, root / "cache" / cached.name)
    return root


def run(copy: Path, program: str, *arguments: str, expect: int = 0) -> str:
    """Return what a program in the copy prints."""
    variables = {"PYTHONPATH": str(copy), "XDG_CACHE_HOME": str(copy / "cache"), "COLUMNS": "200"}
    done = subprocess.run(
        [sys.executable, "-c", program, *arguments],
        cwd=copy, env=os.environ | variables, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == expect, done.stdout + done.stderr
    return done.stdout + done.stderr


def unchanged_modules(copy: Path) -> dict[str, str]:
    """Return the files of the generated package whose definitions no example changes."""
    defined = {x.name: Path(inspect.getfile(x.make)) for x in computed_modules()}
    return {
        f"{name}.py": (ROOT / "generated" / f"{name}.py").read_text()
        for name, file in defined.items()
        if file.read_bytes() == (copy / file.relative_to(ROOT)).read_bytes()
    }


COMMAND = "import sys; from derivation.cli import main; sys.exit(main(sys.argv[1:]))"
# All derivation steps take half a minute; only those that the example needs are run.
SHORT_CHAIN = """
import sys
from derivation.cli import main
from derivation.plate import chain
chain.STEPS = tuple(step for step in chain.STEPS if step[0] == "Hertz")
chain.MOTION_STEPS = tuple(step for step in chain.MOTION_STEPS if step[0] == "mean pressure")
"""
DERIVE = f"{SHORT_CHAIN}sys.exit(main(sys.argv[1:]))"
# The new formulas are derived, and the new routines are proved. All others are taken from the
# checkout with their proofs, because other tests derive and prove them: this saves half an hour.
WHOLE = """
import pickle
import sys
from pathlib import Path
from derivation.engine import package
from derivation.engine.emit import routine as routines
from derivation.engine.formula import proof
from derivation.engine.formula.chain import Chain
from derivation.engine.rewrite.form import form
steps, findings, made, known_blocks, families, functions, kept = pickle.loads(
    Path(sys.argv[1]).read_bytes()
)
strict, prove = proof.prove, routines.routine
proved = {(f.proof.step, f.proof.argument): f.proof for _, records in steps for f in records}
proof.prove = lambda *step, **_: proved.get(step[:2]) or strict(*step)
routines.prove = lambda step, argument, residuals: strict(
    step, argument, residuals or {"proved from the checkout": 0}
)
def prove_new(name, arguments, statements, results, claims, *others):
    claims = tuple(None for _ in claims) if name in functions else claims
    return prove(name, arguments, statements, results, claims, *others)
routines.routine = prove_new
from derivation.plate.waves.theory import bending_branch
named = {formula.name: formula for _, records in steps for formula in records}
# Each is derived in seconds.
bending_branch.bending_fraction = lambda: named["bending_fraction"]
bending_branch.rayleigh = lambda: (named["rayleigh_cubic"], named["rayleigh_residue"])
from derivation.plate import blocks, derived, forms, render
from derivation.plate.chain import MOTION_STEPS
from derivation.plate.modules import printed_modules
computed, files = render.computed_modules, render.module_files
render.computed_modules = lambda: tuple(m for m in computed() if f"{m.name}.py" not in kept)
render.module_files = lambda planned: kept | files(planned)
blocks.build_blocks = lambda _: known_blocks
known = dict(steps)
steps = (*steps, *((name, derive()) for name, derive in MOTION_STEPS if name not in known))
formulas = {formula.name: formula for _, records in steps for formula in records}
shapes = [("pressure", "p_mean", forms._pressure()["p_mean"])]
shapes += [(m.name, name, shape) for m in printed_modules() for name, shape in m.stated().items()]
made += tuple(form(name, module, formulas[name].expression, *shape, {})
              for module, name, shape in shapes)
Chain.derived_steps = lambda _: steps
derived.chain, derived.misprints = lambda: steps, lambda: findings
package.forms_of = lambda *_: made
from derivation.cli import main
"""
GENERATE = f"{WHOLE}sys.exit(main(['generate']))"
# Like `check --update` and `check hard-cases --update`, for the new functions and cases only.
CHECK = WHOLE
CHECK += """
import json
from derivation.engine.measure.record import to_json
from dataclasses import replace
from derivation.engine.measure import hard
from derivation.engine.measure.suite import find_references
from derivation.plate.cases import suite
from derivation.plate.judge import PACKAGE, check, generated_kernels
from derivation.plate.subjects import exports
[own] = [cases for cases in exports("cases", "CASES") if "imprint" in cases.__module__]
suite.families = lambda: (*families, *own())
committed = Path("reports/data")
def added(name, key, text):
    data = json.loads((committed / name).read_text())
    data[key] += json.loads(text)[key]
    (committed / name).write_text(json.dumps(data))
rows = check(kernels=[k for k in generated_kernels() if k.name in sys.argv[2:]])
added("check.json", "rows", to_json(rows, 50, PACKAGE))
assert main(["check", "hard-cases"]) == 2, "there are no references yet"
recorded = {case["key"] for case in json.loads((committed / "hard.json").read_text())["cases"]}
whole, nowhere = suite.suite(), Path("nowhere.json")
new = replace(whole, cases=tuple(c for c in whole.cases if c.key not in recorded))
judged = hard.check(new, find_references(new, nowhere, nowhere))
added("hard.json", "cases", hard.to_json(judged, PACKAGE))
print(json.dumps({
    "functions": [[row.kernel, row.module, row.passed, row.oracles] for row in rows],
    "cases": [[row.case.kernel, row.passed, row.error, row.allowed] for row in judged],
}))
"""
REPORT = WHOLE
REPORT += """
from derivation.engine import report_files
from derivation.plate.reporting import REPORT
figures = dict.fromkeys(REPORT.figures(), lambda: None)  # the additions have none
object.__setattr__(REPORT, "figures", lambda: figures)
report_files.figure_file = lambda *_: b"<svg ></svg>"
sys.exit(main(["report", "--no-pdf", "--out", sys.argv[2]]))
"""
TESTS = "import sys, pytest; sys.exit(pytest.main(['-q', '-o', 'addopts=', *sys.argv[1:]]))"


def test_new_effect_is_in_the_table(copy: Path) -> None:
    def row(scene: Path) -> dict[str, object]:
        data = json.loads(run(copy, COMMAND, "explain", str(scene), "--json", "-"))
        assert data["effects"][-1]["name"] == "drag"
        return dict(data["effects"][-1])

    enabled = copy / "enabled.toml"
    enabled.write_text(SCENE.read_text().replace("[effects]", "[effects]\ndrag = true"))
    assert row(SCENE)["parameter_value"] is None
    shown = row(enabled)
    assert 1e-9 < float(str(shown["parameter_value"])) < 1e-5
    assert 0 < float(str(shown["bound"])) < 1e-5


def test_new_formula_is_derived_with_its_proof(copy: Path) -> None:
    data = json.loads(run(copy, DERIVE, "derive", "--json", "-").split("✓")[0])
    [formula] = [f for f in data if f["name"] == "p_mean"]
    assert formula["proof"]["step"] == "Mean pressure"
    assert formula["proof"]["method"] == "symbolically"


def test_formula_without_a_proof_is_rejected(copy: Path) -> None:
    path = copy / "derivation" / "plate" / "contact" / "theory" / "mean_pressure.py"
    original = path.read_text()
    path.write_text(original.replace("P / (sp.pi * a**2)", "2 * P / (sp.pi * a**2)"))
    try:
        output = run(copy, DERIVE, "derive", expect=1)
    finally:
        path.write_text(original)
    assert "Mean pressure: force leaves the residual" in output


def test_additions_are_generated_checked_and_reported(copy: Path) -> None:
    """All steps of the guide for a formula, a subject, a function and a hard case."""
    known = copy / "known.pickle"
    actual = derived.chain(), derived.misprints(), build.rewrite(PAPER), blocks(), families()
    code = [path.read_text() for path in (ROOT / "generated").glob("*.py")]
    functions = {name for text in code for name in re.findall(r"^def (\w+)", text, re.MULTILINE)}
    kept = unchanged_modules(copy)
    assert "wave_kernels.py" not in kept
    known.write_bytes(pickle.dumps((*actual, functions, kept)))
    run(copy, GENERATE, str(known))
    code = "from generated import *; print(p_mean(0.5, 3.0), imprint_volume(1.0, 1e-4))"
    mean, volume = map(float, run(copy, code).split())
    assert mean == pytest.approx(12 / math.pi, rel=1e-15)
    assert volume == pytest.approx(math.pi / 4 * 1e-16, rel=1e-8)
    assert "3 passed" in run(copy, TESTS, "tests/plate/waves/test_rayleigh.py")
    output = run(copy, CHECK, str(known), *NEW)
    assert "no reference for 4 hard cases" in output
    checked = json.loads(next(line for line in output.splitlines() if line.startswith("{")))
    assert checked["functions"] == [
        ["p_mean", "pressure", True, 0],  # it has no second reference method
        ["imprint_volume", "imprint", True, 2],
        ["dynamic_hardness", "imprint", True, 2],
    ]
    assert {row[0] for row in checked["cases"]} == {*NEW[1:], "G"}
    for kernel, passed, error, allowed in checked["cases"]:
        assert passed, kernel
        assert error <= allowed
    run(copy, REPORT, str(known), str(copy / "report"))
    documents = copy / "report"
    text = "".join((documents / f"{name}.tex").read_text() for name in ("report", "appendices"))
    assert r"\subsection{Mean pressure}" in text  # a section that is written automatically
    assert r"\subsection{Imprint}" in text
    for name in NEW:
        assert name.replace("_", r"\_") in text, name
    page = "".join((documents / f"{name}.html").read_text() for name in ("report", "appendices"))
    assert "mean pressure of the contact" in page
    assert "dynamic hardness of the plate" in page


def test_new_rule_is_applied(copy: Path) -> None:
    output = run(copy, COMMAND, "rewrite", "pi/2 - atan(x)", "--json", "-")
    data = json.loads(output.split("✓")[0])
    assert "complement" in [applied["rule"] for applied in data["applied"]]
    assert data["tested"]["high"] == 1e150


def test_version_is_in_the_changelog() -> None:
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert f"\n## {version}\n" in (ROOT / "CHANGELOG.md").read_text()
    assert f"git tag -a v{version} " in (ROOT / "CONTRIBUTING.md").read_text()
