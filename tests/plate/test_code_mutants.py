"""Generated code of the contact law with one thing wrong, in memory: the oracles notice it."""

import ast
import math
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from types import CodeType, ModuleType
from typing import Any

import numpy as np
import pytest
from mutants import CodeMutant, of_module
from sensitivity_table import ROWS, scene_in, sensitivities_of

import generated
from derivation.engine.files import ROOT
from derivation.plate import oracle as balls
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import forces as contact_forces
from derivation.plate.impact.oracle import impact as contact_impact

Point = tuple[float, ...]
Numbers = Mapping[str, float]
TOLERANCE = 1e-12
"""Some thousand units in the last place: what is noticed is no rounding."""
LAME = 0.36e9, 0.43e9


class Case:
    """A function at some points, and what an oracle gives there."""

    def __init__(
        self,
        function: str | Callable[[ModuleType], Callable[..., Any]],
        points: Sequence[Sequence[float]],
        true: Any,
        least: float = 0.0,
        tolerance: float = TOLERANCE,
    ) -> None:
        """Errors are relative to the larger of what is true and `least`."""
        self.function, self.least, self.tolerance = function, least, tolerance
        self.arguments = tuple(np.array(column) for column in zip(*points, strict=True))
        self.true = np.array(true, dtype=float).T

    def holds(self, module: ModuleType) -> bool:
        """All points at once, the first two, and the first as scalars, which are treated apart."""
        named = isinstance(self.function, str)
        function = getattr(module, self.function) if named else self.function(module)
        for count in (None, 2):
            found = np.asarray(function(*(column[:count] for column in self.arguments)))
            if not self._close(found, self.true[..., :count]):
                return False
        first = np.asarray(function(*(float(column[0]) for column in self.arguments)))
        return self._close(first, self.true[..., 0])

    def _close(self, found: np.ndarray, true: np.ndarray) -> bool:
        if found.shape != true.shape:
            return False
        with np.errstate(invalid="ignore"):
            allowed = self.tolerance * np.maximum(np.abs(true), self.least)
            close = np.isfinite(true) & (np.abs(found - true) <= allowed)
        return bool((close | (found == true) | (np.isnan(found) & np.isnan(true))).all())


USERS: Mapping[str, Sequence[str]] = {
    "contact_points": ("contact_law",),
    "contact_series": ("contact_law", "contact_thickness", "sensitivity"),
    "contact_thickness": ("sensitivity",),
}
"""Modules by whose functions another one is judged, in the order of their imports."""


def compiled(tree: ast.Module | str, name: str) -> ModuleType:
    """A module of the package from changed text, beside the others as they are.

    It has the functions of its users too, which import it.
    """
    whole = ModuleType(name)
    with pytest.MonkeyPatch.context() as patch:
        for part in (name, *USERS.get(name, ())):
            module = ModuleType(f"generated.{part}")
            module.__package__ = generated.__name__
            exec(code_of(part) if part != name else _code(tree, name), module.__dict__)
            patch.setitem(sys.modules, module.__name__, module)
            vars(whole).update(vars(module))
    return whole


@cache
def code_of(name: str) -> CodeType:
    return _code((ROOT / "generated" / f"{name}.py").read_text(), name)


def _code(tree: ast.Module | str, name: str) -> CodeType:
    return compile(tree, f"<mutant of {name}>", "exec")


def survivors(name: str, cases: Sequence[Case]) -> Iterator[str]:
    text = (ROOT / "generated" / f"{name}.py").read_text()
    assert all(case.holds(compiled(text, name)) for case in cases)
    for mutant in of_module(text):
        if survives(mutant, name, cases):
            yield mutant.name


def survives(mutant: CodeMutant, name: str, cases: Sequence[Case]) -> bool:
    """Whether it passes; one that raises an error does not."""
    with np.errstate(all="ignore"):
        try:
            module = compiled(mutant.tree, name)
            return all(case.holds(module) for case in cases)
        except (ArithmeticError, LookupError, TypeError, ValueError, NameError, AttributeError):
            return False


