"""Oracle 1 of an impact's sensitivities: symmetric differences of balls, at many digits.

Differences with the step 2^-22 and with twice that, of results known to 30 digits, err by
the square of the step; Richardson's extrapolation leaves its fourth power, some 1e-25.
What it takes off, 1e-12 or so, times the square of the step, and 1e-20 at least, is put
on as the radius: an estimate with a margin of thousands, not a proof.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction

import flint
from flint import arb

from derivation.engine.formula.ball import Exact, to_ball
from derivation.plate.contact.oracle.balls import ratio_of
from derivation.plate.contact.oracle.sums import excess
from derivation.plate.impact.oracle.impact import impact

STEP = Fraction(1, 2**22)
DIGITS = 30
_BITS = 128
_FLOOR = 1e-20
PARAMETERS = ("R", "m", "v0", "h", "b", "lam", "mu")


def logarithmic(
    results: Callable[[Fraction], Sequence[arb]],
    step: Fraction = STEP,
    bits: int = _BITS,
    floor: float = _FLOOR,
) -> tuple[arb, ...]:
    """d log(result)/d log(parameter) of results as functions of the parameter's factor, near 1.

    Parameters
    ----------
    results
        Factor -> balls, of so many digits that differences of the step's size keep enough.
    step
        Of the differences.
    bits
        Precision they are taken at.
    floor
        Least radius put on.
    """
    found = []
    for size in (step, 2 * step):
        upper, lower = results(1 + size), results(1 - size)
        with flint.ctx.workprec(bits):
            found.append(
                [(u / v).log() / (2 * to_ball(size)) for u, v in zip(upper, lower, strict=True)]
            )
    with flint.ctx.workprec(bits):
        return tuple(
            near + (near - far) / 3 + arb(0, floor + 1e-8 * float(abs(near - far)))
            for near, far in zip(*found, strict=True)
        )


def sensitivities(scene: Sequence[Exact], parameter: str, digits: int = DIGITS) -> tuple[arb, ...]:
    """Of contact time, largest indentation, force and contact radius to one parameter.

    Parameters
    ----------
    scene
        R, m, v0, h, b, lam, mu.
    parameter
        One of these names.
    """
    index = PARAMETERS.index(parameter)

    def results(factor: Fraction) -> Sequence[arb]:
        moved = [Fraction(x) * (factor if i == index else 1) for i, x in enumerate(scene)]
        R, m, v0, h, b, lam, mu = moved
        return tuple(impact(R, m, v0, h, b, lam, mu, digits))

    return logarithmic(results)


def peaks_by_energy(a: Exact, h: Exact, b: Exact) -> tuple[arb, arb]:
    """Of indentation and contact radius to the energy, at a largest radius: exact, no differences.

    d E = P d delta: the radius follows from (2/5) (1 + work)/(2 (1 + sinc)) in terms of the
    sums of `contact.oracle.sums`.
    """
    with flint.ctx.workprec(_BITS):
        eta, alpha = ratio_of(h, b), to_ball(ratio_of(a, b))
        work, slope, depth = (1 + excess(name, alpha, eta) for name in ("work", "sinc", "hertz"))
        return 2 * work / (5 * depth), work / (5 * slope)


def peaks_by_thickness(a: Exact, h: Exact, b: Exact) -> tuple[arb, arb]:
    """Of delta R/h^2 and a/h to h/b at a fixed energy number, at a largest radius."""
    ratio = ratio_of(a, h)

    def results(factor: Fraction) -> tuple[arb, arb]:
        eta = ratio_of(h, b) * factor
        alpha = to_ball(ratio * eta)
        return 1 + excess("hertz", alpha, eta), 1 + excess("work", alpha, eta)

    with flint.ctx.workprec(_BITS):
        depth, work = logarithmic(results)
        by_energy, radius = peaks_by_energy(a, h, b)
        return depth - work * by_energy, -work * radius
