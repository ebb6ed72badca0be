"""Tests stated error bounds: random impacts at several tolerances against Arb reference values.

The reference values of a scene take about a second and are recorded; the errors are measured again
in each run. Each scene is drawn from the seed and its number, log-uniformly over shapes, materials
and speeds within the range of the contact law.
"""

import json
import math
import random
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import flint

from derivation.checks.random_scenes import log_uniform_draw
from derivation.engine.activity import Progress, quiet
from derivation.engine.files import measurements, write_file
from derivation.engine.measure.result import CheckResult, all_passed
from derivation.engine.outputs import expect_recordable, json_by_line, plain_rows
from derivation.plate.impact.oracle import impact as contact_impact
from derivation.scene.model import Model
from derivation.scene.selection.method_selection import solve
from generated.contact_law import force_of_radius, indentation

MEASURED = measurements() / "bounds.json"
SAVE_EVERY = 20
"""Number of new reference values after which they are saved."""
DIGITS = 50
"""Number of digits of the reference values; a bound is never below 4e-14."""
SEED = 1
TOLERANCES = tuple(10.0**-n for n in range(2, 14))
COLUMNS = ("method", "#runs", "#largest error/bound", "#error", "#bound", "result")
QUANTITIES = ("contact_time", "max_indentation", "max_force", "max_contact_radius")
_WRITTEN = DIGITS + 3

Point = tuple[float, ...]
"""R, m, v0, h, b, lam and mu of an impact, in SI units."""
ORACLE: Callable[..., tuple[flint.arb, ...]] = contact_impact.impact


@dataclass(frozen=True)
class SceneReference:
    """Reference values of an impact in the order of `QUANTITIES`, as decimal text."""

    point: Point
    values: tuple[str, ...]


@dataclass(frozen=True)
class BoundRow:
    """The largest ratio of error to bound of one method.

    Parameters
    ----------
    method
        Name of the method.
    runs
        Number of runs, over all scenes and tolerances, in which the method was selected.
    ratio
        Largest error over the stated bound [1].
    error, bound
        Relative error and bound of the run with that ratio [1].
    quantity, point
        The result and the scene of that run.
    """

    method: str
    runs: int
    ratio: float
    error: float
    bound: float
    quantity: str
    point: Point

    @property
    def passed(self) -> bool:
        """Whether no error exceeds its bound."""
        return self.ratio <= 1.0


def check_bounds(count: int, update: bool = False, progress: Progress = quiet) -> CheckResult:
    """Test the bounds that `simulate` states on the first `count` random scenes.

    Recorded reference values are reused; others are computed, which takes about a second per scene.
    With `update`, new ones are saved during the run, so that an interrupted run can be continued.
    """
    if update:
        expect_recordable(MEASURED)
    known = committed_references()
    references: list[SceneReference] = []
    for expected in reference_values(count, known, progress=progress):
        references.append(expected)
        if update and len(references) > len(known) and len(references) % SAVE_EVERY == 0:
            write_file(MEASURED, to_json(references, ()))
    rows = judge(references)
    if update:
        write_file(MEASURED, to_json(references + known[count:], rows))
    cells = [
        (r.method, r.runs, f"{r.ratio:.3f}", f"{r.error:.2g}", f"{r.bound:.2g}", r.quantity)
        for r in rows
    ]
    title = f"Error bounds in {count} scenes"
    return CheckResult(title, COLUMNS, cells, lambda: plain_rows(rows), all_passed(rows))


def scene(number: int, seed: int = SEED) -> Point:
    """Return the scene with a number.

    h/b is 1e-4 to 100; the largest contact radius is 1e-8 to 1 times 85 % of min(b, R, 6 h).
    """
    generator = random.Random(f"bounds {seed} {number}")
    spread = log_uniform_draw(generator)
    b, eta = spread(1e-3, 1e2), spread(1e-4, 1e2)
    h, R = b * eta, b * spread(0.1, 1e3)
    mu, nu = spread(1e4, 1e12), generator.uniform(-0.9, 0.49)
    lam = 2 * mu * nu / (1 - 2 * nu)
    a = 0.85 * min(b, R, 6 * h) * spread(1e-8, 1.0)
    # The work by Hertz's law is 2/5 of P delta; other laws need a slightly different work.
    work = 0.4 * float(force_of_radius(a, R, lam, mu) * indentation(a, R, h, b))
    m = spread(1e-6, 1e6)
    return R, m, math.sqrt(2 * work / m), h, b, lam, mu


