"""A measurement in a few lines: the cheapest methods and the headline."""

from collections.abc import Mapping
from typing import Any

from derivation.plate.benchmark.headline import DIGITS

COLUMNS = ("task", "#digits", "method", "#ns a point", "#relative time", "ties")
CASES = ("paper", "scene")
"""Regimes shown: the paper's, or the scene in its place."""

WANTED = 12
"""Digits that the direct sum is to reach in the headline."""


def cells(data: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the table of winners in arrays, in the case asked for."""
    return [
        (
            found["task"], str(found["digits"]),
            ", ".join(part for part in (found["family"], found["setting"]) if part),
            f"{1e9 * found['seconds']:.3g}", f"{found['relative']:.3g}", ", ".join(found["ties"]),
        )
        for found in data["pareto"]
        if found["kind"] == "vector" and found["regime"] in CASES
    ]  # fmt: skip


def headline(data: Mapping[str, Any]) -> str:
    """The generated law against direct summation."""
    found = data["headline"]
    if not found["reached"]:
        return (
            f"direct sum of {found['modes']} modes to fewer than {DIGITS[0]} digits; generated law "
            f"to {found['digits']:.1f} digits: {1e9 * found['called']:.3g} ns"
        )
    best = found["reached"][-1]
    short = "" if best["digits"] >= WANTED else f" ({WANTED} only in a full run)"
    return (
        f"direct sum to {best['digits']} digits{short}: {best['modes']} modes, "
        f"{best['seconds']:.3g} s a point; generated law to {found['digits']:.1f} digits: "
        f"{1e9 * found['called']:.3g} ns; ratio {best['seconds'] / found['called']:.2g}"
    )
