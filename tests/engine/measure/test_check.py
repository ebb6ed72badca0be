"""The check itself: everything generated keeps its promise, and a single wrong sign does not."""

import importlib
import random
import re
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

import generated
from derivation.engine.files import ROOT
from derivation.engine.measure.kernels import Kernel
from derivation.plate.judge import check, generated_kernels
from generated.manifest import KERNELS

MODULES = ("omega", "influence", "pressure", "mode_shapes", "blocks")
BY_BLOCK = {
    "sinh_minus": "Omega_4",
    "sinh_plus": "Omega_2",
    "sinh_pair": "G",
    "hertz_shape": "A_j",
    "cosh_square": "mode_zz",
    "sinh_cubic": "mode_rz",
    "cosh_quartic": "mode_zz",
    "sinh_quintic": "mode_zz",
    "cosh_quintic": "mode_rr",
}
SIGN = re.compile(r"(?<=[\w)\]] )[+-](?= [\w(])|(?<=[(= ])-(?=[\w(])")


def test_every_promise_is_kept() -> None:
    rows = check(30)
    assert not [row.kernel for row in rows if row.passed is False]
    assert {row.kernel for row in rows if row.passed} == {row["name"] for row in KERNELS}


def test_pressure_ends_at_the_rim() -> None:
    assert generated.p(0.1, 0.1, 5.0) == 0
    assert np.isnan(generated.p(np.nextafter(0.1, 1), 0.1, 5.0))


def signs(text: str) -> list[tuple[str, int]]:
    """Every plus and minus in the code of a module, with the function it stands in."""
    found, name, quoted = [], "", False
    offset = 0
    for line in text.splitlines(keepends=True):
        if line.startswith("def "):
            name = line[4:].split("(")[0]
        inside = quoted
        quoted ^= line.count('"""') % 2 == 1
        code = line.split("#")[0]
        if name and not inside and '"""' not in line and not line.startswith("def "):
            found += [(name, offset + match.start()) for match in SIGN.finditer(code)]
        offset += len(line)
    return found


@pytest.mark.parametrize("seed", range(20))
def test_one_wrong_sign_is_caught(
    seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    generator = random.Random(seed)
    module = MODULES[seed % len(MODULES)]
    text = (ROOT / "generated" / f"{module}.py").read_text()
    name, place = generator.choice([s for s in signs(text) if s[0] != "polynomial"])
    damaged = text[:place] + {"+": "-", "-": "+"}[text[place]] + text[place + 1 :]
    package = f"damaged_{seed}"
    shutil.copytree(ROOT / "generated", tmp_path / package)
    (tmp_path / package / f"{module}.py").write_text(damaged)
    monkeypatch.syspath_prepend(str(tmp_path))
    target = BY_BLOCK.get(name, name)
    (sound,) = (kernel for kernel in generated_kernels() if kernel.name == target)
    function = getattr(importlib.import_module(f"{package}.{sound.module}"), target)
    broken = Kernel(sound.name, sound.module, sound.arguments, function, sound.budget, sound.modes)
    rows = check(30, [broken])
    for loaded in [m for m in sys.modules if m.startswith(package)]:
        del sys.modules[loaded]
    assert any(row.passed is False for row in rows), (
        f"{module}.{name}: {damaged[place - 30 : place + 30]!r}"
    )
