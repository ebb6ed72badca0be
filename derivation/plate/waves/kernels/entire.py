"""cosh and sinh of p and q as entire functions of p^2 and q^2, which the code computes first.

cosh p and sinh(p)/p depend on p^2 alone, for either sign. The code scales both by E_p = e^(-p) for
real p (by 1 otherwise), so that neither overflows; the claims contain the scales.
"""

import sympy as sp

from derivation.engine.emit.routine import Facts, Let, Several
from derivation.engine.formula.functions import unspecified_function
from derivation.plate.vocabulary import gam, kap, x_h
from derivation.plate.waves.theory.bending_branch import quotient
from derivation.plate.waves.theory.dynamic_modes import (
    dynamic_influence,
    in_p_and_q,
    in_sines,
    p,
    q,
    with_roots,
)

E_p, E_q = sp.symbols("E_p E_q", positive=True)
x, over, level, square, m, rest = sp.symbols("x over level square m rest", real=True)
cosh_p, sinh_p, cosh_q, sinh_q = sp.symbols("cosh_p sinh_p cosh_q sinh_q", real=True)
slope_p, slope_q = sp.symbols("slope_p slope_q", real=True)
MEANING: Facts = {x: x_h, over: kap - x_h**2, rest: 1 - gam}
"""Meaning of the arguments."""
_BY_KAP = {over: sp.Integer(1), level: -gam, m: sp.Integer(-1)}
"""Slopes by kap of the first values in the code."""


SlopeOfShc = unspecified_function("SlopeOfShc")
"""(cosh p - sinh(p)/p)/(2 p^2) as a function of p^2."""
Shc = unspecified_function("Shc", SlopeOfShc)
"""sinh(p)/p as a function of p^2."""
Cosh = unspecified_function("Cosh", lambda square: Shc(square) / 2)
"""cosh p as a function of p^2."""
RootTimesSinh = unspecified_function(
    "RootTimesSinh", lambda square: (Shc(square) + Cosh(square)) / 2
)
"""p sinh p as a function of p^2."""
NAMES = {
    Cosh(level): cosh_p,
    Shc(level): sinh_p,
    SlopeOfShc(level): slope_p,
    RootTimesSinh(level): level * sinh_p,
    Cosh(-over): cosh_q,
    Shc(-over): sinh_q,
    SlopeOfShc(-over): slope_q,
    RootTimesSinh(-over): -over * sinh_q,
}
"""Variables of the code for its first values."""


def reduce(expression: sp.Expr) -> sp.Expr:
    """Return 0 if and only if the expression vanishes."""
    return in_sines(in_p_and_q(expression))


def in_cosh_and_sinh(expression: sp.Expr) -> sp.Expr:
    """Return the expression without tanh and coth."""
    reduced = expression.replace(sp.tanh, lambda y: sp.sinh(y) / sp.cosh(y))
    return reduced.replace(sp.coth, lambda y: sp.cosh(y) / sp.sinh(y))


def entire(term: sp.Expr) -> sp.Expr:
    """Return a product of cosh and sinh of p and q, even in both, in the code's first values.

    Raises
    ------
    ValueError
        If it is not even.
    """
    known = {sp.cosh(p): Cosh(level), sp.cosh(q): Cosh(-over)}
    known |= {sp.sinh(p): p * Shc(level), sp.sinh(q): q * Shc(-over)}
    done = in_cosh_and_sinh(term).xreplace(known).subs(2 * x_h**2 - kap, m)
    done = done.subs({p**2: level, q**2: -over, x_h**2: square})
    if done.free_symbols - {m, level, over, square}:
        raise ValueError(f"{term} is not even in p and q")
    roots = {over * Shc(-over): -RootTimesSinh(-over), level * Shc(level): RootTimesSinh(level)}
    return done.subs(roots)


def by_kap(value: sp.Expr) -> sp.Expr:
    """Return the derivative of the code's expression with respect to kap."""
    return sp.Add(*(rate * sp.diff(value, part) for part, rate in _BY_KAP.items()))


def by_log_kap(value: sp.Expr) -> sp.Expr:
    """Return the derivative of an expression of the theory with respect to log kap."""
    return kap * sp.diff(with_roots(value), kap)


def stiffness(bends: bool) -> sp.Expr:
    """Return B_a or B_s in x, kap, p and q."""
    stated: sp.Expr = dynamic_influence()[0 if bends else 1].stated
    return stated


def whole(bends: bool) -> sp.Expr:
    """Return the factor that makes kap B/2 entire."""
    return sp.cosh(p) * sp.cosh(q) if bends else p * sp.sinh(p) * sp.sinh(q) / q


def terms(bends: bool) -> list[sp.Expr]:
    """Return both terms of -kap B/2 times that factor."""
    (bracket,) = (part for part in stiffness(bends).args if part.is_Add)
    return [entire(term * whole(bends)) for term in bracket.args]


def steepness_anywhere() -> sp.Expr:
    """Return minus the slope of B_a's quotient with respect to log kap, times 1 - xi."""
    return -(q**2) / x_h**2 * by_log_kap(quotient()) / quotient()


def _hyperbolic(
    cosh: sp.Symbol, sinh: sp.Symbol, of: sp.Expr, root: sp.Symbol, scale: sp.Symbol
) -> Several:
    exact = (scale * sp.cosh(root), scale * sp.sinh(root) / root)
    return Several((cosh, sinh), "hyperbolic", (of,), exact)


FIRST: tuple[Let | Several, ...] = (
    Let(square, x * x),
    Let(level, rest * square - gam * over, "p^2; q^2 is -over"),
    _hyperbolic(cosh_p, sinh_p, level, p, E_p),
    _hyperbolic(cosh_q, sinh_q, -over, q, E_q),
    Let(m, square - over),
)
"""First statements of every routine of x and kap - x^2."""


def at_zero(expression: sp.Expr, bends: bool) -> sp.Expr:
    """Return 0 if and only if the expression vanishes at all zeros of B, by tanh p from tanh q."""
    t_p, t_q, c_p, c_q = sp.symbols("t_p t_q c_p c_q", positive=True)
    reduced = in_cosh_and_sinh(sp.expand_trig(in_p_and_q(expression)))
    named = {sp.sinh(p): t_p * c_p, sp.sinh(q): t_q * c_q, sp.cosh(p): c_p, sp.cosh(q): c_q}
    top = sp.numer(sp.together(reduced.subs(named)))
    for c, t in ((c_p, t_p), (c_q, t_q)):
        top = _without_squares(top, c, t)
    functions = (sp.tanh, (t_p, t_q)) if bends else (sp.coth, (1 / t_p, 1 / t_q))
    tanh = {functions[0](k): value for k, value in zip((p, q), functions[1], strict=True)}
    (root,) = sp.solve(in_p_and_q(stiffness(bends)).subs(tanh), t_p)
    return sp.expand(sp.numer(sp.together(top.subs(t_p, root))))


def _without_squares(value: sp.Expr, c: sp.Symbol, t: sp.Symbol) -> sp.Expr:
    """Return a polynomial in c, where c^2 = 1/(1 - t^2)."""
    polynomial = sp.Poly(value, c)
    return sp.Add(*(k * c ** (n % 2) * (1 - t**2) ** -(n // 2) for (n,), k in polynomial.terms()))
