"""The complete measurement as plain data: panels, winners, scaling, headline, other programs."""

import os
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from derivation.engine.activity import Progress, quiet
from derivation.engine.measure.clock import CONTENDED, FULL, QUICK, SEED, Session
from derivation.engine.measure.record import provenance
from derivation.engine.outputs import plain
from derivation.plate.benchmark import scaling
from derivation.plate.benchmark.catalogue import methods
from derivation.plate.benchmark.headline import headline
from derivation.plate.benchmark.interface import (
    CASES,
    PAPER,
    TASKS,
    TIE,
    BenchmarkCase,
    largest_contact_radius,
)
from derivation.plate.benchmark.panels import panel
from derivation.plate.benchmark.pareto import winners
from derivation.plate.benchmark.problems import LAW_DIGITS, QUICK_DIGITS
from derivation.plate.benchmark.rows import BenchmarkRow
from derivation.plate.benchmark.speed import machine
from derivation.plate.benchmark.tools import tools
from derivation.plate.judge import PACKAGE


def scene_case(
    R: float, m: float, v0: float, h: float, b: float, lam: float, mu: float
) -> BenchmarkCase:  # fmt: skip
    """Return a scene as the test case that replaces the paper's.

    The law is evaluated from 1/13 of the impact's largest contact radius to twice that radius,
    at most to 0.95 min(b, R) unless the impact goes further.

    Raises
    ------
    ValueError
        If the impact goes beyond the contact law.
    """
    case = BenchmarkCase("scene", R, h, b, 0.0, 0.0, v0, m, lam, mu)
    top = largest_contact_radius(case) / h
    if not top > 0:
        raise ValueError(
            "impact.speed: expected an impact within the contact law (a below R, b and 6 h), got "
            "one beyond it; reduce the speed or use a thicker plate"
        )
    high = min(2 * top, 0.95 * min(b, R) / h)
    return BenchmarkCase("scene", R, h, b, top / 13, max(high, top), v0, m, lam, mu)


def cases(scene: BenchmarkCase | None) -> tuple[BenchmarkCase, ...]:
    """Return every test case, with a scene in place of the paper's if one is given."""
    return tuple(scene if scene and case is PAPER else case for case in CASES)


def measure(
    names: Sequence[str] = (), quick: bool = False, scene: BenchmarkCase | None = None,
    progress: Progress = quiet,
) -> dict[str, Any]:  # fmt: skip
    """Measure all methods, or those named; a quick run takes seconds, a full one minutes.

    Raises
    ------
    ValueError
        If a method is unknown.
    """
    chosen, test_cases = methods(names, quick), cases(scene)
    studies = scaling.studies(quick)
    report = _Progress(progress, len(TASKS) * len(test_cases) + len(studies) + 2)
    effort = QUICK if quick else FULL
    before = os.getloadavg()[0]
    rows: list[BenchmarkRow] = []
    sessions: list[dict[str, Any]] = []
    for case in test_cases:
        for task in TASKS:
            report(f"{task}, {case.name}")
            results = panel(task, case, chosen, quick)
            rows += results.rows
            sessions += [
                {"task": task, "case": case.name, "kind": kind, **_session(session)}
                for kind, session in (("vector", results.vector), ("single", results.single))
                if session is not None
            ]
    growths = []
    for what, study in studies:
        report(f"scaling with {what}")
        growths += study()
    report("headline")
    against = headline(scene or PAPER, quick)
    report("other tools")
    data = {
        "provenance": provenance(QUICK_DIGITS if quick else LAW_DIGITS, PACKAGE),
        "machine": dict(machine()),
        "run": {
            "quick": quick, "rounds": effort.rounds, "seed": SEED, "tie": TIE,
            "contended": CONTENDED, "methods": list(names),
            "load_before": before, "load_after": os.getloadavg()[0],
        },
        "cases": [asdict(case) for case in test_cases],
        "rows": [asdict(row) for row in rows],
        "sessions": sessions,
        "pareto": [asdict(winner) for winner in winners(rows)],
        "scaling": [asdict(growth) for growth in growths],
        "headline": asdict(against),
        "tools": [asdict(tool) for tool in tools()],
    }  # fmt: skip
    cleaned: dict[str, Any] = plain(data)
    return cleaned


def _session(session: Session) -> dict[str, Any]:
    return {
        "spread": session.spread, "attempts": session.attempts, "contended": session.contended,
    }  # fmt: skip


class _Progress:
    """Counter of the parts of the work that reports each part to a callback."""

    def __init__(self, progress: Progress, total: int) -> None:
        self.progress, self.total, self.number = progress, total, 0

    def __call__(self, part: str) -> None:
        self.number += 1
        self.progress(part, self.number, self.total)
