"""Mutation tests of core formulas: a proof or a reference detects each changed formula."""

from collections.abc import Callable, Mapping
from functools import cache

import formula_checks as checks
import mpmath as mp
import pytest
import sympy as sp
import wave_checks
from formula_checks import chain
from mutants import Mutant, of_expression

from derivation.engine.formula.proof import reduces_to_zero


@pytest.fixture(autouse=True)
def _digits():
    with mp.workdps(checks.DIGITS):
        yield


ROUTED = (
    "C_top", "C_bottom", "C_half", "G", "G_m", "G_minus_1", "G_slope", "p", "sonine", "P", "A_j",
    "K_j", "K_j_bottom",
)  # fmt: skip
TARGETS: Mapping[str, Callable[[str], checks.Check]] = {
    "f_j": checks.in_the_equations,
    "g_j": checks.in_the_equations,
    **{f"Omega_{k}": checks.in_the_tractions for k in range(1, 5)},
    **dict.fromkeys(ROUTED, checks.by_route),
    **{
        f"c_{n}_{part}": checks.by_coefficient
        for n in (1, 3, 5, 7)
        for part in ("modes", "lateral")
    },
    "F_modes": checks.by_departure,
    "F_lateral": checks.by_lateral,
    "delta_reduced": checks.by_the_law,
    **{f"xi_{k}": checks.by_inversion for k in range(2, 7)},
    **{f"p_{n}": checks.by_inversion for n in range(1, 5)},
    "contact_integrand": checks.by_energy,
    "contact_work": checks.by_energy,
    "hertz_time": checks.by_hertz_motion,
    "acceleration": checks.by_motion,
    "speed": checks.by_motion,
    "delta_0": checks.by_linear_motion,
    "delta_sphere": checks.by_profile,
    "P_sphere": checks.by_profile,
    "edge_extension": checks.by_edge_displacement,
    "edge_rotation": checks.by_edge_displacement,
    "F_edge": checks.by_residues,
    "S_edge": checks.by_residues,
    "support_ratio": checks.by_poissons_ratio,
    **dict.fromkeys(
        ("B_a", "B_s", "B_a_slow", "B_s_slow", "dynamic_influence"),
        wave_checks.by_first_order_system,
    ),
    **dict.fromkeys(("bending_wave_stress", "extension_wave_stress"), wave_checks.by_free_wave),
}


@cache
def mutants(name: str) -> list[Mutant]:
    return of_expression(chain()[name].expression)


def is_detected(passes: checks.Check, expression: sp.Expr) -> bool:
    """Return whether a mutant fails the check; one without a real value fails too."""
    try:
        return not passes(expression)
    except (ArithmeticError, ValueError, TypeError):
        return True


@pytest.mark.parametrize("name", TARGETS)
def test_mutants_of_core_formulas_are_detected(name: str) -> None:
    """A mutant that passes is equal to the formula."""
    expression = chain()[name].expression
    passes = TARGETS[name](name)
    assert passes(expression)
    survivors = [m for m in mutants(name) if not is_detected(passes, m.expression)]
    assert [m.name for m in survivors if not reduces_to_zero(m.expression - expression)] == []


def test_mutants_are_numerous_and_distinct() -> None:
    counts = {name: len(mutants(name)) for name in TARGETS}
    assert min(counts.values()) >= 2
    assert sum(counts.values()) >= 60
