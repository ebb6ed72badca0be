"""Formulas of several variables by identities that avoid cancellation and overflow.

difference of roots            (p^2 - q^2)/(p + q)
cos u - cos v and similar      products of functions of (u + v)/2 and (u - v)/2
c e^p - c e^q                  c e^max(p, q) (expm1(min(p - q, 0)) - expm1(-max(p - q, 0)))
f(p) - f(q) of other functions see `two_arguments`
log(c e^p + c e^q)             log c + max(p, q) + log1p(e^(min(p, q) - max(p, q)))
sinh u/sinh v and similar      one exponential of the largest exponents, and decaying ones
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, combinations

import sympy as sp
from sympy.codegen.cfunctions import expm1, log1p

from derivation.engine.formula.differences import HYPERBOLIC, TRIGONOMETRIC, in_products
from derivation.engine.formula.proof import decide_zero
from derivation.engine.rewrite.rules import conjugate
from derivation.engine.rewrite.terms import UnreachableError
from derivation.engine.rewrite.two_arguments import difference_of_functions

MOST_CASES = 4
"""Largest number of differences whose signs distinguish the cases of a proof."""
_ANY = sp.Dummy()


def by_identities(expression: sp.Expr) -> Iterator[sp.Expr]:
    """Yield equal expressions that avoid cancellation and overflow, other than the given one."""
    bounded = expression.replace(lambda node: node.is_Mul, _bounded)
    factored = sp.powsimp(sp.factor(expression), combine="exp")
    for given in dict.fromkeys((bounded, expression, factored)):
        stable = given.replace(sp.log, _logarithm)
        for written in conjugate(_ANY, stable):
            assert isinstance(written, sp.Expr)  # `conjugate` returns expressions here
            stable = written
        stable = stable.replace(lambda node: node.is_Add, _sum)
        stable = stable.replace(lambda node: node.is_Mul, _bounded)
        if stable != expression:
            yield stable


def prove_identity(written: sp.Expr, expression: sp.Expr) -> None:
    """Prove that an expression with minima and maxima equals a formula, for every sign.

    Raises
    ------
    UnreachableError
        If that is not proved.
    """
    for case, positive in _cases(written, {}):
        if decide_zero(case - expression, positive) is None:
            raise UnreachableError(f"{written} is not proved equal to {expression}")


def _cases(
    written: sp.Expr, signs: Mapping[sp.Expr, int]
) -> Iterator[tuple[sp.Expr, list[sp.Expr]]]:
    """Yield an expression without its bounds, for every sign of the differences in them.

    The second item contains the differences with the signs that make them positive.
    """
    bounds = written.atoms(sp.Min, sp.Max)
    if any(len(bound.args) != 2 for bound in bounds):
        raise UnreachableError(f"more than two bounds in {written}")
    inner = [
        bound for bound in bounds if not any(part.atoms(sp.Min, sp.Max) for part in bound.args)
    ]
    if not inner:
        yield written, [sign * of for of, sign in signs.items()]
        return
    difference, _ = _difference(min(inner, key=str))
    if len(signs) == MOST_CASES and difference not in signs:
        raise UnreachableError(f"more than {MOST_CASES} signs in {written}")
    for sign in (1, -1) if difference not in signs else (signs[difference],):
        chosen = {**signs, difference: sign}
        alike = {b: _chosen(b, chosen) for b in inner if _difference(b)[0] == difference}
        if not _contradictory([own * of for of, own in chosen.items()]):
            yield from _cases(written.xreplace(alike), chosen)


def _contradictory(positive: Sequence[sp.Expr]) -> bool:
    """Return whether some of the expressions cannot all be positive, because their sum is 0."""
    subsets = chain.from_iterable(combinations(positive, n) for n in range(2, len(positive) + 1))
    return any(sp.expand(sp.Add(*subset)) == 0 for subset in subsets)


def _is_bound(node: sp.Basic) -> bool:
    return isinstance(node, sp.Min | sp.Max)


def _difference(bound: sp.Expr) -> tuple[sp.Expr, int]:
    """Return the difference of two bounds without its rational factor, and the sign removed."""
    one, other = bound.args
    _, difference = sp.expand(one - other).as_content_primitive()
    if difference.could_extract_minus_sign():
        return -difference, -1
    return difference, 1


def _chosen(bound: sp.Expr, signs: Mapping[sp.Expr, int]) -> sp.Expr:
    """Return the bound that is reached, by the signs of the differences."""
    difference, removed = _difference(bound)
    first_is_larger = signs[difference] * removed > 0
    return bound.args[0 if first_is_larger == isinstance(bound, sp.Max) else 1]


def _sum(node: sp.Expr) -> sp.Expr:
    """Return a sum with differences written so that they do not cancel."""
    if not node.is_Add:
        return node
    node = in_products(node, (*TRIGONOMETRIC, *HYPERBOLIC))
    for one, other in combinations(sp.Add.make_args(node), 2):
        product_form = _exponentials(one, other) or difference_of_functions(one, other)
        if product_form is not None:
            rest = sp.Add(*(part for part in node.args if part not in (one, other)))
            return _sum(rest) + product_form
    return node


def _exponent(term: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return a term c e^p as c and p."""
    factors = sp.Mul.make_args(term)
    c = sp.Mul(*(factor for factor in factors if not isinstance(factor, sp.exp)))
    return c, sp.Add(*(factor.args[0] for factor in factors if isinstance(factor, sp.exp)))