def reference(point: Point) -> SceneReference:
    """Compute the reference values of an impact, as decimal text."""
    balls = ORACLE(*point, digits=DIGITS)
    return SceneReference(point, tuple(ball.str(_WRITTEN, radius=False) for ball in balls))


def reference_values(
    count: int, known: Sequence[SceneReference] = (), seed: int = SEED, progress: Progress = quiet
) -> Iterator[SceneReference]:
    """Yield the reference values of the first `count` scenes; known ones are not computed again.

    Parameters
    ----------
    progress
        Called before each computation, with the number of the scene and their total number.
    """
    by_point = {_written(t.point): t for t in known}
    for number in range(count):
        point = scene(number, seed)
        if _written(point) in by_point:
            yield by_point[_written(point)]
            continue
        progress("reference", number + 1, count)
        yield reference(point)


def _written(point: Point) -> tuple[str, ...]:
    """Return the numbers of a scene to 11 digits, which identify it.

    The last digits of the speed depend on rounding errors of the generated contact law.
    """
    return tuple(f"{x:.10e}" for x in point)


def errors(values: Iterable[float], expected: SceneReference) -> tuple[float, ...]:
    """Return the relative errors of the results, with the error of the reference values added."""
    with flint.ctx.workprec(256):
        return tuple(
            float((abs(flint.arb(value) / flint.arb(text) - 1) + 10.0**-DIGITS).abs_upper())
            if math.isfinite(value)
            else math.inf
            for value, text in zip(values, expected.values, strict=True)
        )


def simulated(point: Point, rtol: float) -> tuple[Sequence[float], str, float]:
    """Return results, method and bound of `simulate` for an impact at a tolerance."""
    R, m, v0, h, b, lam, mu = point
    values, accuracy = solve(Model(R, m, v0, h, b, lam, mu), rtol)
    return values[:4], accuracy.method, accuracy.bound


def judge(
    known: Sequence[SceneReference], tolerances: Sequence[float] = TOLERANCES
) -> tuple[BoundRow, ...]:
    """Simulate every scene at every tolerance; return a row for each method, by first use.

    Raises
    ------
    ValueError
        If a bound exceeds the tolerance, or a scene is rejected.
    """
    worst: dict[str, BoundRow] = {}
    for rtol in tolerances:
        for expected in known:
            values, method, bound = simulated(expected.point, rtol)
            if not bound <= rtol:
                raise ValueError(f"{method} states {bound} for {rtol} at {expected.point}")
            error_values = errors(values, expected)
            error = max(error_values)
            before = worst.get(method)
            ratio, runs = error / bound, 1 + (before.runs if before else 0)
            if before is None or ratio > before.ratio:
                quantity = QUANTITIES[error_values.index(error)]
                worst[method] = BoundRow(
                    method, runs, ratio, error, bound, quantity, expected.point
                )
            else:
                worst[method] = replace(before, runs=runs)
    return tuple(worst.values())


def to_json(known: Sequence[SceneReference], rows: Sequence[BoundRow]) -> str:
    """Return reference values and rows as JSON, one per line."""
    data = {"digits": DIGITS, "seed": SEED, "python-flint": flint.__version__}
    listed = {"rows": plain_rows(rows), "references": plain_rows(known)}
    return json_by_line(data | listed, *listed)


def committed_references() -> list[SceneReference]:
    """Return the recorded reference values; none if they have another number of digits."""
    if not MEASURED.is_file():
        return []
    data: dict[str, Any] = json.loads(MEASURED.read_text())
    if data["digits"] != DIGITS:
        return []
    return [SceneReference(tuple(t["point"]), tuple(t["values"])) for t in data["references"]]
