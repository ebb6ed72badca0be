"""Swapped symbols, terms that are missing in a sum of two, roots and dependent symbols."""

import random
from collections.abc import Iterator

import pytest
import sympy as sp

from derivation.engine.errata.lookup import comparable
from derivation.plate.derived import formulas
from derivation.plate.elastic import diagnose_text

CHAIN = formulas()


def agree(one: sp.Expr, other: sp.Expr, seed: int) -> bool:
    """Return whether two expressions have equal values at random points, by SymPy's evaluation."""
    draw = random.Random(seed)
    symbols = sorted(one.free_symbols | other.free_symbols, key=str)
    for _ in range(3):
        point = {s: sp.Rational(draw.randint(20, 99), draw.choice([101, 103])) for s in symbols}
        values = [sp.N(side.subs(point), 30) for side in (one, other)]
        if abs(values[0] - values[1]) > 1e-20 * abs(values[1]):
            return False
    return True


@pytest.mark.parametrize(
    ("name", "text", "kind", "repair"),
    [
        (
            "C_half",
            "(lam + 2*mu)/(2*mu*phi*(lam + phi))",
            "swapped symbol",
            "read mu instead of phi",
        ),
        (
            "delta_half",
            "R**2/a",
            "swapped symbol",
            "exchange R and a in the whole expression",
        ),
        (
            "C_half",
            "(lam + 2*h)/(2*mu*phi*(lam + mu))",
            "swapped symbol",
            "read mu instead of h in the term 2*h",
        ),
        (
            "P",
            "16*mu*(lam + mu)*a**3/(3*h*(lam + 2*mu))",
            "swapped symbol",
            "read R instead of h in the whole expression",
        ),
        (
            "evanescent_amplitude",
            "besselj(0, eta)/besseli(0, k_n*sqrt(1 - kap*(17/10 - 7*nu/10)/(eta**2*k_n**2)))",
            "swapped symbol",
            "read k_n instead of eta in besselj(0, eta)",
        ),
        ("echo_time", "8*h*sqrt(rho)/sqrt(lam)", "wrong term", "add the missing term 2*mu to lam"),
        (
            "P_half",
            "16*sqrt(R)*delta**(3/2)*mu**2/(3*lam + 6*mu)",
            "wrong term",
            "add the missing term 16*lam*mu to 16*mu**2",
        ),
        (
            "flattening",
            "xi_y",
            "missing factor",
            "divide the whole expression by the missing factor sqrt(2*xi_y**3/3 + 1/3)",
        ),
        (
            "gamma_4",
            "a**7*c_5/(R*h**5)",
            "missing factor",
            "divide the whole expression by the missing factor P**(7/3)",
        ),
        (
            "gamma_2_truncated",
            "4*N*a**3/(3*R*b)",
            "missing factor",
            "divide the whole expression by the missing factor P",
        ),
    ],
)
def test_the_correction_reverses_the_misprint(name: str, text: str, kind: str, repair: str) -> None:
    diagnosis = diagnose_text(name, text, CHAIN)
    assert (diagnosis.diagnosis.kind, diagnosis.repair) == (kind, repair)
    assert diagnosis.diagnosis.repaired is not None
    assert agree(diagnosis.diagnosis.repaired, CHAIN[name].expression, 1)


def test_the_argument_of_coth_is_searched() -> None:
    derived = CHAIN["B_s"].expression
    _, fast = sorted(derived.atoms(sp.coth), key=str)
    wrong = derived.subs(fast, sp.coth(fast.args[0] / 2))
    diagnosis = diagnose_text("B_s", str(wrong), CHAIN)
    assert diagnosis.diagnosis.kind == "constant ratio"
    assert diagnosis.diagnosis.repaired is not None
    assert agree(diagnosis.diagnosis.repaired, derived, 2)


def swaps() -> Iterator[tuple[str, sp.Expr]]:
    """Yield formulas in which one symbol is another one at one place."""
    draw = random.Random(11)
    names = [
        n
        for n in comparable(CHAIN)
        if CHAIN[n].expression.count_ops() < 40 and not CHAIN[n].expression.has(sp.Integral)
    ]
    while True:
        name = draw.choice(names)
        derived = CHAIN[name].expression
        terms = [t for t in derived.args if t.is_Symbol or (t.is_Pow and t.base.is_Symbol)]
        symbols = sorted(derived.free_symbols, key=str)
        if not terms or len(symbols) < 2:
            continue
        old = draw.choice(terms)
        base, power = old.as_base_exp()
        other = draw.choice([s for s in symbols if s != base])
        rest = list(derived.args)
        rest[rest.index(old)] = other**power
        wrong = derived.func(*rest)
        # A swapped symbol next to an equal one would merge or cancel with it.
        if other not in derived.as_powers_dict() and other not in derived.args:
            yield name, wrong


def test_a_swapped_symbol_is_named_in_any_formula() -> None:
    source = swaps()
    for _ in range(12):
        name, wrong = next(source)
        diagnosis = diagnose_text(name, str(wrong), CHAIN)
        assert diagnosis.verdict == "different"
        assert diagnosis.diagnosis.kind == "swapped symbol", (name, wrong, diagnosis.repair)
        assert diagnosis.diagnosis.repaired is not None
        assert agree(diagnosis.diagnosis.repaired, CHAIN[name].expression, 3)


def test_powers_with_a_symbol_in_the_exponent_cause_no_exception() -> None:
    diagnosis = diagnose_text("variational_ratio", "4**(-k - 1)*4**(k + 1)/(2*k)", CHAIN)
    assert diagnosis.verdict == "different"
