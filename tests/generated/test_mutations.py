"""Generated code with one thing wrong: a coefficient, a switch, a scaling. All are noticed."""

import importlib
import math
import random
import re
import shutil
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derivation.engine.files import ROOT
from derivation.engine.measure.judge import Truth, measured
from derivation.engine.measure.kernels import Kernel
from derivation.engine.measure.point import Point
from derivation.engine.rewrite.form import Seam
from derivation.plate.blocks import blocks
from derivation.plate.grids import grid
from derivation.plate.judge import generated_kernels, truths
from derivation.plate.modes.kernels.forms import mode_forms

KERNELS = {kernel.name: kernel for kernel in generated_kernels()}

# Every block with a section, a kernel that shows it, and arguments at a value of its variable.
SHOWN: dict[str, tuple[str, Callable[[float], dict[str, float]]]] = {
    "sinh_minus": ("Omega_4_scaled", lambda T: {"phi": T / 2, "h": 1.0, "mu": 1.0}),
    "sinh_pair": ("G", lambda T: {"T": T}),
    "hertz_shape": ("sonine", lambda y: {"phi": y, "a": 1.0}),
}


@pytest.fixture
def damaged(tmp_path: Path) -> Iterator[Callable[..., Any]]:
    """A function that imports a kernel from a copy of the package, one of its files edited."""
    count = 0

    def load(kernel: str, file: str, edit: Callable[[str], str]) -> Kernel:
        nonlocal count
        count += 1
        package = f"damaged_{tmp_path.name.replace('-', '_')}_{count}"
        shutil.copytree(ROOT / "generated", tmp_path / package)
        path = tmp_path / package / file
        text = path.read_text()
        changed = edit(text)
        assert changed != text, "the edit touches nothing"
        path.write_text(changed)
        whole = KERNELS[kernel]
        module = importlib.import_module(f"{package}.{whole.module}")
        return replace(whole, call=getattr(module, kernel))

    sys.path.insert(0, str(tmp_path))
    yield load
    sys.path.remove(str(tmp_path))
    for name in [name for name in sys.modules if name.startswith("damaged_")]:
        del sys.modules[name]


def fails(kernel: Kernel, found: list[Truth]) -> bool:
    errors = measured(kernel, found)
    return errors.ratio is None or errors.ratio > 1.0 or errors.not_finite > 0


def near(kernel: str, block: str, low: float, high: float, count: int) -> list[Truth]:
    at = SHOWN[block][1]
    values = np.linspace(low, high, count, endpoint=False).tolist()
    return truths(kernel, [Point(at(value)) for value in values], 30)


def seam_of(block: str) -> float:
    value = blocks()[block].value
    assert isinstance(value, Seam)
    return float(value.at)


def body_of(text: str, block: str) -> tuple[int, int]:
    begin = text.index(f"def {block}(")
    end = text.find("\ndef ", begin + 1)
    return begin, end if end > 0 else len(text)


def with_coefficient(block: str, index: int, factor: float) -> Callable[[str], str]:
    """An edit that multiplies one Taylor coefficient."""

    def edit(text: str) -> str:
        begin, end = body_of(text, block)
        places = list(re.finditer(r"^ {8}(-?[\d./ e+-]+),$", text[begin:end], re.M))
        place = places[index]
        old = place.group(1)
        at = begin + place.start(1)
        return text[:at] + f"({old}) * {factor!r}" + text[at + len(old) :]

    return edit


def coefficients(block: str) -> list[float]:
    text = (ROOT / "generated" / "blocks.py").read_text()
    begin, end = body_of(text, block)
    found = re.findall(r"^ {8}(-?[\d./ e+-]+),$", text[begin:end], re.M)
    return [float(Fraction(text.replace(" ", ""))) for text in found]


def at_least(wanted: float, coefficient: float) -> float:
    """The first factor that moves a coefficient, itself a double, by so much of it."""
    factor = 1.0 + wanted
    while abs(Fraction(coefficient * factor) / Fraction(coefficient) - 1) < wanted:
        factor = math.nextafter(factor, math.inf)
    return factor


@pytest.mark.parametrize(
    ("block", "index"), [(block, k) for block in SHOWN for k in range(len(coefficients(block)))]
)
def test_a_wrong_taylor_coefficient_is_noticed(
    damaged: Callable[..., Any], block: str, index: int
) -> None:
    """The value at the switch moves by twice the budget."""
    name, at = SHOWN[block]
    whole = KERNELS[name]
    end = math.nextafter(seam_of(block), 0.0)
    point = [np.array([value]) for value in at(end).values()]
    true = float(whole.call(*point)[0])
    assert whole.budget is not None
    step, moved = 1e-6, 0.0
    while moved < 1e4:  # far from rounding, and not far enough to bend
        step *= 10
        assert step < 1e20, f"{name} does not depend on the coefficient"
        wrong = damaged(name, "blocks.py", with_coefficient(block, index, 1.0 + step))
        moved = abs(float(wrong.call(*point)[0]) - true) / float(np.spacing(abs(true)))
    factor = at_least(2.0 * whole.budget / moved * step, coefficients(block)[index])
    found = near(name, block, 0.98 * end, end, 60)
    assert not fails(whole, found)
    assert fails(damaged(name, "blocks.py", with_coefficient(block, index, factor)), found)


