"""Relations between the plate's symbols that a comparison of formulas takes into account.

P follows from (7), A_j from (8), and T = 2 phi h. Young's modulus and Poisson's ratio in a user's
formula are expressed by the Lame constants, which the derived formulas contain instead.
"""

from collections.abc import Mapping, Set
from fractions import Fraction
from functools import partial

import sympy as sp

from derivation.engine.errata import compare, text
from derivation.engine.errata.relations import Formulas, Meanings, Point, Relations, Symbols
from derivation.engine.formula.parse import FormulaError
from derivation.plate.vocabulary import A_j, E, P, T, h, lam, mu, nu, phi

_CONSTANTS = {lam, mu, nu}


def occurs(symbols: Set[sp.Symbol]) -> bool:
    """Return whether an elastic constant of the plate is among the symbols."""
    return bool(_CONSTANTS & symbols)


def relations(used: Set[sp.Symbol]) -> dict[sp.Symbol, sp.Expr]:
    """Return E and nu in terms of the other elastic constants of a comparison.

    Parameters
    ----------
    used
        Symbols of both formulas. With lam among them, E and nu follow from lam and mu;
        without it, E follows from mu and nu.
    """
    if lam in used:
        meaning = {
            E: mu * (3 * lam + 2 * mu) / (lam + mu),
            nu: lam / (2 * (lam + mu)),
        }
    else:
        meaning = {E: 2 * mu * (1 + nu)}
    return {symbol: value for symbol, value in meaning.items() if symbol in used}


def lame(values: Mapping[str, Fraction]) -> dict[str, Fraction]:
    """Return Lame constants [Pa] for Young's modulus E [Pa] and Poisson's ratio nu.

    Raises
    ------
    ValueError
        If no elastic material has these constants.
    """
    young, poisson = values["E"], values["nu"]
    if young <= 0 or not -1 < poisson < Fraction(1, 2):
        raise ValueError(f"expected E > 0 and -1 < nu < 0.5, got E = {young}, nu = {poisson}")
    return {
        "lam": young * poisson / ((1 + poisson) * (1 - 2 * poisson)),
        "mu": young / (2 * (1 + poisson)),
    }


def _between(name: str, given: Symbols, derived: Symbols, formulas: Formulas) -> Meanings:
    """Return the symbols that follow from others.

    Raises
    ------
    FormulaError
        If Young's modulus occurs and cannot be expressed by other constants.
    """
    meaning = {P: formulas["P"].expression, A_j: formulas["A_j"].expression, T: 2 * phi * h}
    used = given | derived
    equations = {s: meaning[s] for s in meaning if s in used and s.name != name}
    used = used.union(*(value.free_symbols for value in equations.values()))
    if E not in used:
        return equations | (relations(used) if mu in used or lam in used else {})
    if not occurs(derived.union(*(v.free_symbols for v in equations.values()))):
        raise FormulaError(
            f"E is read as Young's modulus, but {name} depends on no elastic constant; "
            "write exp(1) for the number 2.718..."
        )
    return equations | relations(used)


def _with_lame(point: Point) -> Point:
    """Return the point with Lame constants instead of Young's modulus and Poisson's ratio."""
    if "E" not in point:
        return point
    if "nu" not in point or {"lam", "mu"} & set(point):
        raise FormulaError("--at: expected E together with nu and without lam and mu; give both")
    try:
        constants = lame({name: point[name][1] for name in ("E", "nu")})
    except ValueError as error:
        raise FormulaError(f"--at: {error}; correct the values") from None
    rest = {name: value for name, value in point.items() if name not in ("E", "nu")}
    return rest | {name: (str(value), value) for name, value in constants.items()}


RELATIONS = Relations(_between, _with_lame)
diagnose = partial(compare.diagnose, relations=RELATIONS)
diagnose_text = partial(text.diagnose_text, relations=RELATIONS)
