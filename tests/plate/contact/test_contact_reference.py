"""Test the two references of the corrected contact law: constants, limits, agreement."""

import json
import math
import random
from functools import cache, partial
from types import ModuleType
from typing import Any

import flint
import numpy as np
import pytest
from flint import arb
from mpmath import mp, mpf

from derivation.engine.formula.ulp import DOUBLE, SINGLE
from derivation.engine.oracle.agreement import OracleError
from derivation.pipeline import MEASURED_CONTACT
from derivation.plate.contact.cases import check as contact
from derivation.plate.contact.cases import grid as contact_grid
from derivation.plate.contact.cases import judge as contact_judge
from derivation.plate.contact.cases import reference_values as contact_reference
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import forces as contact_forces
from derivation.plate.contact.oracle.sums import plate_excess
from derivation.plate.contact.route import residue_law as contact_routes
from derivation.plate.impact.oracle import agreement as contact_agreement
from derivation.plate.impact.oracle import impact as contact_impact
from derivation.plate.impact.oracle import quantities as contact_quantities
from generated import contact_law


def close(ball: flint.arb, expected: mpf | str, digits: int) -> bool:
    with flint.ctx.workprec(400):
        known = flint.arb(str(expected))
        return bool(abs(ball - known) < abs(known) * flint.arb(10) ** -digits)


# --- constants


@cache
def bessel_quotient(y: mpf, precision: int) -> mpf:
    """Return K0/I0, which several integrals need at the same points."""
    with mp.workprec(precision):
        return mp.besselk(0, y) / mp.besseli(0, y)


@pytest.mark.parametrize("n", [0, 2, 6])
def test_kappa_agrees_with_quadrature(n: int) -> None:
    with mp.workdps(30):
        direct = mp.quad(
            lambda u: 3 * u ** (3 * n + 2) * bessel_quotient(u**3, mp.prec),
            [0, 0.5, 1, 1.5, 2, 3, 4],
        )
        assert close(contact_balls.kappa(n, 30), mp.nstr(direct, 28), 22)


@pytest.mark.parametrize(
    ("k", "value"),
    [
        (2, "-1.12648392978257645242944"),
        (3, "7.72386466370692885870034"),
        (4, "41.9670644769000627482199"),
    ],
)
def test_finite_parts_have_the_known_values(k: int, value: str) -> None:
    assert close(contact_balls.finite_part(k, 30), value, 22)


def test_first_coefficient_changes_sign() -> None:
    left, right = (contact_balls.coefficient(1, h, 1.0, 30) for h in (0.53, 0.5304))
    assert left > 0
    assert right < 0


def test_coefficients_of_thin_plates_have_closed_forms() -> None:
    """For a thin plate c_1, c_3 and c_5 have closed forms with M_2, M_3 and M_4.

    The error is of order e^(-4.2/eta), which is 10^-91 here.
    """
    eta = 0.02
    with mp.workdps(60):
        log = mp.euler - mp.log(4 * mpf(eta))
        m = {k: mpf(contact_balls.finite_part(k, 45).str(45, radius=False)) for k in (2, 3, 4)}
        expected = {
            1: 1 / (4 * mp.pi * mpf(eta) ** 2) + 2 / (3 * mp.pi) * (m[2] + 6 * log / 5),
            3: -(m[3] + 6 * log) / (60 * mp.pi),
            5: 8 / mp.pi * 6 / mp.factorial(7) / 64 * m[4],
        }
        for order, value in expected.items():
            assert close(contact_balls.coefficient(order, eta, 1.0, 40), mp.nstr(value, 45), 35)


def test_series_agrees_with_the_law() -> None:
    """Six terms of the series give the law at a/h = 1/100."""
    a, h, b = 0.002, 0.2, 1.0
    with flint.ctx.workprec(300):
        ratio = flint.arb(a) / flint.arb(h)
        terms = (contact_balls.coefficient(n, h, b, 40) * ratio**n for n in range(1, 12, 2))
        total = sum(terms, flint.arb(0))
    far = contact_balls.relative_correction(a, h, b, 40)
    assert close(far, total.str(40, radius=False), 25)


# --- limits


def test_thick_plate_is_a_half_space_with_an_edge() -> None:
    a, b = 1e-6, 1.0
    far = contact_balls.relative_correction(a, 100.0, b, 30)
    assert float(far) / a == pytest.approx(-0.36953, abs=1e-5)
    assert float(contact_balls.finite_radius(a, 30)) == pytest.approx(float(far), rel=1e-12)