# --- what the oracles say


def by_chain(name: str, points: Sequence[dict[str, float]], outside: Sequence[Numbers]) -> Case:
    true = [float(balls.truth(name, point, 20)) for point in points]
    values = [tuple(point.values()) for point in (*points, *outside)]
    return Case(name, values, [*true, *(math.nan for _ in outside)])


def influence_cases() -> list[Case]:
    """Thin to thick: to where e^(-T) underflows, though what it is part of does not.

    And both sides of where the domain begins, at phi h = 1e-151 or T = 1e-151.
    """
    thinnest, too_thin = {"phi": 1.5e-151, "h": 1.0}, {"phi": 1e-100, "h": 1e-100}
    T = [{"T": x} for x in (0.7, 0.02, 2.5, 30.0, 200.0, 352.5, 705.0, 1.5e-151)]
    elastic = [(1.3, 0.7), (-0.5, 0.8), (-1.8, 3.0), (1.3, 0.7), (-1.9e-30, 3e-30)]
    sizes = (0.7, 0.02, 2.5, 40.0, 705.0)
    faces = [
        {"phi": 2 * x, "h": 0.25, "lam": lam, "mu": mu}
        for x, (lam, mu) in zip(sizes, elastic, strict=True)
    ]
    faces.append({"phi": 735.0 * 2, "h": 0.25, "lam": 1e-30, "mu": 1e-30})
    faces.append(faces[0] | thinnest)
    K = [{"phi": 2 * x, "h": 0.25, "b": 0.6, "R": 0.7, "J1": 0.4} for x in sizes]
    K += [{"phi": 1470.0, "h": 0.25, "b": 1e-20, "R": 1e-20, "J1": 1.0}, K[0] | thinnest]
    return [
        *(
            by_chain(name, T, [{"T": 0.0}, {"T": -1.0}, {"T": 0.9e-151}])
            for name in ("G", "G_m", "G_minus_1", "G_slope")
        ),
        *(
            by_chain(
                name,
                faces,
                [faces[0] | wrong for wrong in ({"lam": -0.7, "mu": 1.0}, {"mu": -1.0}, too_thin)],
            )
            for name in ("C_top", "C_bottom")
        ),
        *(
            by_chain(name, K, [K[0] | too_thin, *(K[0] | {key: 0.0} for key in K[0])])
            for name in ("K_j", "K_j_bottom")
        ),
    ]


def by_balls(
    name: str,
    points: Sequence[Point],
    oracle: Callable[..., Any],
    outside: Sequence[Point] = (),
    tolerance: float = TOLERANCE,
) -> Case:
    true = [*(float(oracle(*p, digits=18)) for p in points), *(math.nan for _ in outside)]
    return Case(name, [*points, *outside], true, tolerance=tolerance)


# a, R, h, b: thin, medium, thick, and on to the end of where the law holds, 6 h.
PLATES: Sequence[Point] = [
    (0.004, 0.13, 0.01, 1.0), (0.05, 0.9, 0.05, 0.3), (0.1, 0.3, 9.0, 1.0), (0.05, 0.13, 0.01, 1.0),
    (0.041, 0.13, 0.01, 1.0), (0.0599, 0.13, 0.01, 1.0), (0.29, 0.9, 0.06, 0.3),
    (0.041, 0.13, 0.01, 0.045), (0.0305, 0.13, 0.01, 0.08),
]  # fmt: skip
BEYOND: Sequence[Point] = [(0.2, 0.13, 0.05, 1.0), (0.2, 0.9, 0.05, 0.19), (-0.1, 0.9, 0.05, 1.0)]
"""More than R, than b, and less than 0."""
PAST: Sequence[Point] = [(0.0605, 0.13, 0.01, 0.08)]
"""A contact beyond 6 h, which has an indentation and is no answer."""
DEEP: Sequence[Point] = [(210.0, 0.13, 0.01, 1.0), (0.5, 0.3, 0.5, 0.2), (-0.1, 0.9, 0.05, 1.0)]
SOLIDS: Sequence[Point] = [
    (0.2, 1.3, *LAME), (0.1, 0.7, 2e9, 1e9), (0.3, 0.8, -0.5, 0.8), (0.3, 0.8, -1.8, 3.0),
    (1e-3, 0.7, 0.1, 1.2e308),
]  # fmt: skip
NO_SOLIDS: Sequence[Point] = [(0.3, 0.8, -0.7, 1.0), (0.3, 0.8, 1.0, -1.0), (-0.3, 0.8, *LAME)]


