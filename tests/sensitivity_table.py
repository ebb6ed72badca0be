"""Sensitivities as the oracle gives them, of scenes on both sides of every switch of the law."""

import json
from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

from derivation.plate.impact.theory.sensitivity import RESULTS, exponents

LAM, MU = 6e10, 8e10
TRUTH = json.loads((Path(__file__).parent / "plate/impact/sensitivity_truth.json").read_text())
"""To 1e-20; see its first line."""
ROWS: Sequence[Mapping[str, Any]] = TRUTH["rows"]


def scene_in(row: Mapping[str, Any]) -> list[float]:
    """R, m, v0, h, b, lam, mu."""
    return [float.fromhex(x) for x in row["scene"]]


def sensitivities_of(row: Mapping[str, Any]) -> list[list[Fraction]]:
    """By result and parameter: v0 stands in the energy number alone, b in h/b alone."""
    share = Fraction(LAM) * Fraction(MU) / (Fraction(LAM + MU) * Fraction(LAM + 2 * MU))
    table = {name: [Fraction(int(x.p), int(x.q)) for x in row] for name, row in exponents().items()}
    found = []
    for name, speed, radius in zip(RESULTS, row["v0"], row["b"], strict=True):
        by_energy, by_eta = Fraction(speed) / 2, -Fraction(radius)
        powers = zip(table[name], table["energy"], table["eta"], strict=True)
        *lengths, modulus = [own + by_energy * e + by_eta * q for own, e, q in powers]
        found.append([*lengths, modulus * share, modulus * (1 - share)])
    return found
