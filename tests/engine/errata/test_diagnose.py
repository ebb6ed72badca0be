"""Damaged copies of proved formulas are distinguished and corrected; equal forms stay equal."""

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
PRODUCTS = ("Omega_1", "Omega_2", "Omega_3", "Omega_4", "A_j", "K_j", "C_top")
SWAPS = {sp.sin: sp.cos, sp.cos: sp.sin, sp.sinh: sp.cosh, sp.cosh: sp.sinh}
NUMBERS = tuple(sp.Rational(*q) for q in ((2, 1), (1, 2), (3, 1), (1, 4), (4, 3)))
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


# Damages, made on the tree of a right formula.


def nodes(expression: sp.Expr, path: Path = ()) -> Iterator[tuple[Path, sp.Expr]]:
    yield path, expression
    for index, argument in enumerate(expression.args):
        if not (expression.is_Pow and index == 1):
            yield from nodes(argument, (*path, index))


def damaged_node(kind: str, node: sp.Expr, draw: random.Random) -> sp.Expr | None:
    """The node with a slip of that kind, or None where it cannot have one."""
    symbols = [phi, h, b, mu, a, z, R]
    if kind == "sign":
        return -node
    if kind == "constant":
        return draw.choice(NUMBERS) * node
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
    sums = [factor for factor in node.args if factor.is_Add]
    if not sums:
        return None
    inside = draw.choice(sums)
    first, *rest = draw.sample(inside.args, len(inside.args))
    return node / inside * first + sp.Add(*rest)


def damage(kind: str, expression: sp.Expr, draw: random.Random) -> sp.Expr | None:
    """The expression with a slip of that kind at a random node that can have one."""
    candidates = list(nodes(expression))
    draw.shuffle(candidates)
    for path, node in candidates:
        new = damaged_node(kind, node, draw)
        if new is not None:
            return replaced(expression, path, new)
    return None


def in_exponentials(expression: sp.Expr) -> sp.Expr:
    return expression.rewrite((sp.sinh, sp.cosh), sp.exp)


@cache
def shapes(name: str) -> list[sp.Expr]:
    """The right formula as derived, with exponentials, and as printed where the print is right."""
    derived = chain()[name].expression
    printed = [p.expression for p in PRINTED if p.name == name and same(p.compared, derived)]
    return [derived, in_exponentials(derived), *printed[:1]]


@cache
def chain() -> dict[str, Formula]:
    return derived.formulas()


# Independent judgement: mpmath at random points.


def value(expression: sp.Expr, seed: int) -> mpmath.mpc:
    """The value where every symbol has a number that depends on its name and the seed alone."""
    symbols = sorted(expression.free_symbols, key=str)
    with mpmath.workdps(60):
        numbers = [
            mpmath.mpf(random.Random(f"{s} {seed}").randrange(300, 2000)) / 1009 for s in symbols
        ]
        return mpmath.mpc(sp.lambdify(symbols, expression, modules="mpmath")(*numbers))


def same(x: sp.Expr, y: sp.Expr) -> bool:
    pairs = [(value(x, seed), value(y, seed)) for seed in range(4)]
    with mpmath.workdps(60):
        return all(abs(p - q) <= mpmath.mpf(10) ** -40 * (abs(p) + abs(q)) for p, q in pairs)


# Slips, drawn from a seed.


def terms(expression: sp.Expr) -> int:
    """Number of terms in all sums, with repetition."""
    return sum(len(n.args) * n.is_Add for n in sp.preorder_traversal(expression))


@cache
def single(seed: int) -> tuple[str, sp.Expr] | None:
    """A formula's name and a damaged copy; None if the damage changed nothing or erased terms.

    Terms that SymPy cancels against each other after the damage are erased text, not a slip.
    """
    draw = random.Random(seed)
    name, kind = draw.choice(NAMES), draw.choice(KINDS)
    shape = draw.choice(shapes(name))
    if kind == "face" and name in OTHER_FACE:
        return name, chain()[OTHER_FACE[name]].expression
    slip = damage(kind, shape, draw)
    if slip is None or terms(slip) < terms(shape) or same(slip, chain()[name].expression):
        return None
    return name, slip


