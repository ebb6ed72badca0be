"""Effect of a misprint in the paper's case: values of the published and the derived formula.

Both are evaluated at the largest contact of the corrected law: formulas of a mode for the first
mode, sums over the first MODES modes.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any

import mpmath
import sympy as sp

from derivation.engine.errata.findings import Finding
from derivation.engine.formula.record import Record
from derivation.engine.report.contexts import finding_context
from derivation.engine.report.latex import unit as in_latex
from derivation.engine.report.numbers import number
from derivation.plate.printed.motion import PrintedPower, PrintedSeries
from derivation.plate.vocabulary import BY_NAME, J1, A_j, k, phi
from derivation.scene.model import Model
from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros
from generated.contact_series import plate_coefficients
from generated.impact import impact

MODES = 400
TRUNCATIONS = (100, MODES)
"""Numbers of modes after which divergent sums are truncated."""
Point = Mapping[sp.Symbol, float]


class Consequences:
    """The paper's case as a point at which printed and derived formulas are evaluated."""

    def __init__(self, case: Model, formulas: Mapping[str, Record]) -> None:
        """Take the largest contact of the case."""
        self.formulas = formulas
        peak = impact(case.R, case.m, case.v0, case.h, case.b, case.lam, case.mu)
        a, force = float(peak.max_contact_radius), float(peak.max_force)
        first, third = plate_coefficients(case.h / case.b)[:2]
        reach = min(3.0, case.b / case.h)
        self.case, self.a, self.P = case, a, force
        self.zeros = bessel_j0_zeros(MODES)
        self.weights = bessel_j1_at_j0_zeros(MODES)
        given = {
            "R": case.R, "h": case.h, "b": case.b, "lam": case.lam, "mu": case.mu, "a": a,
            "P": force, "delta": float(peak.max_indentation), "m": case.m, "v0": case.v0,
            "r": case.b / 2, "z": case.h, "c_1": float(first), "c_3": float(third) / reach**2,
        }  # fmt: skip
        self.fixed = {BY_NAME[name].symbol: value for name, value in given.items()}
        for name in ("gamma_2", "gamma_3"):
            self.fixed[BY_NAME[name].symbol] = self.value(formulas[name].expression)

        self.points: dict[int, Point] = {}

    def point(self, j: int) -> Point:
        """Return the values of every symbol in the j-th mode, counted from 1."""
        if j not in self.points:
            self.points[j] = self._mode(j)
        return self.points[j]

    def _mode(self, j: int) -> Point:
        point = dict(self.fixed)
        point[phi], point[J1] = self.zeros[j - 1] / self.case.b, self.weights[j - 1]
        point[A_j] = evaluated(self.formulas["A_j"].expression, point)
        for index in range(1, 5):
            ratio = evaluated(self.formulas[f"Omega_{index}"].expression, point)
            point[BY_NAME[f"C{index}"].symbol] = point[A_j] * ratio
        return point

    def value(self, expression: sp.Expr) -> float:
        """Return the value of a formula without modes."""
        return evaluated(expression, self.fixed)

    def summed(self, expression: sp.Expr, modes: int) -> float:
        """Return the value of a sum truncated after a number of modes."""
        return float(mpmath.fsum(evaluated(expression, self.point(j)) for j in range(1, modes + 1)))

    def of(self, finding: Finding) -> str:
        """Return the consequence of a misprint as LaTeX."""
        printed, derived = finding.diagnosis.given, finding.diagnosis.derived
        unit = in_latex(finding.formula.unit)
        if isinstance(finding.printed, PrintedPower):
            return self._power(printed, derived)
        if isinstance(finding.printed, PrintedSeries):
            cut = [rf"{number(self.summed(printed, modes))} with {modes}" for modes in TRUNCATIONS]
            right = number(self.value(derived))
            return f"truncated, the sum is {' and '.join(cut)} modes, in place of {right} {unit}"
        if finding.formula.summed:
            place, values = f"{MODES} modes", [self.summed(e, MODES) for e in (printed, derived)]
            if finding.printed.name in ("u", "w"):
                place += r" at $r=b/2$, $z=h$"
        else:
            modal = (printed.free_symbols | derived.free_symbols) & {phi, J1, A_j}
            place = "first mode" if modal else "largest contact"
            values = [evaluated(e, self.point(1)) for e in (printed, derived)]
        ratio = values[0] / values[1]
        return (
            f"{place}: {number(values[0])} in place of {number(values[1])} {unit}, "
            f"{times(ratio)} times as much"
        )

    def _power(self, printed: sp.Expr, derived: sp.Expr) -> str:
        """Return the effect of another leading power at half the largest indentation."""
        powers = [sp.Rational(e.subs(k, 2)) for e in (printed, derived)]
        fractions = [0.5 ** float(power) for power in powers]
        deep = float(self.fixed[BY_NAME["delta"].symbol])
        return (
            f"at half the largest indentation, {1e3 * deep / 2:.2f}" + r"\,mm, the leading term "
            f"is {fractions[0]:.3f} of its largest value, in place of {fractions[1]:.3f}"
        )

    def context(self) -> dict[str, str]:
        """Return the numbers of the point as text."""
        case = self.case
        return {
            "R": f"{case.R:g}", "v0": f"{case.v0:g}", "b": f"{case.b:g}",
            "ratio": f"{case.h / case.b:.2f}", "a": f"{1e3 * self.a:.2f}",
            "P": f"{1e-3 * self.P:.2f}",
        }  # fmt: skip


def misprint_names(findings: Sequence[Finding]) -> set[str]:
    """Return the names of the formulas with a misprint."""
    return {finding.printed.name for finding in findings if finding.is_misprint}


def misprints_context(findings: Sequence[Finding], cost: Consequences) -> dict[str, Any]:
    """Return every comparison, with the consequence of a misprint in the paper's case."""
    wrong = sum(finding.is_misprint for finding in findings)
    return {
        "findings": [
            finding_context(f) | {"consequence": cost.of(f) if f.is_misprint else ""}
            for f in findings
        ],
        "counts": {"all": len(findings), "equal": len(findings) - wrong},
        "point": cost.context(),
    }


def times(ratio: float) -> str:
    """Return a ratio with four digits, large ones as powers of ten."""
    return f"${ratio:.4g}$" if 1e-2 <= abs(ratio) < 1e4 else number(ratio)


def evaluated(expression: sp.Expr, point: Point) -> float:
    """Return the value of an expression at a point, in mpmath, without overflow.

    Raises
    ------
    ValueError
        If a symbol has no value there.
    """
    free = sorted(expression.free_symbols, key=str)
    missing = [str(symbol) for symbol in free if symbol not in point]
    if missing:
        raise ValueError(f"expected a value of {', '.join(missing)} in the paper's case, got none")
    function = _function(expression, tuple(free))
    return float(function(*(mpmath.mpf(float(point[symbol])) for symbol in free)))


@cache
def _function(expression: sp.Expr, free: tuple[sp.Symbol, ...]) -> Callable[..., Any]:
    """Return the expression as an mpmath function, cached."""
    made: Callable[..., Any] = sp.lambdify(free, expression, "mpmath")
    return made
