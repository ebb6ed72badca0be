"""Panels: errors, then times, of every method for a task in a test case."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from derivation.engine.measure import clock
from derivation.engine.measure.clock import CPU, FULL, QUICK, Effort, Session, Timing
from derivation.plate.benchmark.errors import MeasuredMethod, measure_errors
from derivation.plate.benchmark.interface import BenchmarkCase, Call, Doubles, Method, Task
from derivation.plate.benchmark.problems import Problem, problem
from derivation.plate.benchmark.rows import BenchmarkRow

SLOW_CALL = 0.05
"""Time of a single result above which a method is timed only once [s]."""

SLOW_ARRAY = 500
"""Points of the array for such methods."""

NO_DIGITS = 0.5
"""Number of correct digits below which a method fails."""


@dataclass(frozen=True)
class BenchmarkPanel:
    """Rows of a task in a test case, and the timing sessions; None if nothing was timed."""

    rows: tuple[BenchmarkRow, ...]
    vector: Session | None
    single: Session | None


def panel(
    task: Task, case: BenchmarkCase, methods: Sequence[Method], quick: bool
) -> BenchmarkPanel:
    """Measure errors and run times of the methods for a task in a test case."""
    wanted = [method for method in methods if method.task == task]
    if not wanted:
        return BenchmarkPanel((), None, None)
    set_task = problem(task, case, quick)
    # Suppressed once, so that methods that overflow need not do it in every call.
    with np.errstate(all="ignore"):
        judged = [measured_row(method, set_task) for method in wanted]
        rows, calls = [row for row, _ in judged], [call for _, call in judged]
        return _timed_rows(rows, calls, wanted, set_task, QUICK if quick else FULL)


def measured_row(method: Method, problem: Problem) -> tuple[BenchmarkRow, MeasuredMethod | None]:
    """Return the row of a method without times, and the function to time unless it fails."""
    reason = method.fails(problem.case)
    row = BenchmarkRow(
        method.task, problem.case.name, method.family, method.setting, method.arithmetic, reason
    )
    if reason is not None:
        return row, None
    judged = measure_errors(method, problem, CPU)
    total = judged.errors.total
    reason = None
    if total == -math.inf:
        reason = "gives no number in part of the case"
    elif total < NO_DIGITS:
        reason = f"no correct digit: relative error up to {10**-total:.2g}"
    row = replace(row, fails=reason, errors=judged.errors, setup=judged.setup)
    if judged.first > SLOW_CALL:
        alone = Timing(judged.first, 1, 1.0, 1)
        many = alone if method.one_by_one else _once(judged.call, problem.sample[:SLOW_ARRAY])
        return replace(row, vector=many, single=alone), None
    return row, judged if total > -math.inf else None


def _once(call: Call, array: Doubles) -> Timing:
    """Return the time of a single call with an array."""
    begin = CPU()
    call(array)
    return Timing((CPU() - begin) / array.size, array.size, 1.0, 1)


def _timed_rows(
    rows: list[BenchmarkRow],
    calls: Sequence[MeasuredMethod | None],
    methods: Sequence[Method],
    problem: Problem,
    effort: Effort,
) -> BenchmarkPanel:
    """Return the rows with times, measured in interleaved rounds for arrays and single calls."""
    known = [(index, judged) for index, judged in enumerate(calls) if judged is not None]
    if not known:
        return BenchmarkPanel(tuple(rows), None, None)
    one = problem.points[-1:]
    alone = clock.session([clock.plan(judged.call, one) for _, judged in known], effort)
    for (index, _), timing in zip(known, alone.timings, strict=True):
        rows[index] = replace(rows[index], vector=timing, single=timing)
    known = [(index, judged) for index, judged in known if not methods[index].one_by_one]
    if not known:
        return BenchmarkPanel(tuple(rows), None, alone)
    arrays = [clock.plan(judged.call, problem.sample) for _, judged in known]
    vector = clock.session(arrays, effort)
    for (index, _), timing in zip(known, vector.timings, strict=True):
        rows[index] = replace(rows[index], vector=timing)
    return BenchmarkPanel(tuple(rows), vector, alone)