@cache
def pair(seed: int) -> tuple[str, sp.Expr] | None:
    """As `single`, with two slips in different factors of the whole."""
    draw = random.Random(seed)
    name = draw.choice(PRODUCTS)
    shape = draw.choice(shapes(name))
    args = list(shape.args)
    for index in draw.sample(range(len(args)), 2):
        slip = damage(draw.choice(LOCAL), args[index], draw)
        if slip is None or terms(slip) < terms(args[index]) or same(slip, args[index]):
            return None
        args[index] = slip
    both = sp.Mul(*args)
    if terms(both) < terms(shape) or same(both, chain()[name].expression):
        return None
    return name, both


@cache
def anywhere(seed: int) -> tuple[str, sp.Expr] | None:
    """Two slips one after the other, wherever they fall."""
    draw = random.Random(seed)
    name = draw.choice(NAMES)
    expression = draw.choice(shapes(name))
    for _ in range(2):
        slip = damage(draw.choice(LOCAL), expression, draw)
        if slip is None:
            return None
        expression = slip
    return None if same(expression, chain()[name].expression) else (name, expression)


def corrected(diagnosis: Diagnosis) -> bool:
    reference = chain()[diagnosis.name].expression
    return diagnosis.repaired is not None and same(diagnosis.repaired, reference)


def checked(slip: tuple[str, sp.Expr]) -> Diagnosis:
    """The diagnosis of a damaged formula, after it was seen to be different."""
    diagnosis = diagnose(slip[0], slip[1], chain())
    assert diagnosis.verdict == "different", slip
    assert diagnosis.repaired is None or corrected(diagnosis), (slip, diagnosis.repair)
    return diagnosis


def drawn(make: Callable[[int], tuple[str, sp.Expr] | None], start: int, count: int) -> list[int]:
    """The first seeds from `start` on that give a damage."""
    return list(islice((seed for seed in itertools.count(start) if make(seed)), count))


@pytest.mark.parametrize("start", [0, 10_000, 20_000])
def test_single_slip_is_corrected_by_one_edit(start: int) -> None:
    for seed in drawn(single, start, 24):
        slip = single(seed)
        assert slip is not None
        diagnosis = checked(slip)
        assert diagnosis.repaired is not None, (seed, slip)
        assert diagnosis.edits == 1, (seed, slip, diagnosis.repair)


def test_two_slips_in_different_factors_are_corrected() -> None:
    for seed in drawn(pair, 0, 12):
        slip = pair(seed)
        assert slip is not None
        diagnosis = checked(slip)
        assert diagnosis.repaired is not None, (seed, slip)
        assert diagnosis.edits <= 2, (seed, slip, diagnosis.repair)


def test_two_slips_anywhere_are_seen() -> None:
    for seed in drawn(anywhere, 0, 6):
        slip = anywhere(seed)
        assert slip is not None
        checked(slip)


