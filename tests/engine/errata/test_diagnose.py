"""The diagnosis detects and corrects misprints, and recognises equivalent formulas as equal."""

import itertools
import json
import random
from collections.abc import Callable, Iterator
from decimal import Decimal
from functools import cache
from itertools import islice

import mpmath
import pytest
import sympy as sp
from mutants import replaced

from derivation.engine.errata.compare import Diagnosis
from derivation.engine.errata.dimensions import dimension_note
from derivation.engine.formula.parse import FormulaError
from derivation.plate import derived
from derivation.plate.elastic import diagnose, diagnose_text
from derivation.plate.printed.contact import PRINTED
from derivation.plate.vocabulary import PLATE, Formula, P, R, T, a, b, h, mu, phi, z

NAMES = ("f_j", "g_j", "Omega_1", "Omega_2", "Omega_3", "Omega_4", "A_j", "K_j", "C_top")
PRODUCT_FORMULAS = ("Omega_1", "Omega_2", "Omega_3", "Omega_4", "A_j", "K_j", "C_top")
SWAPS = {sp.sin: sp.cos, sp.cos: sp.sin, sp.sinh: sp.cosh, sp.cosh: sp.sinh}
FACTORS = tuple(sp.Rational(*q) for q in ((2, 1), (1, 2), (3, 1), (1, 4), (4, 3)))
OTHER_FACE = {"K_j": "K_j_bottom", "C_top": "C_bottom"}
KINDS = (
    "sign",
    "constant",
    "monomial",
    "exponent",
    "function",
    "parentheses",
    "face",
    "doubled",
)
LOCAL = ("sign", "constant", "monomial", "exponent", "function", "parentheses")
Path = tuple[int, ...]


# Misprints, generated in the expression tree of a correct formula.


def nodes(expression: sp.Expr, path: Path = ()) -> Iterator[tuple[Path, sp.Expr]]:
    """Yield each subexpression with its path, except exponents."""
    yield path, expression
    for index, argument in enumerate(expression.args):
        if not (expression.is_Pow and index == 1):
            yield from nodes(argument, (*path, index))


def misprinted_node(kind: str, node: sp.Expr, draw: random.Random) -> sp.Expr | None:
    """Return the node with a misprint of this kind, or None if the kind does not apply to it."""
    symbols = [phi, h, b, mu, a, z, R]
    if kind == "sign":
        return -node
    if kind == "constant":
        return draw.choice(FACTORS) * node
    if kind == "monomial":
        return node * draw.choice(symbols) ** draw.choice((-2, -1, 1, 2))
    if kind == "exponent" and node.is_Pow:
        return node.base ** (node.exp + draw.choice((-1, 1)))
    if kind == "exponent" and node.is_Symbol:
        return node ** draw.choice((2, 3))
    if kind == "function" and node.func in SWAPS:
        return SWAPS[node.func](node.args[0])
    if kind == "parentheses" and node.is_Mul:
        return without_parentheses(node, draw)
    if kind == "face" and node.has(z):
        return node.subs(z, -z)
    if kind == "doubled" and node.is_Mul:
        return node * draw.choice(node.args)
    return None


def without_parentheses(node: sp.Mul, draw: random.Random) -> sp.Expr | None:
    """Return the product with the parentheses around one of its sums removed."""
    sums = [factor for factor in node.args if factor.is_Add]
    if not sums:
        return None
    inside = draw.choice(sums)
    first, *rest = draw.sample(inside.args, len(inside.args))
    return node / inside * first + sp.Add(*rest)


def misprinted(kind: str, expression: sp.Expr, draw: random.Random) -> sp.Expr | None:
    """Return the expression with a misprint of this kind at a random node to which it applies."""
    candidates = list(nodes(expression))
    draw.shuffle(candidates)
    for path, node in candidates:
        new = misprinted_node(kind, node, draw)
        if new is not None:
            return replaced(expression, path, new)
    return None


def in_exponentials(expression: sp.Expr) -> sp.Expr:
    return expression.rewrite((sp.sinh, sp.cosh), sp.exp)


@cache
def shapes(name: str) -> list[sp.Expr]:
    """Return the formula as derived, with exponentials, and as published if that is correct."""
    derived = chain()[name].expression
    printed = [p.expression for p in PRINTED if p.name == name and same(p.compared, derived)]
    return [derived, in_exponentials(derived), *printed[:1]]


@cache
def chain() -> dict[str, Formula]:
    return derived.formulas()


# Independent comparison: mpmath at random points.


