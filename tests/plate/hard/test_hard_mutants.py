"""Algorithms written by hand with one thing wrong, in memory: hard cases notice it."""

from collections.abc import Mapping

import pytest
from hard_mutants import survivors
from mutated_code import ANYWHERE, GUARDS, SIZE, START

SLOW = "the slow way to the same"
COMMON = "both polynomials hold at their common end"
ZERO = "the sign of zero, of which other tests tell"
MAY_PASS: Mapping[str, Mapping[str, tuple[int, str]]] = {
    "contact_cells": {},
    "contact_domain": dict.fromkeys(("_MANY", "_SAMPLE"), (1, SIZE)),
    "contact_law": {},
    "contact_points": {"flat": (1, SLOW), "cut": (1, SLOW), "pieces": (2, SLOW)},
    "contact_thickness": {},
    "impact": {
        "_state": (6, START),
        "_deepest": (5, START),
        "_far_deepest": (4, f"{START}; and where the law ends, which its own test tells"),
        "_solve": (3, f"{SIZE}; and {GUARDS}"),
        **dict.fromkeys(("_BATCH", "rise"), (1, SIZE)),
    },
    "impact_shapes": {"_POINTS": (1, SIZE), "_far_shapes": (1, GUARDS)},
    "plate_arrays": {
        "_invert": (5, START),
        "_plate_by_plate": (2, SLOW),
        **dict.fromkeys(("_APART", "_indentations"), (1, SLOW)),
        **dict.fromkeys(("_contact", "_forces"), (1, ZERO)),
    },
    "plate_points": {
        "_invert": (8, START),
        "linear": (1, START),
        "_modulus": (4, SLOW),
        **dict.fromkeys(("_ORDINARY", "_USUAL"), (2, SLOW)),
        **dict.fromkeys(("_piece_at", "indentation"), (1, COMMON)),
    },
    "series_constants": {"_looked_up": (1, GUARDS)},
}
"""By module and function or constant, how many mutants may pass at most, and why."""


@pytest.mark.parametrize("name", MAY_PASS)
def test_every_mutant_is_noticed_or_may_pass(name: str) -> None:
    most = {home: count for home, (count, _) in (ANYWHERE | MAY_PASS[name]).items()}
    found = survivors(name)
    assert {home: those for home, those in found.items() if len(those) > most.get(home, 0)} == {}
