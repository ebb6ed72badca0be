"""Targets of the search: each function with its domain, reference and tolerance."""

import importlib
import inspect
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from flint import arb

from derivation.engine.measure import target
from derivation.engine.measure.kernels import Kernel
from derivation.engine.measure.point import Point
from derivation.engine.measure.target import (
    Domain,
    Numbers,
    Target,
    measure_by,
    named_targets,
)
from derivation.engine.oracle.reference import Reference, exact_reference
from derivation.plate.contact.cases.reference_values import tolerance
from derivation.plate.impact.oracle.agreement import FIRST
from derivation.plate.judge import JUDGE, generated_kernels
from derivation.plate.oracle import certified_value
from derivation.plate.search.draw import (
    CONTACTS,
    LAW,
    domain_of_law,
    domain_of_row,
    draw,
)

ULP_OF_LAW = 8.0
"""Tolerance of the contact law's functions in ULP, before the factor `tolerance`."""

_OF_LAW = 24
"""Number of digits of the contact law's reference."""

_SLOW, _SLOWEST = (1, 16), (1, 32)
_TURNS = {
    "impact": _SLOW, "kappa": _SLOWEST, "finite_part": _SLOWEST, "kappa_ratio": _SLOW,
    "finite_part_ratio": _SLOW, "contact_radius": (1, 1), "indentation": (3, 1),
    "stiffness": (3, 1),
}  # fmt: skip
"""Points per turn, and number of rounds per turn, for slow references."""

_TURN, _TURN_OF_SUMS = (48, 1), (4, 1)


def targets(names: Sequence[str] = ()) -> tuple[Target, ...]:
    """Return the generated functions that can be searched, in a fixed order: all, or those named.

    Raises
    ------
    ValueError
        If no function has one of the names.
    """
    manifest = importlib.import_module("generated.manifest").KERNELS
    closed = zip(manifest, generated_kernels(), strict=True)
    chosen_targets = [closed_target(domain_of_row(row), kernel) for row, kernel in closed]
    chosen_targets += [_law_target(name) for name in LAW]
    return named_targets(chosen_targets, names)


# --- closed formulas, modal sums and tables


def closed_target(domain: Domain, kernel: Kernel) -> Target:
    """Return the target of a function of the manifest, with its budget and conditioning."""
    turn_size, every = _TURNS.get(kernel.name, _TURN_OF_SUMS if kernel.modes else _TURN)
    return target.closed_target(JUDGE, domain, kernel, draw, turn_size, every)


# --- the contact law


def _law_target(name: str) -> Target:
    """Return the target of a function of the contact law, with ULP_OF_LAW as tolerance."""
    module = importlib.import_module(f"generated.{'impact' if name == 'impact' else 'contact_law'}")
    function = getattr(module, name)
    parameters = inspect.signature(function).parameters.values()
    domain = domain_of_law(name, tuple(p.name for p in parameters if p.default is p.empty))

    def call(points: Sequence[Point]) -> list[Numbers]:
        columns = [np.array([p.values[key] for p in points]) for key in domain.arguments]
        if len(points) == 1:  # plain numbers: one plate is computed in another way than many
            columns = [column[0] for column in columns]
        results = function(*columns)
        rows = [np.ravel(row) for row in (results if name == "impact" else (results,))]
        return [tuple(float(row[i]) for row in rows) for i in range(len(points))]

    def references(point: Point) -> list[Reference] | None:
        given = tuple(point.values[key] for key in domain.arguments)
        balls = _reference_values(name, given, domain.arguments)
        if balls is None:
            return None
        scaled = name in ("indentation", "contact_radius", "stiffness")
        scale = tolerance(name, given, float(balls[0])) if scaled else 1.0
        return [exact_reference(ball, scale) for ball in balls]

    turn_size, every = _TURNS.get(name, _TURN)
    measure = measure_by(references, ULP_OF_LAW)
    return Target(domain, draw, call, measure, None, turn_size, every)


@lru_cache(maxsize=8)
def _reference_values(
    name: str, given: Sequence[Any], keys: tuple[str, ...]
) -> tuple[arb, ...] | None:
    """Return the Arb balls; None where the contact is wider than the domain of the functions."""
    values = dict(zip(keys, given, strict=True))
    if name == "force_of_radius":
        return (certified_value("P", values, _OF_LAW),)
    value = FIRST[name](*given, digits=_OF_LAW)
    balls = tuple(value) if name == "impact" else (value,)
    if name in ("indentation", "stiffness"):
        return balls
    inside = balls[-1] < min(values["b"], values["R"], CONTACTS[1] * values["h"])
    return balls if inside else None
