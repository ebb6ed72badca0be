"""Checks of core formulas that do not contain the formulas themselves, for `test_formula_mutants`.

An expression passes instead of a formula if it satisfies the equations that the formula solves, or
if it agrees with an independent reference.
"""

import math
import random
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import cache
from operator import itemgetter

import mpmath as mp
import numpy as np
import scipy.special
import sympy as sp

from derivation.engine.formula.proof import decide_zero
from derivation.plate import derived
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.edge.route import supported as edge_routes
from derivation.plate.impact.theory.impact import orders
from derivation.plate.modes.route import routes
from derivation.plate.modes.theory.face_conditions import tractions
from derivation.plate.modes.theory.mode_shapes import CONSTANTS, substitute
from derivation.plate.vocabulary import A_j, Formula, c_A, kappa

Numbers = Mapping[str, mp.mpf]
Check = Callable[[sp.Expr], bool]
"""Function that returns whether an expression passes instead of a formula."""

DIGITS = 30


@cache
def chain() -> Mapping[str, Formula]:
    return derived.formulas()


@cache
def evaluator(expression: sp.Expr) -> Callable[[Numbers], mp.mpf]:
    """Return the function of an expression; `lambdify` takes longer than its few evaluations."""
    if isinstance(expression, sp.Symbol):
        return itemgetter(str(expression))
    if isinstance(expression, sp.Rational):
        p, q = int(expression.p), int(expression.q)
        return lambda _: mp.mpf(p) / q
    operation = OPERATIONS.get(expression.func)
    if operation is None:
        symbols = sorted(expression.free_symbols, key=str)
        call = sp.lambdify(symbols, expression, "mpmath")
        return lambda numbers: call(*(numbers[str(symbol)] for symbol in symbols))
    operands = [evaluator(part) for part in expression.args]
    return lambda numbers: operation(*(operand(numbers) for operand in operands))


OPERATIONS: Mapping[type[sp.Basic], Callable[..., mp.mpf]] = {
    sp.Add: lambda *terms: sum(terms),
    sp.Mul: lambda *factors: math.prod(factors),
    sp.Pow: lambda base, exponent: base**exponent,
    type(sp.pi): lambda: +mp.pi,
    sp.sin: mp.sin, sp.cos: mp.cos, sp.tan: mp.tan, sp.sinh: mp.sinh, sp.cosh: mp.cosh,
    sp.tanh: mp.tanh, sp.coth: mp.coth, sp.exp: mp.exp, sp.log: mp.log,
    sp.besselj: mp.besselj, sp.besseli: mp.besseli, sp.besselk: mp.besselk,
}  # fmt: skip
"""Functions of mpmath for the nodes of expressions."""


def close(actual: mp.mpf, expected: mp.mpf, tolerance: float = 1e-18) -> bool:
    return bool(abs(actual - expected) <= tolerance * abs(expected))


def number(ball: object) -> mp.mpf:
    return mp.mpf(ball.str(25, radius=False))  # type: ignore[attr-defined]


def drawn(names: set[str], seed: str, count: int = 2) -> list[Numbers]:
    """Return random points of doubles between 1/4 and 9/4; the pressure A_j is negative."""
    generator = random.Random(seed)
    points = []
    for _ in range(count):
        values = {name: mp.mpf(generator.uniform(0.25, 2.25)) for name in sorted(names)}
        points.append({k: -v if k == "A_j" else v for k, v in values.items()})
    return points


# --- displacements and stresses of a mode: the equations solved, and the mpmath reference


def in_the_equations(name: str) -> Check:
    """Check f_j or g_j in both equations of motion, with the other one unchanged."""
    other = chain()["g_j" if name == "f_j" else "f_j"].expression

    def passes(expression: sp.Expr) -> bool:
        pair = (expression, other) if name == "f_j" else (other, expression)
        return all(decide_zero(residual) for residual in substitute(*pair))

    return passes


def in_the_tractions(name: str) -> Check:
    """Check one Omega, with the other three unchanged, in the tractions of both faces."""
    own = {c: A_j * chain()[f"Omega_{k}"].expression for k, c in enumerate(CONSTANTS, start=1)}
    constant = CONSTANTS[int(name[-1]) - 1]

    def passes(expression: sp.Expr) -> bool:
        with_it = own | {constant: A_j * expression}
        return all(decide_zero(value.subs(with_it)) for value in tractions().values())

    return passes


