"""Edits inside an integral: another limit, or a change in the integrand, found by trial."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import cosh, exp, pi, sinh, tanh

import flint
import sympy as sp

from derivation.engine.errata.edit import Edit, edit_of
from derivation.engine.errata.pairs import outer_value
from derivation.engine.errata.position import Position, all_positions, with_required_values
from derivation.engine.errata.sample import Sample, Values, real
from derivation.engine.errata.variant import COST, LIMIT, VariantSearch, all_variants
from derivation.engine.formula.ball import enclose
from derivation.engine.formula.tape import recorded

_TRIAL_BITS = 53
_NODES, _STEP = 24, 0.13
_INSIDE = flint.arb(flint.fmpq(307, 811))
"""Position in the range of the variable at which changes of the integrand are compared."""
_CLOSE = 1e-3
"""Relative error that an estimate may have."""


def integral_edits(root: Position, reference: Values, search: VariantSearch) -> list[Edit]:
    """Return edits inside integrals that give the correct values, the most likely first."""
    edits = []
    for position, need in with_required_values(root, reference, search.points):
        if isinstance(position.node, sp.Integral):
            for edit in _edits(position.node, position, search):
                if _possible(edit.new, need[0], search.points) and search.points.same(
                    edit.new, need
                ):
                    edits.append(edit)
    return sorted(edits, key=Edit.order)


def _possible(new: sp.Integral, need: flint.acb, points: Sample) -> bool:
    """Return whether an integral may have a value at the first sample point, by an estimate."""
    try:
        with flint.ctx.workprec(_TRIAL_BITS):
            value = _estimate(new, points.known[0])
    except (NotImplementedError, OverflowError):  # no ball arithmetic, or out of range
        return False
    return abs(value - complex(need)) <= _CLOSE * abs(complex(need))


def _estimate(node: sp.Integral, known: Mapping[sp.Basic, flint.acb]) -> complex:
    """Return an estimate of an integral, by double exponential quadrature."""
    *rest, (x, low, high) = node.limits
    function = sp.Integral(node.function, *rest) if rest else node.function
    inside = function.atoms(sp.Integral)
    inner = [
        part for part in inside if not any(part != other and other.has(part) for other in inside)
    ]
    symbols = sorted(function.free_symbols - {x}, key=str)
    tape = recorded(function, (x, *symbols, *inner))
    begin, end = (
        limit if limit.is_infinite else complex(enclose(limit, known)) for limit in (low, high)
    )
    total = 0j
    for place, weight in _nodes(begin, end):
        here = {**known, x: flint.acb(place)}
        parts = [flint.acb(_estimate(part, here)) for part in inner]
        value = flint.acb(tape.run([here[x], *(here[s] for s in symbols), *parts])[-1])
        if value.is_finite():  # not next to a singular end
            total += weight * complex(value)
    return total


def _nodes(begin: complex | sp.Expr, end: complex | sp.Expr) -> Iterator[tuple[complex, complex]]:
    """Yield points of a range and their weights."""
    for index in range(-_NODES, _NODES + 1):
        t = index * _STEP
        s, weight = pi / 2 * sinh(t), _STEP * pi / 2 * cosh(t)
        if isinstance(begin, complex) and isinstance(end, complex):
            half = (end - begin) / 2
            yield begin + half * (1 + tanh(s)), half * weight / cosh(s) ** 2
        elif isinstance(begin, complex):
            yield begin + exp(s), weight * exp(s)
        elif isinstance(end, complex):
            yield end - exp(s), weight * exp(s)
        else:
            yield complex(sinh(s)), weight * cosh(s)


def _edits(node: sp.Integral, position: Position, search: VariantSearch) -> Iterator[Edit]:
    for index, (x, *limits) in enumerate(node.limits):
        for place, limit in enumerate(limits):
            for other in _other_limits(limit, search):
                changed = [*limits[:place], other, *limits[place + 1 :]]
                bounds = [*node.limits[:index], (x, *changed), *node.limits[index + 1 :]]
                end = ("lower", "upper")[place]
                says = f"read the {end} limit {other} of the integral over {x} instead of {limit}"
                yield Edit(LIMIT, position, sp.Integral(node.function, *bounds), says, COST[LIMIT])
    inner = _inside(node, search)
    root, seen = Position(node.function), set[float]()
    for part in all_positions(root):
        for variant in all_variants(part, inner):
            value = real(outer_value(part, variant.value, root, inner))
            if value is None or round(value, 12) in seen:
                continue
            seen.add(round(value, 12))
            edit = edit_of(variant, part)
            new = sp.Integral(part.put(edit.new), *node.limits)
            yield replace(edit, place=position, new=new, says=_says(edit))


def _says(edit: Edit) -> str:
    says = edit.says.replace("the whole expression", "the integrand")
    return says if says != edit.says else f"{says}, inside the integral"


def _other_limits(limit: sp.Expr, search: VariantSearch) -> list[sp.Expr]:
    symbols = search.points.symbols
    own = [] if limit in (0, sp.oo, -sp.oo) else [2 * limit, limit / 2, -limit]
    others = [sp.Integer(0), sp.Integer(1), sp.oo, -sp.oo, sp.pi, sp.pi / 2, 2 * sp.pi, *symbols]
    return [other for other in (*own, *others) if other != limit]


def _inside(node: sp.Integral, search: VariantSearch) -> VariantSearch:
    """Return the search inside the integrand, at the first point and one of the variables."""
    variables = tuple(node.variables)
    known = dict(search.points.known[0])
    for x, *limits in reversed(node.limits):
        low, high = (None if end.is_infinite else enclose(end, known) for end in limits)
        far = (0 if low is None else low + 2) if high is None else high
        known[x] = flint.acb(
            (far - 3 if low is None else low) * _INSIDE + far * (1 - _INSIDE)
        ).mid()
    points = Sample((*search.points.symbols, *variables), (known,))
    points.learn(node.function)
    return VariantSearch(points, search.factors, ())
