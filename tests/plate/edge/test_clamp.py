"""Test the clamped edge: theory, measured constants, references, functions, bound, limits."""

import itertools
import json
import math
from fractions import Fraction

import flint
import numpy as np
import pytest
from flint import arb
from mpmath import mp
from shared_scenes import lame

from derivation.engine.files import measurements
from derivation.engine.formula.ball import evaluate, to_ball
from derivation.engine.formula.proof import ProofError, prove
from derivation.plate.back_face import theory as back_face
from derivation.plate.edge.oracle import clamped as clamp_balls
from derivation.plate.edge.remainder import RADIUS, RemainderCase, RemainderMesh, edge_contribution
from derivation.plate.edge.route import clamped as clamp_routes
from derivation.plate.edge.theory import clamped as clamp
from derivation.plate.edge.theory.supported import states
from derivation.plate.vocabulary import alpha, eta, lam, mu, z
from generated import edge as kernels
from generated.edge_kernels import turn_of_clamp

BITS = 140
pytestmark = pytest.mark.usefixtures("silent")


# --- theory


def test_proof_fails_for_the_thinning_of_a_plate() -> None:
    """The proof fails if the strip has the thinning of a plate with two curvatures."""
    wrong = (lam + 2 * mu) * states()[1].w.diff(z) + lam * z
    with pytest.raises(ProofError, match="faces"):
        prove("Strip", "", {"faces": wrong})


# --- measured constants


def strip_record() -> list[dict[str, float]]:
    rows: list[dict[str, float]] = json.loads((measurements() / "edge_strip.json").read_text())[
        "rows"
    ]
    return rows


def test_fits_agree_with_the_measured_strip() -> None:
    rows = strip_record()
    assert min(row["n"] for row in rows) < -0.48
    assert max(row["n"] for row in rows) > 0.95
    for row in rows:
        assert row["change"] < 2e-5
        n = Fraction(row["n"])
        chi, level = clamp_balls.constants(n)
        assert float(chi / n**2) == pytest.approx(row["turn"], rel=2e-3)
        assert float(level) == pytest.approx(row["level"], rel=2e-3)
        # shear at the end of the strip, to first order in n
        assert abs(row["shear"] - float(clamp.SHEAR_TERM)) < 1e-3 + 0.16 * abs(row["n"])


def test_measurement_of_the_strip_agrees_with_the_record() -> None:
    """Coarser elements reproduce the recorded constants and a rigid motion of the strip."""
    pytest.importorskip("scipy")
    from derivation.plate.edge.strip import Strip

    strip = Strip(0.25, RemainderMesh(degree=5, layers=4))
    (row,) = (row for row in strip_record() if row["n"] == 0.25)
    for got, name in zip(strip.constants(), ("turn", "level", "shear"), strict=True):
        assert got == pytest.approx(row[name], rel=2e-3)
    # A rigid motion of the end is a rigid motion of the whole strip.
    turn, level = strip.rigid(0.3 * strip.z, 0.0 * strip.z + 0.2)
    assert turn == pytest.approx(0.3, abs=1e-9)
    assert level == pytest.approx(0.2, abs=1e-9)


def test_law_agrees_with_three_dimensional_elements() -> None:
    """The error against 3-D finite elements is small relative to Kirchhoff's deflection.

    Kirchhoff's deflection of a clamped plate is P b^2/(16 pi D).
    """
    rows = json.loads((measurements() / "edge_remainder.json").read_text())["rows"]
    limits = {0.02: 1e-4, 0.05: 1e-4, 0.1: 3e-4, 0.2: 1.5e-3, 0.3: 3.5e-3}
    tested = 0
    for row in rows:
        size = row["h_over_b"]
        if row["support"] == "clamped" and size in limits:
            case = RemainderCase("clamped", size, row["nu"])
            a = row["a_over_b"]
            error = row["relative_error"] * edge_contribution(case, a)[1]
            kirchhoff = a**3 / RADIUS / (8 * math.pi * size**3)
            usual = -0.5 <= row["nu"] <= 0.45
            assert abs(error) < limits[size] * kirchhoff * (1.0 if usual else 2.0), row
            tested += 1
    assert tested == 5 * 7 * 3


# --- limits


@pytest.mark.parametrize("ratio", [-0.5, 0.0, 0.3, 0.45])
@pytest.mark.parametrize("h", [0.01, 0.1, 0.25])
def test_clamp_changes_small_contacts_by_a_known_factor(h: float, ratio: float) -> None:
    """For a small contact the clamp changes the deflection by a known multiple of P b^2/D.

    The factor is -[(1 - s)^2 + 2 chi eta + eta^3/5 + (16/3) n^2 eta^4]/(16 pi).
    """
    n = ratio / (1 - ratio)
    chi = n * n / (7.436 + 3.168 * n - 0.976 * n**2 + 0.204 * n**3)
    s = 2 * n * (1 - 2 / (7.638 + 0.801 * n - 0.316 * n**2 + 0.255 * n**3)) * h**2
    known = -((1 - s) ** 2 + 2 * chi * h + h**3 / 5 + 16 / 3 * n**2 * h**4) / (16 * math.pi)
    a = 1e-7
    # P = (4/3) E* a^3/R and D = (2/3) E* h^3.
    actual = float(kernels.clamped_edge(a, h, 1.0, *lame(ratio))) * a**2
    assert actual / (2 * a**3 / h**3) == pytest.approx(known, rel=1e-11)


