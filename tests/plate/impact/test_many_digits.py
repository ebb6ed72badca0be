"""Test the law with any number of digits: both references, error bounds, and the command."""

import json
import math
import re
from pathlib import Path
from typing import Any

import flint
import pytest
from flint import acb, arb
from mpmath import mp, mpf
from shared_scenes import PAPER

from derivation.cli import main
from derivation.engine.formula.ball import PrecisionError
from derivation.engine.oracle.agreement import RouteError, to_ball
from derivation.plate.contact.oracle import lateral as contact_lateral
from derivation.plate.contact.oracle import points as contact_points
from derivation.plate.contact.oracle import sums as contact_sums
from derivation.plate.contact.oracle.balls import ratio_of
from derivation.plate.contact.route import residue_law
from derivation.plate.contact.route import residues as residue_routes
from derivation.plate.impact.oracle import ball_law, many_digits
from derivation.plate.impact.oracle import impact as contact_impact

PLATES = [
    pytest.param(0.02, 0.03, 30, id="thin"),
    pytest.param(0.1, 0.0134, 50, id="paper"),
    pytest.param(0.1, 0.45, 30, id="paper, wide contact"),
    pytest.param(1.0, 0.6, 50, id="thick"),
]
Captured = pytest.CaptureFixture[str]


def bits_of(digits: int) -> int:
    return math.ceil(3.33 * digits) + 8


@pytest.mark.parametrize(("eta", "alpha", "digits"), PLATES)
def test_series_and_integrals_agree(eta: float, alpha: float, digits: int) -> None:
    bits, plate = bits_of(digits) + 32, ratio_of(eta, 1.0)
    series = contact_points.series(plate, alpha, bits)
    with flint.ctx.workprec(bits):
        for name in contact_sums.COEFFICIENTS:
            by_series = 1 + series.excess(name, arb(alpha))
            assert by_series.overlaps(1 + contact_sums.excess(name, arb(alpha), plate))
            assert by_series.rel_accuracy_bits() >= bits_of(digits)


DEPTHS = [
    *PLATES,
    (0.1, 0.3, 120),
    (0.1, 0.58, 60),
    (5.0, 0.9, 60),
    (30.0, 0.9, 60),
    (1e-3, 2e-4, 30),
    (1e-3, 4e-3, 50),
]


@pytest.mark.parametrize(("eta", "alpha", "digits"), DEPTHS)
def test_second_reference_is_inside_the_interval(eta: float, alpha: float, digits: int) -> None:
    """The Arb interval overlaps the second reference, widened by its requested accuracy."""
    R, lam, mu = 2.0, 0.36e9, 0.43e9
    law = ball_law.law_of(ratio_of(eta, 1.0), alpha, digits)
    balls = ball_law.static_contact(alpha, R, 1.0, lam, mu, law, digits + 3)
    others = (
        residue_law.indentation(alpha, R, eta, 1.0, digits),
        residue_law.stiffness(alpha, R, eta, 1.0, lam, mu, digits),
    )
    for ball, other in zip(balls, others, strict=True):
        with flint.ctx.workprec(bits_of(digits) + 64):
            assert ball.overlaps(to_ball(other) * arb(1, arb(10) ** -digits))
        assert many_digits.agreed_digits(ball, other) > digits


@pytest.mark.parametrize(
    ("h", "v0", "digits"),
    [(0.1, 1.0, 60), (0.1, 1.0, 120), (0.5, 30.0, 60), (0.02, 0.1, 30), (0.1, 600.0, 30)],
)
def test_references_of_an_impact_agree(h: float, v0: float, digits: int) -> None:
    """Both references of an impact agree from a = h/7 to a = 5 h, where their series cancel."""
    motion = (2.0, 1000.0, v0, h, 1.0, 0.36e9, 0.43e9)
    reference = many_digits.reference(motion, digits, lambda *_: None)
    assert [quantity.compared for quantity in reference.quantities] == [digits] * 10
    assert min(quantity.agreed for quantity in reference.quantities) > digits


def test_digits_do_not_depend_on_the_scale_of_the_powers(monkeypatch: pytest.MonkeyPatch) -> None:
    """More digits and another range of the series change nothing within the requested digits."""
    motion, digits = (2.0, 72.0, 1.0, 0.1, 1.0, 0.36e9, 0.43e9), 40
    near = residue_law.impact(*motion, digits)
    monkeypatch.setattr(residue_law, "SHALLOW", 0.9)
    actual = near, residue_law.impact(*motion, 60)
    with mp.workdps(80):
        for one, other in zip(*actual, strict=True):
            assert 0 < abs(one / other - 1) < mpf(10) ** -digits


def test_roots_and_bessel_functions_of_the_residues() -> None:
    with mp.workdps(60):
        for n in (1, 2, 40):
            T = residue_routes._root(n, mp.prec)
            assert abs(mp.sinh(T) - (-1) ** n * T) < mpf(10) ** -55 * abs(T)
            assert mp.pi * n < T.imag < mp.pi * (n + 0.5)
        for w in (mp.mpc(0.3, -0.2), mp.mpc(12, -3), mp.mpc(40, -5)):
            direct = mp.besselk(0, w) / mp.besseli(0, w)
            assert abs(residue_routes._bessel_quotient(w) - direct) < mpf(10) ** -58