def with_switch(block: str, factor: float) -> Callable[[str], str]:
    """An edit that moves a block's switch point."""

    def edit(text: str) -> str:
        begin, end = body_of(text, block)
        at = seam_of(block)
        body = re.sub(r"(below = \w+ < ).*", rf"\g<1>{at * factor!r}", text[begin:end])
        body = re.sub(rf"(np\.m(?:in|ax)imum\(\w+, ){at!r}\)", rf"\g<1>{at * factor!r})", body)
        return text[:begin] + body + text[end:]

    return edit


@pytest.mark.parametrize("factor", [0.5, 2.0])
@pytest.mark.parametrize("block", ["sinh_minus", "sinh_pair", "hertz_shape"])
def test_a_moved_switch_is_noticed(damaged: Callable[..., Any], block: str, factor: float) -> None:
    name = SHOWN[block][0]
    low, high = sorted((seam_of(block), seam_of(block) * factor))
    found = near(name, block, low, high, 400)
    assert not fails(KERNELS[name], found)
    assert fails(damaged(name, "blocks.py", with_switch(block, factor)), found)


FIELDS = {
    name: float(value.at) for name, (_, value) in mode_forms().items() if isinstance(value, Seam)
}


@pytest.mark.parametrize("factor", [0.5, 2.0])
@pytest.mark.parametrize("name", sorted(FIELDS))
def test_a_moved_switch_of_a_field_is_noticed_or_harmless(
    damaged: Callable[..., Any], name: str, factor: float
) -> None:
    """Between the switch and where it was moved, at depths near the middle and near the faces.

    Those that are not noticed cost nothing: there both branches keep the budget.
    """
    at = FIELDS[name]
    low, high = sorted((at, at * factor))
    generator = random.Random(name)
    points = [
        Point(
            {"z": depth * generator.uniform(0.9, 1.0), "phi": T / 2, "h": 1.0,
             "lam": generator.uniform(-0.5, 3.0), "mu": 1.0, "A_j": -1.0}
        )
        for T in np.linspace(low, high, 60, endpoint=False).tolist()
        for depth in (-1.0, -0.5, -1e-3, 1e-7, 0.1, 0.7, 1.0)
    ]  # fmt: skip
    found = truths(name, points, 30)
    assert not fails(KERNELS[name], found)

    def moved(text: str) -> str:
        begin, end = body_of(text, name)
        body = re.sub(r"(below = \w+ < ).*", rf"\g<1>{at * factor!r}", text[begin:end])
        body = re.sub(rf"(np\.m(?:in|ax)imum\(\w+, ){at!r}\)", rf"\g<1>{at * factor!r})", body)
        return text[:begin] + body + text[end:]

    noticed = factor > 1.0 or name in ("mode_g", "mode_rr", "mode_tt")
    assert fails(damaged(name, "mode_shapes.py", moved), found) == noticed


SCALINGS = (
    # kernel, file, what stands there, what it becomes without its scaling
    (
        "Omega_2",
        "blocks.py",
        "return 2 * T * np.exp(-T) - np.expm1(-2 * T)",
        "return 2 * np.exp(-T) * (np.sinh(T) + T)",
    ),
    (
        "Omega_4",
        "blocks.py",
        "numerator = 1 - (2 * T_high * decay + decay**2)",
        "numerator = 2 * np.exp(-T_high) * (np.sinh(T_high) - T_high)",
    ),
)


@pytest.mark.parametrize(("name", "file", "old", "new"), SCALINGS)
def test_a_missing_scaling_is_noticed(
    damaged: Callable[..., Any], name: str, file: str, old: str, new: str
) -> None:
    kernel = KERNELS[name]
    found = truths(name, grid(name, kernel.arguments), 30)
    assert not fails(kernel, found)
    with np.errstate(all="ignore"):
        assert fails(damaged(name, file, lambda text: text.replace(old, new, 1)), found)


def test_an_exponential_in_one_piece_is_noticed(damaged: Callable[..., Any]) -> None:
    """e^(-x) underflows where Omega_1, over a small phi and mu, does not."""

    def whole(text: str) -> str:
        begin, end = body_of(text, "Omega_1")
        return text[:begin] + text[begin:end].replace("np.minimum(x, 700)", "x") + text[end:]

    values = {"phi": 3e-7, "h": 730.0 / 3e-7, "lam": 2.6e-3, "mu": 2.6e-3}
    found = truths("Omega_1", [Point(values)], 30)
    assert not fails(KERNELS["Omega_1"], found)
    assert fails(damaged("Omega_1", "omega.py", whole), found)
