"""References and test points of a paper whose functions have closed formulas."""

import importlib
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from pathlib import Path
from typing import Any

from derivation.engine.formula.chain import Chain
from derivation.engine.formula.grid import domain_grid, inside, joint_points, towards_zeros
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.measure.case import HardCase, read_cases
from derivation.engine.measure.check import Judge
from derivation.engine.measure.kernels import Kernel, generated_kernels
from derivation.engine.measure.point import Point
from derivation.engine.measure.suite import Suite
from derivation.engine.measure.target import NO_REFERENCE, Domain
from derivation.engine.nearest import did_you_mean
from derivation.engine.oracle.agreement import Route, Routes
from derivation.engine.oracle.oracle import Balls
from derivation.engine.rewrite.blocks import Definition, build_blocks
from derivation.engine.rewrite.form import switch_points

FEW = 3
"""Number of digits of values whose sign is needed."""
ALL = 400
"""Exponent of ten of a range that contains all doubles, because stated forms state no range."""
STATED_FORM = 6
"""Exponent of ten of the largest arguments with which stated forms are tested together."""
JOINT = 1000
"""Number of points at which several arguments are extreme, next to ends, or nearly equal."""

USUAL, USUAL_DECADES = 3000, 2
"""Number of points at which all arguments are of moderate size, and the exponent of ten of the
largest; most errors of functions are largest there."""


def decades_of(row: Any) -> int:
    """Return the exponent of ten of the largest arguments for which a function is accurate."""
    return int(row.get("decades") or STATED_FORM)


def stated_domain(row: Any, decades: int) -> Domain:
    """Return the domain that a row of the manifest states, in a range of all arguments.

    The decades are the exponent of ten of the largest arguments.
    """
    stated = tuple(part.strip() for part in row["domain"].split(",") if part.strip())
    range_of_each = (
        f"not 0 < abs({name}) < 1e-{decades} and abs({name}) <= 1e{decades}"
        for name in row["arguments"]
    )
    return Domain(row["name"], tuple(row["arguments"]), False, (*stated, *range_of_each))


def domain_judge(
    chain: Chain,
    routes: Mapping[str, Route],
    package: str,
    blocks: tuple[Definition, ...],
    easy: Callable[[Point], bool],
    hard_cases: Path | None = None,
) -> Judge:
    """Return references and test points of closed formulas, with points from their domains.

    Parameters
    ----------
    chain
        The formulas with their vocabulary.
    routes
        For each formula, an independent method for its value in mpmath; a formula without one is
        evaluated as derived.
    package
        Import name of the generated package.
    blocks
        Building blocks of the forms; points next to their switch points are tested.
    easy
        Function that returns whether such a method is fast at a point.
    hard_cases
        File with hard cases, if there are any; see `derivation.engine.measure.case.read_cases`.

    Returns
    -------
    Judge
        The references and test points.
    """
    references = Routes(Balls(chain.vocabulary, chain.formulas), routes)

    @cache
    def words(name: str) -> Vocabulary:
        formula = chain.formulas().get(name)
        return chain.vocabulary.with_conditions(formula.where if formula else ())

    def sign(name: str, point: dict[str, float]) -> int:
        try:
            value = references.balls.value(name, point, FEW)
        except NO_REFERENCE:
            return 0
        return int(value > 0) - int(value < 0)

    def grid(name: str, arguments: Sequence[str], _: bool) -> tuple[Point, ...]:
        switches = switch_points(block.value for block in build_blocks(blocks).values())
        vocabulary = words(name)
        points = domain_grid(name, arguments, vocabulary, switches)
        rows = {row["name"]: row for row in importlib.import_module(f"{package}.manifest").KERNELS}
        if name in rows:
            decades = decades_of(rows[name])
            points += joint_points(name, arguments, vocabulary, decades, JOINT)
            points += joint_points(f"usual {name}", arguments, vocabulary, USUAL_DECADES, USUAL)
            stated = stated_domain(rows[name], rows[name].get("decades") or ALL)
            points = tuple(p for p in points if stated.holds(Point(p)))
            signs = [(p, sign(name, p)) for p in points]
            points += tuple(towards_zeros(signs, partial(sign, name)))
        return tuple(map(Point, points))

    def in_domain(name: str, point: Point) -> bool:
        return inside(words(name), point.values)

    def suite() -> Suite:
        assert hard_cases is not None  # it is called only with hard cases
        kernels = {kernel.name: kernel for kernel in generated_kernels(package)}
        cases = tuple(read_cases(hard_cases))
        for case in cases:
            _expect_arguments(case, kernels)
        return Suite(cases, kernels, {}, references.balls)

    hard = suite if hard_cases is not None else None
    return Judge(references, grid, package, easy, in_domain, hard)


def _expect_arguments(case: HardCase, kernels: Mapping[str, Kernel]) -> None:
    """Raise ValueError if a case is not of a generated function, or has other arguments."""
    if case.kernel not in kernels:
        raise ValueError(
            f"hard case of {case.kernel!r}: {did_you_mean(case.kernel, kernels)}expected one of "
            f"{', '.join(kernels)}"
        )
    expected = kernels[case.kernel].arguments
    if {*expected} != case.inputs.keys():
        raise ValueError(
            f"hard case of {case.kernel}: expected the arguments {', '.join(expected)}, got "
            f"{', '.join(case.inputs)}"
        )