@cache
def law_cases() -> list[Case]:
    depths, past = (
        [(float(contact_balls.indentation(*p, digits=18)), *p[1:]) for p in points]
        for points in (PLATES, PAST)
    )
    forces = [(float(contact_forces.force_of_radius(*p, digits=18)), *p[1:]) for p in SOLIDS]
    return [
        by_balls("indentation", PLATES, contact_balls.indentation, BEYOND),
        by_balls("indentation", PLATES, contact_balls.indentation),
        by_balls("contact_radius", depths, contact_balls.contact_radius, [*past, *DEEP]),
        Case("contact_radius", [(-0.0, *p[1:]) for p in PLATES], [0.0] * len(PLATES)),
        by_balls("force", [(*p, *LAME) for p in depths], contact_forces.force),
        by_balls("stiffness", [(*p, *LAME) for p in PLATES], contact_balls.stiffness,
                 [(*p, *LAME) for p in BEYOND]),
        by_balls("force_of_radius", SOLIDS, contact_forces.force_of_radius, NO_SOLIDS),
        by_balls("max_pressure", SOLIDS, contact_forces.max_pressure, NO_SOLIDS),
        by_balls("radius_of_force", forces, contact_forces.radius_of_force, NO_SOLIDS),
    ]  # fmt: skip


ONE_PLATE = 0.9, 0.06, 0.3
"""R, h, b."""
NEAR, FURTHER, FAR = (0.004, 0.029), (0.031, 0.1, 0.17), (0.19, 0.25, 0.29)
"""Radii that the short polynomial serves, the first one, and the second."""


def on_one_plate(module: ModuleType) -> Callable[..., Any]:
    """One sphere and one plate for all radii have a law of their own."""
    return lambda a: module.indentation(a, *ONE_PLATE)


def of_coefficients(module: ModuleType) -> Callable[..., Any]:
    """The indentation over a^2/R by the coefficients that a user gets."""

    def lift(A: np.ndarray, eta: np.ndarray) -> np.ndarray:
        powers = module.plate_coefficients(eta)
        share = np.asarray(A / np.minimum(3, 1 / eta))[..., None] ** 2
        return 1 + A * (powers * share ** np.arange(powers.shape[-1])).sum(axis=-1)

    return lift


def of_second(**several: Sequence[float]) -> Callable[[ModuleType], Callable[..., Any]]:
    """The indentation for the second of several spheres or plates."""

    def function(module: ModuleType) -> Callable[..., Any]:
        scene = dict(zip("Rhb", ONE_PLATE, strict=True)) | several
        return lambda a: module.indentation(np.asarray(a)[..., None], **scene)[..., 1]

    return function


def series_cases() -> list[Case]:
    return [*law_cases(), *piece_cases(), *end_cases(), *sensitivity_cases()]