def _exponentials(one: sp.Expr, other: sp.Expr) -> sp.Expr | None:
    (c, p), (factor, q) = _exponent(one), _exponent(other)
    if c != -factor or p == q:
        return None
    if c.could_extract_minus_sign():
        c, p, q = factor, q, p
    return c * _difference_of_exponentials(p, q)


def _difference_of_exponentials(p: sp.Expr, q: sp.Expr) -> sp.Expr:
    """Return e^p - e^q without overflow of a part."""
    d = sp.factor_terms(sp.expand(p - q, power_base=False))  # not (x/y)^n as x^n y^-n
    if d.is_positive:
        return -sp.exp(p) * expm1(-d)
    if d.is_negative:
        return sp.exp(q) * expm1(d)
    return sp.exp(sp.Max(p, q)) * (expm1(sp.Min(d, 0)) - expm1(-sp.Max(d, 0)))


def _logarithm(argument: sp.Expr) -> sp.Expr:
    """Return the logarithm of a sum of two exponentials without overflow."""
    if not (argument.is_Add and len(argument.args) == 2):
        return sp.log(argument)
    (c, p), (factor, q) = (_exponent(term) for term in argument.args)
    if c != factor or not c.is_positive:
        return sp.log(argument)
    low, high = sp.Min(p, q), sp.Max(p, q)
    return sp.log(c) + high + log1p(sp.exp(low - high))


def _bounded(node: sp.Mul) -> sp.Expr:
    """Return a product of hyperbolic functions and exponentials without overflow of a factor."""
    exponents, rest = [], sp.Integer(1)
    for factor in node.args:
        base, power = factor.as_base_exp()
        if isinstance(factor, sp.exp):
            exponents.append(factor.args[0])
        elif isinstance(base, sp.sinh | sp.cosh) and power.is_Integer:
            largest, remainder = _largest(base)
            exponents.append(power * largest)
            rest *= remainder**power
        else:
            rest *= factor
    if len(exponents) < 2 or not node.has(sp.sinh, sp.cosh):
        return node
    return rest * sp.exp(_one_bound(sp.Add(*exponents)))


def _one_bound(exponent: sp.Expr) -> sp.Expr:
    """Return a sum with a bound as the bound of sums, in which terms may cancel exactly."""
    bounds = [part for part in exponent.args if _is_bound(part) or _is_bound(-part)]
    if not exponent.is_Add or len(bounds) != 1:
        return sp.factor_terms(exponent)
    (bound,) = bounds
    sign, bound = (1, bound) if _is_bound(bound) else (-1, -bound)
    rest = exponent - sign * bound
    kind = {(sp.Max, 1): sp.Max, (sp.Min, 1): sp.Min, (sp.Max, -1): sp.Min, (sp.Min, -1): sp.Max}
    sums = (sp.factor_terms(sp.expand(rest + sign * part)) for part in bound.args)
    return kind[bound.func, sign](*sums)


def _largest(function: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return |u| of sinh u or cosh u, and the function divided by e^|u|."""
    u = function.args[0]
    if u.is_nonnegative:
        largest, decay, difference = u, -2 * u, -expm1(-2 * u)
    else:
        largest, decay = sp.Max(u, -u), sp.Min(2 * u, -2 * u)
        difference = expm1(sp.Min(2 * u, 0)) - expm1(-sp.Max(2 * u, 0))
    return largest, (difference if isinstance(function, sp.sinh) else 1 + sp.exp(decay)) / 2
