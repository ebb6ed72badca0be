"""Generated code with one thing wrong: a coefficient, a switch, a scaling. All are noticed."""

import ast
import math
import random
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from mutated_code import compiled, source

from derivation.engine.measure.judge import Truth, measured
from derivation.engine.measure.kernels import Kernel
from derivation.engine.measure.point import Point
from derivation.engine.rewrite.automatic import FADES
from derivation.engine.rewrite.form import Seam
from derivation.plate.blocks import blocks
from derivation.plate.grids import grid
from derivation.plate.judge import generated_kernels, truths
from derivation.plate.modes.kernels.forms import mode_forms
from generated import blocks as accurate
from generated import omega

KERNELS = {kernel.name: kernel for kernel in generated_kernels()}

# Every block with a section, a kernel that shows it, and arguments at a value of its variable.
SHOWN: dict[str, tuple[str, Callable[[float], dict[str, float]]]] = {
    "sinh_minus": ("Omega_4_scaled", lambda T: {"phi": T / 2, "h": 1.0, "mu": 1.0}),
    "sinh_pair": ("G", lambda T: {"T": T}),
    "hertz_shape": ("sonine", lambda y: {"phi": y, "a": 1.0}),
}


def damaged(name: str, file: str, edit: ast.NodeTransformer) -> Kernel:
    """A kernel of its module, or upon one, of which one function is edited."""
    whole = KERNELS[name]
    tree = edit.visit(ast.parse(source(file)))
    assert ast.unparse(tree) != ast.unparse(ast.parse(source(file))), "the edit touches nothing"
    users = () if whole.module == file else (whole.module,)
    module = compiled(ast.fix_missing_locations(tree), file, users)
    return replace(whole, call=getattr(module, name))


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


class WithCoefficient(ast.NodeTransformer):
    """Multiplies one Taylor coefficient of a block; collects them all."""

    def __init__(self, block: str, index: int, factor: float) -> None:
        self.block, self.index, self.factor = block, index, factor
        self.coefficients: list[float] = []

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        return self.generic_visit(node) if node.name == self.block else node

    def visit_Call(self, node: ast.Call) -> ast.AST:
        if isinstance(node.func, ast.Name) and node.func.id == "polynomial":
            _, *terms = node.args
            self.coefficients = [float(eval(ast.unparse(term))) for term in terms]
            times = ast.BinOp(terms[self.index], ast.Mult(), ast.Constant(self.factor))
            node.args[1 + self.index] = times
        return self.generic_visit(node)


def coefficients(block: str) -> list[float]:
    read = WithCoefficient(block, 0, 1.0)
    read.visit(ast.parse(source("blocks")))
    return read.coefficients


def at_least(wanted: float, coefficient: float) -> float:
    """The first factor that moves a coefficient, itself a double, by so much of it."""
    factor = 1.0 + wanted
    while abs(Fraction(coefficient * factor) / Fraction(coefficient) - 1) < wanted:
        factor = math.nextafter(factor, math.inf)
    return factor


@pytest.mark.parametrize(
    ("block", "index"), [(block, k) for block in SHOWN for k in range(len(coefficients(block)))]
)
def test_a_wrong_taylor_coefficient_is_noticed(block: str, index: int) -> None:
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
        wrong = damaged(name, "blocks", WithCoefficient(block, index, 1.0 + step))
        moved = abs(float(wrong.call(*point)[0]) - true) / float(np.spacing(abs(true)))
    factor = at_least(2.0 * whole.budget / moved * step, coefficients(block)[index])
    found = near(name, block, 0.98 * end, end, 60)
    assert not fails(whole, found)
    assert fails(damaged(name, "blocks", WithCoefficient(block, index, factor)), found)


class WithSwitch(ast.NodeTransformer):
    """Moves a function's switch point: a number compared with, or that values are held beyond."""

    def __init__(self, function: str, at: float, factor: float) -> None:
        self.function, self.at, self.factor = function, at, factor

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        return self.generic_visit(node) if node.name == self.function else node

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        node.comparators = [*map(self.moved, node.comparators)]
        return node

    def visit_Call(self, node: ast.Call) -> ast.AST:
        if ast.unparse(node.func) in ("np.minimum", "np.maximum"):
            node.args = [*map(self.moved, node.args)]
        return self.generic_visit(node)

    def moved(self, node: ast.expr) -> ast.expr:
        plain = not any(isinstance(part, ast.Name) for part in ast.walk(node))
        here = plain and eval(ast.unparse(node)) == self.at
        return ast.Constant(self.at * self.factor) if here else node


@pytest.mark.parametrize("factor", [0.5, 2.0])
@pytest.mark.parametrize("block", ["sinh_minus", "sinh_pair", "hertz_shape"])
def test_a_moved_switch_is_noticed(block: str, factor: float) -> None:
    name = SHOWN[block][0]
    low, high = sorted((seam_of(block), seam_of(block) * factor))
    found = near(name, block, low, high, 400)
    assert not fails(KERNELS[name], found)
    assert fails(damaged(name, "blocks", WithSwitch(block, seam_of(block), factor)), found)


FIELDS = {
    name: float(value.at) for name, (_, value) in mode_forms().items() if isinstance(value, Seam)
}


@pytest.mark.parametrize("factor", [0.5, 2.0])
@pytest.mark.parametrize("name", sorted(FIELDS))
def test_a_moved_switch_of_a_field_is_noticed_or_harmless(name: str, factor: float) -> None:
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

    noticed = factor > 1.0 or name in ("mode_g", "mode_rr", "mode_tt")
    assert fails(damaged(name, "mode_shapes", WithSwitch(name, at, factor)), found) == noticed


def sinh_plus(T: np.ndarray) -> np.ndarray:
    return 2 * np.exp(-T) * (np.sinh(T) + T)


def sinh_minus(T: np.ndarray) -> np.ndarray:
    large = np.maximum(T, 2.0)
    return np.where(T < 2, accurate.sinh_minus(T), np.exp(-large) * (np.sinh(large) - large) / 4)


@pytest.mark.parametrize(("name", "block"), [("Omega_2", sinh_plus), ("Omega_4", sinh_minus)])
def test_a_missing_scaling_is_noticed(
    name: str, block: Callable[..., np.ndarray], monkeypatch: pytest.MonkeyPatch
) -> None:
    kernel = KERNELS[name]
    found = truths(name, grid(name, kernel.arguments), 30)
    assert not fails(kernel, found)
    monkeypatch.setattr(omega, block.__name__, block)
    with np.errstate(all="ignore"):
        assert fails(kernel, found)


def test_an_exponential_in_one_piece_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """e^(-x) underflows where Omega_1, over a small phi and mu, does not."""
    values = {"phi": 3e-7, "h": 730.0 / 3e-7, "lam": 2.6e-3, "mu": 2.6e-3}
    found = truths("Omega_1", [Point(values)], 30)
    assert not fails(KERNELS["Omega_1"], found)

    def minimum(x: np.ndarray, limit: float) -> np.ndarray:
        return x if limit == FADES else np.minimum(x, limit)

    monkeypatch.setattr(omega, "np", SimpleNamespace(**vars(np) | {"minimum": minimum}))
    assert fails(KERNELS["Omega_1"], found)
