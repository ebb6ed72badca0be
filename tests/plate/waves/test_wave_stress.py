"""Test the stress of waves and modes on the back face against other methods and limits."""

import numpy as np
import pytest
from mpmath import mp, mpf

from derivation.engine.formula.proof import ProofError
from derivation.plate.waves import oracle, route
from derivation.plate.waves.theory import wave_stress as theory
from generated.edge_modes import clamped_waves, supported_waves
from generated.plate_waves import branches
from generated.wave_stress import mode_stress, wave_stress


@pytest.mark.parametrize(("x", "nu"), [(0.01, 0.22), (0.7, 0.45), (3.0, -0.5), (12.0, 0.3)])
@pytest.mark.parametrize("kind", oracle.KINDS)
def test_stress_of_a_wave_is_that_of_the_first_order_equations(
    x: float, nu: float, kind: str
) -> None:
    for index in range(3):
        with mp.workdps(60):
            kap = mpf(oracle.zero(x, nu, kind, index, 50).str(45, radius=False))
            expected = float(route.wave_stress(x, kap, nu, kind == oracle.KINDS[0], 15))
            frequency = float(mp.sqrt(kap))
        # The ratio is as sensitive to the frequency as its distance to a pole is small.
        shifted = wave_stress(x, frequency * (1.0 + 1e-12), nu, kind)
        found = wave_stress(x, frequency, nu, kind)
        allowed = 1e-12 + 1e-3 * abs(shifted / found - 1.0)
        assert found == pytest.approx(expected, rel=allowed), index


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_waves_of_all_branches_add_up_to_the_static_stress(nu: float) -> None:
    """The residues of the stress at all branches, divided by kap, add up to that of a slow load."""
    x = 0.9
    total, partial = 0.0, []
    for kind in oracle.KINDS:
        frequency, residue = branches(x, nu, 400, kind)
        with np.errstate(all="ignore"):
            stress = wave_stress(x, frequency, nu, kind)
        terms = np.where(residue > 0.0, residue * stress, 0.0) / frequency**2
        partial.append(np.cumsum(terms))
    total = float(partial[0][-1] + partial[1][-1])
    with mp.workdps(30):
        slow = mpf(10) ** -12
        (_, bent), (_, stretched) = route._moved(mpf(x), slow, mpf(nu))
        expected = float(-(1 + mpf(nu)) / (1 - mpf(nu)) * x * (bent + stretched))
    assert total == pytest.approx(expected, rel=1e-5)
    assert partial[0][0] != pytest.approx(expected, rel=1e-2)  # A0 alone is not sufficient


@pytest.mark.parametrize("run", [clamped_waves, supported_waves])
def test_modes_of_thin_plates_have_the_bending_stress_of_kirchhoff(run: object) -> None:
    """The stress follows from the curvature of J0(k r) - c I0(k r) on the axis."""
    eta, nu = 1e-4, 0.3
    waves = run(4, eta, nu)  # type: ignore[operator]
    curved = waves.k**2 * (1.0 + waves.c) / (1.0 - waves.c)
    bent = (1.0 + nu) / (1.0 - nu) * eta**2 * curved
    assert mode_stress(waves, eta, nu) == pytest.approx(bent, rel=1e-5)


def test_modes_without_evanescent_part_have_the_stress_of_a_wave() -> None:
    eta, nu = 0.02, 0.3
    waves = clamped_waves(40, eta, nu)
    late = np.abs(waves.c) < 1e-12
    assert late.any()
    own = wave_stress(waves.k * eta, waves.root, nu)
    assert mode_stress(waves, eta, nu)[late] == pytest.approx(own[late], rel=1e-11)


def test_stress_is_nan_outside_the_domain_and_other_parities_are_rejected() -> None:
    assert np.isnan(wave_stress(0.1, 0.01, 0.5))
    assert np.isnan(wave_stress(0.0, 0.01, 0.3))
    with pytest.raises(ValueError, match="parity"):
        wave_stress(0.1, 0.01, 0.3, "sideways")


def test_a_wrong_stress_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    right = theory.stress
    monkeypatch.setattr(theory, "stress", lambda tanh, _: right(tanh, True))
    with pytest.raises(ProofError, match="extension"):
        theory.wave_stress.__wrapped__()