@pytest.mark.parametrize("eta", [1e-3, 1e-4])
def test_thin_plate_agrees_with_kirchhoff(eta: float) -> None:
    """F/(a/h) tends to 1/(4 pi eta^2), Kirchhoff's deflection P b^2/(8 pi D)."""
    a = 1e-2 * eta
    far = float(contact_balls.relative_correction(a, eta, 1.0, 30))
    assert far / (a / eta) * 4 * math.pi * eta**2 == pytest.approx(1.0, abs=60 * eta**2)


def test_impact_on_a_half_space_agrees_with_hertz() -> None:
    """For a small contact the contact time is Hertz's, 2 * 1.4716375921623523 delta/v0."""
    R, m, v0, lam, mu = 1.0, 1.0, 1e-40, 0.0, 0.5
    result = contact_impact.impact(R, m, v0, 1.0, 1.0, lam, mu, 20)
    constant = float(result.contact_time * flint.arb(v0) / result.max_indentation)
    assert constant == pytest.approx(2 * 1.4716375921623523, rel=1e-14)


def test_series_of_the_plate_factor_agrees_with_the_closed_form() -> None:
    with flint.ctx.workprec(200):
        for T in (1.999999, 2.000001):
            with mp.workdps(50):
                x = mpf(T)
                G = (mp.sinh(x) * mp.cosh(x) + x) / (mp.sinh(x) ** 2 - x**2) - 1
            assert close(plate_excess(flint.acb(T)).real, mp.nstr(G, 45), 40)


# --- consistency


def test_contact_radius_inverts_the_indentation() -> None:
    depth = float(contact_balls.indentation(0.3, 2.0, 0.1, 1.0, 30))
    radius = contact_balls.contact_radius(depth, 2.0, 0.1, 1.0, 30)
    assert float(radius) == pytest.approx(0.3, rel=1e-15)


def test_slope_is_the_derivative() -> None:
    step = 2.0**-30
    up, down = (contact_balls.indentation(0.25 + s, 2.0, 0.125, 1.0, 40) for s in (step, -step))
    actual = float(contact_balls.slope(0.25, 2.0, 0.125, 1.0, 40))
    assert float((up - down) / (2 * step)) == pytest.approx(actual, rel=1e-14)


def test_history_ends_at_half_the_contact_time() -> None:
    case = (0.01, 0.03, 1.0, 0.1, 1.0, 1.2e11, 8e10)
    result = contact_impact.impact(*case, digits=20)
    edge = math.nextafter(float(result.max_contact_radius.lower()), 0.0) * (1 - 1e-15)
    early, late = contact_impact.history((1e-5, edge), *case, digits=20)
    assert float(early) == pytest.approx(1e-10 / 0.01, rel=1e-3)
    assert float(late) == pytest.approx(float(result.contact_time) / 2, rel=1e-6)


def test_states_near_the_turning_point_conserve_energy() -> None:
    """States near the turning point conserve energy, and two methods agree on the speed.

    The state is computed by a series next to the turning point and by Newton's iteration
    farther away. The speed is proportional to the time from the turning point.
    """
    case = (0.01, 0.03, 1.0, 0.1, 1.0, 1.2e11, 8e10)
    whole = contact_impact.impact(*case, digits=60).contact_time
    offsets = (-4e-13, -5e-14, 2e-16, 5e-14, 4e-13)
    times = [float(whole) / 2 * (1 + 2 * offset) for offset in offsets]
    rates = []
    for t in times:
        depth, speed, radius, load = contact_quantities.state(t, *case, digits=40)
        R, m, v0, h, b, lam, mu = case
        with flint.ctx.workprec(300):
            at = contact_quantities.fraction(radius)
            stored = contact_impact.stored_energy(at, R, h, b, lam, mu, 45)
            assert abs(2 * stored / (arb(m) * arb(v0) ** 2) + (speed / arb(v0)) ** 2 - 1) < 1e-38
            assert abs(contact_balls.indentation(at, R, h, b, 45) / depth - 1) < 1e-38
            assert abs(contact_forces.force_of_radius(at, R, lam, mu) / load - 1) < 1e-38
            rates.append(speed / (whole / 2 - arb(t)))
    with flint.ctx.workprec(300):
        # The iteration obtains the speed from the remaining energy, with fewer correct digits.
        assert all(abs(rate / rates[2] - 1) < 1e-15 for rate in rates)
        assert all(abs(rate / rates[2] - 1) < 1e-22 for rate in rates[1:4])