SPREAD = (
    "(lam + 2*mu)*(h*phi*(lam + mu)*cosh(h*phi) + sinh(h*phi))"
    "/(2*mu*phi*(lam + mu)*(sinh(2*h*phi) + 2*h*phi))"
)
SLIPS = {
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


@pytest.mark.parametrize("kind", SLIPS)
def test_kind_of_slip_is_named(kind: str) -> None:
    name, text = SLIPS[kind]
    found = diagnose_text(name, text, chain()).diagnosis
    assert (found.verdict, found.kind) == ("different", kind), found.repair
    assert (found.repaired is None) == (kind in ("unexplained", "dimension"))
    assert found.repaired is None or corrected(found)


def test_stray_factor_is_named_by_dimension_alone() -> None:
    stray = chain()["Omega_4"].expression / phi
    note = dimension_note(stray, "1/Pa", PLATE) or ""
    assert all(unit in note for unit in ("[1/Pa]", "[m/Pa]", "[m] too much"))
    assert dimension_note(chain()["Omega_4"].expression, "1/Pa", PLATE) is None


def rewritten() -> dict[str, tuple[str, sp.Expr]]:
    """The same formulas in other shapes."""
    right = {name: chain()[name].expression for name in NAMES}
    force = chain()["P"].expression
    loads = {f"{name} in exponentials": (name, in_exponentials(e)) for name, e in right.items()}
    loads |= {f"{name} expanded": (name, sp.expand(e)) for name, e in right.items()}
    loads |= {f"{name} over one denominator": (name, sp.together(e)) for name, e in right.items()}
    by_force = sp.solve(force - P, R)[0]
    loads["A_j by force"] = ("A_j", right["A_j"].subs(R, by_force))
    loads["K_j by force"] = ("K_j", right["K_j"].subs(R, by_force))
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
    found = diagnose(*rewritten()[shape], chain())
    assert (found.verdict, found.kind, found.edits) == ("equal", "equal", 0)


def test_force_is_not_its_own_relation() -> None:
    assert diagnose("P", 2 * chain()["P"].expression, chain()).ratio == 2
    assert diagnose("P", P, chain()).verdict == "different"


def test_values_have_every_digit_right() -> None:
    text = "-sinh(phi*h)/(2*mu*phi*(sinh(2*phi*h) + 2*phi*h))"
    found = diagnose_text("Omega_3", text, chain(), at={"phi": "2.5", "h": "0.1"})
    with mpmath.workdps(80):
        x, scale = mpmath.mpf("0.25"), 2 * mpmath.mpf("0.43e9")
        reference = -mpmath.sinh(x) / scale / (mpmath.sinh(2 * x) + 2 * x)
        assert found.derived_value == str(Decimal(mpmath.nstr(reference, 50, strip_zeros=False)))
        assert abs(mpmath.mpf(found.given_value) * mpmath.mpf("2.5") / reference - 1) < 1e-49
    assert (found.verdict, found.ratio) == ("different", 1 / phi)
    report = json.loads(json.dumps(found.to_json()))
    assert report["given"] == found.given_value
    assert report["derived"] == found.derived_value
    assert report["ratio"] == "1/phi"


def test_values_survive_cancellation() -> None:
    text = "(sinh(T)*cosh(T) + T)/(sinh(T)**2 - T**2)"
    found = diagnose_text("G", text, chain(), at={"T": "1e-40"}, digits=60)
    assert found.verdict == "equal"
    assert found.given_value == found.derived_value
    assert Decimal(found.given_value).adjusted() == 120


BAD_REQUESTS = {
    "unknown formula": (("Omega_9", "phi"), {}, "expected one of f_j"),
    "formula with unknown functions": (("radial_ode", "phi"), {}, "expected one of f_j"),
    "unknown symbol in the point": (("Omega_3", "phi"), {"at": {"q": "1"}}, "unknown symbol"),
    "not a number": (("Omega_3", "phi"), {"at": {"h": "nan"}}, "decimal number"),
    "infinite": (("Omega_3", "phi"), {"at": {"h": "inf"}}, "decimal number"),
    "huge": (("Omega_3", "phi"), {"at": {"h": "1e999999"}}, "power of ten"),
    "singular point": (("Omega_3", "log(h - phi)"), {"at": {"phi": "9"}}, "no real value"),
    "outside the domain": (("Omega_3", "phi"), {"at": {"phi": "0"}}, "phi > 0, got phi = 0"),
    "outside by a default": (("delta_half", "a"), {"at": {"a": "9"}}, "a < R, .* give R too"),
    "what does not occur": (("Omega_3", "phi"), {"at": {"T": "1"}}, "got T; remove"),
    "twice by two names": (("f_j", "C1"), {"at": {"C1": "1", "C_1": "2"}}, "C1 once, got it twice"),
    "out of range": (("Omega_3", "exp(phi*h)"), {"at": {"phi": "1e99"}}, "too large"),
    "hidden zero divisor": (("Omega_3", "1/(sin(h)**2 + cos(h)**2 - 1)"), {}, "division by zero"),
    "integral": (("F_wall", "phi"), {}, "defined by an integral"),
    "whole sum": (("delta", "a**2/R"), {}, "one mode, which depends on J1, phi"),
    "sum times what differs by mode": (("delta", "phi*Sum(a, (j, 1, oo))"), {}, "inside Sum"),
    "finite sum": (("delta", "Sum(a*phi, (j, 1, 9))"), {}, "sum over all modes"),
    "E without elastic constants": (("G", "E*T"), {}, r"write exp\(1\)"),
    "E without nu": (("P", "E*a"), {"at": {"E": "1e9"}}, "E together with nu"),
    "no material": (("P", "E*a"), {"at": {"E": "1e9", "nu": "0.5"}}, "nu < 0.5"),
    "dependent symbol": (("A_j", "P"), {"at": {"P": "1"}}, "follows from"),
    "no digits": (("Omega_3", "phi"), {"digits": 0}, "digits"),
    "foreign text": (("Omega_3", "__import__('os')"), {}, "quoted text"),
}


@pytest.mark.parametrize("what", BAD_REQUESTS)
def test_bad_requests_are_refused_with_a_reason(what: str) -> None:
    (name, text), options, reason = BAD_REQUESTS[what]
    with pytest.raises(FormulaError, match=reason):
        diagnose_text(name, text, chain(), **options)
