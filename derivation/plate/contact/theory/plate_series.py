"""Step 13: delta R/a^2 = 1 + c_1 A + c_3 A^3 + ..., A = a/h, with exact coefficients of h/b.

The split of the indentation converges, so its terms may be expanded in a:
sin y - y cos y = sum (-1)^k (2k-2)/(2k-1)! y^(2k-1), k >= 2. The double sum converges absolutely:
for a < 4 h in the modes, where G - 1 decays like e^(-4 eta j_n), and for a < 2 b in the
finite-radius term, where K0/I0 decays like e^(-2y). The coefficients are the paper's gamma_k
without the divergent part of their sums.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import flint
import sympy as sp

from derivation.engine.cache import in_file
from derivation.engine.formula.ball import LOG2_10, refine
from derivation.engine.formula.dimension import thirds
from derivation.engine.formula.proof import Proof, prove
from derivation.plate.contact.theory.hertz import SOURCES
from derivation.plate.contact.theory.split import lateral_bracket, lateral_tail, reduced_split
from derivation.plate.modes.theory.plate_factor import plate_factors
from derivation.plate.vocabulary import (
    J1,
    Formula,
    P,
    R,
    T,
    a,
    a_ratio,
    alpha,
    c_A,
    eta,
    h,
    j_n,
    kappa,
)

_y = sp.Symbol("y", positive=True)
FIRST, LAST = 2, 5
"""Range of k for which the derivation records coefficients c_(2k-3)."""


@dataclass(frozen=True)
class Coefficient:
    """c_(2k-3): a sum over the modes plus a multiple of kappa_(2k-4).

    Parameters
    ----------
    k
        Index of the paper's gamma_k.
    mode
        One mode's term, in eta, j_n and J1(j_n).
    side
        The part of the finite radius, in eta and kappa.
    proof
        Expansion of the split.
    """

    k: int
    mode: sp.Expr
    side: sp.Expr
    proof: Proof

    @property
    def order(self) -> int:
        """Power of a/h to which the coefficient belongs."""
        return 2 * self.k - 3

    @property
    def by_plate_radius(self) -> tuple[sp.Expr, sp.Expr]:
        """Both parts as coefficients of (a/b)^order, for thick plates."""
        return self.mode / eta**self.order, self.side / eta**self.order


def sine_coefficient(k: int) -> sp.Rational:
    """Return the coefficient of y^(2k-1) in sin y - y cos y."""
    return sp.Rational((-1) ** k * (2 * k - 2), sp.factorial(2 * k - 1))


@in_file(SOURCES, Coefficient, Proof)  # modules of kernels need it when they are imported
def coefficient(k: int) -> Coefficient:
    """Return c_(2k-3), k >= 2, from the coefficient of alpha^(2k-3) in the split, alpha = eta A."""
    order = 2 * k - 3
    excess = plate_factors()[2].expression.subs(T, 2 * eta * j_n)
    size = abs(sine_coefficient(k))
    mode = eta**order * size * (-1) ** k * 8 / sp.pi * j_n ** (2 * k - 5) * excess / J1**2
    side = -(eta**order) * size * 8 / sp.pi**2 * kappa[2 * k - 4]
    mode_term = reduced_split()[1].expression
    factor = 8 * alpha / (3 * sp.pi) / (j_n * J1**2)
    spread = 3 * (sp.sin(_y) - _y * sp.cos(_y)) / _y**3
    taylor = sp.series(spread, _y, 0, order + 1).removeO().coeff(_y, order - 1)
    lateral = sp.series(lateral_bracket(alpha), alpha, 0, 2 * k).removeO().coeff(alpha, 2 * k - 1)
    proof = prove(
        f"Coefficient c_{order}",
        r"Both parts of the split are expanded in Taylor series, with $\alpha = \eta A$.",
        lambda mode, side: {
            "mode term": mode_term - factor * spread.subs(_y, alpha * j_n) * excess,
            "Taylor coefficient": factor / alpha * taylor * j_n ** (order - 1) * eta**order * excess
            - mode,
            "finite radius": -8
            / sp.pi**2
            * lateral
            * kappa[2 * k - 4]
            / _y ** (2 * k - 4)
            * eta**order
            - side,
        },
        *(mode, side),
    )
    return Coefficient(k, mode, side, proof)


@cache
def kappa_by_parts(n: int) -> Proof:
    """Prove kappa_n = int y^n K0/I0 dy = 1/(n+1) int_0^oo y^n/I0^2 dy.

    (K0/I0)' = -1/(y I0^2) by the Wronskian of I0 and K0, and y^(n+1) K0/I0
    vanishes at both ends; the new integrand has no logarithm at 0.
    """
    i0, i1, k0, k1 = sp.symbols("i0 i1 k0 k1", positive=True)
    rates = {i0: i1, i1: i0 - i1 / _y, k0: -k1, k1: -k0 - k1 / _y}

    def slope(expression: sp.Expr) -> sp.Expr:
        inner = (sp.diff(expression, s) * rate for s, rate in rates.items())
        return sp.diff(expression, _y) + sp.Add(*inner)

    wronskian = _y * (i0 * k1 + i1 * k0)
    small = {i0: 1, i1: _y / 2, k0: -sp.log(_y), k1: 1 / _y}
    (derivative,) = sp.solve(wronskian - 1, k1)
    product = _y ** (n + 1) / (n + 1) * k0 / i0
    return prove(
        f"kappa_{n} by parts",
        "y (I0 K1 + I1 K0) is constant and tends to 1 for y -> 0; y^(n+1) K0/I0/(n+1) is "
        "differentiated.",
        {
            "Wronskian": slope(wronskian),
            "constant": sp.limit(wronskian.subs(small), _y, 0) - 1,
            "derivative": slope(product).subs(k1, derivative)
            - _y**n * k0 / i0
            + _y**n / ((n + 1) * i0**2),
        },
    )


@cache
def kappa_ball(n: int, digits: int = 30) -> flint.arb:
    """Return a ball around kappa_n, n >= 0, with a relative radius below 10^-digits."""
    kappa_by_parts(n)

    def compute() -> flint.arb:
        end = flint.arb(int(digits * LOG2_10 / 2) + 8 * (n + 5))
        body = flint.acb.integral(_lateral_integrand(n), flint.acb(0), flint.acb(end)).real
        return (body + flint.arb(0, lateral_tail(n, end).upper())) / (n + 1)

    return refine(compute, digits, f"kappa_{n}")


def _lateral_integrand(n: int) -> Callable[[flint.acb, bool], flint.acb]:
    return lambda y, _: y**n / y.bessel_i(0) ** 2


@cache
def series_formulas() -> tuple[Formula, ...]:
    """Return both parts of c_1, c_3, ..., and the corrected form of the paper's gamma_k."""
    formulas: list[Formula] = []
    for k in range(FIRST, LAST + 1):
        c = coefficient(k)
        parts = (("modes", "modes", c.mode, True), ("lateral", "finite radius", c.side, False))
        for part, source, value, summed in parts:
            formulas.append(
                Formula(
                    f"c_{c.order}_{part}",
                    rf"c_{{{c.order}}}^{{\mathrm{{{part}}}}}",
                    rf"coefficient of $(a/h)^{c.order}$ in $\delta R/a^2$: {source}",
                    value,
                    "1",
                    "10",
                    ("F_modes",) if summed else ("F_lateral",),
                    c.proof,
                    summed=summed,
                )
            )
    return (*formulas, *(regular_gamma(k) for k in range(FIRST, LAST + 1)), small_contact())


