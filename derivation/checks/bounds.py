"""Whether stated error bounds hold: random impacts at several tolerances against oracle 1.

A scene's truth does not depend on how it is computed otherwise, takes the oracle about a
second, and is kept; errors are measured anew each time. Scenes are drawn one by one from a
seed and their number, log-uniform over shapes, materials and speeds within the law's range.
"""

import json
import math
import random
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import flint

from derivation.checks.random_scenes import Tell, spreading
from derivation.engine.measure.record import plain
from derivation.plate.impact.oracle import impact as contact_impact
from generated.contact_law import force_of_radius, indentation

DIGITS = 50
"""Of a truth; a bound is never below 4e-14."""
SEED = 1
TOLERANCES = tuple(10.0**-n for n in range(2, 14))
QUANTITIES = ("contact_time", "max_indentation", "max_force", "max_contact_radius")
_WRITTEN = DIGITS + 3

Point = tuple[float, ...]
"""R, m, v0, h, b, lam and mu of an impact."""
Solve = Callable[[Point, float], tuple[Sequence[float], str, float]]
"""Results, method and bound of an impact at a tolerance."""
ORACLE: Callable[..., tuple[flint.arb, ...]] = contact_impact.impact


@dataclass(frozen=True)
class SceneTruth:
    """An impact's results by the oracle, in decimal, to DIGITS digits."""

    point: Point
    values: tuple[str, ...]


@dataclass(frozen=True)
class BoundRow:
    """How one method's bounds held.

    Parameters
    ----------
    method
        Its name.
    runs
        How often it was chosen, of all scenes at all tolerances.
    ratio
        Largest true error over the bound stated.
    error, bound
        Both of them there [1].
    quantity, point
        Of which result, and where.
    """

    method: str
    runs: int
    ratio: float
    error: float
    bound: float
    quantity: str
    point: Point

    @property
    def kept(self) -> bool:
        """Whether no error was above its bound."""
        return self.ratio <= 1.0


def scene(number: int, seed: int = SEED) -> Point:
    """The scene of a number: h/b from 1e-4 to 100, a_m from 1e-8 of the law's range up."""
    generator = random.Random(f"bounds {seed} {number}")
    spread = spreading(generator)
    b, eta = spread(1e-3, 1e2), spread(1e-4, 1e2)
    h, R = b * eta, b * spread(0.1, 1e3)
    mu, nu = spread(1e4, 1e12), generator.uniform(-0.9, 0.49)
    lam = 2 * mu * nu / (1 - 2 * nu)
    a = 0.85 * min(b, R, 6 * h) * spread(1e-8, 1.0)
    # Hertz's share, 2/5; a stiffer or softer law needs not quite this work to come to a.
    work = 0.4 * float(force_of_radius(a, R, lam, mu) * indentation(a, R, h, b))
    m = spread(1e-6, 1e6)
    return R, m, math.sqrt(2 * work / m), h, b, lam, mu


def truth(point: Point) -> SceneTruth:
    """What oracle 1 says of an impact."""
    balls = ORACLE(*point, digits=DIGITS)
    return SceneTruth(point, tuple(ball.str(_WRITTEN, radius=False) for ball in balls))


def truths(
    count: int, known: Sequence[SceneTruth] = (), seed: int = SEED, tell: Tell | None = None
) -> Iterator[SceneTruth]:
    """The first `count` scenes' truths, one by one; those already known are not sought again.

    Parameters
    ----------
    tell
        Called before each that is sought, with its number and how many there will be.
    """
    found = {_written(t.point): t for t in known}
    for number in range(count):
        point = scene(number, seed)
        if _written(point) in found:
            yield found[_written(point)]
            continue
        if tell is not None:
            tell("oracle", number + 1, count)
        yield truth(point)


def _written(point: Point) -> tuple[str, ...]:
    """A scene's numbers to 11 digits: the last ones of its speed follow those of the generated law.

    A truth on record is one of the point on record.
    """
    return tuple(f"{x:.10e}" for x in point)


def errors(values: Iterable[float], true: SceneTruth) -> tuple[float, ...]:
    """Relative errors of the results, the truth's own radius added."""
    with flint.ctx.workprec(256):
        return tuple(
            float((abs(flint.arb(value) / flint.arb(text) - 1) + 10.0**-DIGITS).abs_upper())
            if math.isfinite(value)
            else math.inf
            for value, text in zip(values, true.values, strict=True)
        )


def judge(
    known: Sequence[SceneTruth], solve: Solve, tolerances: Sequence[float] = TOLERANCES
) -> tuple[BoundRow, ...]:
    """Every scene at every tolerance, gathered by method in order of first use.

    Raises
    ------
    ValueError
        If a bound does not meet the tolerance, or a scene is refused.
    """
    worst: dict[str, BoundRow] = {}
    for rtol in tolerances:
        for true in known:
            values, method, bound = solve(true.point, rtol)
            if not bound <= rtol:
                raise ValueError(f"{method} states {bound} for {rtol} at {true.point}")
            found = errors(values, true)
            error = max(found)
            before = worst.get(method)
            ratio, runs = error / bound, 1 + (before.runs if before else 0)
            if before is None or ratio > before.ratio:
                quantity = QUANTITIES[found.index(error)]
                worst[method] = BoundRow(method, runs, ratio, error, bound, quantity, true.point)
            else:
                worst[method] = replace(before, runs=runs)
    return tuple(worst.values())


def to_json(known: Sequence[SceneTruth], rows: Sequence[BoundRow]) -> str:
    """Truths and rows as JSON, one to a line."""
    head = {"digits": DIGITS, "seed": SEED, "python-flint": flint.__version__}
    parts = [f'"{name}": {json.dumps(value)}' for name, value in head.items()]
    listed: tuple[tuple[str, Sequence[BoundRow] | Sequence[SceneTruth]], ...]
    listed = ("rows", rows), ("truths", known)
    for name, items in listed:
        body = ",\n ".join(json.dumps(plain(asdict(item))) for item in items)
        parts.append(f'"{name}": [\n {body}\n]')
    return "{" + ",\n".join(parts) + "}\n"


def from_json(text: str) -> list[SceneTruth]:
    """The truths of a file, none if they are of other digits."""
    data: dict[str, Any] = json.loads(text)
    if data["digits"] != DIGITS:
        return []
    return [SceneTruth(tuple(t["point"]), tuple(t["values"])) for t in data["truths"]]
