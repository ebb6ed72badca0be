"""Test that routines for clamped or supported plates are proved, and wrong steps rejected."""

from typing import Any

import pytest

from derivation.engine.formula.proof import SYMBOLIC, ProofError
from derivation.plate.edge_modes.kernels import amplitudes, edge_mode_kernels, edges, faces, states
from derivation.plate.vocabulary import k_n


def test_routines_are_verified_symbolically() -> None:
    assert {made.proof.method for made in edge_mode_kernels().routines} == {SYMBOLIC}


@pytest.mark.parametrize(
    ("module", "name", "wrong", "make"),
    [
        (states, "RATE", 2 * states.RATE, states.to_cutoff),
        (states, "RATE", 2 * states.RATE, edges.edge),
        (edges, "curl_of", lambda of: of(2, k_n), edges.first_edge),
        (edges, "curl_powers", lambda count: (0,) * (count - 1) + (1,), edges.first_power),
        (amplitudes, "PART", -amplitudes.PART, amplitudes.weight),
        (faces, "FADED", 2 * faces.FADED, faces.modified),
    ],
)
def test_wrong_routine_is_rejected(
    monkeypatch: pytest.MonkeyPatch, module: Any, name: str, wrong: Any, make: Any
) -> None:
    monkeypatch.setattr(module, name, wrong)
    with pytest.raises(ProofError):
        make()
