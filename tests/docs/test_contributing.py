"""The worked examples of CONTRIBUTING.md, typed into a copy of the sources and followed."""

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

from derivation.engine import build
from derivation.engine.files import ROOT
from derivation.plate import derived
from derivation.plate.paper import PAPER

GUIDE = (ROOT / "CONTRIBUTING.md").read_text()
BLOCK = re.compile(r"```(?:python|toml)\n# (.+?)\n(.*?)```", re.DOTALL)
SCENE = ROOT / "derivation" / "scene" / "examples" / "paper.toml"


def typed(place: str, text: str, root: Path) -> None:
    """Do what a block's first line says."""
    if place.startswith("new file: "):
        path = root / place.removeprefix("new file: ")
        assert not path.exists(), f"{path.name} is no new file"
        path.write_text(text)
        return
    name, where, line = (*re.split(r", (below|above|at the end)", place, maxsplit=1), "")[:3]
    old = (root / name).read_text()
    if where == "at the end":
        (root / name).write_text(old + text)
        return
    line = line.removeprefix(": ") + "\n"
    assert f"\n{old}".count(f"\n{line}") == 1, f"{name} has not just one line {line}"
    both = line + text if where == "below" else f"{text}\n\n{line}"
    (root / name).write_text(old.replace(line, both))


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sources with every example typed in."""
    root = tmp_path_factory.mktemp("copy")
    for folder in ("derivation", "generated", "reports/data"):
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / folder, root / folder, ignore=ignored)
    shutil.copy(ROOT / "pyproject.toml", root)
    blocks = BLOCK.findall(GUIDE)
    assert len(blocks) >= 10
    for place, text in blocks:
        typed(place, text, root)
    return root


def run(copy: Path, program: str, *arguments: str, expect: int = 0) -> str:
    """What a program in the copy prints."""
    places = {"PYTHONPATH": str(copy), "XDG_CACHE_HOME": str(copy / "cache"), "COLUMNS": "200"}
    done = subprocess.run(
        [sys.executable, "-c", program, *arguments],
        cwd=copy, env=os.environ | places, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == expect, done.stdout + done.stderr
    return done.stdout + done.stderr


COMMAND = "import sys; from derivation.cli import main; sys.exit(main(sys.argv[1:]))"
# The whole chain takes half a minute: of its links those that the example rests on.
SHORT_CHAIN = """
import sys
from derivation.cli import main
from derivation.plate import chain
chain.LINKS = tuple(link for link in chain.LINKS if link[0] == "Hertz")
chain.MOTION_LINKS = tuple(link for link in chain.MOTION_LINKS if link[0] == "mean pressure")
"""
DERIVE = f"{SHORT_CHAIN}sys.exit(main(sys.argv[1:]))"
FORM = """
from derivation.plate.budgets import read_budgets
from derivation.plate import forms
from derivation.engine.rewrite.form import form
from derivation.plate.contact.theory.mean_pressure import mean_pressure
[formula] = mean_pressure()
made = form("p_mean", "pressure", formula.expression, *forms._pressure()["p_mean"], {})
print(made.name, "proved, to", read_budgets()["p_mean"].ulp, "ULP")
"""
# The links and forms of the checkout, and the new ones: all of the guide, without half an hour.
WHOLE = """
import pickle
import sys
from pathlib import Path
from derivation.plate import derived
from derivation.engine import package
from derivation.engine.formula.chain import Chain
from derivation.plate import forms
from derivation.engine.rewrite.form import form
from derivation.plate.contact.theory.mean_pressure import mean_pressure
links, findings, made = pickle.loads(Path(sys.argv[1]).read_bytes())
[formula] = mean_pressure()
links = (*links, ("mean pressure", (formula,)))
made = (*made, form("p_mean", "pressure", formula.expression, *forms._pressure()["p_mean"], {}))
Chain.found = lambda _: links
derived.chain, derived.misprints = lambda: links, lambda: findings
package.forms_of = lambda *_: made
from derivation.cli import main
"""
GENERATE = f"{WHOLE}sys.exit(main(['generate']))"
CHECK = f"""{WHOLE}
from derivation.plate.judge import check
from derivation.plate.judge import generated_kernels
[row] = check(kernels=[k for k in generated_kernels() if k.name == "p_mean"])
print(row.kernel, row.budget, "kept" if row.passed else row, row.oracles, "by both oracles")
"""
REPORT = f"{WHOLE}sys.exit(main(['report', '--no-pdf', '--out', sys.argv[2]]))"
HARD = """
import json
from pathlib import Path
from derivation.plate.hard import check as hard_check
from derivation.plate.hard.record import find_references
[case] = [c for c in hard_check.cases() if c.cause == "T is a third, which no double is."]
kernels = hard_check.kernels()
nowhere = Path("nowhere.json")
truth = find_references([case], kernels, nowhere, nowhere)
rows = hard_check.check([case], truth, kernels)
print(json.dumps([[row.kept, row.error, row.allowed] for row in rows]))
"""


def test_the_new_effect_has_its_row(copy: Path) -> None:
    def row(scene: Path) -> dict[str, object]:
        found = json.loads(run(copy, COMMAND, "explain", str(scene), "--json", "-"))
        assert found["effects"][-1]["name"] == "drag"
        return dict(found["effects"][-1])

    asked = copy / "asked.toml"
    asked.write_text(SCENE.read_text().replace("[effects]", "[effects]\ndrag = true"))
    assert row(SCENE)["parameter_value"] is None
    shown = row(asked)
    assert 1e-9 < float(str(shown["parameter_value"])) < 1e-5
    assert 0 < float(str(shown["bound"])) < 1e-5


def test_the_new_formula_is_derived_with_its_proof(copy: Path) -> None:
    found = json.loads(run(copy, DERIVE, "derive", "--json", "-").split("✓")[0])
    [formula] = [f for f in found if f["name"] == "p_mean"]
    assert formula["proof"]["step"] == "Mean pressure"
    assert formula["proof"]["method"] == "symbolically"


def test_without_a_proof_there_is_no_formula(copy: Path) -> None:
    path = copy / "derivation" / "plate" / "contact" / "theory" / "mean_pressure.py"
    right = path.read_text()
    path.write_text(right.replace("P / (sp.pi * a**2)", "2 * P / (sp.pi * a**2)"))
    try:
        said = run(copy, DERIVE, "derive", expect=1)
    finally:
        path.write_text(right)
    assert "Mean pressure: force leaves the residual" in said


def test_the_new_formula_has_a_stable_form_and_a_budget(copy: Path) -> None:
    assert "p_mean proved, to 1.5 ULP" in run(copy, FORM)


def test_the_new_formula_is_generated_checked_and_reported(copy: Path) -> None:
    """To the guide's last step: nobody wrote a word about the link, or a route for an oracle."""
    known = copy / "known.pickle"
    known.write_bytes(pickle.dumps((derived.chain(), derived.misprints(), build.rewrite(PAPER))))
    run(copy, GENERATE, str(known))
    code = "from generated.pressure import p_mean; print(p_mean(0.5, 3.0))"
    assert float(run(copy, code)) == pytest.approx(12 / math.pi, rel=1e-15)
    said = run(copy, CHECK, str(known))
    assert re.search("p_mean 1.5 kept [1-9] by both oracles", said), said
    run(copy, REPORT, str(known), str(copy / "report"))
    text = (copy / "report" / "report.tex").read_text()
    assert r"\subsection{Mean pressure}" in text
    assert r"eq:p\_mean" in text or "eq:p_mean" in text
    assert "mean pressure of the contact" in (copy / "report" / "report.html").read_text()


def test_the_new_rule_acts(copy: Path) -> None:
    said = run(copy, COMMAND, "rewrite", "1 - cos(x)", "--json", "-").split("✓")[0]
    found = json.loads(said)
    assert "half angle" in [applied["rule"] for applied in found["applied"]]
    assert "sin" in found["source"]
    assert "cos" not in found["source"].split("return")[-1]


def test_the_new_hard_case_is_judged(copy: Path) -> None:
    assert "T=0x1.5555555555555p-2" in run(copy, COMMAND, "check", "hard-cases", expect=2)
    [[kept, error, allowed]] = json.loads(run(copy, HARD))
    assert kept
    assert error <= allowed


def test_the_version_is_in_the_changelog() -> None:
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert f"\n## {version}\n" in (ROOT / "CHANGELOG.md").read_text()
    assert f"git tag -a v{version} " in GUIDE
