"""Formulas with roots, a logarithm or an inverse function, in a variable that suits them.

roots of 1 + b x     y = |(1 + b x)^(1/q) - 1|; a rational function is left, in which sums that
                     cancel become products: sqrt(1 + x) - 1 - x/2 = -y^2/2
asin(b x)            u = asin(b x); sqrt(1 - b^2 x^2) is cos u
asinh(b x)           u = asinh(b x); sqrt(1 + b^2 x^2) is cosh u
log(1 + b x)         t = |b| x/(2 + b x) and |log(1 + b x)| = 2 atanh t, whose series converges for
                     every x
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import sympy as sp

from derivation.engine.rewrite.form import Step

MOST_ROOT = 6
"""Largest q."""
LARGEST_RATIO = sp.Rational(2, 3)
"""Largest t: above it, the formula itself cancels less."""


@dataclass(frozen=True)
class Substitution:
    """A formula f(x) = front g(u).

    Parameters
    ----------
    front
        A power of x.
    expression, variable
        g, and the symbol u.
    steps
        The steps that compute u from x without cancellation.
    inverse
        x as an expression in u, which rises.
    end
        The largest x at which u is used.
    """

    front: sp.Expr
    expression: sp.Expr
    variable: sp.Symbol
    steps: tuple[Step, ...]
    inverse: sp.Expr
    end: sp.Expr


def substitutions(expression: sp.Expr, x: sp.Symbol) -> Iterator[Substitution]:
    """Yield the formula in the other variable, if that makes it simpler."""
    yield from _in_inverse_function(expression, x)
    roots = {node for node in expression.atoms(sp.Pow) if node.has(x) and not node.exp.is_Integer}
    logarithms = {node for node in expression.atoms(sp.log) if node.has(x)}
    bases = {node.base for node in roots} | {node.args[0] for node in logarithms}
    if len(bases) != 1 or (roots and logarithms):
        return
    (base,) = bases
    start, slope = base.subs(x, 0), base.diff(x)
    if not (start.is_Rational and slope.is_Rational and start > 0 and slope):
        return
    b = slope / start
    if roots and all(node.exp.is_Rational for node in roots):
        yield from _in_root(expression, x, {node: node.exp for node in roots}, start, b)
    elif logarithms and start == 1:
        yield from _in_inverse_tangent(expression, x, sp.log(base), b)


INVERSES: Mapping[type[sp.Function], tuple[type[sp.Function], type[sp.Function], int]] = {
    sp.asin: (sp.sin, sp.cos, -1),
    sp.asinh: (sp.sinh, sp.cosh, 1),
}
"""The function whose inverse it is, its derivative g', and the sign in (g')^2 = 1 +- g^2."""


def _in_inverse_function(expression: sp.Expr, x: sp.Symbol) -> Iterator[Substitution]:
    """Yield a formula with asin(b x) or asinh(b x) and its root in the value of this function."""
    inverses = expression.atoms(*INVERSES)
    if len(inverses) != 1:
        return
    (inverse,), (u,) = inverses, _symbols("angle", x)
    function, derivative, sign = INVERSES[inverse.func]
    b = inverse.args[0] / x
    if not (b.is_Rational and b > 0):
        return
    root = sp.Dummy(positive=True)

    def is_root(node: sp.Basic) -> bool:
        return isinstance(node, sp.Pow) and sp.expand(node.base - 1 - sign * b**2 * x**2) == 0

    written = expression.replace(is_root, lambda node: root ** (2 * node.exp))
    written = written.xreplace({inverse: u, x: function(u) / b}).xreplace({root: derivative(u)})
    if not written.has(sp.Pow) or all(node.exp.is_Integer for node in written.atoms(sp.Pow)):
        end = 1 / b if sign < 0 else sp.oo
        yield Substitution(sp.Integer(1), written, u, (Step(u, inverse),), function(u) / b, end)


def _in_root(
    expression: sp.Expr,
    x: sp.Symbol,
    exponents: dict[sp.Expr, sp.Rational],
    start: sp.Rational,
    b: sp.Rational,
) -> Iterator[Substitution]:
    q = sp.ilcm(1, *(exponent.q for exponent in exponents.values()))
    if q > MOST_ROOT:
        return
    y, own, sign = *_symbols("change_of_root", "root", x), sp.sign(b)
    changed, root = 1 + sign * y, sp.Dummy(positive=True)
    inverse = sp.expand(changed**q - 1) / b
    powers = {
        node: start**exponent * root ** (q * exponent) for node, exponent in exponents.items()
    }
    inner = expression.xreplace(powers).subs(x, inverse).subs(root, changed)
    if inner.is_rational_function(y):
        power = (1 + b * x) ** sp.Rational(1, q)
        change = abs(b) * x / sp.horner(sum(own**k for k in range(q)), own)
        steps = Step(own, power), Step(y, change)
        yield Substitution(
            sp.Integer(1),
            sp.factor(sp.cancel(inner)),
            y,
            steps,
            inverse,
            sp.oo if b > 0 else -1 / b,
        )


def _in_inverse_tangent(
    expression: sp.Expr, x: sp.Symbol, logarithm: sp.Expr, b: sp.Rational
) -> Iterator[Substitution]:
    t, value = *_symbols("ratio", x), sp.Dummy()
    sign = sp.sign(b)
    inverse = 2 * t / (abs(b) * (1 - sign * t))
    if expression.xreplace({logarithm: value}).is_rational_function(x, value):
        # Without its leading power, the rounding of t has little effect on the formula.
        front = x ** expression.as_leading_term(x).as_coeff_exponent(x)[1]
        inner = sp.cancel((expression / front).xreplace({logarithm: value}).subs(x, inverse))
        written = inner.xreplace({value: 2 * sign * sp.atanh(t)})
        steps = (Step(t, abs(b) * x / (2 + b * x)),)
        yield Substitution(front, written, t, steps, inverse, inverse.subs(t, LARGEST_RATIO))


def _symbols(*names: object) -> tuple[sp.Symbol, ...]:
    """Return symbols named after the variable, the last argument."""
    return tuple(sp.Symbol(f"{name}_of_{names[-1]}", positive=True) for name in names[:-1])