def by_route(name: str) -> Check:
    """Check a formula against the mpmath reference."""
    names = {str(symbol) for symbol in chain()[name].expression.free_symbols}
    points = drawn(names, name)
    if name == "p":
        points = [point | {"r": point["r"] * point["a"] / 3} for point in points]
    expected = [routes.value(name, {k: float(v) for k, v in p.items()}, 22) for p in points]

    def passes(expression: sp.Expr) -> bool:
        call = evaluator(expression)
        return all(close(call(p), t) for p, t in zip(points, expected, strict=True))

    return passes


# --- the contact law


@cache
def zeros(count: int) -> tuple[Numbers, ...]:
    with mp.workdps(DIGITS):
        actual = [mp.besseljzero(0, n) for n in range(1, count + 1)]
        return tuple({"j_n": j, "J1": mp.besselj(1, j)} for j in actual)


def summed(expression: sp.Expr, numbers: Numbers, count: int = 34) -> mp.mpf:
    """Return the sum of an expression over the modes; its terms decay like e^(-4 h j_n/b)."""
    call = evaluator(expression)
    return mp.fsum(call({**numbers, **mode}) for mode in zeros(count))


ETAS = (Fraction(2, 5), Fraction(4, 5))


def by_coefficient(name: str) -> Check:
    """Check a part of c_k: the sum of both parts against the Arb reference of the contact law."""
    order, part = int(name.split("_")[1]), name.split("_")[2]
    expected = [number(contact_balls.coefficient(order, eta, Fraction(1), 20)) for eta in ETAS]
    moment = {f"kappa_{order - 1}": number(contact_balls.kappa(order - 1, 25))}
    assert str(kappa[order - 1]) in moment
    etas = [{"eta": mp.mpf(eta.numerator) / eta.denominator} for eta in ETAS]
    rest = chain()[f"c_{order}_{'lateral' if part == 'modes' else 'modes'}"].expression

    def passes(expression: sp.Expr) -> bool:
        modes, side = (expression, rest) if part == "modes" else (rest, expression)
        return all(
            close(summed(modes, values) + evaluator(side)({**moment, **values}), c, 1e-17)
            for c, values in zip(expected, etas, strict=True)
        )

    return passes


def by_departure(_: str) -> Check:
    """Check the part of the modes against the Arb reference without the lateral surface."""
    alphas = Fraction(1, 5), Fraction(1, 2)
    lateral_surfaces = [contact_balls.finite_radius(alpha, 20) for alpha in alphas]
    points = [
        ({"alpha": mp.mpf(x.numerator) / x.denominator, "eta": mp.mpf(e.numerator) / e.denominator},
         number(contact_balls.relative_correction(x, e, Fraction(1), 20)) - number(lateral))
        for x, lateral in zip(alphas, lateral_surfaces, strict=True) for e in ETAS
    ]  # fmt: skip
    return lambda e: all(close(summed(e, values), expected, 1e-16) for values, expected in points)


def by_the_law(_: str) -> Check:
    """Check 1 + c_1 A + ... against the Arb reference of the indentation at a small A."""
    eta, A = Fraction(1, 2), Fraction(1, 16)
    values = {str(c_A[n]): number(contact_balls.coefficient(n, eta, 1, 25)) for n in (1, 3, 5, 7)}
    at = values | {"a_ratio": mp.mpf(A.numerator) / A.denominator}
    expected = 1 + number(contact_balls.relative_correction(A * eta, eta, 1, 25))
    last = abs(values["c_7"]) * at["a_ratio"] ** 7
    return lambda expression: bool(abs(evaluator(expression)(at) - expected) < 0.01 * last)


def by_inversion(name: str) -> Check:
    """Check xi_k or p_n: with the others, they invert the contact law of a small contact."""
    formal = name.startswith("xi")
    family = [x for x in chain() if x.startswith(name[:-1]) and x[-1].isdigit()]
    gammas = [f"gamma_{k}" for k in range(2, len(family) + 2)]
    odd = [f"c_{n}" for n in (1, 3, 5, 7)]
    with mp.workdps(120):
        numbers = drawn({*gammas, *odd}, name, 1)[0]
        small = mp.mpf(2) ** -30
        own = {x: evaluator(chain()[x].expression)(numbers) for x in family}
        if formal:  # powers of x = P^(1/3); the indentation is divided by gamma_2 x^3
            depth = mp.fsum(numbers[g] * small ** (2 * i) for i, g in enumerate(gammas))
            root = mp.cbrt(depth) * small
            powers = {x: root ** (2 * i + 3) / small**3 for i, x in enumerate(family)}
            expected, rest = mp.mpf(1), small ** (2 * len(family))
        else:  # powers of A
            F = mp.fsum(numbers[c] * small ** int(c[2:]) for c in odd)
            eps = small * mp.sqrt(1 + F)
            powers = {x: eps ** int(x[2:]) for x in family}
            expected, rest = (small / eps) ** 3 - 1, small ** (len(family) + 1)

    def passes(expression: sp.Expr) -> bool:
        with mp.workdps(120):
            terms = own | {name: evaluator(expression)(numbers)}
            total = mp.fsum(value * powers[x] for x, value in terms.items())
            return bool(abs(total - expected) < 1e4 * rest)

    return passes


