"""Oracle 1 of an impact's sensitivities: symmetric differences of balls, at many digits.

The step is 2^-36 of the parameter, the results are known to 50 digits: an error of
order step^2, some 1e-22, is what remains. Differences with twice the step show it:
four thirds of what both differ by is added to the ball as its radius.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction

import flint
from flint import arb

from derivation.formula.ball import Exact, to_ball
from derivation.reference.contact_balls import ratio_of
from derivation.reference.contact_impact import impact
from derivation.reference.contact_sums import excess

STEP = Fraction(1, 2**36)
DIGITS = 50
PARAMETERS = ("R", "m", "v0", "h", "b", "lam", "mu")


def logarithmic(
    results: Callable[[Fraction], Sequence[arb]], step: Fraction = STEP
) -> tuple[arb, ...]:
    """d log(result)/d log(parameter) of results as functions of the parameter's factor, near 1."""
    found = []
    for size in (step, 2 * step):
        upper, lower = results(1 + size), results(1 - size)
        with flint.ctx.workprec(256):
            found.append(
                [(u / v).log() / (2 * to_ball(size)) for u, v in zip(upper, lower, strict=True)]
            )
    with flint.ctx.workprec(256):
        return tuple(
            near + arb(0, (4 * abs(far - near) / 3).abs_upper())
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
        moved = [*map(Fraction, scene)]
        moved[index] *= factor
        return tuple(impact(*moved, digits=digits))

    return logarithmic(results)


def peaks_by_energy(a: Exact, h: Exact, b: Exact) -> tuple[arb, arb]:
    """Of indentation and contact radius to the energy, at a largest radius: exact, no differences.

    d E = P d delta: the radius follows from (2/5) (1 + work)/(2 (1 + sinc)) in terms of the
    sums of `contact_sums`.
    """
    with flint.ctx.workprec(256):
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

    with flint.ctx.workprec(256):
        depth, work = logarithmic(results)
        by_energy, radius = peaks_by_energy(a, h, b)
        return depth - work * by_energy, -work * radius