def test_states_at_the_ends_of_a_contact_are_nearly_free_motion() -> None:
    case = (0.01, 0.03, 1.0, 0.1, 1.0, 1.2e11, 8e10)
    whole = contact_impact.impact(*case, digits=40).contact_time
    for t in (1e-20, math.nextafter(float(whole), 0.0) * (1 - 1e-15)):
        depth, speed, radius, _ = contact_quantities.state(t, *case, digits=30)
        with flint.ctx.workprec(200):
            left = min(arb(t), whole - arb(t), key=float)
            assert abs(depth / left - 1) < 1e-9
            assert abs(abs(speed) - 1) < 1e-20
            assert abs(radius**2 / (arb(0.01) * left) - 1) < 1e-6


def test_contact_at_the_edge_is_rejected() -> None:
    with pytest.raises(ValueError, match="a/b < 1"):
        contact_balls.indentation(1.0, 2.0, 0.5, 1.0)
    with pytest.raises(ValueError, match="edge"):
        contact_balls.contact_radius(1e3, 2.0, 0.5, 1.0)
    with pytest.raises(ValueError, match="odd"):
        contact_balls.coefficient(2, 0.5, 1.0)
    with pytest.raises(ValueError, match="a/b < 1"):
        contact_routes.indentation(1.0, 2.0, 0.5, 1.0)


# --- agreement of both references


def test_references_agree_on_the_law() -> None:
    generator = random.Random("contact law")
    for eta in (1e-4, 10 ** generator.uniform(-3.5, -1.5), 10 ** generator.uniform(-1.4, 2.0), 1e2):
        for ratio in (10 ** generator.uniform(-8.0, -1.0), generator.uniform(0.5, 6.0)):
            a = min(eta * ratio, 0.95)
            contact_agreement.agree("indentation", (a, 2.0, eta, 1.0), 40)
            contact_agreement.agree("slope", (a, 2.0, eta, 1.0), 40)


def test_references_agree_on_the_inversion() -> None:
    contact_agreement.agree("contact_radius", (1.04629, 2.0, 0.1, 1.0), 40)


def reaching(a: float, h: float) -> contact_grid.ContactShape:
    """Return the impact with a largest contact radius of about a on a plate of radius 1."""
    return contact_grid.ContactShape(a, R=40.0, h=h, b=1.0, lam=3e9, mu=2e9, m=0.5)


@pytest.mark.parametrize(
    ("where", "bending"),
    [
        pytest.param(contact_grid.PAPER_IMPACT, 1.087, id="paper"),
        pytest.param(reaching(4.139e-5, 6.9e-6), 1.0028e10, id="thin, beyond 3 h"),
        pytest.param(reaching(2.8e-5, 2.8e-5), 1.0150e8, id="thin"),
        pytest.param(reaching(0.971, 3.0), -0.35885, id="thick"),
    ],
)
def test_references_agree_on_impacts(
    where: tuple[float, ...] | contact_grid.ContactShape, bending: float
) -> None:
    """Both references agree to 24 digits; c_1 A measures the deviation from Hertz's impact."""
    reference = contact_reference.reference_value(("impact", where))
    assert reference.digits >= 24
    assert reference.bend == pytest.approx(bending, rel=1e-3)


def test_disagreement_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(contact_agreement.SECOND, "indentation", contact_routes.slope)
    with pytest.raises(OracleError, match="against"):
        contact_agreement.agree("indentation", (0.3, 2.0, 0.1, 1.0), 20)


@pytest.mark.parametrize(
    ("reference", "part"), [(contact_impact, "modulus"), (contact_routes, "hertz_stiffness")]
)
def test_error_in_either_reference_of_impacts_is_detected(
    monkeypatch: pytest.MonkeyPatch, reference: ModuleType, part: str
) -> None:
    """A relative error of 1e-20 in one reference is detected, though the results change less."""
    right = getattr(reference, part)

    def wrong(*arguments: float) -> flint.arb | mpf:
        value = right(*arguments)
        return value + value / 10**20

    monkeypatch.setattr(reference, part, wrong)
    with pytest.raises(OracleError, match="against"):
        contact_agreement.agree("impact", (2.0, 1.0, 0.01, 3.0, 1.0, 0.0, 0.5), 22)


def test_work_equals_the_kinetic_energy() -> None:
    R, m, v0, h, b, lam, mu = contact_grid.PAPER_IMPACT
    result = contact_impact.impact(R, m, v0, h, b, lam, mu, 20)
    radius = float(result.max_contact_radius)
    energy = contact_impact.stored_energy(radius, R, h, b, lam, mu, 20)
    assert float(energy) == pytest.approx(m * v0**2 / 2, rel=1e-14)


# --- the check of generated functions


def rounded(*point: Any) -> float:
    """Return the rounded reference value for numbers or arrays of one number."""
    return float(contact_balls.indentation(*(np.asarray(x).item() for x in point), 25))


