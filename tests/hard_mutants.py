"""Generated modules with one error, in memory, tested by the hard cases of all their users.

In addition, a function must have a value at its example, and return NaN outside its domain.
"""

import ast
import importlib
import json
import math
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from functools import cache
from pathlib import Path
from types import CodeType, FrameType, ModuleType
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np
from domains import EXAMPLE, OUTSIDE, POINTWISE, ROWS, violations
from mutants import CodeMutant, of_module
from mutated_code import source

import generated
from derivation.engine.files import ROOT
from derivation.engine.formula.ulp import spacing_exponent
from derivation.engine.measure import hard
from derivation.engine.measure.case import HardCase
from derivation.engine.measure.judge import judge
from derivation.engine.measure.kernels import Kernel
from derivation.engine.oracle.reference import Reference, reference_from_text
from derivation.plate.cases import calls
from derivation.plate.cases import suite as hard_suite
from derivation.plate.paper import PAPER

CALLS = calls.__name__
STEPS = {"impact": 8, "plate_arrays": 8, "plate_points": 8}
"""Limits of the number of Newton iterations, so that a slower convergence is detected."""
FIRST = 20
"""Number of checks that every mutant runs."""
ROUNDED = 0.51
"""Largest change of a reference value when it is rounded to a double [ULP]."""


class CaseCheck(NamedTuple):
    """A hard case with its reference values, and the allowed differences from them."""

    case: HardCase
    references: list[Reference]
    expected: np.ndarray
    allowed: np.ndarray

    def accepts(self, kernels: Mapping[str, Kernel]) -> bool:
        """Return whether values, type and shape of the results are correct, without warnings."""
        actual, problem = hard._results(
            self.case, kernels[self.case.kernel], len(self.expected), self.references
        )
        if problem or actual.shape != self.expected.shape or actual.dtype != self.case.format.name:
            return False
        with np.errstate(all="ignore"):
            near = np.abs(actual - self.expected) <= self.allowed
        return bool(
            (near | (actual == self.expected) | (np.isnan(actual) & np.isnan(self.expected))).all()
        )


class Domain(NamedTuple):
    """A function has a value at its example and NaN outside its domain, alone and in an array."""

    name: str

    def accepts(self, kernels: Mapping[str, Kernel]) -> bool:
        given, call = domain_points(self.name), kernels[self.name].call
        more = {"modes": 5} if ROWS[self.name].get("modes") else {}
        with np.errstate(all="ignore"):
            alone = [np.asarray(call(*point, **more)) for point in given]
            columns = (np.array(column) for column in zip(*given, strict=True))
            together = np.asarray(call(*columns, **more))
        nan = np.isnan(alone)
        # Results of a point lie along a last axis of their own, or along the first ones.
        same = np.isnan(together if together.shape == nan.shape else np.moveaxis(together, -1, 0))
        return bool(nan[:-1].all() and not nan[-1].any() and (same == nan).all())


@cache
def domain_points(name: str) -> tuple[tuple[float, ...], ...]:
    """Return points outside the domain of a function, and its example."""
    outside = [dict(moved) for _, moved in violations(name)]
    outside += [{key: bad} for key, several in OUTSIDE.get(name, {}).items() for bad in several]
    names = ROWS[name]["arguments"]
    return tuple(tuple((EXAMPLE | point)[key] for key in names) for point in (*outside, {}))


class Layouts(NamedTuple):
    """Contacts in arrays of various layouts: each result must equal that of the single contact."""

    name: str = "indentation"

    def accepts(self, kernels: Mapping[str, Kernel]) -> bool:
        call = kernels[self.name].call
        few, many = np.array([0.05, 0.02, 0.2]), np.resize([0.05, 0.3, 0.02, 0.1], 1200)
        a = np.resize(np.geomspace(1e-3, 0.25, 101), (700, 3))
        layouts = [
            (a[:, 0], 0.9, 0.05), (a, 0.9, few), (a.T, 0.9, few[:, None]), (a[None], 0.9, few),
            (a[:, 0], 0.9, many[:700]), (a[:, :1], 0.9, few), (a[:500], 0.9, few),
            (np.resize(a, 1200), 0.9, many), (a[:, :2], 0.9, few[:2]), (a[:, :2], few[:2] + 1, 0.1),
        ]  # fmt: skip
        for radii, R, h in layouts:
            result = call(radii, R, h, 1.0)
            sampled = [x.ravel()[::37].tolist() for x in np.broadcast_arrays(radii, R, h)]
            alone = [call(*one, 1.0) for one in zip(*sampled, strict=True)]
            if not np.allclose(result.ravel()[::37], alone, rtol=1e-14, atol=0.0):
                return False
        return True


Check = CaseCheck | Domain | Layouts


@cache
def code(name: str) -> CodeType:
    text = Path(calls.__file__).read_text() if name == CALLS else source(name)
    return compile(text, name, "exec")


@cache
def imports(name: str) -> frozenset[str]:
    """Return the generated modules that a generated module imports."""
    nodes = [node for node in ast.walk(ast.parse(source(name))) if isinstance(node, ast.ImportFrom)]
    packaged = {
        alias.name for node in nodes if node.level and not node.module for alias in node.names
    }
    return frozenset(packaged | {node.module for node in nodes if node.level and node.module})


@cache
def users(name: str) -> tuple[str, ...]:
    """Return the modules that depend on a module, each after those on which it depends."""
    every = {path.stem for path in (ROOT / "generated").glob("*.py")} - {"__init__", "manifest"}
    actual = {name}
    while more := {other for other in every - actual if imports(other) & actual}:
        actual |= more
    order, left = list[str](), actual - {name}
    while left:
        order += sorted(other for other in left if not imports(other) & left)
        left -= {*order}
    return tuple(order)