@cache
def piece_cases() -> list[Case]:
    """Every table of the law on both sides of its ends."""
    radii = [NEAR, (*FURTHER, *NEAR), (*FAR, *NEAR, *FURTHER), FAR]
    depths = {
        a: float(contact_balls.indentation(a, *ONE_PLATE, digits=18))
        for a in (*NEAR, *FURTHER, *FAR)
    }
    nowhere = [(-0.1,), (0.31,), (math.nan,)]
    R, h, b = ONE_PLATE
    others = [(2 * R, h, b), (R, 0.05, b)]
    beside = [
        [float(contact_balls.indentation(a, *other, digits=18)) for a in NEAR] for other in others
    ]
    plates = [(A, 50.0, 1.0, v) for v in (3.3, 5.0, 9.0, 20.0) for A in (0.4, 2.8, 3.2, 4.9, 6.5)
              if v > A]  # fmt: skip
    inner = [(A, 1 / v) for A, _, _, v in plates if A < 3]
    lifts = [float(contact_balls.indentation(A, 1, 1, v, digits=18)) / A**2 for A, v in
             ((A, 1 / eta) for A, eta in inner)]  # fmt: skip
    return [
        Case(of_second(R=[R, 2 * R]), [(a,) for a in NEAR], beside[0]),
        Case(of_second(h=[h, 0.05]), [(a,) for a in NEAR], beside[1]),
        *(Case(on_one_plate, [(a,) for a in some], [depths[a] for a in some]) for some in radii),
        Case(on_one_plate, [(NEAR[0],), *nowhere], [depths[NEAR[0]], *([math.nan] * 3)]),
        by_balls("indentation", plates, contact_balls.indentation),
        by_balls("stiffness", [(*p, *LAME) for p in plates], contact_balls.stiffness),
        Case(of_coefficients, inner, lifts),
    ]


@cache
def end_cases() -> list[Case]:
    """Where the law ends, and where the short polynomial does."""
    thinnest = 1.5e-90
    bent = 1 + 0.5 / (4 * math.pi * thinnest**2)
    """F of a thin plate, but for a share of eta^2 log(eta)."""
    ends = [(0.5, thinnest), (0.5, 0.9e-90), (0.0, 1.1e90)]
    wide = (6.0, 50.0, 1.0, 20.0)
    deepest = float(contact_balls.indentation(*wide, digits=18)) * (1 + 7e-16)
    return [
        Case(of_coefficients, ends, [bent, math.nan, math.nan]),
        Case("contact_radius", [(deepest, *wide[1:])], [wide[0]]),
        by_balls(
            "indentation", [(4.0, 50.0, 1.0, 1e6), (3.2, 50.0, 1.0, 9.0)], contact_balls.indentation
        ),
        by_balls(
            "indentation", [(0.498, 1.0, 1.0, 3.1)], contact_balls.indentation, tolerance=4e-15
        ),
        by_balls("indentation", [(6.5, 50.0, 1.0, 1 / 1.5e-5)], contact_balls.indentation),
    ]


@cache
def sensitivity_cases() -> list[Case]:
    slopes = [float(contact_balls.slope(*p, 22)) for p in PLATES]
    sure = [np.array(sensitivities_of(row), dtype=float).T for row in ROWS]
    nowhere = [(0.13, 1.0, 1e9, 0.1, 1.0, *LAME), (0.13, -1.0, 1.0, 0.1, 1.0, *LAME)]
    lost = [np.full((7, 4), math.nan)] * len(nowhere)
    return [
        Case("indentation_slope", [*PLATES, *BEYOND], [*slopes, *([math.nan] * len(BEYOND))]),
        Case(
            "impact_sensitivities",
            [*map(scene_in, ROWS), *nowhere],
            np.array([*sure, *lost]),
            least=1.0,
        ),
    ]


# R, m, v0, h, b
IMPACTS = [(0.13, 72.2, 1.0, 0.1, 1.0, *LAME), (0.13, 72.2, 1.0, 10.0, 1.0, *LAME),
           (2.0, 3e4, 12.0, 0.06, 0.6, *LAME)]  # fmt: skip
SLOW = [(0.13, 0.5, 1e-4, 0.1, 1.0, *LAME)]
SEAMS = [(2.0, 3e4, v0, 0.06, 0.6, *LAME) for v0 in (7.2, 7.5, 50.0)]
SEAMS += [(2.0, 3e4, 2.05, 0.06, 0.2, *LAME)]
"""On both sides of the first polynomial's end, a = 3 h, and before the last one's, 6 h."""
TOO_FAST = [
    (2.0, 3e4, 51.5, 0.06, 0.6, *LAME),
    (0.13, 72.2, 1e9, 0.1, 1.0, *LAME),
    (0.13, -1.0, 1.0, 0.1, 1.0, *LAME),
]