@cache
def regular_gamma(k: int) -> Formula:
    """Return gamma_k without its divergent part: delta = (a^2/R) + sum gamma_k P^((2k-1)/3)."""
    order = 2 * k - 3
    value = (a / P ** sp.Rational(1, 3)) ** (2 * k - 1) * c_A[order] / (R * h**order)
    term = a**2 / R * c_A[order] * (a / h) ** order
    power = sp.latex(P ** sp.Rational(2 * k - 1, 3), fold_frac_powers=True)
    proof = prove(
        f"gamma_{k}",
        r"$\gamma_k P^{(2k-1)/3}$ is the term of the small-contact series; $a/P^{1/3}$ is "
        "constant.",
        lambda value: {"term": value * P ** sp.Rational(2 * k - 1, 3) - term},
        value,
    )
    return Formula(
        f"gamma_{k}",
        rf"\gamma_{k}",
        f"coefficient of ${power}$ in the indentation, after Hertz's term",
        value,
        f"m/{thirds('N', 2 * k - 1)}",
        "10",
        (f"c_{order}_modes", f"c_{order}_lateral"),
        proof,
    )


@cache
def small_contact() -> Formula:
    """Return delta R/a^2 as a polynomial in A = a/h, to the recorded order."""
    orders = [2 * k - 3 for k in range(FIRST, LAST + 1)]
    value = 1 + sp.Add(*(c_A[n] * a_ratio**n for n in orders))
    terms = [coefficient(k) for k in range(FIRST, LAST + 1)]
    x = sp.Symbol("x", positive=True)
    total = sp.Add(*(c_A[c.order] * x * eta ** (-c.order) * alpha**c.order for c in terms))
    proof = prove(
        "Small contact",
        r"Powers of $\alpha$ become powers of $A = \alpha/\eta$.",
        lambda value: {"powers": total.subs(alpha, eta * a_ratio) / x + 1 - value},
        value,
    )
    return Formula(
        "delta_reduced",
        r"\delta R/a^2",
        "indentation divided by that of the half-space, for $a < 4 h$ and $a < b$",
        value,
        "1",
        "10",
        tuple(f"c_{n}_modes" for n in orders),
        proof,
        where=("a_ratio < 4",),
    )
