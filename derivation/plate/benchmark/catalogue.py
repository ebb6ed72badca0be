"""Every method that is compared, their order of simplicity, and the choice by family."""

from collections.abc import Sequence
from dataclasses import replace

from derivation.engine.nearest import did_you_mean
from derivation.plate.benchmark import inversion, laws, motion, polynomials, ready_methods, sums
from derivation.plate.benchmark.arithmetic import (
    HAS_LONG_DOUBLE,
    LONG_DOUBLE,
    SINGLE,
    BallArithmetic,
    Mpmath,
)
from derivation.plate.benchmark.interface import PAPER, BenchmarkCase, Method
from derivation.plate.benchmark.ready_methods import hertz
from derivation.plate.impact.oracle import ball_law

SIMPLEST = (
    "Hertz", "generated code", "Gauss-Legendre", "thin-plate closed form",
    "series in a/h", "Newton, series in a/h", "Gauss-Legendre, series in a/h",
    "reversed series", "Chebyshev polynomial", "cubic interpolation", "split sum",
    "split sum, y = u^3", "Levin u transform", "direct sum", "published sum",
)  # fmt: skip
"""Families, the simplest to use first; among ties the first one is the winner."""

DEEP = (30, 50, 100)
"""Digits of the methods in wide arithmetic."""

DEEPEST = 1000
"""Largest number of digits, in the paper's test case only."""

TERMS = {30: 16, 50: 25, 100: 47, DEEPEST: 448}
"""Number of terms of the series in a/h in the paper's test case, by number of digits."""

NODES = {30: 84, 50: 156, 100: 360}
"""Number of nodes of the finite-radius integral, by number of digits."""


def law_methods() -> list[Method]:
    """Return the methods for the indentation as a function of the contact radius."""
    methods = [
        hertz("law"),
        ready_methods.generated_law(),
        ready_methods.prepared_law(),
        ready_methods.generated_law(SINGLE),
    ]
    methods += [sums.printed(n) for n in (10, 100, 1000)]
    methods += [sums.direct(n, quick=n <= 10_000) for n in (100, 1000, 10_000, 100_000)]
    methods += [sums.direct(1000, SINGLE)]
    methods += [sums.split(n, m) for n, m in ((8, 1), (12, 2), (16, 2), (24, 3), (32, 4), (48, 4))]
    methods += [sums.split(n, m, double_exponential=False) for n, m in ((16, 2), (32, 4), (64, 5))]
    methods += [sums.split(48, 4, SINGLE)]
    methods += [sums.levin(n) for n in (4, 8, 12, 16, 20)]
    methods += [polynomials.small_contacts(n) for n in (1, 2, 4, 8, 12, 16)]
    methods += [polynomials.small_contacts(16, SINGLE)]
    methods += [polynomials.thin_plate(n) for n in (2, 4, 8, 16)]
    methods += [polynomials.chebyshev(n) for n in (2, 4, 6, 9, 16)]
    methods += [polynomials.chebyshev(6, SINGLE)]
    methods += [polynomials.table(n) for n in (64, 1024, 8192)]
    return methods + _wide_laws()


def _wide_laws() -> list[Method]:
    """Return the methods for the indentation in more than double precision."""
    methods = []
    if HAS_LONG_DOUBLE:
        methods += [
            polynomials.small_contacts(24, LONG_DOUBLE),
            sums.split(64, 5, LONG_DOUBLE, quick=False),
        ]
    for digits in DEEP:
        quick = digits == DEEP[0]
        for ar in (Mpmath(digits), BallArithmetic(digits)):
            methods.append(polynomials.small_contacts(TERMS[digits], ar, quick))
            methods.append(sums.split(NODES[digits], 0.2 * digits, ar, quick=False))
        methods.append(ready_methods.arb_reference("law", digits, quick))
    return methods + _deepest_laws()