def test_rounded_value_passes_and_wrong_value_fails() -> None:
    points = {"indentation": ((0.3, 2.0, 0.1, 1.0), (0.9, 2.0, 3.0, 1.0))}
    (row,) = contact.check({"indentation": rounded}, points)
    assert row.passed
    assert row.points == 2
    (row,) = contact.check({"indentation": lambda *p: rounded(*p) * (1 + 4e-15)}, points)
    assert not row.passed
    (row,) = contact.check({"indentation": lambda *p: math.nan * rounded(*p)}, points)
    assert not row.passed
    assert row.max_error == math.inf


def test_errors_are_in_units_of_the_format() -> None:
    """The error of a force is compared with the resolution of its floating-point format.

    P = 16 mu (lam + mu) a^3/(3 R (lam + 2 mu)) has the condition numbers 3 (a), 1 (R) and 1
    (both moduli together).
    """
    point = (0.25, 2.0, 0.0, 0.75)
    exact = contact_reference.reference_value(("force_of_radius", point))
    total = contact_judge.conditioning(contact_law.force_of_radius, point)
    assert total == pytest.approx([5.0], rel=1e-8)
    for fmt in (DOUBLE, SINGLE):
        kind = np.dtype(fmt.name).type
        right = kind(float(flint.arb(exact.values[0])))

        def off(*_: float, ulps: int = 0, right: Any = right) -> Any:
            return right + ulps * np.spacing(right)

        kept = contact_judge.judge(off, [exact], 8.0, fmt)
        assert kept.within_limits(fmt)
        assert kept.max_ulp <= 0.5
        broken = contact_judge.judge(partial(off, ulps=11), [exact], 8.0, fmt)
        assert not broken.within_limits(fmt)
        assert 10.0 < broken.needed <= 11.5  # a constant function has no condition number
    nan = contact_judge.judge(lambda *_: np.float64(math.nan), [exact], 8.0)
    assert nan.ratio == math.inf
    always_double = contact_judge.judge(contact_law.force_of_radius, [exact], 8.0, SINGLE)
    assert always_double.within_limits(SINGLE)
    wrong_type = contact_judge.judge(lambda *_: np.float64(0.1), [exact], 8.0, SINGLE)
    assert not wrong_type.within_limits(SINGLE)
    assert wrong_type.dtype == "float64"


def test_references_agree_on_forces() -> None:
    for name in ("force", "force_of_radius", "radius_of_force", "max_pressure"):
        shape = contact_grid.grid(name)[100]
        assert contact_reference.reference_value((name, shape)).digits >= 24


def test_check_rejects_unknown_functions() -> None:
    with pytest.raises(ValueError, match="kernels: expected"):
        contact.check({"depth": rounded})


def test_grids_are_inside_the_plate() -> None:
    for shape in contact_grid.grid("indentation"):
        assert 0 < shape.a < shape.b
        assert shape.a <= 6 * shape.h


def test_several_processes_give_the_same_result() -> None:
    jobs = [("stiffness", shape) for shape in contact_grid.grid("stiffness")[100:102]]
    reported: list[tuple[str, int, int]] = []
    alone = contact_reference.reference_values(jobs)
    assert contact_reference.reference_values(jobs, 2, lambda *what: reported.append(what)) == alone
    assert reported == [("stiffness", 1, 2), ("stiffness", 2, 2)]


def test_record_covers_the_stated_range() -> None:
    """Every function is within its budget in both formats, and within 2e-15 of both references.

    The impacts have c_1 A from -0.369 to 1e10.
    """
    measured = json.loads(MEASURED_CONTACT.read_text())
    rows = {row["kernel"]: row for row in measured["rows"]}
    assert set(rows) == set(contact.KERNELS)
    for row in rows.values():
        assert row["digits"] >= 20
        assert row["passed"]
        assert row["max_error"] <= measured["limit"] == contact.LIMIT == 2e-15
        assert row["budget"] >= contact.stated_limits()[row["kernel"]]
        assert row["double"]["ratio"] <= 1
        assert row["single"]["ratio"] <= 1
        assert row["single"]["dtype"] == "float32"
    cases = rows["impact"]["cases"]
    assert len(cases) == rows["impact"]["points"] >= 24
    assert cases[0]["c1_A"] <= -0.369
    assert cases[-1]["c1_A"] >= 1e10
    assert min(abs(case["c1_A"]) for case in cases if case["a_over_h"] > 0.5) < 1e-10
    assert {case["a_over_h"] > 3 for case in cases} == {True, False}
