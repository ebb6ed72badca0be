"""Summary of a measurement: the fastest methods and the headline."""

from collections.abc import Mapping
from typing import Any

from derivation.plate.benchmark.headline import DIGITS

COLUMNS = ("task", "#digits", "method", "#ns a point", "#relative time", "ties")
CASES = ("paper", "scene")
"""Test cases shown: the paper's, or the scene in its place."""

REQUIRED_DIGITS = 12
"""Number of digits required of the direct sum in the headline."""


def cells(data: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """Return the rows of the table of fastest methods for arrays, in the paper's case or scene."""
    return [
        (
            row["task"], str(row["digits"]),
            ", ".join(part for part in (row["family"], row["setting"]) if part),
            f"{1e9 * row['seconds']:.3g}", f"{row['relative']:.3g}", ", ".join(row["ties"]),
        )
        for row in data["pareto"]
        if row["kind"] == "vector" and row["case"] in CASES
    ]  # fmt: skip


def headline(data: Mapping[str, Any]) -> str:
    """Return a comparison of the generated law with direct summation as text."""
    measured = data["headline"]
    if not measured["direct_sum"]:
        return (
            f"direct sum of {measured['modes']} modes to fewer than {DIGITS[0]} digits; generated "
            f"law to {measured['digits']:.1f} digits: {1e9 * measured['seconds_with_setup']:.3g} ns"
        )
    best, own = measured["direct_sum"][-1], measured["seconds_with_setup"]
    short = "" if best["digits"] >= REQUIRED_DIGITS else f" ({REQUIRED_DIGITS} only in a full run)"
    return (
        f"direct sum to {best['digits']} digits{short}: {best['modes']} modes, "
        f"{best['seconds']:.3g} s a point; generated law to {measured['digits']:.1f} digits: "
        f"{1e9 * own:.3g} ns; ratio {best['seconds'] / own:.2g}"
    )
