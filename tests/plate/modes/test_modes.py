"""Test the fields of a mode and their sums at arguments of former errors, and in any units."""

import itertools
import math
from random import Random

import flint
import numpy as np
import pytest

from derivation.engine.formula.ball import enclose
from derivation.engine.measure.point import Point
from derivation.engine.measure.target import Target
from derivation.engine.rewrite.truncated_series import END, truncated_series
from derivation.plate.search.draw import draw
from derivation.plate.search.targets import targets
from generated import blocks as generated_blocks

MODES = ("mode_f", "mode_g", "mode_zz", "mode_rz", "mode_rr", "mode_tt")
SUMS = ("delta", "u", "w", "sigma_rr", "sigma_tt", "sigma_zz", "sigma_rz")
TARGETS = {target.name: target for target in targets((*MODES, *SUMS))}

WORST = (
    # The terms of both faces cancel at mid-plane of a plate somewhat thicker than T = 2.
    (
        "mode_g",
        (
            "-0x1.74496cab96ebcp-48 0x1.0c85337e38376p+0 0x1.1bd0425a3dba3p+0 "
            "-0x1.70b02347cd5f1p-29 0x1.aaadf94ba7414p+12 -0x1.3d8da23bdeaa8p+44"
        ),
    ),
    (
        "mode_rr",
        (
            "0x1.d71597b1b1e59p-49 0x1.32b08a2ec9cb6p+21 0x1.f2d5b7cb7219cp-22 "
            "-0x1.4a57783c9cfa7p+24 0x1.f623209cdd675p+24 0x1.7c7a9147fb691p+4"
        ),
    ),
    # Close to a zero of the function.
    (
        "mode_tt",
        (
            "-0x1.b3486fcbc8e93p+1 0x1.743786fb5c7a5p-5 0x1.453c3c6697b37p+4 "
            "0x1.3ae88d2a55b84p+32 0x1.7408dfd8d3e12p+35 -0x1.e280e3a08a1acp+29"
        ),
    ),
    # On the contact face, where S_zz equals A_j.
    (
        "mode_zz",
        (
            "0x1.071c9f8f437c5p+0 0x1.2d6128a565ae5p+2 0x1.071ca186d22a7p+0 "
            "0x1.8898c86fb15f0p-18 0x1.9eee833d8a9e9p+0 0x1.d030fbdb974b8p+0"
        ),
    ),
    (
        "mode_f",
        (
            "0x1.cd48cdb11d810p+0 0x1.bb25807fb9dc3p+0 0x1.cd48cdded2d60p+0 "
            "0x1.382aed3f71c24p+7 0x1.1190ebad7d995p+0 0x1.d144b9b0b1e6dp+0"
        ),
    ),
    # Close to the largest double.
    (
        "mode_f",
        (
            "-0x1.3109492c469b3p-8 0x1.757da1009f5d9p-259 0x1.1aec0b05a8fd5p-5 "
            "-0x1.cca081b5f1168p-14 0x1.c277199f04dcfp-13 -0x1.30cdfd0566cf2p-38"
        ),
    ),
    # Intermediate products underflow although the result is of moderate size.
    (
        "mode_rz",
        (
            "-0x1.b4a2339c0ebeep-5 0x1.a2fe76a3f9475p-499 0x1p+0 "
            "0x1.bb45c720e3ea8p-372 0x1.75373ed86198ap-384 -0x1.a71368f0f3047p-403"
        ),
    ),
    (
        "mode_zz",
        (
            "0x1.3333333333333p-2 0x1.199999999999ap+0 0x1p+0 "
            "0x1.047824f2bb6dap-784 0x1.047824f2bb6dap-783 0x1.86b4376c19247p-783"
        ),
    ),
    (
        "mode_g",
        (
            "0x1.7e57912838a52p+197 0x1.9b604aaaca626p-199 0x1.3e9e4e4c2f344p+199 "
            "0x1p+0 0x1p+0 0x1p+0"
        ),
    ),
    # On the back face, where the half-space deflection is not the largest term.
    (
        "mode_f",
        (
            "-0x1.ae5982793b72dp+13 0x1.3a674fba6957fp-13 0x1.ae59828b9decep+13 "
            "0x1.0e8b6a1971cd2p+26 0x1.7501d3eedfbd9p+9 -0x1.2ea19df5466adp-23"
        ),
    ),
    # Mid-plane of a thin plate, where -2 nu/4 is nearly the whole value.
    (
        "mode_g",
        (
            "0x1.4b3bca02d7d0bp-17 0x1.d9d5a89aee143p-9 0x1.4eca30b9f2838p+7 "
            "0x1.e388e938df3b6p+4 0x1.c71d95e394817p-9 0x1.42d8b0fe2bd82p-17"
        ),
    ),
    # Bending and stretching of a thin plate cancel.
    (
        "mode_tt",
        (
            "-0x1.d8239bfc2a203p-6 0x1.39dacb7fbc74bp-3 0x1.898dab2dccaafp+0 "
            "-0x1.32b6fd1790247p-7 0x1.781293401c817p+22 -0x1.f361615044907p+54"
        ),
    ),
    # Mid-plane, where the square of phi h is close to the smallest double.
    (
        "mode_rr",
        "0x0p+0 0x1p-402 0x1p+0 -0x1p-8 0x1p-7 0x1.3p+0",
    ),
)
"""Names of functions, and arguments."""

