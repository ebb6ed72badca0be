"""Test the measured remainder of the edge law: convergence, linearity and the record."""

import json
from functools import partial

import numpy as np
import pytest

from derivation.engine.files import measurements
from derivation.plate.edge import remainder as edge_remainder
from derivation.plate.edge.remainder import (
    MESHES,
    POISSON,
    SIZES,
    SUPPORTS,
    WIDTHS,
    Field,
    RemainderCase,
    RemainderMesh,
    edge_contribution,
    heights,
    lobatto,
    radii,
    remainders,
    rim_displacement,
)

COARSE = RemainderMesh(degree=6, layers=4)


def test_lobatto_rule_is_exact_for_polynomials() -> None:
    nodes, weights, slope = lobatto(7)
    for power in range(14):
        assert abs(weights @ nodes**power - (1 + (-1) ** power) / (power + 1)) < 1e-14
    np.testing.assert_allclose(slope @ nodes**5, 5 * nodes**4, atol=1e-13)


@pytest.mark.parametrize("h", [0.02, 0.3, 1.0, 2.0])
def test_meshes_cover_the_plate(h: float) -> None:
    r, z = radii(h, 5), heights(h, 5)
    assert (r[0], r[-1], z[0], z[-1]) == (0.0, 1.0, -h, h)
    assert (np.diff(r) > 0).all()
    assert (np.diff(z) > 0).all()
    np.testing.assert_allclose(z, -z[::-1], atol=1e-15)


def test_number_of_modes_at_the_edge_is_sufficient() -> None:
    """With a quarter of the modes the edge displacement changes by less than 1e-6."""
    case, z = RemainderCase("supported", 0.2, 0.3), np.array([-0.2, 0.0, 0.1, 0.2])
    values = rim_displacement(case, 0.1, z)
    fewer = rim_displacement(case, 0.1, z, modes=1500)
    assert np.abs(values - fewer).max() < 1e-6 * np.abs(values).max()


@pytest.mark.parametrize("support", SUPPORTS)
def test_edge_states_and_elements_add_up_to_the_total(support: str) -> None:
    """Finite elements without the edge states give the same total as states plus elements."""
    case = RemainderCase(support, 0.2, 0.3)
    whole = Field(case, COARSE).depths(WIDTHS, states=False)
    rest = Field(case, COARSE).depths(WIDTHS)
    relative = remainders(case, COARSE)
    for a, one, other, remainder in zip(WIDTHS, whole, rest, relative, strict=True):
        assert abs(one / other - 1) < 1e-8
        more, indentation = edge_contribution(case, a)
        assert abs(other - more - remainder * indentation) < 1e-12 * indentation


def test_remainder_converges() -> None:
    case = RemainderCase("supported", 0.3, 0.3)
    coarse, fine = remainders(case, COARSE), remainders(case, RemainderMesh(degree=8, layers=4))
    assert np.abs(np.array(coarse) / fine - 1).max() < 1e-4


def test_record_is_complete_and_accurate() -> None:
    """The record contains every case, has converged, and is small for sufficiently thin plates."""
    record = json.loads((measurements() / "edge_remainder.json").read_text())
    rows = record["rows"]
    assert len(rows) == len(SUPPORTS) * len(SIZES) * len(POISSON) * len(WIDTHS)
    assert [mesh["degree"] for mesh in record["meshes"]] == [mesh.degree for mesh in MESHES]
    for row in rows:
        size = abs(row["relative_error"])
        # The corners of a clamped edge are singular; those of a supported edge are not.
        floor = 1e-7 if row["support"] == "supported" else 3e-5
        assert abs(row["lower_degree"]) + abs(row["fewer_layers"]) < 0.01 * size + floor
        assert size < 0.03
        if row["support"] == "supported" and row["nu"] >= 0 and row["a_over_b"] <= 0.1:
            assert size < (1e-3 if row["h_over_b"] <= 0.5 else 3e-3)
        if row["support"] == "clamped" and row["h_over_b"] <= 0.3:
            assert size < 1e-3


def test_rows_state_contributions_and_their_changes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Coarser meshes agree with the record, and each row states its changes with two meshes."""
    meshes = (COARSE, RemainderMesh(degree=5, layers=4), RemainderMesh(degree=6, layers=3))
    monkeypatch.setattr(edge_remainder, "MESHES", meshes)
    monkeypatch.setattr(edge_remainder, "SIZES", (1.0,))
    monkeypatch.setattr(edge_remainder, "POISSON", (0.3,))
    monkeypatch.setattr(edge_remainder, "rows", partial(edge_remainder.rows, (1.0,), (0.3,)))
    data = json.loads(edge_remainder.text())
    assert [mesh["layers"] for mesh in data["meshes"]] == [4, 4, 3]
    record = json.loads((measurements() / "edge_remainder.json").read_text())["rows"]
    head = ("support", "h_over_b", "nu", "a_over_b")
    known = {tuple(row[key] for key in head): row for row in record}
    assert len(data["rows"]) == len(SUPPORTS) * len(WIDTHS)
    for row in data["rows"]:
        best = known[tuple(row[key] for key in head)]["relative_error"]
        assert abs(row["relative_error"] / best - 1) < 1e-2
    for support in SUPPORTS:
        finest, lower, fewer = (
            remainders(RemainderCase(support, 1.0, 0.3), mesh) for mesh in meshes
        )
        mine = [row for row in data["rows"] if row["support"] == support]
        for row, remainder, one, other in zip(mine, finest, lower, fewer, strict=True):
            assert row["lower_degree"] == pytest.approx(one - remainder, rel=0.06)
            assert row["fewer_layers"] == pytest.approx(other - remainder, rel=0.06)


@pytest.mark.parametrize("h", [0.22213133, *np.geomspace(0.01, 9.0, 60)])
def test_element_at_the_axis_is_not_too_narrow(h: float) -> None:
    """The element at the axis is at least 0.19 times as wide as its neighbour."""
    for layers in range(2, 8):
        r = radii(h, layers)
        assert (r[0], r[-1]) == (0.0, 1.0)
        steps = np.diff(r)
        assert steps[0] > 0.19 * steps[1]
        assert steps[-1] == pytest.approx(min(h, 1.0) * 0.5**layers)