def test_nodes_of_the_quadrature_of_an_impact() -> None:
    with mp.workdps(60):
        nodes = residue_law._fejer(24, 200)
        for power in range(0, 24, 2):
            total = sum(w * u**power for u, w in nodes)
            assert abs(total - mpf(1) / (power + 1)) < mpf(10) ** -55
        assert abs(sum(w * u**24 for u, w in nodes) - mpf(1) / 25) > mpf(10) ** -20


@pytest.mark.parametrize("coarse", [1 / 8, 1 / 12, 1 / 16])
def test_bound_of_the_trapezoidal_rule_holds(coarse: float) -> None:
    """For the fastest growing g, halving the step changes the integral by less than the bound."""
    with flint.ctx.workprec(400):
        sums = []
        for step in (arb(coarse), arb(coarse) / 2):
            points, weights = contact_lateral.trapezoidal(step, 200.0)
            pairs = zip(points, weights, strict=True)
            sums.append(sum((w * y.cosh() for y, w in pairs), arb(0)))
        changed = abs(sums[0] - sums[1])
        assert changed > 0
        assert changed < contact_lateral.step_bound(arb(coarse))
        assert changed > contact_lateral.step_bound(arb(coarse)) ** 1.5


def test_bound_on_the_shifted_line_holds() -> None:
    """The bound is 1 to 3 times the quadrature of the largest allowed integrand."""
    with mp.workdps(20):
        shift = mp.mpc(0, contact_lateral.SHIFT)

        def size(t: mpf) -> mpf:
            y = 2 * mp.sinh(t + shift)
            slope = 2 * mp.cosh(t + shift)
            return mp.exp(abs(y.real)) * abs(slope) / abs(mp.besseli(0, y)) ** 2

        direct = 2 * mp.quad(size, [0, 0.5, 1, 1.5, 2, 3, 4, 5])
        bound = mpf(float(contact_lateral.shifted_bound()))
    assert direct <= bound <= 3 * direct


@pytest.mark.parametrize("eta", [0.02, 0.1, 1.0])
def test_bound_of_the_omitted_modes_holds(eta: float) -> None:
    plate = ratio_of(eta, 1.0)
    few, many = (contact_points.mode_points(plate, bits, 120) for bits in (30, 120))
    with flint.ctx.workprec(200):
        beyond = sum(many.weights[len(few.weights) :], arb(0))
        assert beyond > 0
        assert beyond < few.rest
        assert few.rest < 1e-9


@pytest.mark.parametrize("name", ["hertz", "sinc", "work"])
def test_bound_of_the_remainder_of_the_series_holds(name: str) -> None:
    plate = ratio_of(0.1, 1.0)
    short, long = (contact_points.series(plate, 0.3, bits) for bits in (40, 300))
    with flint.ctx.workprec(400):
        for alpha in (arb(0.3), arb(0.1)):
            assert short.excess(name, alpha).overlaps(long.excess(name, alpha))
            values = [series.powers[name](alpha**2) for series in (short, long)]
            assert abs(values[0] - values[1]) < short.rest


def test_slope_polynomial_is_within_its_bound() -> None:
    plate = ratio_of(0.1, 1.0)
    short, long = (contact_points.series(plate, 0.3, bits) for bits in (40, 300))
    with flint.ctx.workprec(400):
        polynomial, error = short.slope(arb(0.3))
        for q in (arb(1), arb(0.5)):
            exact = long.excess("sinc", arb(0.3) * q) / q
            assert abs(polynomial(q * q) - exact).upper() <= error.upper() * (1 + 1e-6)


def test_series_rejects_contacts_outside_its_range() -> None:
    plate = ratio_of(0.1, 1.0)
    with pytest.raises(PrecisionError, match="up to"):
        contact_points.series(plate, 0.3, 40).excess("hertz", arb(0.31))
    with pytest.raises(PrecisionError, match="is valid up to"):
        contact_points.series(ratio_of(1e-3, 1.0), 0.1, 40)
    with pytest.raises(ValueError, match="a/b < 1"):
        contact_points.series(plate, 1.0, 40)


