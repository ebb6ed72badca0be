"""What hard cases of laws are held to: by a second oracle, and what kernels state themselves."""

import dataclasses
from fractions import Fraction

import flint
import numpy as np
from mpmath import mp, mpf

from derivation.measure import hard_check
from derivation.measure.hard import Case
from derivation.measure.hard_kernels import Stating
from derivation.measure.hard_laws import LAWS
from derivation.measure.hard_truth import Known, restored
from derivation.reference import edge_routes, far_face_routes, pressure_routes
from derivation.reference.routes import to_ball as as_ball
from generated.impact import history


def test_the_second_oracle_agrees(cases: tuple[Case, ...], truth: dict[str, Known]) -> None:
    """At the first point of a case; nothing of it is in units."""

    def first(kernel: str) -> tuple[dict[str, float], flint.arb]:
        case = next(c for c in cases if c.kernel == kernel)
        return case.points[0], restored(truth[case.key].references[0]).value

    with mp.workdps(40), flint.ctx.workprec(200):
        p, value = first("clamped_edge")
        nu = mpf(p["lam"]) / (2 * (mpf(p["lam"]) + mpf(p["mu"])))
        edge = edge_routes.edge_part("indentation", p["a"], p["h"], p["b"], nu, 24)
        assert abs(value / as_ball(-edge) - 1) < 1e-23

        p, value = first("far_stress")
        total = far_face_routes.far_sum(p["a"], p["h"], p["b"], 24)
        nu = mpf(p["lam"]) / (2 * (mpf(p["lam"]) + mpf(p["mu"])))
        stress = (1 + nu) * p["P"] / (8 * mp.pi * mpf(p["h"]) ** 2) * total
        assert abs(value / as_ball(stress) - 1) < 1e-22

        p, value = first("contact")
        shape = Fraction(p["a"]) / Fraction(p["h"]), Fraction(p["h"]) / Fraction(p["b"])
        force = pressure_routes.solve(*shape, digits=20)[0]
        force *= mpf(p["modulus"]) * mpf(p["a"]) ** 3 / mpf(p["R"])
        assert abs(value / as_ball(force) - 1) < 1e-19


def test_who_states_an_error_is_held_to_it(
    cases: tuple[Case, ...], truth: dict[str, Known]
) -> None:
    known = hard_check.kernels()["leading"]
    assert isinstance(known, Stating)
    case = next(c for c in cases if c.kernel == "leading")

    def with_stated(share: float) -> hard_check.Row:
        less = dataclasses.replace(
            known, stated=lambda *x: tuple(share * error for error in known.stated(*x))
        )
        (row,) = hard_check.check([case], truth, {"leading": less})
        return row

    assert with_stated(1.0).kept
    assert not with_stated(0.1).kept


def test_rounding_of_a_state_is_what_the_arguments_change() -> None:
    """Differences of the generated code say what moving every argument does, added up."""
    given, step = (7e-3, 0.13, 72.2, 1.0, 0.1, 1.0, 0.36e9, 0.43e9), 1e-4
    total = np.zeros(4)
    for place in range(len(given)):
        ends = [
            [*given[:place], given[place] * f, *given[place + 1 :]] for f in (1 + step, 1 - step)
        ]
        upper, lower = (np.array(history(*moved)) for moved in ends)
        total += np.abs(upper - lower) / (2 * step)
    law = LAWS["history"]
    assert law.slopes is not None
    found = law.slopes(given, law.values(given, 20))
    np.testing.assert_allclose([float(x) for x in found], total, rtol=1e-4)