@contextmanager
def replaced(name: str, tree: ast.Module | str) -> Iterator[dict[str, Kernel]]:
    """Yield the functions of the hard cases, with one module changed and its users reloaded."""
    with ExitStack() as stack:
        for one in (name, *users(name), CALLS):
            full = one if one == CALLS else f"{generated.__name__}.{one}"
            module = ModuleType(full)
            module.__package__ = full.rpartition(".")[0]
            stack.enter_context(patch.dict(sys.modules, {full: module}))
            if one != CALLS:
                stack.enter_context(patch.object(generated, one, module, create=True))
            exec(compile(tree, name, "exec") if one == name else code(one), vars(module))
            vars(module).update({"_STEPS": STEPS[one]} if one in STEPS else {})
        yield {kernel.name: kernel for kernel in (*_rows(), *module.special_calls())}


def _rows() -> Iterator[Kernel]:
    for name, row in ROWS.items():
        call = getattr(importlib.import_module(f"generated.{row['module']}"), name)
        yield Kernel(name, row["module"], tuple(row["arguments"]), call, float(row["budget"]))


@cache
def case_checks() -> tuple[CaseCheck, ...]:
    """Return every hard case with its reference values."""
    suite = hard_suite.suite()
    references = hard.committed_references(json.loads(PAPER.hard.read_text()), suite.cases)
    return tuple(
        _case_check(
            case, suite.kernels[case.kernel], suite.results(case.kernel), references[case.key]
        )
        for case in suite.cases
    )


def _case_check(case: HardCase, kernel: Kernel, count: int, known: hard.Known) -> CaseCheck:
    references, allowed = [reference_from_text(row) for row in known.references], []
    values = [float(one.value) for one in references]
    for one, value, budget in zip(
        references, values, hard._budgets(case, kernel, references), strict=True
    ):
        error = 0.0
        if math.isfinite(value):
            ulps = judge(value, one, budget, case.format).allowed + ROUNDED
            error = ulps * math.ldexp(1.0, spacing_exponent(one.value, case.format))
        allowed.append(error)
    shape = (count, *case.shape)
    return CaseCheck(case, references, np.reshape(values, shape), np.reshape(allowed, shape))


def undetected(name: str, may_pass: Mapping[str, int]) -> dict[str, list[str]]:
    """Return the mutants of each function or constant of which more pass than allowed.

    A mutant that passes runs all checks, which takes most of the time. Where so many mutants of a
    function are detected that the others may all pass, these run the first checks only.
    """
    beneath = {name, *users(name)}
    known = hard_suite.kernels()
    checks: list[Check] = [x for x in case_checks() if known[x.case.kernel].module in beneath]
    checks += [Domain(x) for x in POINTWISE if ROWS[x]["module"] in beneath]
    checks += [Layouts()] if "contact_law" in users(name) else []
    assert checks
    always, executed = _executed_lines(name, checks)
    pairs = list(zip(checks, executed, strict=True))

    def passes(mutant: CodeMutant, most: int | None = None) -> bool:
        # A check that does not run a changed line gives the same result as before.
        every = not always.isdisjoint(mutant.lines)
        able = [i for i, (_, run) in enumerate(pairs) if every or not run.isdisjoint(mutant.lines)]
        detecting = _detecting_check(name, mutant.tree, [pairs[i][0] for i in able[:most]])
        if detecting is not None and able:  # it is likely to detect the next one
            pairs.insert(0, pairs.pop(able[detecting]))
        return detecting is None

    actual: dict[str, list[CodeMutant]] = {}
    for mutant in of_module(source(name)):
        if passes(mutant, FIRST):
            actual.setdefault(mutant.home, []).append(mutant)
    for home, those in actual.items():
        left = iter(those.copy())
        while len(those) > may_pass.get(home, 0) and (mutant := next(left, None)):
            if not passes(mutant):
                those.remove(mutant)
    return {
        home: [mutant.change for mutant in those]
        for home, those in actual.items()
        if len(those) > may_pass.get(home, 0)
    }


def _executed_lines(name: str, checks: Sequence[Check]) -> tuple[set[int], list[set[int]]]:
    """Return the lines of a module that run when it is loaded, and those that each check runs.

    All checks must accept the module.
    """
    lines, executed = set[int](), list[set[int]]()

    def in_module(frame: FrameType, *_: object) -> Callable[..., Any] | None:
        if frame.f_code.co_filename != name:
            return None
        lines.add(frame.f_lineno)
        return in_module

    before = sys.gettrace()
    sys.settrace(in_module)
    try:
        with replaced(name, source(name)) as kernels:
            always = {*lines}
            for check in checks:
                lines.clear()
                assert check.accepts(kernels)
                executed.append({*lines})
    finally:
        sys.settrace(before)
    return always, executed


def _detecting_check(name: str, tree: ast.Module, checks: Sequence[Check]) -> int | None:
    """Return the index of the first check that fails; 0 if the module cannot be loaded."""
    try:
        with replaced(name, tree) as kernels:
            return next((i for i, check in enumerate(checks) if not _accepts(check, kernels)), None)
    except Exception:
        return 0


def _accepts(check: Check, kernels: Mapping[str, Kernel]) -> bool:
    try:
        return check.accepts(kernels)
    except Exception:  # any exception counts as detected
        return False