def by_lateral(_: str) -> Check:
    """Check the lateral surface's integral by a Gauss rule (y = u^3) against the Arb reference."""
    expected = float(number(contact_balls.finite_radius(Fraction(3, 5), 20)))
    nodes, weights = scipy.special.roots_legendre(300)
    u = 1.8 * (nodes + 1)

    def passes(expression: sp.Expr) -> bool:
        factor, integral = expression.as_independent(sp.Integral)
        (height,) = integral.variables
        call = sp.lambdify((height, "alpha"), factor * integral.function, "scipy")
        with np.errstate(all="ignore"):
            actual = (weights * 1.8 * 3 * u**2 * call(u**3, 0.6)).sum()
        return bool(abs(actual / expected - 1) < 1e-6)

    return passes


# --- the impact


def by_energy(name: str) -> Check:
    """Check the integrand of the contact time, and the work, against the energy integral.

    C = a_m = R = 1, m = 2: 2 u dx/dq over the root of the work between q = 1 - u^2 and 1.
    """
    weights = drawn({f"D_{n}" for n in orders()[1:]}, name, 1)[0]

    def rate(q: mp.mpf) -> mp.mpf:
        return mp.fsum(n * weights.get(f"D_{n}", 1) * q ** (n - 1) for n in orders())

    def work(start: mp.mpf) -> mp.mpf:
        return mp.quad(lambda q: q**3 * rate(q), [start, 1], method="gauss-legendre")

    if name == "contact_work":
        return lambda expression: close(evaluator(expression)(weights), work(mp.mpf(0)))
    at = [mp.mpf("0.3"), mp.mpf("0.8")]
    expected = [2 * u * rate(1 - u**2) / mp.sqrt(work(1 - u**2)) for u in at]

    def passes(expression: sp.Expr) -> bool:
        call = evaluator(expression)
        return all(close(call(weights | {"u_t": u}), t) for u, t in zip(at, expected, strict=True))

    return passes


def by_hertz_motion(_: str) -> Check:
    """Check Hertz's contact time: 2 int_0^1 dx/sqrt(1 - x^(5/2)), with x = 1 - u^2."""

    def integrand(u: mp.mpf) -> mp.mpf:
        return 4 * u / mp.sqrt(-mp.expm1(mp.mpf("2.5") * mp.log1p(-(u**2))))

    with mp.workdps(20):
        expected = mp.quad(integrand, [0, 1])
    return lambda expression: close(evaluator(expression)({}), expected, 1e-14)


MOTION = {
    key: mp.mpf(text)
    for key, text in (
        ("m", "0.7"), ("v0", "3"), ("xi_2", "1.3"), ("xi_3", "0.4"), ("delta", "0.6"), ("t", "0.9"),
    )
}  # fmt: skip


def by_motion(name: str) -> Check:
    """Check the motion with force xi_2 delta + xi_3 delta^(5/3), by quadrature of the work."""

    def force(at: mp.mpf) -> mp.mpf:
        return MOTION["xi_2"] * at + MOTION["xi_3"] * mp.cbrt(at) ** 5

    depth, m, v0 = MOTION["delta"], MOTION["m"], MOTION["v0"]
    if name == "acceleration":
        return lambda expression: close(evaluator(expression)(MOTION), -force(depth) / m)
    expected = mp.sqrt(v0**2 - 2 / m * mp.quad(force, [0, depth]))
    return lambda expression: close(evaluator(expression)(MOTION), expected, 1e-12)


