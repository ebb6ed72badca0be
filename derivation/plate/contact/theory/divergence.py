"""Step 11: the terms of the paper's gamma_k for large j, and whether a modal sum converges.

For j -> oo the plate factor tends to 1 and J1(j_n)^2 to 2/(pi j_n), so that phi_j^3 K_j -> 4/(R b).
The terms phi_j^(2k-1) K_j of gamma_k therefore grow like phi_j^(2k-4): for every k >= 2 they do not
tend to zero.
"""

from dataclasses import dataclass
from functools import cache

import sympy as sp

from derivation.engine.formula.dimension import thirds
from derivation.engine.formula.proof import prove
from derivation.mathematics.bessel.theory.zeros import slope_squared, zero_correction
from derivation.plate.contact.theory.hertz import SINE_MINUS
from derivation.plate.contact.theory.law import contact_law
from derivation.plate.vocabulary import J1, Formula, N, P, a, b, h, phi

CONVERGENT, DIVERGENT, UNDECIDED = "convergent", "divergent", "undecided"
_E = sp.Symbol("E", positive=True)


@dataclass(frozen=True)
class Tail:
    """The behaviour of the terms of a modal sum for large j.

    Parameters
    ----------
    kind
        ``convergent`` (absolutely), ``divergent`` or ``undecided``.
    exponent
        Power of j that the amplitude of the terms follows; -oo if they decay exponentially.
    leading
        The terms for large j, in phi; None if they oscillate.
    finding
        Description in words.
    """

    kind: str
    exponent: sp.Expr
    leading: sp.Expr | None
    finding: str


@cache
def slope_at_infinity() -> sp.Expr:
    """Return J1(b phi)^2 for large j in terms of phi: 2/(pi b phi).

    The expansions of J1(j_n)^2 and of j_n begin with 2/(pi beta) and beta.
    """
    first = slope_squared(2).term(0, b * phi)
    # The zero's correction begins with 1/beta, so beta may be replaced by j_n = b phi.
    assert zero_correction(0, 1).first < 1
    return 2 * first / (sp.pi * b * phi)


def tail(term: sp.Expr, variable: sp.Symbol = phi) -> Tail:
    """Determine whether the sum of a term over all modes converges.

    The term is a rational function of e^(h phi), times powers of phi and of J1(b phi), and possibly
    sin and cos of multiples of phi, which are bounded. Convergence depends on its leading power of
    e^(h phi) and then of phi: phi_n grows like n, and a sum of n^p converges only for p < -1.
    """
    smooth = term.subs(J1, sp.sqrt(slope_at_infinity()))
    growth, leading = _leading_exponential(smooth)
    if growth != 0:
        grows = bool(growth > 0)
        return Tail(
            DIVERGENT if grows else CONVERGENT,
            sp.oo if grows else -sp.oo,
            leading,
            f"the terms {'grow' if grows else 'decay'} exponentially with j",
        )
    waves = {node: sp.Dummy() for node in leading.atoms(sp.sin, sp.cos)}
    exponent, top = _leading_power(leading.xreplace(waves), variable)
    oscillates = bool(top.free_symbols & set(waves.values()))
    return _convergence(exponent, None if oscillates else top * variable**exponent)


def _convergence(exponent: sp.Expr, leading: sp.Expr | None) -> Tail:
    like = f"like {_power('j', exponent)}"
    if bool(sp.simplify(-1 - exponent).is_positive):
        return Tail(CONVERGENT, exponent, leading, f"the terms decrease {like}, faster than 1/j")
    if exponent == 0 and leading is not None:
        return Tail(DIVERGENT, exponent, leading, "the terms do not tend to zero")
    if bool(sp.simplify(exponent).is_nonnegative):
        return Tail(DIVERGENT, exponent, leading, f"the terms grow {like}")
    if leading is not None and bool(sp.simplify(exponent + 1).is_nonnegative):
        return Tail(DIVERGENT, exponent, leading, f"the terms decrease no faster than {like[5:]}")
    return Tail(UNDECIDED, exponent, leading, f"the terms oscillate with an amplitude {like}")


def _power(base: str, exponent: sp.Expr) -> str:
    if exponent == 1:
        return base
    return f"{base}^{exponent}" if exponent.is_Integer and exponent > 0 else f"{base}^({exponent})"


