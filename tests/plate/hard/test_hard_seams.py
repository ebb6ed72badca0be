"""No switch of the generated code without hard cases on both sides of it, or a reason why not."""

import ast
import math
import tomllib
from collections.abc import Iterable, Mapping
from fractions import Fraction
from pathlib import Path

import pytest
from seams import SEAMS as KERNEL_SEAMS
from seams import Place, Seam
from wave_seams import WAVE_SEAMS

import generated
from derivation.engine.formula.ulp import ordinal
from derivation.plate.hard import check as hard_check
from derivation.plate.hard.case import HardCase
from derivation.plate.hard.places import OFFSETS

SWITCHES: dict[str, dict[str, str]] = tomllib.loads(
    (Path(__file__).parent / "switches.toml").read_text()
)
"""By module and as code: a name of `SEAMS`, or the reason why it is none."""

REASONS = {"domain", "range", "iteration", "shape", "bound", "end"}

_CHOICES = {"minimum", "maximum", "min", "max", "clip", "heaviside", "searchsorted", "int"}
_PLAIN = {"manifest", "as_printed", "__init__"}
"""Modules without numerics of their own, or with none that promises anything."""


# --- what the generated code switches on


def switches(source: str) -> set[str]:
    """Comparisons and choices in a module, but for those that state a domain by `inside`."""
    found: set[str] = set()

    def visit(node: ast.AST) -> None:
        name = ""
        if isinstance(node, ast.Call):
            function = node.func
            name = function.attr if isinstance(function, ast.Attribute) else ""
            name = function.id if isinstance(function, ast.Name) else name
        if name == "inside":
            return
        if name in _CHOICES and isinstance(node, ast.Call) and (node.args or name == "heaviside"):
            found.add(ast.unparse(node))
        if isinstance(node, ast.Compare) and not isinstance(node.ops[0], ast.Is | ast.IsNot):
            found.add(ast.unparse(node))
        for child in ast.iter_child_nodes(node):
            visit(child)

    visit(ast.parse(source))
    return {text for text in found if ".kind " not in text}


def modules() -> list[Path]:
    (folder,) = generated.__path__
    return [path for path in sorted(Path(folder).glob("*.py")) if path.stem not in _PLAIN]


@pytest.mark.parametrize("path", modules(), ids=lambda path: path.stem)
def test_every_switch_is_known(path: Path) -> None:
    """A new one needs a name here: that of its cases' seam, or the reason why it has none."""
    known = SWITCHES.get(path.stem, {})
    found = switches(path.read_text())
    assert found - known.keys() == set(), "switches without a name"
    assert known.keys() - found == set(), "names without a switch"


def test_a_new_switch_is_noticed() -> None:
    (source,) = (path.read_text() for path in modules() if path.stem == "edge")
    for line in ("np.where(T < 3.0, low, high)", "np.maximum(y, _THIN)", "int(7 / eta)"):
        assert switches(f"{source}\nx = {line}\n") - SWITCHES["edge"].keys()


def names(module: str) -> set[str]:
    return {name for value in SWITCHES[module].values() for name in value.split(", ")}


def test_every_name_is_a_seam_or_a_reason() -> None:
    named = {name for module in SWITCHES for name in names(module)}
    assert named - REASONS == SEAMS.keys()


# --- where they are


SEAMS = KERNEL_SEAMS | WAVE_SEAMS


def missing(seam: Seam, cases: Iterable[HardCase]) -> list[str]:
    """Kernels and places without cases at the place, and 1 and 32 ULP to either side."""
    values: dict[str, set[float]] = {kernel: set() for kernel in seam.kernels}
    for case in cases:
        if case.kernel in values:
            for point in case.points:
                if all(map(math.isfinite, point.values())):
                    values[case.kernel].add(value_of(seam, point))
    return [
        f"{kernel} at {float(place):.17g}"
        for place in seam.places()
        for kernel, found in values.items()
        if not surrounded(place, found)
    ]


def value_of(seam: Seam, point: Mapping[str, float]) -> float:
    """The variable as a double; NaN where it has no meaning."""
    try:
        return float(seam.of({name: Fraction(x) for name, x in point.items()}))
    except (ZeroDivisionError, OverflowError, KeyError):
        return math.nan


def surrounded(place: Place, found: Iterable[float]) -> bool:
    """Whether values lie as `OFFSETS` do, up to what rounding the variable makes of them.

    Whole numbers are their own neighbours.
    """
    if isinstance(place, int) and place > 1:
        return {place + offset for offset in OFFSETS if place + offset > 0} <= set(found)
    middle = ordinal(float(place))
    steps = [ordinal(x) - middle for x in found if math.isfinite(x)]
    near = sorted(step for step in steps if abs(step) <= 80)
    beside = [step for step in near if abs(step) <= 4]
    return (
        len(near) >= len(OFFSETS)
        and near[0] <= -14
        and near[-1] >= 14
        and any(step < 0 for step in beside)
        and any(step > 0 for step in beside)
    )


@pytest.mark.parametrize("name", SEAMS)
def test_every_seam_has_cases_on_both_sides(name: str) -> None:
    assert missing(SEAMS[name], hard_check.cases()) == []


@pytest.mark.parametrize("name", ["thin edge", "sphere", "index of kappa", "cells of the law"])
def test_a_seam_without_cases_is_noticed(name: str) -> None:
    seam = SEAMS[name]
    others = [case for case in hard_check.cases() if case.kernel != seam.kernels[0]]
    assert missing(seam, others)
    moved = Seam(seam.kernels, seam.of, lambda: [float(x) * 1.001 for x in seam.places()])
    assert missing(moved, hard_check.cases())


def test_every_kernel_with_a_switch_of_its_own_is_in_the_suite() -> None:
    """Of the modules whose every seam is named above, no kernel is left out."""
    tried = {case.kernel for case in hard_check.cases()}
    for name in SWITCHES:
        if names(name) - REASONS:
            kernels = {k.name for k in hard_check.kernels().values() if k.module == name}
            assert kernels - tried <= UNTRIED, name


UNTRIED = {
    "plate_coefficients",
    "side_wall",
    "bending",
    "zener_number",
    "bending_period",
    "echo_time",
}
"""Coefficients, whose seams are those of the law that they make; the effects without a switch."""
