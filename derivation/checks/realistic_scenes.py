"""Random scenes as an engineer might write them, and the outcome of their simulation.

Materials range from foam to steel, sphere radii from 1 mm to 0.1 m, and plate thicknesses from
0.5 mm to 0.2 m. Scenes far outside the range of an elastic model are drawn again.
"""

import json
import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from random import Random
from typing import Any, Literal

from derivation.checks.random_scenes import Scene, log_uniform_draw
from derivation.engine.measure.result import CheckResult

SEED = 1
RTOL = 1e-3
"""Relative tolerance of the simulations."""
MOST_REJECTED = 0.15
"""Largest allowed fraction of the runs with `RTOL` that are rejected or incomplete."""
MAX_CONTACT_RADIUS = 0.4
"""Largest contact radius, by Hertz's law, over the sphere radius in a realistic scene."""
PLATES: Mapping[str, tuple[float, float, float]] = {
    "foam": (1e7, 0.3, 100.0),
    "rubber": (5e6, 0.45, 1100.0),
    "polyethylene": (1e9, 0.42, 950.0),
    "wood": (1e10, 0.3, 500.0),
    "lead": (1.6e10, 0.44, 11340.0),
    "titanium": (1.1e11, 0.34, 4500.0),
}
"""Young's modulus [Pa], Poisson's ratio [1] and density [kg/m^3] of unnamed materials."""
NAMED_MATERIALS = ("steel", "glass", "aluminium", "concrete", "PMMA")
"""Materials given by name."""
STIFFNESS = {"steel": 210e9, "glass": 70e9, "aluminium": 70e9, "concrete": 33e9, "PMMA": 3.3e9}
"""Their Young's moduli [Pa], to decide whether a scene is realistic."""
DENSITY = {"steel": 7850.0, "glass": 2500.0, "aluminium": 2700.0, "concrete": 2400.0,
           "PMMA": 1190.0}  # fmt: skip
"""Their densities [kg/m^3], for the same purpose."""
EDGES = ("paper", "simply-supported", "clamped")
VISCOELASTIC_MATERIALS = ("foam", "rubber", "polyethylene")
"""Materials that may be viscoelastic."""
Kind = Literal["finished", "rejected", "incomplete", "NaN", "traceback", "overrun"]
KINDS: tuple[Kind, ...] = ("finished", "rejected", "incomplete", "NaN", "traceback", "overrun")
COLUMNS = ("rtol", "outcome", "#runs", "#fraction", "reason")
"""Column heads of the table."""


@dataclass(frozen=True)
class Outcome:
    """The outcome of a simulation.

    Attributes
    ----------
    kind
        One of `KINDS`: "rejected" before the impact, "incomplete" if stopped during it, "overrun"
        if stopped at the limit of time.
    message
        The reason, if it did not finish; the last lines of a traceback.
    rtol
        Relative tolerance [1]; None for the default.
    scene
        The scene.
    seconds
        Processor time [s]; NaN if the process terminated without a result.
    memory
        Peak memory of the process so far [bytes].
    """

    kind: Kind
    message: str
    rtol: float | None
    scene: Scene
    seconds: float = math.nan
    memory: float = math.nan

    @property
    def group(self) -> str:
        """The key at the beginning of the message."""
        return self.message.partition(":")[0] if self.kind != "finished" else ""

    @property
    def states_remedy(self) -> bool:
        """Whether the message states a remedy after a semicolon, if the run was rejected."""
        if self.kind not in ("rejected", "incomplete"):
            return True
        return bool(self.message.rpartition("; ")[0] and self.message.rpartition("; ")[2].strip())


def scenes(count: int, seed: int = SEED) -> Iterator[Scene]:
    """Yield `count` realistic scenes; the same seed gives the same scenes."""
    generator = Random(seed)
    for _ in range(count):
        scene = _draw(generator)
        while not _realistic(scene):
            scene = _draw(generator)
        yield scene


def _draw(generator: Random) -> Scene:
    """Return a random scene: sphere, plate, impact and effects."""
    spread = log_uniform_draw(generator)
    R = spread(1e-3, 0.1)
    sphere: dict[str, Any] = {"radius": R, "material": generator.choice(NAMED_MATERIALS)}
    if generator.random() < 0.3:  # a rigid sphere, which may be hollow or heavy
        sphere = {"radius": R, "mass": 4.0 / 3.0 * math.pi * R**3 * spread(200.0, 1.2e4)}
    thickness = spread(5e-4, 0.2)
    plate: dict[str, Any] = {"thickness": thickness, "radius": thickness * spread(3.0, 100.0)}
    name = generator.choice((*PLATES, *NAMED_MATERIALS))
    if name in NAMED_MATERIALS:
        plate["material"] = name
    else:
        keys = ("youngs_modulus", "poissons_ratio", "density")
        plate |= dict(zip(keys, PLATES[name], strict=True))
    plate["edge"] = generator.choice(EDGES)
    impact = {"speed": spread(0.01, 50.0)}
    effects: dict[str, Any] = {"inertia": generator.random() < 0.5}
    if generator.random() < 0.3:
        impact["gravity"] = 9.81
    if name in VISCOELASTIC_MATERIALS and generator.random() < 0.3:
        # A fraction of the contact time by Hertz's law.
        scene = {"sphere": sphere, "plate": plate, "impact": impact}
        plate["retardation_time"] = (
            spread(1e-3, 0.3) * 3.0 * _widest(scene) ** 2 * R / impact["speed"]
        )
    if generator.random() < 0.2:
        effects["non_hertzian_pressure"] = True
    return {"sphere": sphere, "plate": plate, "impact": impact, "effects": effects}


