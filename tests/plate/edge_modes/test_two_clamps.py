"""Compare the parameter chi of a clamped edge in the static law with that of the plate modes."""

import pytest
import sympy as sp

from derivation.plate.edge.theory import clamped as law
from derivation.plate.edge_modes.theory import waves
from derivation.plate.vocabulary import alpha, eta, lam, mu, nu

POISSON = (0.2, 0.3, 0.45)
THIN = 1e-4


def static_law(ratio: float, half: float) -> float:
    """Return the reduction by the clamp under a force on the axis, in P b^2/(16 pi D)."""
    reduction = law.clamp_law()[0].expression * 8 * sp.pi * eta**3 / alpha
    known = {lam: 2 * mu * ratio / (1 - 2 * ratio), alpha: 0, eta: half}
    return float(sp.simplify(sp.expand(reduction).subs(known)))


def static_modes(ratio: float, half: float) -> float:
    """Return the same reduction, as the sum over all modes of the clamped plate."""
    change = next(f for f in waves.static_changes() if f.name == "clamped_static_change")
    return float((-16 * sp.pi * change.expression).subs({nu: ratio, eta: half}))


def chi_of_law(ratio: float) -> float:
    """Return chi/n^2 of the static law."""
    known = {lam: 2 * mu * ratio / (1 - 2 * ratio)}
    return float(sp.simplify((law.turn() / law.RATIO**2).subs(known)))


def effective_chi(ratio: float, half: float) -> float:
    """Return the chi/n^2 with which the modes have the static deflection of the law."""
    n = ratio / (1 - ratio)
    missing = static_law(ratio, half) - static_modes(ratio, half)
    return float(waves.CHI) + missing / (2 * half * n**2)


@pytest.mark.parametrize("ratio", POISSON)
def test_modes_have_the_static_deflection_of_the_law(ratio: float) -> None:
    for half, most in ((0.001, 3e-5), (0.03, 4e-4), (0.1, 4e-4), (0.15, 1e-3), (0.25, 6e-3)):
        assert abs(static_modes(ratio, half) / static_law(ratio, half) - 1) < most


@pytest.mark.parametrize("ratio", POISSON)
def test_effective_chi_is_in_the_range_of_finite_elements(ratio: float) -> None:
    values = [effective_chi(ratio, half) for half in (0.03, 0.05, 0.1, 0.15, 0.25)]
    assert 0.074 < min(values) < 0.09 < max(values) < 0.113


@pytest.mark.parametrize("ratio", POISSON)
def test_effective_chi_of_thin_plates_is_that_of_the_law(ratio: float) -> None:
    assert effective_chi(ratio, THIN) == pytest.approx(chi_of_law(ratio), rel=1e-3)
    assert 0.105 < chi_of_law(ratio) < 0.123