@cache
def impact_cases() -> list[Case]:
    every = [*IMPACTS, *SLOW, *SEAMS]
    found = [[float(x) for x in contact_impact.impact(*p, digits=18)] for p in every]
    nowhere = [[math.nan] * 4] * len(TOO_FAST)
    return [Case("impact", [*every, *TOO_FAST], [*found, *nowhere]), *map(by_history, IMPACTS)]


def by_history(scene: Point) -> Case:
    """Radii shortly after the start, half way and near the deepest, when they are reached."""
    time, _, _, largest = (float(x) for x in contact_impact.impact(*scene, digits=18))
    R, m, v0, h, b, lam, mu = scene
    radii = [0.3 * largest, 0.7 * largest, 0.97 * largest]
    times = [float(x) for x in contact_impact.history(radii, *scene, digits=18)]
    energy = [float(contact_impact.stored_energy(a, R, h, b, lam, mu, digits=18)) for a in radii]
    rows = [
        (
            float(contact_balls.indentation(a, R, h, b, digits=18)),
            math.sqrt(v0**2 - 2 * work / m),
            a,
            float(contact_forces.force_of_radius(a, R, lam, mu, digits=18)),
        )
        for a, work in zip(radii, energy, strict=True)
    ]
    again = [(depth, -speed, a, load) for depth, speed, a, load in rows]
    start, free = (0.0, v0, 0.0, 0.0), [(0.0, v0, 0.0, 0.0), (0.0, -v0, 0.0, 0.0)]
    moments = [0.0, *times, *(time - t for t in times), -0.1 * time, 1.1 * time]
    return Case("history", [(t, *scene) for t in moments], [start, *rows, *again, *free])


GUARDS = "kept out of sight: what it gives is not used, or another guard says the same"
START = "where the iteration starts, or whether it does from an end that is safe"
ORDER = "how fast the iteration converges, not to what"
SIZE = "how many are worked on at a time"
BEYOND_ALL = "beyond it nothing changes in double precision"
PROMISES = "a promise about the module, not used in it"
SAME = "the same number"

OUTER = "exponent * residual * (1.0 + 0.5 * (exponent - 1.0) * residual)"
INNER = "1.0 + 0.5 * (exponent - 1.0) * residual"
HALLEY = [
    f"{OUTER} -> {OUTER.replace('* (1', '/ (1')}",
    f"{INNER} -> {INNER.replace('+', '-')}",
    "0.5 * (exponent - 1.0) -> 0.5 / (exponent - 1.0)",
    "0.5 -> 1.0 in 0.5 * (exponent - 1.0)",
    "exponent - 1.0 -> exponent + 1.0",
    "1.0 -> 2.0 in exponent - 1.0",
    "0.3 -> 0.6 in np.clip(1.0 + step, 0.3, 3.0)",
    "3.0 -> 6.0 in np.clip(1.0 + step, 0.3, 3.0)",
]
"""Halley's share of the step, and the clip of a step too far."""
STEPS = ["_STEPS: 60 -> 120 in _STEPS = 60", "_CLOSE: 1e-09 -> 2e-09 in _CLOSE = 1e-09"]
THIN = "1.0 / np.cbrt(eps * linear)"