def test_interval_containing_a_zero_of_the_bessel_function_has_no_bound(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """One wide interval contains a zero of I0, so no bound is available.

    On the shifted line y = 2 i sin d passes near i j_1.
    """
    monkeypatch.setattr(contact_lateral, "PIECES", 1)
    with pytest.raises(PrecisionError, match="1/I0"):
        contact_lateral.shifted_bound.__wrapped__()
    assert acb(0, 2.404825557695773).bessel_i(0).abs_lower() < 1e-12


@pytest.mark.parametrize("h", [0.1, 1.0])
def test_impacts_from_series_and_from_integrals_agree(h: float) -> None:
    motion = (0.13, 72.0, 1.0, h, 1.0, 0.36e9, 0.43e9)
    plate = ratio_of(h, 1.0)
    known = contact_impact.impact(*motion, 30)
    reach = float(known.max_contact_radius) * (1 + 1e-9)
    result = contact_impact.impact(
        *motion, 50, lambda bits: contact_points.series(plate, reach, bits)
    )
    for narrow, wide in zip(result, known, strict=True):
        assert narrow.overlaps(wide)
        assert narrow.rel_accuracy_bits() > 166


# --- the command


def test_reference_shows_digits_radius_and_agreement(capsys: Captured) -> None:
    assert main(["reference", str(PAPER), "--digits", "30"]) == 0
    shown = capsys.readouterr()
    assert "0.00880816122632222377784403527581" in shown.out
    assert shown.out.count("30 of 30 digits") == 10
    assert "exactly" in shown.out
    assert "about" in shown.err


def test_reference_is_printed_as_json(capsys: Captured) -> None:
    assert main(["reference", str(PAPER), "--digits", "20", "--json", "-"]) == 0
    actual: dict[str, Any] = json.loads(capsys.readouterr().out)
    assert actual["inputs"]["R"] == 0.13
    time = actual["impact"]["contact_time"]
    assert time["value"] == "0.0088081612263222237778"
    assert 0 < float(time["radius"]) < 1e-22
    assert (time["compared_digits"], time["agreed_digits"]) == (20, 20)
    assert [sorted(row) for row in actual["law"]] == [
        ["contact_radius", "indentation", "stiffness"]
    ] * 3


@pytest.mark.parametrize("digits", ["0", "1001", "-3", "many"])
def test_number_of_digits_out_of_range_is_rejected(digits: str, capsys: Captured) -> None:
    assert main(["reference", str(PAPER), "--digits", digits]) == 2
    assert "digits" in capsys.readouterr().err


def test_scenes_are_rejected_as_in_simulate(tmp_path: Path, capsys: Captured) -> None:
    assert main(["reference", str(tmp_path / "none.toml")]) == 2
    assert "cannot read the scene file" in capsys.readouterr().err
    fast = tmp_path / "fast.toml"
    fast.write_text(PAPER.read_text().replace("speed = 1.0", "speed = 900.0"))
    messages = []
    for command in ("simulate", "reference"):
        assert main([command, str(fast)]) == 2
        messages.append(capsys.readouterr().err)
    assert messages[0] == messages[1]
    assert "impact.speed" in messages[0]


def test_disagreement_of_references_gives_status_1(
    monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    right = residue_law.hertz_stiffness
    monkeypatch.setattr(residue_law, "hertz_stiffness", lambda *a: right(*a) * (1 + mpf(10) ** -12))
    assert main(["reference", str(PAPER), "--digits", "15"]) == 1
    assert "12 of 15 digits" in capsys.readouterr().out


def test_common_digits_are_limited_by_the_interval() -> None:
    assert 9 < many_digits.agreed_digits(arb(3, 1e-10), mpf(3)) < 10.5
    assert many_digits.agreed_digits(arb(3), mpf(3)) == math.inf


@pytest.mark.parametrize("name", ["indentation", "stiffness", "impact"])
def test_every_result_is_compared_with_the_second_reference(
    name: str, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    """An error of 1e-12 in one function of the second reference shows in its results only."""
    right = getattr(residue_law, name)

    def off(*arguments: Any) -> Any:
        actual = right(*arguments)
        with mp.workdps(30):
            factor = 1 + mpf(10) ** -12
            return tuple(x * factor for x in actual) if name == "impact" else actual * factor

    monkeypatch.setattr(residue_law, name, off)
    assert main(["reference", str(PAPER), "--digits", "15"]) == 1
    output = capsys.readouterr().out
    wrong = 4 if name == "impact" else 3
    assert len(re.findall(r"agrees to 1\d of 15 digits", output)) == 10
    assert output.count("agrees to 15 of 15 digits") == 10 - wrong


def test_unavailable_reference_gives_a_message(
    monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    def fails(*_: Any) -> None:
        raise PrecisionError("a ball stays wide")

    monkeypatch.setattr(many_digits, "reference", fails)
    assert main(["reference", str(PAPER), "--digits", "15"]) == 2
    assert "digits" in capsys.readouterr().err


def test_ctrl_c_gives_a_message(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    def interrupted(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(many_digits, "reference", interrupted)
    assert main(["reference", str(PAPER), "--digits", "15"]) == 2
    assert "interrupted" in capsys.readouterr().err


def test_estimated_time_grows_with_the_digits() -> None:
    motion = (0.13, 72.0, 1.0, 0.1, 1.0, 0.36e9, 0.43e9)
    seconds = [many_digits.expected_seconds(motion, 0.0134, n) for n in (30, 100, 300, 1000)]
    assert seconds == sorted(seconds)
    assert seconds[0] < 10
    assert not ball_law.by_series(1e-3, 0.1, 30)
    assert seconds[-1] < 600
    with pytest.raises(ValueError, match="digits"):
        many_digits.reference(motion, 0, lambda *_: None)


def test_contact_too_deep_for_power_series_is_rejected() -> None:
    with pytest.raises(RouteError, match="contacts up to a = 96 h, got 97 h"):
        residue_law.indentation(0.97, 2.0, 0.01, 1.0)