@cache
def values(expression: sp.Expr) -> list[mpmath.mpc]:
    """Evaluate at four points that depend only on the names of the symbols."""
    symbols = sorted(expression.free_symbols, key=str)
    function = sp.lambdify(symbols, expression, modules="mpmath")
    with mpmath.workdps(60):
        points = [
            [mpmath.mpf(random.Random(f"{s} {seed}").randrange(300, 2000)) / 1009 for s in symbols]
            for seed in range(4)
        ]
        return [mpmath.mpc(function(*point)) for point in points]


def same(x: sp.Expr, y: sp.Expr) -> bool:
    """Return whether two expressions agree to 40 digits at four random points."""
    pairs = list(zip(values(x), values(y), strict=True))
    with mpmath.workdps(60):
        return all(abs(p - q) <= mpmath.mpf(10) ** -40 * (abs(p) + abs(q)) for p, q in pairs)


# Random misprints, each defined by a seed.


def terms(expression: sp.Expr) -> int:
    """Count the terms of all sums, with repetition."""
    return sum(len(n.args) * n.is_Add for n in sp.preorder_traversal(expression))


@cache
def single(seed: int) -> tuple[str, sp.Expr] | None:
    """Return the name of a formula and a copy with one misprint, or None.

    None is returned if the change has no effect, or if SymPy cancels terms after it: then text is
    missing, which is not a misprint of the kinds above.
    """
    draw = random.Random(seed)
    name, kind = draw.choice(NAMES), draw.choice(KINDS)
    shape = draw.choice(shapes(name))
    if kind == "face" and name in OTHER_FACE:
        return name, chain()[OTHER_FACE[name]].expression
    misprint = misprinted(kind, shape, draw)
    if (
        misprint is None
        or terms(misprint) < terms(shape)
        or same(misprint, chain()[name].expression)
    ):
        return None
    return name, misprint


@cache
def pair(seed: int) -> tuple[str, sp.Expr] | None:
    """Return a formula with misprints in two different factors; otherwise as `single`."""
    draw = random.Random(seed)
    name = draw.choice(PRODUCT_FORMULAS)
    shape = draw.choice(shapes(name))
    args = list(shape.args)
    for index in draw.sample(range(len(args)), 2):
        misprint = misprinted(draw.choice(LOCAL), args[index], draw)
        if misprint is None or terms(misprint) < terms(args[index]) or same(misprint, args[index]):
            return None
        args[index] = misprint
    both = sp.Mul(*args)
    if terms(both) < terms(shape) or same(both, chain()[name].expression):
        return None
    return name, both


@cache
def anywhere(seed: int) -> tuple[str, sp.Expr] | None:
    """Return a formula with two misprints at any nodes, or None if they have no effect."""
    draw = random.Random(seed)
    name = draw.choice(NAMES)
    expression = draw.choice(shapes(name))
    for _ in range(2):
        misprint = misprinted(draw.choice(LOCAL), expression, draw)
        if misprint is None:
            return None
        expression = misprint
    return None if same(expression, chain()[name].expression) else (name, expression)


def corrected(diagnosis: Diagnosis) -> bool:
    """Return whether the suggested correction is the derived formula."""
    reference = chain()[diagnosis.name].expression
    return diagnosis.repaired is not None and same(diagnosis.repaired, reference)


def checked(misprint: tuple[str, sp.Expr]) -> Diagnosis:
    """Diagnose a misprint; assert that it is detected and any correction is valid."""
    diagnosis = diagnose(misprint[0], misprint[1], chain())
    assert diagnosis.verdict == "different", misprint
    assert diagnosis.repaired is None or corrected(diagnosis), (misprint, diagnosis.repair)
    return diagnosis


def drawn(make: Callable[[int], tuple[str, sp.Expr] | None], start: int, count: int) -> list[int]:
    """Return the first seeds from `start` on for which `make` gives a misprint."""
    return list(islice((seed for seed in itertools.count(start) if make(seed)), count))


@pytest.mark.parametrize("start", [0, 10_000, 20_000])
def test_single_misprint_is_corrected_by_one_edit(start: int) -> None:
    for seed in drawn(single, start, 24):
        misprint = single(seed)
        assert misprint is not None
        diagnosis = checked(misprint)
        assert diagnosis.repaired is not None, (seed, misprint)
        assert diagnosis.edits == 1, (seed, misprint, diagnosis.repair)