EQUIVALENT: Mapping[str, Mapping[str, Sequence[str]]] = {
    "influence": {
        BEYOND_ALL: [
            f"{name}: {change} in {where}"
            for name, T in (
                *((name, "T") for name in ("G", "G_m", "G_minus_1", "G_slope")),
                *((name, "h * phi") for name in ("C_top", "C_bottom", "K_j", "K_j_bottom")),
            )
            for change, where in (
                ("1000000000 -> 2000000000", f"np.minimum({T}, 1000000000)"),
                ("5e-324 -> 1e-323", f"np.maximum(np.minimum({T}, 1000000000), 5e-324)"),
            )
        ],
        SAME: ["G_slope: -np.expm1(-2 * T) -> np.expm1(-2 * T)"],  # it is squared
    },
    "contact_law": {
        ORDER: [*STEPS, *(f"_invert: {change}" for change in HALLEY[-2:])],
        START: [
            "_invert: 0.0 -> 1 in np.maximum(plates.first.coefficients[0][pick], 0.0)",
            f"_invert: 1.0 -> 2.0 in {THIN}",
            f"_invert: 1.0 -> 2.0 in np.minimum({THIN}, 1.0)",
        ],
        GUARDS: [
            "indentation: 0 -> 1 in radius.min() >= 0",  # the slow way to the same
            "_contact: ROUNDED * b -> ROUNDED / b",
            "_plates: 1.0 -> 2.0 in np.where(sound, b, 1.0)",
        ],
    },
    "contact_points": {
        SIZE: ["flat: 1 -> 2 in np.prod(shape) != 1", "cut: 0 -> 1 in x.strides[0] == 0"],
    },
    "contact_series": {
        SIZE: [
            "_BLOCK: 32768 -> 65536 in _BLOCK = 32768",
            "_MODE_BLOCK: 4096 -> 8192 in _MODE_BLOCK = 4096",
            "direct: 1 -> 2 in max(1, 65536 // min(zeros.size, _MODE_BLOCK))",
            "direct: 65536 -> 131072 in 65536 // min(zeros.size, _MODE_BLOCK)",
        ],
        GUARDS: [  # the slow way to the same; and both polynomials hold at their common end
            *(
                f"{name}: {low} -> 2{low[1:]} in ({ends})"
                for name, ends in (("_ORDINARY", "1e-100, 1e+100"), ("_USUAL", "1e-20, 1e+20"))
                for low in ends.split(", ")
            ),
            *(
                f"{name}: reach * ROUNDED -> reach / ROUNDED"
                for name in ("sphere_on_plate", "correction", "correction_with_slope")
            ),
        ],
        BEYOND_ALL: [
            "direct: int(3.9 / eta) + 2 -> int(3.9 / eta) - 2",
            "direct: 3.9 -> 7.8 in 3.9 / eta",
            "direct: 2 -> 4 in int(3.9 / eta) + 2",
        ],
        SAME: [
            "_tabulated: rows[-1] + 0.0 * tau -> rows[-1] - 0.0 * tau",
            "horner: coefficients[-1] + 0.0 * t -> coefficients[-1] - 0.0 * t",
            "with_slopes: piece.coefficients[-1] + 0.0 * t -> piece.coefficients[-1] - 0.0 * t",
            "with_slopes: 0.0 * t -> 0.0 / t",
        ],
    },
    "contact_thickness": {},
    "sensitivity": {
        SAME: [
            (
                f"_near_sums: {last}[-1][:, None] + 0.0 * s -> {last}[-1][:, None] - 0.0 * s"
            ) for last in ("(2 * count + 1) * law.terms", "law.tails")
        ] + 2 * ["_near_sums: 0.0 * s -> 0.0 / s"],
    },
    "impact": {
        PROMISES: [
            "(COARSE_QUADRATURE, FULL_QUADRATURE): 9e-09 -> 1.8e-08 in (9e-09, 1e-14)",
            "(COARSE_QUADRATURE, FULL_QUADRATURE): 1e-14 -> 2e-14 in (9e-09, 1e-14)",
            "ROUNDING: 4e-14 -> 8e-14 in ROUNDING = 4e-14",
        ],
        ORDER: [
            *STEPS,
            *(f"_deepest: {change}" for change in HALLEY),
            "_state: 0.1 -> 0.2 in 0.1 * w",
            "_state: 1.0 -> 2.0 in np.clip(w + 2.0 * time * residual / slope, 0.1 * w, 1.0)",
            "_state: _CLOSE * goal -> _CLOSE / goal",
            "_far_deepest: _CLOSE * goal -> _CLOSE / goal",
        ],
        START: [
            "_state: 0.5 * whole[owner] -> 0.5 / whole[owner]",
            "_state: 0.5 -> 1.0 in 0.5 * whole[owner]",
            (
                "_state: np.minimum(goal / np.sqrt(half), 1.0) -> "
                "np.maximum(goal / np.sqrt(half), 1.0)"
            ),
            "_state: goal / np.sqrt(half) -> goal * np.sqrt(half)",
            "_state: np.sqrt(half) -> np.cbrt(half)",
            "_state: 1.0 -> 2.0 in np.minimum(goal / np.sqrt(half), 1.0)",
            "_deepest: 0.0 -> 1 in np.maximum(np.asarray(piece.coefficients[0]), 0.0)",
            "_deepest: 0.4 -> 0.8 in 0.4 / bending",
            "_deepest: 6.0 -> 12.0 in 1.0 / 6.0",
            (
                "_deepest: np.minimum(np.minimum(thin, 1.0), most) -> "
                "np.maximum(np.minimum(thin, 1.0), most)"
            ),
            "_deepest: np.minimum(thin, 1.0) -> np.maximum(thin, 1.0)",
            "_deepest: 1.0 -> 2.0 in np.minimum(thin, 1.0)",
            (
                "_far_deepest: np.minimum(near * (goal / known) ** 0.2, end) -> "
                "np.maximum(near * (goal / known) ** 0.2, end)"
            ),
            "_far_deepest: near * (goal / known) ** 0.2 -> near / (goal / known) ** 0.2",
            "_far_deepest: goal / known -> goal * known",
            "_far_deepest: 0.2 -> 1.2 in (goal / known) ** 0.2",
        ],
        GUARDS: [
            "history: 1.0 -> 2.0 in np.where(t > 0, t, 1.0)",
            "_far_shapes: 1.0 -> 2.0 in np.minimum(q / ratio, 1.0)",
            "_far_shapes: 0.0 -> 1 in np.where(outside, 0.0, left - gap)",
            "_far_shapes: 1.0 -> 2.0 in np.where(outside, 1.0, left)",
            "_solve: 1e+200 -> 2e+200 in np.minimum(np.ravel(hertz / h), 1e+200)",
            "_solve: ROUNDED * b -> ROUNDED / b",
            (
                "_far_deepest: (known + end ** 5 * rise(end)) * ROUNDED -> "
                "(known + end ** 5 * rise(end)) / ROUNDED"
            ),
            "_solve: 1 -> 2 in -1",  # any negative number says that there is none
        ],
        SAME: [
            "_near_shapes: terms[-1][:, None] + 0.0 * s -> terms[-1][:, None] - 0.0 * s",
            "_near_shapes: tails[-1][:, None] + 0.0 * s -> tails[-1][:, None] - 0.0 * s",
            "_near_shapes: 0.0 * s -> 0.0 / s",
            "_near_shapes: 0.0 * s -> 0.0 / s",
        ],
        SIZE: [
            "_SCENES: 512 -> 1024 in _SCENES = 512",
            "_solve: 8 -> 16 in _parts(over_h.size, 8)",
        ],
    },
}  # fmt: skip
"""Mutants that change no result, by the reason; every other one must be noticed."""

CASES: Mapping[str, Callable[[], list[Case]]] = {
    "influence": influence_cases,
    "contact_law": law_cases,
    "impact": impact_cases,
    "contact_points": law_cases,
    "contact_series": series_cases,
    "contact_thickness": sensitivity_cases,
    "sensitivity": sensitivity_cases,
}


@pytest.mark.parametrize("name", CASES)
def test_every_mutant_of_the_code_is_noticed_or_changes_nothing(name: str) -> None:
    named = [mutant for those in EQUIVALENT[name].values() for mutant in those]
    assert sorted(survivors(name, CASES[name]())) == sorted(named)