def test_generated_edge_rotation_equals_the_reference() -> None:
    """`turn_of_clamp`, which other generated modules use, equals the reference constant."""
    n = np.array([-0.4, 0.0, 0.3, 0.9])
    reference = [float(clamp_balls.constants(Fraction(x))[0]) for x in n]
    np.testing.assert_allclose(turn_of_clamp(n), reference, rtol=1e-15)


def test_clamp_is_stiffer_than_in_thin_plate_theory() -> None:
    """The clamp prevents thinning, so chi > 0 except at nu = 0, where chi = 0."""
    chi = turn_of_clamp(np.array([-0.45, -0.1, 0.0, 0.1, 0.99]))
    assert (chi[[0, 1, 3, 4]] > 0).all()
    assert chi[2] == 0


# --- references


@pytest.mark.parametrize("kind", ["indentation", "slope"])
@pytest.mark.parametrize(
    ("h", "width", "ratio"),
    [(0.002, 0.5, 0.25), (0.1, 0.9, -0.9), (0.7, 0.3, 0.49), (3.0, 0.01, 0.4)],
)
def test_references_and_theory_agree(kind: str, h: float, width: float, ratio: float) -> None:
    n = Fraction(ratio)
    plate = width, h, 1, 2 * n, 1 - 2 * n
    ball = clamp_balls.clamp_part(kind, *plate, digits=27)
    expression = clamp.clamp_law()[kind == "slope"].expression
    numbers = dict(zip((alpha, eta, lam, mu), map(Fraction, (width, h, *plate[3:])), strict=True))
    with flint.ctx.workprec(BITS):
        assert abs(ball / evaluate(expression, numbers, 27) - 1) < 1e-25
    with mp.workdps(40):
        route = clamp_routes.clamp_part(kind, width, h, 1, ratio, 27)
        far = clamp_routes.back_face_clamp(width, h, 1, ratio, 27)
        with flint.ctx.workprec(BITS):
            assert abs(ball / arb(mp.nstr(route, 35)) - 1) < 1e-25
            exact = to_ball(sum(clamp_balls.back_face_clamp(*plate)))
            assert abs(exact / arb(mp.nstr(far, 35)) - 1) < 1e-25
            derived = evaluate(back_face.back_face_clamp().expression, numbers, 27)
            assert abs(exact / derived - 1) < 1e-25


def test_reference_rejects_invalid_arguments() -> None:
    with pytest.raises(ValueError, match="a < b"):
        clamp_balls.clamp_part("slope", 1.0, 0.1, 1.0, 1.0, 1.0)


# --- generated functions


@pytest.mark.parametrize("size", [1e-90, 1e90])
def test_results_are_finite_for_extreme_sizes(size: float) -> None:
    for function in (kernels.clamped_edge, kernels.clamped_edge_slope, kernels.clamped_edge_bound):
        assert np.isfinite(function([0.0, 1e-5, 0.9], size, 1.0, *lame(0.3))).all()


# --- the bound


def test_bound_holds_and_is_close_for_thin_plates() -> None:
    """0 < -slope <= bound holds for random contacts, and the bound increases with the contact."""
    random = np.random.default_rng(5)
    for _ in range(3000):
        h, ratio = 10 ** random.uniform(-2, 1), random.uniform(-0.99, 0.499)
        if random.random() < 0.3:  # 1 - s near 0: slope below its a = 0 value
            h = (0.75 * 2 * abs(ratio) / (1 - ratio) + 1e-9) ** -0.5 * random.uniform(0.8, 1.2)
        width = np.sort(random.uniform(0, 0.9, 4))
        taken = -kernels.clamped_edge_slope(width, h, 1.0, *lame(ratio))
        limits = kernels.clamped_edge_bound(width, h, 1.0, *lame(ratio))
        assert (taken > 0).all()
        assert (taken <= limits * (1 + 1e-14)).all()
        assert (np.diff(limits) > 0).all()
    thin = kernels.clamped_edge_bound(1e-3, 1e-3, 1.0, *lame(0.3))
    assert thin < 1.01 * abs(kernels.clamped_edge_slope(1e-3, 1e-3, 1.0, *lame(0.3)))


@pytest.mark.parametrize("width", [0.3, 0.97])
def test_bound_holds_in_interval_arithmetic(width: float) -> None:
    for h, ratio in itertools.product((0.02, 0.1, 0.5, 1.0, 3.0), (-0.9, 0.3, 0.49)):
        taken = clamp_balls.clamp_part("slope", width, h, 1, *lame(ratio), digits=12)
        assert 0 < taken < float(kernels.clamped_edge_bound(width, h, 1.0, *lame(ratio)))


def test_generated_bound_agrees_with_the_formula() -> None:
    expression = clamp.clamp_bound().expression
    for h, ratio in itertools.product((0.003, 0.4, 1.7), (-0.7, 0.2, 0.45)):
        first, second = lame(ratio)
        numbers = {alpha: 0.3, eta: h, lam: first, mu: second}
        reference = float(evaluate(expression, {s: Fraction(x) for s, x in numbers.items()}, 20))
        got = float(kernels.clamped_edge_bound(0.3, h, 1.0, first, second))
        assert got == pytest.approx(reference, rel=1e-14)