def test_misprints_in_two_factors_are_corrected() -> None:
    for seed in drawn(pair, 0, 12):
        misprint = pair(seed)
        assert misprint is not None
        diagnosis = checked(misprint)
        assert diagnosis.repaired is not None, (seed, misprint)
        assert diagnosis.edits <= 2, (seed, misprint, diagnosis.repair)


def test_two_misprints_at_any_nodes_are_detected() -> None:
    for seed in drawn(anywhere, 0, 6):
        misprint = anywhere(seed)
        assert misprint is not None
        checked(misprint)


SPREAD = (
    "(lam + 2*mu)*(h*phi*(lam + mu)*cosh(h*phi) + sinh(h*phi))"
    "/(2*mu*phi*(lam + mu)*(sinh(2*h*phi) + 2*h*phi))"
)
MISPRINTS = {
    "sign": ("C_top", "-C_top"),
    "constant ratio": ("K_j", "3*K_j/2"),
    "extra factor": ("Omega_1", "Omega_1/h"),
    "wrong exponent": ("C_half", "(lam + 2*mu)**2/(2*mu*phi*(lam + mu))"),
    "swapped function": (
        "f_j",
        "C1*cosh(phi*z) + C2*sinh(phi*z) + C3*z*cosh(phi*z) + C4*z*cosh(phi*z)",
    ),
    "missing parentheses": (
        "A_j",
        "-(16*mu*(lam + mu)*sin(a*phi) - a*phi*cos(a*phi))/(pi*b**2*R*(2*mu + lam)*phi**3*J1**2)",
    ),
    "superfluous parentheses": ("Omega_2", SPREAD),
    "factor counted twice": ("delta", "K_j*A_j"),
    "other face": ("K_j_bottom", "K_j"),
    "two misprints": (
        "Omega_3",
        "sinh(phi*h)/(2*mu*(2*phi*h - sinh(phi*h)))",
    ),
    "unexplained": ("G", "T + tanh(T)"),
    "dimension": ("Omega_3", "log(h*phi) + 7"),
}


@pytest.mark.parametrize("kind", MISPRINTS)
def test_kind_of_misprint_is_reported(kind: str) -> None:
    name, text = MISPRINTS[kind]
    diagnosis = diagnose_text(name, text, chain()).diagnosis
    assert (diagnosis.verdict, diagnosis.kind) == ("different", kind), diagnosis.repair
    assert (diagnosis.repaired is None) == (kind in ("unexplained", "dimension"))
    assert diagnosis.repaired is None or corrected(diagnosis)


def test_dimension_note_reports_the_extra_factor() -> None:
    extra = chain()["Omega_4"].expression / phi
    note = dimension_note(extra, "1/Pa", PLATE) or ""
    assert all(unit in note for unit in ("[1/Pa]", "[m/Pa]", "[m] too much"))
    assert dimension_note(chain()["Omega_4"].expression, "1/Pa", PLATE) is None


def rewritten() -> dict[str, tuple[str, sp.Expr]]:
    """Return the correct formulas in other equivalent forms."""
    derived = {name: chain()[name].expression for name in NAMES}
    force = chain()["P"].expression
    loads = {f"{name} in exponentials": (name, in_exponentials(e)) for name, e in derived.items()}
    loads |= {f"{name} expanded": (name, sp.expand(e)) for name, e in derived.items()}
    loads |= {f"{name} over one denominator": (name, sp.together(e)) for name, e in derived.items()}
    by_force = sp.solve(force - P, R)[0]
    loads["A_j by force"] = ("A_j", derived["A_j"].subs(R, by_force))
    loads["K_j by force"] = ("K_j", derived["K_j"].subs(R, by_force))
    loads["pressure by radius"] = ("p", chain()["p"].expression.subs(P, force))
    loads["G over wave number"] = ("G", chain()["G"].expression.subs(T, 2 * phi * h))
    return loads


@pytest.mark.parametrize(
    "shape",
    [
        *(f"{name} {how}" for name in NAMES for how in ("in exponentials", "expanded")),
        *(f"{name} over one denominator" for name in NAMES),
        "A_j by force",
        "K_j by force",
        "pressure by radius",
        "G over wave number",
    ],
)
def test_rewritten_formulas_are_equal(shape: str) -> None:
    diagnosis = diagnose(*rewritten()[shape], chain())
    assert (diagnosis.verdict, diagnosis.kind, diagnosis.edits) == ("equal", "equal", 0)


def test_formula_of_the_force_is_not_replaced_by_its_symbol() -> None:
    assert diagnose("P", 2 * chain()["P"].expression, chain()).ratio == 2
    assert diagnose("P", P, chain()).verdict == "different"