def by_linear_motion(_: str) -> Check:
    """Check m x'' + xi_2 x = 0, x(0) = 0 and x'(0) = v0, by numerical differentiation."""
    m, v0, stiff, at = (MOTION[key] for key in ("m", "v0", "xi_2", "t"))

    def passes(expression: sp.Expr) -> bool:
        call = evaluator(expression)

        def displacement(time: mp.mpf) -> mp.mpf:
            return call(MOTION | {"t": time})

        return (
            abs(displacement(mp.mpf(0))) < 1e-15
            and close(mp.diff(displacement, 0), v0, 1e-8)
            and close(m * mp.diff(displacement, at, 2), -stiff * displacement(at), 1e-8)
        )

    return passes


# --- sphere, edge, inertia


def by_profile(name: str) -> Check:
    """Check the profile of a sphere from flat punches (Sneddon 1965), and dP = 2 E* a d delta."""
    numbers = drawn({"lam", "mu"}, name, 1)[0] | {"R": mp.mpf(3), "a": mp.mpf("1.7")}
    E = 2 / routes.value("C_half", {"phi": 1.0} | {k: float(numbers[k]) for k in ("lam", "mu")}, 20)
    R, a = numbers["R"], numbers["a"]
    radius = sp.Symbol("a", positive=True)

    def passes(expression: sp.Expr) -> bool:
        start, slope = evaluator(expression), evaluator(sp.diff(expression, radius))
        if not abs(start(numbers | {"a": mp.mpf("1e-12")})) < 1e-10:
            return False
        if name == "P_sphere":
            depth = evaluator(sp.diff(chain()["delta_sphere"].expression, radius))
            return close(slope(numbers), 2 * E * a * depth(numbers), 1e-15)
        fitted = mp.quad(
            lambda angle: angle * mp.sin(angle) * slope(numbers | {"a": a * mp.cos(angle)}),
            [0, mp.pi / 2], method="gauss-legendre",
        )  # fmt: skip
        return close(2 / mp.pi * a * fitted, R - mp.sqrt(R**2 - a**2), 1e-12)

    return passes


def by_edge_displacement(name: str) -> Check:
    """Check mean and first moment of u at the edge against the mpmath reference of a mode."""
    numbers = drawn({"phi", "h", "b", "lam", "mu", "A_j", "J1"}, name, 1)[0]
    given = {key: float(numbers[key]) for key in ("phi", "h", "lam", "mu", "A_j")}
    h, b, rotation = numbers["h"], numbers["b"], name == "edge_rotation"
    nodes, weights = scipy.special.roots_legendre(24)
    total = mp.fsum(
        mp.mpf(w)
        * h
        * routes.value("mode_g", given | {"z": float(h) * x}, 20)
        * (h * x) ** rotation
        for x, w in zip(nodes, weights, strict=True)
    )
    factor = 3 / (2 * h**3 * b) if rotation else 1 / (2 * h * b)
    expected = numbers["phi"] * numbers["J1"] * total * factor
    return lambda expression: close(evaluator(expression)(numbers), expected, 1e-10)


def by_residues(name: str) -> Check:
    """Check the edge's part of the contact law against the mpmath reference, a sum of residues."""
    kind = "indentation" if name == "F_edge" else "slope"
    lam, mu, alpha = 1.3, 0.7, 0.6
    nu = lam / (2 * (lam + mu))
    cases = [(0.05, scipy.special.jn_zeros(0, 1800)), (0.4, scipy.special.jn_zeros(0, 260))]
    expected = [float(edge_routes.edge_part(kind, alpha, eta, 1.0, nu, 15)) for eta, _ in cases]

    def passes(expression: sp.Expr) -> bool:
        names = sorted(expression.free_symbols, key=str)
        call = sp.lambdify(names, expression, "numpy")
        for (eta, zeros), value in zip(cases, expected, strict=True):
            values = {"alpha": alpha, "eta": eta, "lam": lam, "mu": mu, "j_n": zeros}
            values["J1"] = scipy.special.j1(zeros)
            with np.errstate(all="ignore"):
                sums = np.cumsum(call(*(values[str(symbol)] for symbol in names)))
            for _ in range(8):  # terms alternate
                sums = (sums[1:] + sums[:-1]) / 2
            if not abs(sums[-1] / value - 1) < 1e-7:
                return False
        return True

    return passes


def by_poissons_ratio(_: str) -> Check:
    """Check (1 - nu)/(1 + nu) in terms of the Lame constants."""
    values = drawn({"lam", "mu"}, "support")
    ratios = [v["lam"] / (2 * (v["lam"] + v["mu"])) for v in values]
    pairs = [(v, (1 - nu) / (1 + nu)) for v, nu in zip(values, ratios, strict=True)]
    return lambda expression: all(
        close(evaluator(expression)(v), expected) for v, expected in pairs
    )
