"""Test the references and error limits of hard cases of laws, and stated error bounds."""

import dataclasses
import math
from fractions import Fraction

import flint
import numpy as np
import pytest
from mpmath import mp, mpf

from derivation.engine.measure import hard
from derivation.engine.measure.case import HardCase
from derivation.engine.measure.kernels import Stating
from derivation.engine.measure.suite import Known, Suite
from derivation.engine.oracle.agreement import to_ball as as_ball
from derivation.engine.oracle.reference import reference_from_text
from derivation.plate.back_face import route as back_face_routes
from derivation.plate.cases.laws import LAWS
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.edge.route import clamped as clamp_routes
from derivation.plate.edge.route import supported as edge_routes
from derivation.plate.pressure import route as pressure_routes
from generated.impact import history


def test_second_reference_agrees(cases: tuple[HardCase, ...], references: dict[str, Known]) -> None:
    """The second reference agrees at the first point of a case."""

    def first(kernel: str) -> tuple[dict[str, float], flint.arb]:
        case = next(c for c in cases if c.kernel == kernel)
        return case.points[0], reference_from_text(references[case.key].references[0]).value

    with mp.workdps(40), flint.ctx.workprec(200):
        p, value = first("clamped_edge")
        nu = mpf(p["lam"]) / (2 * (mpf(p["lam"]) + mpf(p["mu"])))
        edge = clamp_routes.clamp_part("indentation", p["a"], p["h"], p["b"], nu, 24)
        assert abs(value / as_ball(-edge) - 1) < 1e-23

        p, value = first("supported_edge")
        nu = mpf(p["lam"]) / (2 * (mpf(p["lam"]) + mpf(p["mu"])))
        edge = edge_routes.edge_part("indentation", p["a"], p["h"], p["b"], nu, 24)
        assert abs(value / as_ball((1 - nu) / (1 + nu) * edge) - 1) < 1e-23

        p, value = first("back_face_stress")
        total = back_face_routes.back_face_sum(p["a"], p["h"], p["b"], 24)
        nu = mpf(p["lam"]) / (2 * (mpf(p["lam"]) + mpf(p["mu"])))
        stress = (1 + nu) * p["P"] / (8 * mp.pi * mpf(p["h"]) ** 2) * total
        assert abs(value / as_ball(stress) - 1) < 1e-22

        p, value = first("contact")
        shape = Fraction(p["a"]) / Fraction(p["h"]), Fraction(p["h"]) / Fraction(p["b"])
        force = pressure_routes.solve(*shape, digits=20)[0]
        force *= mpf(p["modulus"]) * mpf(p["a"]) ** 3 / mpf(p["R"])
        assert abs(value / as_ball(force) - 1) < 1e-19


def test_stated_errors_are_tested(suite: Suite, references: dict[str, Known]) -> None:
    known = suite.kernels["leading"]
    assert isinstance(known, Stating)
    case = next(c for c in suite.cases if c.kernel == "leading")

    def with_stated(fraction: float) -> hard.HardRow:
        less = dataclasses.replace(
            known, stated=lambda *x: tuple(fraction * error for error in known.stated(*x))
        )
        one = dataclasses.replace(suite, cases=(case,), kernels={"leading": less})
        (row,) = hard.check(one, references)
        return row

    assert with_stated(1.0).passed
    assert not with_stated(0.1).passed


def test_conditioning_of_a_state_is_the_change_by_the_arguments() -> None:
    """The conditioning is the sum of the changes due to each argument, by finite differences."""
    given, step = (7e-3, 0.13, 72.2, 1.0, 0.1, 1.0, 0.36e9, 0.43e9), 1e-4
    total = np.zeros(4)
    for index in range(len(given)):
        ends = [
            [*given[:index], given[index] * f, *given[index + 1 :]] for f in (1 + step, 1 - step)
        ]
        upper, lower = (np.array(history(*moved)) for moved in ends)
        total += np.abs(upper - lower) / (2 * step)
    law = LAWS["history"]
    assert law.slopes is not None
    slopes = law.slopes(given, law.values(given, 20))
    np.testing.assert_allclose([float(x) for x in slopes], total, rtol=1e-4)


def test_stress_of_a_clamped_plate_agrees_with_the_record(
    cases: tuple[HardCase, ...], references: dict[str, Known]
) -> None:
    """It agrees with the recorded value, which differs from the stress with the paper's edge."""
    for kernel in ("clamped_back_face_stress", "back_face_stress"):
        case = next(case for case in cases if case.kernel == "clamped_back_face_stress")
        [given] = [tuple(case.points[0].values())]
        [actual] = LAWS[kernel].values(given, 10)
        known = reference_from_text(references[case.key].references[0]).value
        assert (abs(float(actual / known) - 1) < 1e-9) is (kernel == case.kernel)


def test_error_limit_of_a_force_scales_like_that_of_its_radius() -> None:
    """The error limit of a force has the same scale as that of its contact radius.

    The plate is thick, so the plate term sets a scale above 1.
    """
    a, R, h, b = 0.4, 1.0, 1.0, 1.0
    delta = float(contact_balls.indentation(a, R, h, b, 20))
    of_radius, of_force = (LAWS[name].scale for name in ("contact_radius", "force"))
    assert of_radius is not None
    assert of_force is not None
    known = of_radius((delta, R, h, b), flint.arb(a))
    assert of_force((delta, R, h, b, 1.0, 1.0), flint.arb(1)) == known
    assert known > 1.0
    assert LAWS["impact"].scale is None


def test_conditioning_is_not_used_next_to_nu_of_minus_one() -> None:
    """The condition number of nu is not used next to nu = -1, but at nu = -1 + 1e-6 it is."""
    law = LAWS["supported_waves"]
    assert law.slopes is not None
    for nu, free in ((math.nextafter(-1.0, 0.0), True), (-1.0 + 1e-6, False)):
        values = law.values((1.0, 0.1, nu), 20)
        k, slope = values[0], law.slopes((1.0, 0.1, nu), values)[0]
        assert bool(slope < 10 * abs(k)) is free


@pytest.mark.parametrize("name", ["hertz", "leading"])
def test_simple_law_is_not_finite_beyond_its_range(name: str, suite: Suite) -> None:
    """Results and stated errors are not finite for an impact far beyond the law's range."""
    known = suite.kernels[name]
    assert isinstance(known, Stating)
    paper = (0.13, 72.2, 1.0, 0.1, 1.0, 0.36e9, 0.43e9)
    for speed, shown in ((1.0, True), (1e9, False)):
        scene = (*paper[:2], speed, *paper[3:])
        for actual in (known.call(*scene), known.stated(*scene)):
            assert (np.isfinite(np.ravel(actual)) == shown).all()