def _realistic(scene: Scene) -> bool:
    """Return whether the sphere is smaller than the plate, and the contact than both."""
    R, b = scene["sphere"]["radius"], scene["plate"]["radius"]
    wide = _widest(scene)
    return bool(b > R and wide < MAX_CONTACT_RADIUS and wide * R < 0.5 * b)


def _widest(scene: Scene) -> float:
    """Return the approximate largest contact radius, by Hertz's law, over the sphere radius [1]."""
    sphere, plate, v0 = scene["sphere"], scene["plate"], scene["impact"]["speed"]
    R = sphere["radius"]
    soft = 0.0 if "mass" in sphere else 1.0 / STIFFNESS[sphere["material"]]
    youngs_modulus = plate.get("youngs_modulus") or STIFFNESS[plate["material"]]
    mass = sphere.get("mass") or 4.0 / 3.0 * math.pi * R**3 * DENSITY[sphere["material"]]
    modulus = 1.1 / (1.0 / youngs_modulus + soft)
    return math.pow(15.0 / 16.0 * mass * v0**2 / (modulus * R**3), 0.2)


def passed(outcomes: Sequence[Outcome]) -> bool:
    """Return whether no run failed, each rejection states a remedy, and few runs are rejected."""
    failed = any(outcome.kind in ("NaN", "traceback", "overrun") for outcome in outcomes)
    remedied = all(outcome.states_remedy for outcome in outcomes)
    return not failed and remedied and rejected(outcomes).get(RTOL, 0.0) <= MOST_REJECTED


def rejected(outcomes: Sequence[Outcome]) -> dict[float | None, float]:
    """Return the fraction of runs that were rejected or incomplete, by tolerance."""
    runs = Counter(outcome.rtol for outcome in outcomes)
    stopped = Counter(o.rtol for o in outcomes if o.kind in ("rejected", "incomplete"))
    return {rtol: stopped[rtol] / many for rtol, many in runs.items()}


def cells(outcomes: Sequence[Outcome]) -> list[tuple[str, ...]]:
    """Return the rows of the table: tolerance, outcome, number and fraction of runs, reason."""
    runs = Counter(outcome.rtol for outcome in outcomes)
    groups = Counter((outcome.rtol, outcome.kind, outcome.group) for outcome in outcomes)
    rows: list[tuple[str, ...]] = []
    for rtol, total in runs.items():
        here = [(k, g, many) for (r, k, g), many in groups.items() if r == rtol]
        for kind, group, many in sorted(here, key=lambda x: (KINDS.index(x[0]), -x[2])):
            asked = "default" if rtol is None else f"{rtol:g}"
            rows.append((asked, kind, str(many), f"{100 * many / total:.1f} %", group or "-"))
    return rows


def cost(outcomes: Sequence[Outcome]) -> str:
    """Return processor time and memory of the runs as a sentence."""
    seconds = sorted(o.seconds for o in outcomes if not math.isnan(o.seconds))
    if not seconds:
        return "Processor time and memory of the runs are unknown."
    median, most = (seconds[int(part * (len(seconds) - 1))] for part in (0.5, 0.95))
    memory = max(o.memory for o in outcomes if not math.isnan(o.seconds))
    return (
        f"Processor time of a run: median {median:.2g} s, 95 % below {most:.2g} s, maximum "
        f"{seconds[-1]:.2g} s, total {sum(seconds):.3g} s; peak memory of a process "
        f"{memory / 1e9:.2g} GB."
    )


def failures(outcomes: Sequence[Outcome]) -> list[str]:
    """Return the first message and scene, as TOML in one line, of each group not finished."""
    firsts: dict[tuple[str, str, bool], Outcome] = {}
    for outcome in outcomes:
        if outcome.kind != "finished":
            firsts.setdefault((outcome.kind, outcome.group, outcome.states_remedy), outcome)
    lines = []
    for outcome in firsts.values():
        remedy = "" if outcome.states_remedy else " (no remedy)"
        asked = "" if outcome.rtol is None else f", rtol = {outcome.rtol:g}"
        lines.append(f"{outcome.kind}{remedy}{asked}: {outcome.message.strip()}")
        lines.append(f"  {one_line(outcome.scene)}")
    return lines


def one_line(scene: Scene) -> str:
    """Return a scene as inline tables of TOML, in one line."""
    tables = (
        f"{table} = {{ " + ", ".join(f"{k} = {json.dumps(v)}" for k, v in keys.items()) + " }"
        for table, keys in scene.items()
    )
    return "; ".join(tables)


def as_data(outcomes: Sequence[Outcome], seed: int) -> dict[str, Any]:
    """Return the outcomes as plain data."""
    rows = [
        {
            "kind": outcome.kind,
            "message": outcome.message,
            "remedied": outcome.states_remedy,
            "rtol": outcome.rtol,
            "scene": outcome.scene,
            "seconds": None if math.isnan(outcome.seconds) else outcome.seconds,
            "memory": None if math.isnan(outcome.memory) else outcome.memory,
        }
        for outcome in outcomes
    ]
    stopped = [{"rtol": rtol, "fraction": part} for rtol, part in rejected(outcomes).items()]
    return {"seed": seed, "passed": passed(outcomes), "rejected": stopped, "runs": rows}


def result(outcomes: Sequence[Outcome], count: int, seed: int) -> CheckResult:
    """Return the table of outcomes, with an example of each kind that did not finish."""
    return CheckResult(
        f"Simulations of {count} realistic scenes, seed {seed}",
        COLUMNS,
        cells(outcomes),
        lambda: as_data(outcomes, seed),
        passed(outcomes),
        note=cost(outcomes),
        listings=[("Example of each group that did not finish", failures(outcomes))],
    )
