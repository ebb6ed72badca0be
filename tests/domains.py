"""Domains of the generated functions: an example of every argument, and points outside."""

import re
from collections.abc import Iterator, Mapping
from typing import Any

from generated.manifest import CONTACT, KERNELS

ROWS = {row["name"]: row for row in (*KERNELS, *CONTACT)}
TABLES = [name for name, row in ROWS.items() if "count" in row["arguments"]]
POINTWISE = [name for name in ROWS if name not in TABLES]
EXAMPLE = {
    "r": 0.002, "z": 0.004, "phi": 24.0, "h": 0.01, "T": 0.48, "b": 0.1, "R": 0.13, "a": 0.004,
    "lam": 0.36e9, "mu": 0.43e9, "P": 1000.0, "A_j": -1e6, "J1": 0.52, "x": 1.3, "n": 7.0,
    "k": 4.0, "delta": 1e-6, "m": 0.2, "v0": 1.5, "t": 1e-4, "eta": 0.1,
    "a_over_R": 0.03, "a_ratio": 0.4, "alpha": 0.04, "rho": 2500.0,
    "yield_stress": 1e7, "xi_y": 1.7, "viscous_time": 1e-5, "x_v": 0.2, "kap": 0.7, "nu": -0.6,
}  # fmt: skip
Values = Mapping[str, Any]

OUTSIDE = {
    "contact_radius": {"delta": (5.0,)},
    "force": {"delta": (5.0,)},
    "radius_of_force": {"P": (1e9,)},
    "indentation": {"h": (1e-7,)},  # a > 6 h, because the plate is too thin
    "stiffness": {"h": (1e-7,)},
    "force_by_series": {"delta": (1e-4,)},
    "impact": {"v0": (1e4,), "m": (1e9,)},
    "history": {"v0": (1e4,), "m": (1e9,)},
    "kappa": {"n": (0.5, 1e4)},
    "kappa_ratio": {"n": (0.5, 1e6 + 0.5)},
    "finite_part": {"k": (2.5, 1e4)},
    "finite_part_ratio": {"k": (2.5,)},
}
"""Arguments outside a domain because of a condition on the result, or because not integers."""


def conditions(name: str) -> list[str]:
    """Return the conditions of a domain that contain only names of arguments."""
    row = ROWS[name]
    known = {*row["arguments"], "abs", "or", "e"}
    parts = row["domain"].split(", ")
    return [part for part in parts if part and set(re.findall(r"[A-Za-z]\w*", part)) <= known]


def holds(condition: str, values: Values) -> bool:
    return bool(eval(condition, {"abs": abs}, dict(values)))


def violations(name: str) -> Iterator[tuple[str, Values]]:
    """Yield, for each condition, points that violate it and as few others as possible."""
    names = ROWS[name]["arguments"]
    base = {key: EXAMPLE[key] for key in names}
    for condition in conditions(name):
        assert holds(condition, base)
        actual = []
        for key in set(re.findall(r"[A-Za-z]\w*", condition)) & set(names):
            for value in (
                0.0,
                -base[key],
                *(base[key] * 10.0**k for k in (1, 2, 3, -7, 92, -92, -155)),
            ):
                changed = base | {key: value}
                divisible = changed.get("b", 1) != 0
                broken = [c for c in conditions(name) if divisible and not holds(c, changed)]
                if condition in broken or (condition in ("b > 0", "b != 0") and not divisible):
                    actual.append((len(broken), condition, changed))
        fewest = min(count for count, _, _ in actual)
        yield from ((condition, changed) for count, _, changed in actual if count == fewest)
