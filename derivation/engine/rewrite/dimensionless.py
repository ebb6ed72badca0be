"""Formulas as functions of their dimensionless products, found from the structure of the formula.

Terms of a sum have equal dimensions, and arguments of functions have none. The quotients of terms
and the arguments span the exponents of all products. A basis of them is selected, arguments of
functions first, so that exp(k h) + y depends on k h and y.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from derivation.engine.rewrite.terms import UnreachableError

Weights = Mapping[sp.Symbol, sp.Rational]
"""Exponents of a product, without zeros."""


@dataclass(frozen=True)
class Product:
    """A dimensionless product, or a symbol that has no dimension.

    Parameters
    ----------
    variable
        Its symbol in the reduced formula.
    powers
        The formula's symbols with their integer exponents.
    """

    variable: sp.Symbol
    powers: tuple[tuple[sp.Symbol, sp.Integer], ...]

    @property
    def is_symbol(self) -> bool:
        """Whether it is a symbol of the formula."""
        return self.powers == ((self.variable, 1),)


@dataclass(frozen=True)
class FunctionOfProducts:
    """A formula: powers of its symbols times a function of dimensionless products."""

    front: tuple[tuple[sp.Symbol, sp.Rational], ...]
    expression: sp.Expr
    products: tuple[Product, ...]


def reduced(
    expression: sp.Expr, zeros: Sequence[sp.Symbol], names: Iterator[str]
) -> FunctionOfProducts:
    """Return a formula in its dimensionless products.

    Parameters
    ----------
    expression
        The formula.
    zeros
        Symbols that may be zero; they are not divided by.
    names
        Names for products of several symbols.

    Raises
    ------
    UnreachableError
        If products are not powers, or symbols that may be zero are divided by one another.
    """
    symbols = sorted(expression.free_symbols, key=str)
    front, vectors = _weights(expression)
    basis = [_integer(vector, zeros) for vector in _basis(vectors, symbols)]
    matrix = sp.Matrix([[vector.get(symbol, 0) for symbol in symbols] for vector in basis])
    columns = _eliminated(matrix, symbols, zeros) if basis else []
    for column in columns:
        if symbols[column] in zeros and front.get(symbols[column]):
            (row,) = [k for k in range(len(basis)) if matrix[k, column]][:1]
            rate = front[symbols[column]] / matrix[row, column]
            front = _plus(front, basis[row], -rate)
    if any(power < 0 for symbol, power in front.items() if symbol in zeros):
        raise UnreachableError(f"{expression} is divided by a symbol that may be zero")
    products = tuple(Product(_variable(vector, names), tuple(vector.items())) for vector in basis)
    inverse = matrix[:, columns].inv() if basis else sp.Matrix()
    values = dict.fromkeys(symbols, sp.Integer(1)) | {
        symbols[column]: sp.Mul(*(p.variable ** inverse[i, j] for j, p in enumerate(products)))
        for i, column in enumerate(columns)
    }
    whole = expression / sp.Mul(*(symbol**power for symbol, power in front.items()))
    whole = sp.powdenest(sp.powsimp(whole.subs(values, simultaneous=True)))
    for product in products:
        whole = whole.replace(sp.Add, _without_divisor(product.variable))
    return FunctionOfProducts(tuple(front.items()), whole, products)


def _without_divisor(x: sp.Symbol) -> Callable[..., sp.Expr]:
    """Return a function that writes the terms 1 + 2/x as (x + 2)/x."""

    def of_terms(*terms: sp.Expr) -> sp.Expr:
        exponents = [term.as_coeff_exponent(x)[1] for term in terms]
        if not all(exponent.is_Rational for exponent in exponents) or min(exponents) >= 0:
            return sp.Add(*terms)
        least = min(exponents)
        return x**least * sp.Add(*(term / x**least for term in terms))

    return of_terms


def _variable(vector: Weights, names: Iterator[str]) -> sp.Symbol:
    """Return the symbol of a product; its sign is unknown if that of a factor is."""
    first = next(iter(vector))
    if vector == {first: 1}:
        return first
    if all(symbol.is_nonnegative for symbol in vector):
        return sp.Symbol(next(names), positive=True)
    return sp.Symbol(next(names), real=True)


def _weights(node: sp.Basic) -> tuple[dict[sp.Symbol, sp.Rational], list[Weights]]:
    """Return the exponents of a part as a product of powers, and of dimensionless products in it.

    The order of the latter is that in which they are selected.
    """
    if isinstance(node, sp.Symbol):
        return {node: sp.Integer(1)}, []
    if isinstance(node, sp.Mul):
        parts = [_weights(part) for part in node.args]
        total: dict[sp.Symbol, sp.Rational] = {}
        for powers, _ in parts:
            total = _plus(total, powers, 1)
        return total, [vector for _, inner in parts for vector in inner]
    if isinstance(node, sp.Pow) and node.exp.is_Rational:
        powers, inner = _weights(node.base)
        return {symbol: power * node.exp for symbol, power in powers.items()}, inner
    parts = [_weights(part) for part in node.args]
    vectors = [vector for _, inner in parts for vector in inner]
    if isinstance(node, sp.Add):
        parts.sort(key=lambda part: (len(part[0]), str(part[0])))
        first = parts[0][0] if parts else {}
        return first, [*vectors, *(_plus(powers, first, -1) for powers, _ in parts[1:])]
    return {}, [*(powers for powers, _ in parts), *vectors]


def _plus(one: Weights, other: Weights, factor: sp.Expr) -> dict[sp.Symbol, sp.Rational]:
    keys = dict.fromkeys((*one, *other))
    total = {key: one.get(key, 0) + factor * other.get(key, 0) for key in keys}
    return {key: sp.sympify(power) for key, power in total.items() if power}


def _basis(vectors: Sequence[Weights], symbols: Sequence[sp.Symbol]) -> list[Weights]:
    """Return independent vectors with the same span, if possible single symbols."""
    given = [vector for vector in vectors if vector]
    rank = _rank(given, symbols)
    alone: list[Weights] = [{symbol: sp.Integer(1)} for symbol in symbols]
    chosen: list[Weights] = []
    for vector in (*given, *alone):
        inside = _rank([*given, vector], symbols) == rank
        if inside and _rank([*chosen, vector], symbols) > len(chosen):
            chosen.append(vector)
    return _without_signs(_simplified(chosen, alone, symbols))


def _without_signs(chosen: Sequence[Weights]) -> list[Weights]:
    """Remove symbols of unknown sign from products if they are products themselves."""
    free = {s for vector in chosen if len(vector) == 1 for s in vector if not s.is_nonnegative}
    return [
        {s: power for s, power in vector.items() if len(vector) == 1 or s not in free}
        for vector in chosen
    ]


def _simplified(
    chosen: list[Weights], alone: Sequence[Weights], symbols: Sequence[sp.Symbol]
) -> list[Weights]:
    """Replace vectors by single symbols where the span stays the same."""
    for vector in alone:
        if vector in chosen or _rank([*chosen, vector], symbols) > len(chosen):
            continue
        for k in reversed(range(len(chosen))):
            rest = [*chosen[:k], *chosen[k + 1 :]]
            if len(chosen[k]) > 1 and _rank([*rest, vector], symbols) == len(chosen):
                chosen = [*rest, vector]
                break
    return chosen


def _rank(vectors: Sequence[Weights], symbols: Sequence[sp.Symbol]) -> int:
    rows = [[vector.get(symbol, 0) for symbol in symbols] for vector in vectors]
    return int(sp.Matrix(rows).rank()) if rows else 0


def _integer(vector: Weights, zeros: Sequence[sp.Symbol]) -> dict[sp.Symbol, sp.Integer]:
    """Return a vector with coprime integers, positive for symbols that may be zero."""
    unit = sp.Integer(math.lcm(*(int(power.q) for power in vector.values())))
    unit /= sp.gcd_list([power * unit for power in vector.values()])
    signs = {sp.sign(power) for symbol, power in vector.items() if symbol in zeros}
    if len(signs) > 1:
        raise UnreachableError("expected products that stay finite if symbols are zero")
    sign = next(iter(signs or {sp.sign(next(iter(vector.values())))}))
    if len(vector) == 1:
        return dict.fromkeys(vector, sp.Integer(1))
    return {symbol: sign * unit * power for symbol, power in vector.items()}


def _eliminated(
    matrix: sp.Matrix, symbols: Sequence[sp.Symbol], zeros: Sequence[sp.Symbol]
) -> list[int]:
    """Return columns of symbols that the products replace, those that may be zero first."""
    order = sorted(
        range(len(symbols)),
        key=lambda k: (symbols[k] not in zeros, max(map(abs, matrix[:, k])), str(symbols[k])),
    )
    chosen: list[int] = []
    for column in order:
        if matrix[:, [*chosen, column]].rank() > len(chosen):
            chosen.append(column)
    return chosen