def _leading_exponential(term: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return the dominant power of e^(h phi) for large phi, and its coefficient."""
    exponential = term.rewrite((sp.sinh, sp.cosh, sp.tanh, sp.coth), sp.exp)
    exponential = exponential.replace(
        sp.exp, lambda argument: _E ** sp.cancel(sp.expand(argument) / (h * phi))
    )
    constant, power = sp.Integer(1), sp.Integer(0)
    for factor in sp.Mul.make_args(sp.together(exponential)):
        base, exponent = factor.as_base_exp()
        if not base.has(_E):
            constant *= factor
            continue
        collected = sp.collect(sp.expand(base), _E, evaluate=False)
        highest = max(collected, key=lambda p: sp.degree(p, _E) if p.has(_E) else 0)
        constant *= collected[highest] ** exponent
        power += exponent * (sp.degree(highest, _E) if highest.has(_E) else 0)
    return power, constant


def _leading_power(expression: sp.Expr, variable: sp.Symbol) -> tuple[sp.Expr, sp.Expr]:
    """Return the highest power of the variable, and its coefficient, in a product of power sums."""
    exponent, coefficient = sp.Integer(0), sp.Integer(1)
    for factor in sp.Mul.make_args(sp.powsimp(expression)):
        base, outer = factor.as_base_exp()
        if base == variable:
            exponent += outer
            continue
        parts: dict[sp.Expr, sp.Expr] = {}
        for piece in sp.Add.make_args(sp.powsimp(sp.expand(base))):
            rest, own = piece.as_independent(variable, as_Add=False)
            inner = sp.simplify(variable * sp.diff(own, variable) / own)
            parts[inner] = parts.get(inner, sp.Integer(0)) + rest
        top = max(parts, key=lambda p: p.subs(dict.fromkeys(p.free_symbols, 2)))
        exponent += top * outer
        coefficient *= parts[top] ** outer
    return sp.expand(exponent), coefficient


@cache
def influence_at_infinity() -> Formula:
    """Return phi_j^3 K_j for j -> oo."""
    cubed = phi**3 * contact_law()[0].expression.subs(J1, sp.sqrt(slope_at_infinity()))
    limit = sp.limit(cubed.rewrite(sp.exp), h, sp.oo)
    behaviour = tail(phi**3 * contact_law()[0].expression)
    leading = behaviour.leading
    assert leading is not None, "K_j does not oscillate"
    value = sp.factor(limit)
    proof = prove(
        "Influence at infinity",
        r"With $J_1(j_n)^2 \to 2/(\pi j_n)$, $\phi^3 K_j$ depends on $\phi h$ alone, and its limit "
        r"for $\phi h \to \infty$ is the ratio of leading coefficients.",
        lambda limit: {"limit": limit - leading, "exponent": behaviour.exponent},
        value,
    )
    return Formula(
        "K_j_limit",
        r"\lim_{j\to\infty}\phi_j^3 K_j",
        r"limit of $\phi_j^3 K_j$ for large $j$",
        value,
        "1/m^2",
        "10",
        ("K_j",),
        proof,
    )


def printed_term(k: int) -> sp.Expr:
    """Return one mode's term of the paper's gamma_k, k >= 2, with the derived K_j."""
    return _scale(k) * phi ** (2 * k - 1) * contact_law()[0].expression


def _scale(k: int) -> sp.Expr:
    """Return the coefficient of phi^(2k-1) in s(a phi), with a in terms of P^(1/3)."""
    factor = sp.Rational((-1) ** k * (2 * k - 2), sp.factorial(2 * k - 1))
    return factor * (a / P ** sp.Rational(1, 3)) ** (2 * k - 1)


@cache
def truncated_gamma(k: int) -> Formula:
    """Return the leading growth with N of the paper's gamma_k, its sum truncated after N modes.

    By Stolz's theorem the partial sums of positive terms that behave like
    C n^p, p > -1, behave like C N^(p+1)/(p+1); phi_n behaves like pi n/b.
    """
    n = sp.Symbol("n", integer=True, positive=True)
    growth = tail(printed_term(k))
    assert growth.kind == DIVERGENT, growth.finding
    assert growth.leading is not None
    term = sp.powsimp(growth.leading.subs(phi, sp.pi * n / b), force=True)
    power = growth.exponent
    constant = sp.expand(term / n**power)
    total = sp.powsimp(constant * N ** (power + 1) / (power + 1))
    step = sp.Symbol("N", integer=True, positive=True)
    limit = influence_at_infinity().expression
    partial = sp.expand(sp.summation(n**power, (n, 1, step)) / step ** (power + 1))
    proof = prove(
        f"Growth of gamma_{k}",
        r"The sum of $n^p$ over $n \le N$ is Faulhaber's polynomial; its leading coefficient is "
        "$1/(p + 1)$, and by Stolz's theorem lower terms do not change the leading one.",
        lambda total: {
            "power": power - (2 * k - 4),
            "coefficient": sp.series(SINE_MINUS, phi, 0, 2 * k).removeO().coeff(phi, 2 * k - 1)
            - _scale(k) * P ** sp.Rational(2 * k - 1, 3),
            "Faulhaber": sp.limit(partial, step, sp.oo) - 1 / (power + 1),
            "constant": constant - _scale(k) * (sp.pi / b) ** power * limit,
            "growth": sp.diff(total, N) - _scale(k) * (sp.pi / b) ** power * limit * N**power,
        },
        total,
    )
    return Formula(
        f"gamma_{k}_truncated",
        rf"\gamma_{k}^{{(N)}}",
        rf"the paper's $\gamma_{k}$ truncated after $N$ modes, for large $N$",
        total,
        f"m/{thirds('N', 2 * k - 1)}",
        "10",
        ("K_j_limit",),
        proof,
    )


def divergence() -> tuple[Formula, ...]:
    """Return the limit of phi^3 K_j, and the growth of the first truncated coefficients."""
    return (influence_at_infinity(), truncated_gamma(2), truncated_gamma(3))