WORST_SUMS = (
    # Near the back face of a thick plate, where the terms nearly cancel for nu close to -1.
    (
        "sigma_rr",
        (
            "0x0p+0 -0x1.9201189c733a1p+24 0x1.92014995c93b0p+24 0x1.4fc6175319fedp+20 "
            "0x1.34691fec5cbedp+1 0x1.14dea80a52341p+1 "
            "-0x1.0e0c2fd12dc19p-24 0x1.9512b937d62e4p-24"
        ),
        3,
    ),
    (
        "sigma_tt",
        (
            "0x1.ba76e26b40bd6p+5 -0x1.53f244616b85ap+11 0x1.53f2446172b8fp+11 "
            "0x1.15ac0b0647cebp+8 0x1.58b622ce07d22p+57 0x1.9bae6338a162dp+5 "
            "-0x1.8975787dd642ep-17 0x1.27181a5e6273bp-16"
        ),
        49,
    ),
    # Powers of phi cancel each other.
    (
        "delta",
        ("0x1.0f2ca29f6631ep-20 0x1.a8bdf5e016cd4p-24 0x1.17014e9652908p+3 0x1.306c8fffe8cd9p-24"),
        1,
    ),
)
"""Names of sums, arguments, and numbers of modes."""


def ratio(target: Target, point: Point) -> float | None:
    """Return the error over its limit, or None if it cannot be evaluated; raise on warnings."""
    with np.errstate(all="raise"):
        (got,) = target.call([point])
    actual = target.measure(point, got)
    return None if actual is None or math.isinf(actual.allowed) else actual.ratio


@pytest.mark.parametrize(
    ("name", "inputs", "modes"), [*((*case, None) for case in WORST), *WORST_SUMS]
)
def test_former_errors_are_corrected(name: str, inputs: str, modes: int | None) -> None:
    target = TARGETS[name]
    values = map(float.fromhex, inputs.split())
    actual = ratio(target, Point(dict(zip(target.domain.arguments, values, strict=True)), modes))
    assert actual is not None
    assert actual <= 1.0


LENGTHS, STRESSES = ("r", "z", "h", "b", "R", "a"), ("lam", "mu", "A_j")


@pytest.mark.parametrize("name", [*MODES, *SUMS])
def test_results_do_not_depend_on_units(name: str) -> None:
    """The error limits hold for lengths and stresses scaled by 2^-400, 1 and 2^400."""
    target, generator, judged = TARGETS[name], Random(name), 0
    for length, stress in itertools.product((-400, 0, 400), repeat=2):
        powers = dict.fromkeys(LENGTHS, length) | dict.fromkeys(STRESSES, stress)
        for _ in range(4):
            drawn = draw(target.domain, generator)
            values = {
                key: math.ldexp(value, powers.get(key, -length if key == "phi" else 0))
                for key, value in drawn.values.items()
            }
            if any(0 < abs(value) < 1e-300 for value in values.values()):
                continue
            actual = ratio(target, Point(values, drawn.modes))
            judged += actual is not None
            assert actual is None or actual <= 1.0, (length, stress, drawn)
    assert judged > 12


@pytest.mark.parametrize("name", list(truncated_series()))
def test_truncated_series_are_accurate_up_to_the_end_of_their_range(name: str) -> None:
    """Each truncated Taylor series is accurate to two ULP from 0 to the end of its range."""
    section = truncated_series()[name]
    (square,) = section.arguments
    inner = np.random.default_rng(3).uniform(0.0, float(END) ** 2, 300)
    points = np.concatenate([inner, [1e-300, 1e-16, float(END) ** 2]])
    actual = getattr(generated_blocks, name)(points)
    with flint.ctx.workprec(3000):
        for point, got in zip(points.tolist(), actual.tolist(), strict=True):
            exact = float(enclose(section.total, {square: flint.arb(point)}))
            assert abs(got - exact) <= 2.0 * math.ulp(exact)