def test_values_are_correct_to_all_printed_digits() -> None:
    text = "-sinh(phi*h)/(2*mu*phi*(sinh(2*phi*h) + 2*phi*h))"
    diagnosis = diagnose_text("Omega_3", text, chain(), at={"phi": "2.5", "h": "0.1"})
    with mpmath.workdps(80):
        x, scale = mpmath.mpf("0.25"), 2 * mpmath.mpf("0.43e9")
        reference = -mpmath.sinh(x) / scale / (mpmath.sinh(2 * x) + 2 * x)
        assert diagnosis.derived_value == str(
            Decimal(mpmath.nstr(reference, 50, strip_zeros=False))
        )
        assert abs(mpmath.mpf(diagnosis.given_value) * mpmath.mpf("2.5") / reference - 1) < 1e-49
    assert (diagnosis.verdict, diagnosis.ratio) == ("different", 1 / phi)
    report = json.loads(json.dumps(diagnosis.to_json()))
    assert report["given"] == diagnosis.given_value
    assert report["derived"] == diagnosis.derived_value
    assert report["ratio"] == "1/phi"


def test_values_are_correct_in_spite_of_cancellation() -> None:
    text = "(sinh(T)*cosh(T) + T)/(sinh(T)**2 - T**2)"
    diagnosis = diagnose_text("G", text, chain(), at={"T": "1e-40"}, digits=60)
    assert diagnosis.verdict == "equal"
    assert diagnosis.given_value == diagnosis.derived_value
    assert Decimal(diagnosis.given_value).adjusted() == 120


INVALID_REQUESTS = {
    "unknown formula": (("Omega_9", "phi"), {}, "expected one of f_j"),
    "formula with unknown functions": (("radial_ode", "phi"), {}, "expected one of f_j"),
    "unknown symbol in the point": (("Omega_3", "phi"), {"at": {"q": "1"}}, "unknown symbol"),
    "not a number": (("Omega_3", "phi"), {"at": {"h": "nan"}}, "decimal number"),
    "infinite": (("Omega_3", "phi"), {"at": {"h": "inf"}}, "decimal number"),
    "exponent too large": (("Omega_3", "phi"), {"at": {"h": "1e999999"}}, "power of ten"),
    "singular point": (("Omega_3", "log(h - phi)"), {"at": {"phi": "9"}}, "no real value"),
    "outside the domain": (("Omega_3", "phi"), {"at": {"phi": "0"}}, "phi > 0, got phi = 0"),
    "outside by a default": (("delta_half", "a"), {"at": {"a": "9"}}, "a < R, .* give R too"),
    "symbol that does not occur": (("Omega_3", "phi"), {"at": {"T": "1"}}, "got T; remove"),
    "given by two names": (("f_j", "C1"), {"at": {"C1": "1", "C_1": "2"}}, "C1 once, got it twice"),
    "value too large": (("Omega_3", "exp(phi*h)"), {"at": {"phi": "1e99"}}, "too large"),
    "hidden zero divisor": (("Omega_3", "1/(sin(h)**2 + cos(h)**2 - 1)"), {}, "division by zero"),
    "integral": (("F_lateral", "phi"), {}, "defined by an integral .* substitute"),
    "whole sum": (("delta", "a**2/R"), {}, "one mode, which depends on J1, phi"),
    "sum times a factor that depends on the mode": (
        ("delta", "phi*Sum(a, (j, 1, oo))"),
        {},
        "inside Sum",
    ),
    "finite sum": (("delta", "Sum(a*phi, (j, 1, 9))"), {}, "sum over all modes"),
    "E without elastic constants": (("G", "E*T"), {}, r"write exp\(1\)"),
    "E without nu": (("P", "E*a"), {"at": {"E": "1e9"}}, "E together with nu"),
    "invalid material": (("P", "E*a"), {"at": {"E": "1e9", "nu": "0.5"}}, "nu < 0.5"),
    "dependent symbol": (("A_j", "P"), {"at": {"P": "1"}}, "follows from"),
    "no digits": (("Omega_3", "phi"), {"digits": 0}, "digits"),
    "Python code": (("Omega_3", "__import__('os')"), {}, "quoted text"),
}


@pytest.mark.parametrize("case", INVALID_REQUESTS)
def test_invalid_requests_are_rejected_with_a_reason(case: str) -> None:
    (name, text), options, reason = INVALID_REQUESTS[case]
    with pytest.raises(FormulaError, match=reason):
        diagnose_text(name, text, chain(), **options)
