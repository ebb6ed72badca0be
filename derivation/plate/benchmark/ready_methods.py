"""Methods without their own set-up: Hertz's formulas, the generated code, and the references."""

from collections.abc import Callable

import flint
import numpy as np
from flint import arb

from derivation.plate.benchmark.arithmetic import (
    DOUBLE,
    Arithmetic,
    Array,
    BallArithmetic,
    Floats,
)
from derivation.plate.benchmark.interface import BenchmarkCase, Call, Method, Task
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.impact.oracle import impact as contact_impact
from generated import contact_law, contact_series
from generated.impact import impact

# --- Hertz's formulas


def hertz_law(case: BenchmarkCase, ar: Arithmetic) -> Call:
    """Return delta = a^2/R as a function of a."""
    R = ar.number(case.R)
    return lambda a: a * a / R


def hertz_force(case: BenchmarkCase, ar: Arithmetic) -> Call:
    """Return P = (4/3) E* sqrt(R) delta^(3/2) as a function of delta."""
    stiff = stiffness(case, ar)
    return lambda delta: stiff * (delta * np.sqrt(delta))


def hertz_time(case: BenchmarkCase, ar: Arithmetic) -> Call:
    """Return the contact time on a half-space [s] as a function of speed [m/s]."""
    with flint.ctx.workprec(ar.bits):
        root, tenth = arb.pi().sqrt(), arb(1) / 10
        factor = ar.number(4 * root * (4 * tenth).gamma() / (5 * (9 * tenth).gamma()))
    m, power, stiff = ar.number(case.m), 2 * ar.number(1.0) / 5, stiffness(case, ar)
    return lambda v0: factor * (5 * m * v0 * v0 / (4 * stiff)) ** power / v0


def stiffness(case: BenchmarkCase, ar: Arithmetic) -> Array:
    """Return (4/3) E* sqrt(R) [N/m^(3/2)]."""
    R, lam, mu = (ar.number(x) for x in (case.R, case.lam, case.mu))
    return 16 * mu * (lam + mu) / (3 * (lam + 2 * mu)) * np.sqrt(R)


def hertz(task: Task) -> Method:
    """Return the method of Hertz's formulas, which omit the plate."""
    made = {"law": hertz_law, "inversion": hertz_force, "impact": hertz_time}
    return Method(task, "Hertz", "", made[task])


# --- the generated code


def plate(case: BenchmarkCase, ar: Floats) -> list[Array]:
    """Return R, h, b, lam and mu in doubles or singles."""
    r = case
    return [ar.number(x) for x in (r.R, r.h, r.b, r.lam, r.mu)]


def generated_law(ar: Floats = DOUBLE) -> Method:
    """Return the method `indentation` as users call it, with all checks in every call."""

    def prepare(case: BenchmarkCase, _: Arithmetic) -> Call:
        R, h, b, *_elastic = plate(case, ar)
        return lambda a: contact_law.indentation(a, R, h, b)

    return Method("law", "generated code", "set-up included", prepare, ar, "all")


def prepared_law() -> Method:
    """Return the method of the same polynomials, with the plate prepared and without checks."""

    def prepare(case: BenchmarkCase, _: Arithmetic) -> Call:
        plates = contact_series.plates_of(np.array([case.eta]))
        law = contact_series.sphere_on_plate(plates, np.array([case.h]), np.array(case.R))
        if law is None:
            raise ValueError(f"expected ordinary lengths, got {case}")

        def call(a: Array) -> Array:
            values = np.empty(a.size)
            for part in contact_series.blocks_of(a.size):
                contact_series.indent(a[part], a[part].max(), law, values[part])
            return values

        return call

    return Method("law", "generated code", "set-up excluded", prepare, DOUBLE, "all")


def generated_force(ar: Floats = DOUBLE) -> Method:
    """Return the method `force`, the generated code's Newton iteration."""

    def prepare(case: BenchmarkCase, _: Arithmetic) -> Call:
        others = plate(case, ar)
        return lambda delta: contact_law.force(delta, *others)

    return Method("inversion", "generated code", "set-up included", prepare, ar, "all")


def generated_impact(ar: Floats = DOUBLE) -> Method:
    """Return the method `impact` set-up included: 24 nodes, and all four results."""

    def prepare(case: BenchmarkCase, _: Arithmetic) -> Call:
        R, *others = plate(case, ar)
        m = ar.number(case.m)
        return lambda v0: impact(R, m, v0, *others).contact_time

    return Method("impact", "generated code", "set-up included", prepare, ar, "all")


# --- the references


def arb_reference(task: Task, digits: int, quick: bool = True) -> Method:
    """Return the method of certified balls; common quantities are computed at set-up."""
    family = {
        "law": "contour integrals",
        "inversion": "interval root finding",
        "impact": "interval quadrature",
    }

    def prepare(case: BenchmarkCase, ar: Arithmetic) -> Call:
        one = _ball_function(task, case, ar)
        if task == "law":
            one(case.high * case.h)
        return lambda values: np.array([one(float(x)) for x in values], dtype=object)

    return Method(task, family[task], f"{digits} digits", prepare, BallArithmetic(digits), "ball",
                  quick=quick)  # fmt: skip


def _ball_function(task: Task, case: BenchmarkCase, ar: Arithmetic) -> Callable[[float], arb]:
    r, digits = case, ar.digits

    def force(delta: float) -> arb:
        a = contact_balls.contact_radius(delta, r.R, r.h, r.b, digits)
        return 4 * contact_balls.modulus(r.lam, r.mu) * a**3 / (3 * arb(r.R))

    def time(v0: float) -> arb:
        return contact_impact.impact(r.R, r.m, v0, r.h, r.b, r.lam, r.mu, digits).contact_time

    def depth(a: float) -> arb:
        return contact_balls.indentation(a, r.R, r.h, r.b, digits)

    functions: dict[Task, Callable[[float], arb]] = {
        "law": depth,
        "inversion": force,
        "impact": time,
    }
    return functions[task]
