"""What the check of the contact law leaves out keeps its budget: coefficients, series, course."""

from functools import cache

import flint
import numpy as np
import pytest
from flint import arb
from reversed_terms import reversed_terms

from derivation.engine.formula.ulp import DOUBLE, SINGLE, Format, spacing_exponent
from derivation.plate.contact.cases.check import promised
from derivation.plate.contact.cases.judge import conditioning
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.impact.oracle import impact as contact_impact
from generated.contact_series import plate_coefficients
from generated.impact import history
from generated.reversed_series import force_by_series

BUDGET = promised()
ETAS = (1e-3, 0.05, 0.0908, 0.0911, 0.2, 0.3332, 0.3335, 0.5302, 1.0, 10.0)
LAM, MU = 6e10, 8e10


def ulps(got: arb, truth: arb, scale: arb, fmt: Format = DOUBLE) -> float:
    """Distance in units in the last place of a scale."""
    return float(abs(got - truth) * arb(2) ** -spacing_exponent(scale, fmt))


@cache
def departure(alpha: float, eta: float) -> arb:
    return contact_balls.departure(alpha, eta, 1.0, 25)


@pytest.mark.parametrize("eta", ETAS)
@pytest.mark.parametrize("fmt", [DOUBLE, SINGLE], ids=lambda fmt: fmt.name)
def test_coefficients_give_the_correction(eta: float, fmt: Format) -> None:
    kind = np.dtype(fmt.name).type
    eta = float(np.float32(eta))  # for both, so that they share their truths
    rows = plate_coefficients(kind(eta))
    assert rows.dtype == fmt.name
    with flint.ctx.workprec(200):
        reach = min(arb(3), 1 / arb(eta))
        for share in (0.02, 0.16, 0.5, 0.8, 0.98):
            A = reach * arb(share)
            alpha = float(A * arb(eta))
            A = arb(alpha) / arb(eta)
            value = arb(0)
            for coefficient in rows[::-1]:
                value = value * (A / reach) ** 2 + arb(float(coefficient))
            truth = departure(alpha, eta)
            scale = (1 + truth).max(abs(truth))
            assert ulps(A * value, truth, scale, fmt) <= BUDGET["plate_coefficients"]


TERMS = 12


@pytest.mark.parametrize(("h", "b"), [(1.0, 20.0), (1.0, 1.5)])
@pytest.mark.parametrize("fmt", [DOUBLE, SINGLE], ids=lambda fmt: fmt.name)
def test_reversed_series_is_the_series(
    h: float, b: float, fmt: Format, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(flint.ctx, "cap", TERMS)
    kind, R = np.dtype(fmt.name).type, 1e4
    c1 = float(plate_coefficients(h / b)[0])

    def call(*arguments: float) -> np.ndarray:
        return force_by_series(*arguments, terms=TERMS)

    for share in (0.01, 0.1, 0.25):
        delta = float(kind((share / max(abs(c1), 1.0) * h) ** 2 / R))
        got = call(*(kind(x) for x in (delta, R, h, b, LAM, MU)))
        assert got.dtype == fmt.name
        lam, mu = float(kind(LAM)), float(kind(MU))
        with flint.ctx.workprec(200):
            stiff = 16 * arb(mu) * (arb(lam) + mu) / (arb(lam) + 2 * arb(mu)) / 3
            a = (arb(R) * arb(delta)).sqrt()
            bracket = sum(
                (p * (a / h) ** n for n, p in enumerate(reversed_terms(h, b, TERMS))), arb(0)
            )
            truth = stiff * a * arb(delta) * bracket
            # Without what conditioning allows: that takes many slow calls.
            assert ulps(arb(float(got)), truth, truth, fmt) <= BUDGET["force_by_series"]


SCENES = ((0.05, 0.03, 10.0, 0.001, 0.05, LAM, MU), (0.13, 72.2, 1.0, 0.1, 1.0, 0.36e9, 0.43e9))


@pytest.mark.parametrize("scene", SCENES)
def test_course_keeps_its_budget(scene: tuple[float, ...]) -> None:
    """At the times when the growing contact has given radii."""
    R, _, v0, h, b, lam, mu = scene
    peaks = contact_impact.impact(*scene, digits=25)
    radii = [float(peaks.max_contact_radius) * share for share in (0.05, 0.3, 0.7, 0.97)]
    times = contact_impact.history(radii, *scene, digits=25)
    names = ("indentation", "velocity", "contact_radius", "force")
    for a, ball in zip(radii, times, strict=True):
        point = (float(ball), *scene)
        found = history(*point)
        with flint.ctx.workprec(200):
            energy = contact_impact.stored_energy(a, R, h, b, lam, mu, 25)
            whole = arb(scene[1]) * arb(v0) ** 2 / 2
            speed = arb(v0) * (1 - energy / whole).sqrt()
            stiff = 16 * arb(mu) * (arb(lam) + mu) / (arb(lam) + 2 * arb(mu)) / 3 / arb(R)
            truths = (
                contact_balls.indentation(a, R, h, b, 25), speed, arb(a), stiff * arb(a) ** 3
            )  # fmt: skip
            largest = (peaks.max_indentation, arb(v0), peaks.max_contact_radius, peaks.max_force)
            totals = conditioning(history, point)
            for name, truth, scale, total in zip(names, truths, largest, totals, strict=True):
                got = arb(float(getattr(found, name)))
                allowed = BUDGET["history"] + float(total) / 2 * float(abs(truth) / scale)
                assert ulps(got, truth, scale) <= allowed, name
