"""Models and scenes that several tests use."""

import json
import random
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import derivation.scene
from derivation.scene import Result, load, read, simulate
from derivation.scene.effects import BY_NAME
from derivation.scene.model import Model

EXAMPLES = Path(derivation.scene.__file__).parent / "examples"
PAPER = EXAMPLES / "paper.toml"
AT_REST = {"inertia": False}
"""Effects of a scene whose plate is quasi-static."""
TWO_CONTACTS = """
[sphere]
radius = 0.02
material = "steel"
[plate]
radius = 0.2
thickness = 0.01
material = "aluminium"
[impact]
speed = 1.0
[effects]
inertia = true
[inertia]
modes = 8
"""
"""A scene file with a sphere that touches the plate twice."""
_MORE = "inertia", "damping", "plasticity", "stretching"
ALL = frozenset(name for name, e in BY_NAME.items() if e.selectable and name not in _MORE)
"""Every effect of a quasi-static, elastic law; the plate of `model` is simply supported."""


@cache
def result_of(example: Path) -> Result:
    """Return the simulation of a scene file, which several tests need."""
    return simulate(load(example))


def model(**changes: Any) -> Model:
    """Return the model of an elastic sphere on a plate, with some fields replaced."""
    values: dict[str, Any] = {
        "R": 0.1, "m": 3.0, "v0": 1.0, "h": 0.02, "b": 0.5, "lam": 2e9, "mu": 3e9,
        "sphere_modulus": 5e10, "gravity": 9.81, "edge": "simply-supported",
    }  # fmt: skip
    return Model(**{**values, **changes})


def scene(**tables: Mapping[str, Any]) -> Any:
    """Return a similar scene with a glass sphere; keys are replaced, or removed if None."""
    tables_used: dict[str, dict[str, Any]] = {
        "sphere": {"radius": 0.1, "mass": 3.0, "material": "glass"},
        "plate": {
            "radius": 0.5, "half_thickness": 0.02, "lame_lambda": 2e9, "lame_mu": 3e9,
            "edge": "simply-supported",
        },
        "impact": {"speed": 1.0, "gravity": 9.81},
        "effects": dict(AT_REST),
    }  # fmt: skip
    for name, keys in tables.items():
        merged = tables_used.get(name, {}) | dict(keys)
        tables_used[name] = {k: v for k, v in merged.items() if v is not None}
    return read(tables_used)


def lame(ratio: float) -> tuple[float, float]:
    """Return Lame's constants over mu, from Poisson's ratio."""
    return 2.0 * ratio / (1.0 - 2.0 * ratio), 1.0


def material(ratio: float) -> Fraction:
    """Return gam = mu/(lam + 2 mu), from Poisson's ratio."""
    return (1 - 2 * Fraction(ratio)) / (2 * (1 - Fraction(ratio)))


def random_models(count: int) -> Iterator[Model]:
    """Yield models with random thickness, speed, sphere modulus and gravity."""
    generator = random.Random(4)
    for _ in range(count):
        yield model(
            h=10 ** generator.uniform(-3, 0.5), v0=10 ** generator.uniform(-3, 1),
            sphere_modulus=10 ** generator.uniform(9, 12), gravity=generator.choice([0.0, 9.81]),
        )  # fmt: skip


def changed(**tables: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Return a valid scene with Hertz's pressure; keys are replaced, or removed if None."""
    tables_used: dict[str, dict[str, Any]] = {
        "sphere": {"radius": 0.13, "mass": 72.0},
        "plate": {"radius": 1.0, "thickness": 0.2, "lame_lambda": 0.36e9, "lame_mu": 0.43e9},
        "impact": {"speed": 1.0},
        "effects": {"spherical_profile": False, "non_hertzian_pressure": False} | AT_REST,
    }
    for name, keys in tables.items():
        tables_used[name] = {
            k: v for k, v in (tables_used.get(name, {}) | dict(keys)).items() if v is not None
        }
    return tables_used


def written(folder: Path, tables: Mapping[str, Mapping[str, Any]]) -> Path:
    """Write a scene to a file in a folder and return its path."""
    path = folder / "scene.toml"
    parts = (
        f"[{table}]\n" + "".join(f"{key} = {json.dumps(value)}\n" for key, value in keys.items())
        for table, keys in tables.items()
    )
    path.write_text("\n".join(parts))
    return path


def thick(speed: float = 1.0, size: float = 1e6) -> Any:
    """Return a scene with so large a plate that Hertz's law of the half-space applies."""
    return read(changed(plate={"radius": size, "thickness": 2 * size}, impact={"speed": speed}))
