"""Mutation tests of hand-written algorithms: hard cases detect each error in the code."""

from collections.abc import Mapping

import pytest
from hard_mutants import undetected
from mutated_code import ANYWHERE, FINE, GUARDS, SIZE, START

SAME = "a choice between a fast and a slow computation of the same result"
COMMON = "both polynomials are accurate at their common end"
ZERO = "the sign of a zero, which other tests check"
ENDS = "the end of the range of the law, which `test_contact_kernels` checks"
DOMAIN = "the limits of the domain, which other tests check"
SHAPE = "an array of which only the shape is used"
UNIT = "either elastic constant can be the unit of both"
NEGLIGIBLE = "the number of modes, of which the last ones are below rounding errors"
MAY_PASS: Mapping[str, Mapping[str, tuple[int, str]]] = {
    "back_face": {
        "_evaluated": (7, f"{DOMAIN}; and {UNIT}"),
    },
    "contact_cells": {},
    "contact_domain": dict.fromkeys(("_MANY", "_SAMPLE"), (1, SIZE)),
    "contact_law": {},
    "contact_points": {"flat": (1, SAME), "cut": (1, SAME), "pieces": (2, SAME)},
    "contact_series": {
        **dict.fromkeys(("_ORDINARY", "_USUAL"), (2, SAME)),
        **dict.fromkeys(("correction", "correction_with_slope"), (1, COMMON)),
        "sphere_on_plate": (2, f"{SAME}; {COMMON}"),
        "direct": (5, f"{NEGLIGIBLE}; and {SIZE}"),
        **dict.fromkeys(("(THINNEST, THICKEST)", "ROUNDED"), (2, ENDS)),
        "_beyond": (1, ENDS),
    },
    "contact_thickness": {},
    "edge": {
        **dict.fromkeys(("supported_edge_bound", "clamped_edge_bound"), (1, DOMAIN)),
    },
    "edge_mode_functions": {"grown": (1, "a term that is zero in all hard cases")},
    "edge_curvature": {
        "clamped_edge_curvature": (1, "a contact radius that the result does not depend on")
    },
    "edge_sums": {
        "edge_ratios": (1, DOMAIN),
        "_POINTS": (1, SIZE),
        "elastic_ratios": (1, UNIT),
        "edge_sums": (2, "a switch point at which sum and closed form are both accurate"),
        "_MODES": (1, SIZE),
        "blocks_of_modes": (3, NEGLIGIBLE),
    },
    "impact": {
        "_state": (7, f"{START}; one of them depends on the processor's rounding"),
        "_deepest": (5, START),
        "_far_deepest": (4, f"{START}; and the end of the range, which another test checks"),
        "_solve": (3, f"{SIZE}; and {GUARDS}"),
        **dict.fromkeys(("_BATCH", "rise"), (1, SIZE)),
    },
    "impact_shapes": {"_POINTS": (1, SIZE), "_far_shapes": (1, GUARDS)},
    "mode_sums": {
        "BLOCK": (1, SIZE),
        "power_of_two": (1, "a scale factor that is divided out again"),
    },
    "plate_arrays": {
        "_invert": (5, START),
        "_plate_by_plate": (2, SAME),
        **dict.fromkeys(("_APART", "_at", "_indentations"), (1, SAME)),
        **dict.fromkeys(("_contact", "_forces"), (1, ZERO)),
    },
    "plate_points": {
        "_invert": (6, START),
        "linear": (1, START),
        "_modulus": (3, SAME),
        **dict.fromkeys(("_ORDINARY", "_USUAL"), (2, SAME)),
        **dict.fromkeys(("_piece_at", "indentation"), (1, COMMON)),
    },
    "plate_waves": {
        "_MOST": (1, SIZE),
        "branches": (1, SHAPE),
        "_edges": (2, SHAPE),
        "_between": (8, START),
    },
    "prepared_plate": {},
    "reversed_series": {
        **dict.fromkeys(("_CIRCLE", "_TOGETHER"), (1, FINE)),
        "_reversed": (10, f"{FINE}; and {START}"),
        "force_by_series": (1, "the smallest number of terms, which another test checks"),
    },
    "sensitivity": {"_near_sums": (4, SHAPE)},
    "series_constants": {"_looked_up": (1, GUARDS)},
}
"""Largest number of undetected mutants by module and function or constant, with the reason."""


@pytest.mark.parametrize("name", MAY_PASS)
def test_mutants_are_detected_up_to_the_listed_number(name: str) -> None:
    most = {home: count for home, (count, _) in (ANYWHERE | MAY_PASS[name]).items()}
    assert undetected(name, most) == {}