def _deepest_laws() -> list[Method]:
    """Return the methods with DEEPEST digits; those that would take too long state the reason."""

    def elsewhere(case: BenchmarkCase) -> str | None:
        if case == PAPER:
            return None
        return f"omitted: zeros of J0 to {DEEPEST} digits take minutes for each plate"

    def refused(method: Method, reason: str) -> Method:
        return replace(method, fails=lambda case: f"omitted: {reason}")  # noqa: ARG005

    methods = []
    for ar in (Mpmath(DEEPEST), BallArithmetic(DEEPEST)):
        small = polynomials.small_contacts(TERMS[DEEPEST], ar, quick=False)
        methods.append(replace(small, fails=elsewhere))
        # The number of digits is about 1.7 nodes/log(nodes).
        split = sums.split(5000, 0.2 * DEEPEST, ar, quick=False)
        reason = (
            f"nodes, weights and zeros of J0 to {DEEPEST} digits take minutes, "
            "and each point takes seconds"
        )
        methods.append(refused(split, reason))
    hours = ball_law.integrals_seconds(DEEPEST) / 3600
    oracle = ready_methods.arb_reference("law", DEEPEST, quick=False)
    return [*methods, refused(oracle, f"{DEEPEST} digits take about {hours:.0f} hours")]


def inversion_methods() -> list[Method]:
    """Return the methods for the force as a function of the indentation."""
    methods = [
        hertz("inversion"),
        ready_methods.generated_force(),
        ready_methods.generated_force(SINGLE),
    ]
    methods += [inversion.reversed_series(n) for n in (2, 4, 8, 12, 16, 24)]
    methods += [inversion.reversed_series(12, SINGLE)]
    methods += [inversion.table(n) for n in (64, 1024, 8192)]
    methods += [inversion.table(1024, SINGLE)]
    methods += [laws.newton(n) for n in (4, 8, 16)]
    methods += [laws.newton(8, SINGLE), laws.newton(24, Mpmath(DEEP[0]))]
    if HAS_LONG_DOUBLE:
        methods += [inversion.reversed_series(24, LONG_DOUBLE), laws.newton(24, LONG_DOUBLE)]
    return methods + [
        ready_methods.arb_reference("inversion", digits, digits == DEEP[0]) for digits in DEEP
    ]


def impact_methods() -> list[Method]:
    """Return the methods for the contact time as a function of the impact speed."""
    methods = [
        hertz("impact"),
        ready_methods.generated_impact(),
        ready_methods.generated_impact(SINGLE),
    ]
    methods += [motion.linear(n) for n in (25, 100, 400)]
    methods += [motion.perturbation(corrected) for corrected in (False, True)]
    methods += [motion.gauss(n) for n in (4, 6, 8, 12, 16, 20, 24)]
    methods += [laws.gauss(n, m) for n, m in ((4, 4), (12, 8), (24, 16))]
    methods += [laws.gauss(8, 8, SINGLE), laws.gauss(48, 24, Mpmath(DEEP[0]))]
    if HAS_LONG_DOUBLE:
        methods += [laws.gauss(32, 24, LONG_DOUBLE)]
    for name in ("DOP853", "Radau", "LSODA"):
        for rtol in (1e-3, 1e-6, 1e-9, 1e-12):
            quick = name != "Radau" or rtol > 1e-8
            methods.append(motion.solver(name, rtol, quick=quick))
            if name != "DOP853":
                methods.append(motion.solver(name, rtol, largest_step=0.05, quick=False))
    methods += [motion.verlet(n, n == 20) for n in (20, 100, 1000)]
    methods += [motion.verlet(100, False, SINGLE)]
    return methods + [ready_methods.arb_reference("impact", digits, quick=False) for digits in DEEP]


def methods(names: Sequence[str] = (), quick: bool = False) -> list[Method]:
    """Return every method, or those of the named families.

    Raises
    ------
    ValueError
        If there is no such family.
    """
    every = [*law_methods(), *inversion_methods(), *impact_methods()]
    families = list(dict.fromkeys(method.family for method in every))
    for name in names:
        if name not in families:
            suggestion = did_you_mean(name, families)
            known = "; ".join(families)
            raise ValueError(f"--method: no method {name!r}: {suggestion}expected one of: {known}")
    return [
        method
        for method in every
        if (not names or method.family in names) and (method.quick or not quick)
    ]


def simplicity(family: str) -> int:
    """Return the position of a family in SIMPLEST; families not listed come last."""
    return SIMPLEST.index(family) if family in SIMPLEST else len(SIMPLEST)
