"""Step 26: the first six steps with plate inertia, rho d^2/dt^2.

A mode u = g(z) phi J1(phi r), w = f(z) J0(phi r), both times cos(omega t), adds rho omega^2 g and
rho omega^2 f to step 1's equations. On e^(s z) they give s^2 = phi^2 - rho omega^2/(lam + 2 mu),
for motion without rotation, and s^2 = phi^2 - rho omega^2/mu for motion without dilatation.
Half of A_j on both faces, in equal or opposite directions, leaves the back face free and separates
the motion into bending (f even) and extension (f odd). With x = phi h, kap = (omega h/c_T)^2,
c_T^2 = mu/rho, gam = mu/(lam + 2 mu), p^2 = x^2 - gam kap and q^2 = x^2 - kap,

    C = w(+h)/A_j = (h/mu) (1/B_a + 1/B_s),
    B_a = -(2/kap) [(2 x^2 - kap)^2 tanh(p)/p - 4 x^2 q tanh(q)],
    B_s = -(2/kap) [(2 x^2 - kap)^2 coth(p)/p - 4 x^2 q coth(q)],

the static step's C for kap -> 0. For kap < x^2 the brackets cancel; with shc y = sinh(y)/y,
S = p + q and d = p - q = (1 - gam) kap/S the same is

    B_a = 2 [8 x^2 q^2 (1 - gam) F/(cosh p cosh q) - kap tanh(p)/p],
    B_s = (2/p^2) [2 x^2 (1 - gam) (shc S + shc d)/(shc p shc q) - kap p coth(p)],
    F = (shc S - shc d)/(S^2 - d^2) = sum_(n>=0) [sum_(i<=n) S^(2i) d^(2n-2i)]/(2n + 3)!,

where every function is positive. Of any two solutions (Lagrange's identity)

    [S_zz f' - S_zz' f + phi (S_rz g' - S_rz' g)]_-h^h = rho (omega'^2 - omega^2)
                                                         int (f f' + phi^2 g g') dz,

' marking the other one. For two free waves the left side is 0: they are orthogonal. For one load at
neighbouring frequencies it is A_j dw(+h): 1/B_a and 1/B_s increase with kap where they are finite,

    d(1/B)/dkap = (mu^2/(h^3 A_j^2)) int (f^2 + phi^2 g^2) dz > 0,

so that between two poles of B lies one zero, a branch of free waves, 1/B = r_k/(kap_k - kap) + ...
there, and rho h r_k = h f(h)^2/int (f^2 + phi^2 g^2) dz of that wave. For |kap| -> oo both
1/B -> 0 on circles between their poles, so that 1/B = sum r_k/(kap_k - kap) (Mittag-Leffler).
"""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import sympy as sp

from derivation.engine.formula.proof import Proof, prove
from derivation.plate.modes.theory.equilibrium import (
    BESSEL_J0,
    BESSEL_J1,
    equilibrium,
    factor_of,
    force_balance,
    hooke,
    without_functions,
)
from derivation.plate.modes.theory.influence import influence_coefficients
from derivation.plate.vocabulary import (
    C1,
    C2,
    C3,
    C4,
    Formula,
    f,
    g,
    gam,
    h,
    kap,
    lam,
    mu,
    omega,
    phi,
    rho,
    x_h,
    z,
)

P_NUMBER = sp.sqrt(phi**2 - rho * omega**2 / (lam + 2 * mu))
S_NUMBER = sp.sqrt(phi**2 - rho * omega**2 / mu)
"""p/h and q/h."""
p, q = sp.symbols("p q", positive=True)
"""For proofs with h = mu = 1: kap = x^2 - q^2 and gam kap = x^2 - p^2 eliminate all roots."""
IN_P_AND_Q = {kap: x_h**2 - q**2, gam: (x_h**2 - p**2) / (x_h**2 - q**2)}


class Wave(NamedTuple):
    """f and g through the thickness, and the stresses, factors of J0 and J1."""

    f: sp.Expr
    g: sp.Expr
    zz: sp.Expr
    rz: sp.Expr


@cache
def wave_equations() -> tuple[Formula, Formula]:
    """Return step 1's equations with inertia, as expressions that must vanish."""
    radial, axial = (ode.expression for ode in equilibrium())
    inertia = rho * omega**2
    u, w = g * phi * BESSEL_J1, f * BESSEL_J0
    balance = force_balance(hooke(u, w))
    first, second = radial + inertia * g, axial + inertia * f
    proof = prove(
        "Waves of one mode",
        r"For a motion proportional to $\cos(\omega t)$, $-\rho d^2/dt^2$ is $\rho \omega^2$; it "
        r"stands on the right of both balances of forces.",
        lambda first, second: {
            "radial": without_functions(balance[0] + inertia * u - phi * first * BESSEL_J1),
            "axial": without_functions(balance[1] + inertia * w - second * BESSEL_J0),
        },
        *(first, second),
    )
    sources = ("radial_ode", "axial_ode")
    return (
        Formula(
            "radial_wave", "0", "equation of radial motion of mode $j$", first, "Pa", "",
            sources[:1], proof,
        ),
        Formula(
            "axial_wave", "0", "equation of axial motion of mode $j$", second, "Pa/m", "",
            sources[1:], proof,
        ),
    )  # fmt: skip


def wave(shape_p: sp.Expr, shape_q: sp.Expr) -> Wave:
    """Return the motion from a part without rotation, of p z/h, and one without dilatation."""
    shape_f = shape_p + shape_q
    shape_g = -sp.diff(shape_p, z) / (p / h) ** 2 - sp.diff(shape_q, z) / phi**2
    stress = hooke(shape_g * phi * BESSEL_J1, shape_f * BESSEL_J0)
    parts = factor_of(stress.zz, BESSEL_J0), factor_of(stress.rz, BESSEL_J1)
    return Wave(shape_f, shape_g, *parts)


@cache
def wave_shapes() -> tuple[Formula, Formula]:
    """Return f and g with four constants."""
    first = C1 * sp.cosh(p * z / h) + C2 * sp.sinh(p * z / h)
    second = (C3 * sp.cosh(q * z / h) + C4 * sp.sinh(q * z / h)) / phi
    solution = wave(first, second)
    numbers = {p: h * P_NUMBER, q: h * S_NUMBER}
    shape_f, shape_g = (part.subs(numbers) for part in solution[:2])
    residuals = [
        in_p_and_q(ode.expression.subs({f: solution.f, g: solution.g}).doit())
        for ode in wave_equations()
    ]
    proof = prove(
        "Solution of the waves",
        "$f$ and $g$ are inserted into both equations; their four functions are independent, as "
        "in step 2.",
        lambda f, g: {
            "f": f - solution.f.subs(numbers),
            "g": g - solution.g.subs(numbers),
            "radial": residuals[0],
            "axial": residuals[1],
        },
        *(shape_f, shape_g),
    )
    sources = ("radial_wave", "axial_wave")
    return (
        Formula(
            "wave_f", r"f(z)\vert_\omega", "deflection of a wave through the thickness",
            shape_f, "m", "", sources, proof,
        ),
        Formula(
            "wave_g", r"g(z)\vert_\omega", r"radial displacement of a wave through the "
            r"thickness, divided by $\phi_j$", shape_g,
            "m^2", "", sources, proof,
        ),
    )  # fmt: skip


# --- a load on one face


def stiffness(tanh_p: sp.Expr, tanh_q: sp.Expr) -> sp.Expr:
    """Return B_a, or B_s with coth for tanh, in x, kap, p and q."""
    bracket = (2 * x_h**2 - kap) ** 2 * tanh_p / p - 4 * x_h**2 * q * tanh_q
    return -2 / kap * bracket


def slow_stiffness() -> tuple[sp.Expr, sp.Expr]:
    """Return B_a and B_s in functions that are positive for kap < x^2."""
    total, apart = p + q, p - q
    even, odd = (shc(total) + sign * shc(apart) for sign in (1, -1))
    rest = 1 - gam
    bent = 8 * x_h**2 * q**2 * rest * odd / (4 * p * q * sp.cosh(p) * sp.cosh(q))
    stretched = 2 * x_h**2 * rest * even / (shc(p) * shc(q)) - kap * p * sp.coth(p)
    return 2 * (bent - kap * sp.tanh(p) / p), 2 / p**2 * stretched


def shc(y: sp.Expr) -> sp.Expr:
    """Return sinh(y)/y."""
    return sp.sinh(y) / y


def with_roots(expression: sp.Expr) -> sp.Expr:
    """Insert the definitions of p and q."""
    return expression.subs({p: sp.sqrt(x_h**2 - gam * kap), q: sp.sqrt(x_h**2 - kap)})


def in_p_and_q(expression: sp.Expr) -> sp.Expr:
    """Return an expression of the plate in x, p and q: h = mu = 1, so that phi = x."""
    roots = {x_h**2 - gam * kap: p, x_h**2 - kap: q}
    plain = expression.replace(
        lambda e: e.is_Pow and e.base in roots, lambda e: roots[e.base] ** (2 * e.exp)
    )
    lame = 1 / IN_P_AND_Q[gam] - 2
    speed = {phi: x_h, h: 1, mu: 1, lam: lame, rho: 1, omega: sp.sqrt(IN_P_AND_Q[kap])}
    return plain.subs(speed).subs(IN_P_AND_Q)


@cache
def loaded_wave(bends: bool) -> Wave:
    """Return the motion under 1/2 on both faces: equal (f even) or opposite (f odd) directions.

    In x, p and q as by `in_p_and_q`; A_j = 1.
    """
    shape = sp.cosh if bends else sp.sinh
    general = wave(C1 * shape(p * z / h), C3 * shape(q * z / h) / phi)
    plain = [in_p_and_q(part) for part in general]
    faces = [part.subs(z, 1) for part in plain[2:]]
    (solution,) = sp.linsolve([faces[0] - sp.Rational(1, 2), faces[1]], C1, C3)
    constants = {c: sp.factor(value) for c, value in zip((C1, C3), solution, strict=True)}
    return Wave(*(part.subs(constants) for part in plain))


@cache
def dynamic_influence() -> tuple[Formula, ...]:
    """Return C, B_a and B_s as derived, and in forms without cancellation below x^2."""
    parts = loaded_wave(bends=True), loaded_wave(bends=False)
    printed = stiffness(sp.tanh(p), sp.tanh(q)), stiffness(sp.coth(p), sp.coth(q))
    slow = slow_stiffness()
    exact = (*printed, *slow, *map(with_roots, (*printed, *slow)))
    residuals = {"back face": in_sines(sum(part.zz.subs(z, -1) for part in parts))}
    for part, value, name in zip(parts, printed, ("B_a", "B_s"), strict=True):
        residuals[name] = in_sines(part.f.subs(z, 1) - 1 / in_p_and_q(value))
        residuals[f"shear of {name}"] = in_sines(part.rz.subs(z, -1))
    for form, value, name in zip(slow, printed, ("B_a", "B_s"), strict=True):
        residuals[f"{name} without cancellation"] = in_sines(in_p_and_q(form - value))
    proof = prove(
        "Dynamic influence coefficient",
        r"A pressure $A_j/2$ acts on both faces, in equal and in opposite directions; the sum of "
        r"both cases leaves the back face free. The tractions are solved for the constants, "
        r"with $\kappa$ and $\gamma$ expressed by $p$ and $q$.",
        lambda *claims: residuals
        | {f"form {i}": claim - exact[i] for i, claim in enumerate(claims)},
        *exact,
    )  # fmt: skip
    shapes = "wave_f", "wave_g"
    total = h / mu * sum(1 / with_roots(value) for value in printed)
    slowly = r"over $\mu/h$, without cancellation for $\kappa < x^2$"
    rows = (
        ("B_a", "B_a", r"dynamic stiffness in bending, over $\mu/h$", "1", shapes, printed[0]),
        ("B_s", "B_s", r"dynamic stiffness in extension, over $\mu/h$", "1", shapes, printed[1]),
        ("B_a_slow", "B_a", f"dynamic stiffness in bending, {slowly}", "1", ("B_a",), slow[0]),
        ("B_s_slow", "B_s", f"dynamic stiffness in extension, {slowly}", "1", ("B_s",), slow[1]),
    )
    parts_of_both = tuple(
        Formula(
            name, latex, meaning, with_roots(value), unit, "", sources, proof, stated=value
        )
        for name, latex, meaning, unit, sources, value in rows
    )  # fmt: skip
    stated = h / mu * sum(1 / sp.Symbol(name) for name in ("B_a", "B_s"))
    load, forms = static_limit(), dict(zip(("B_a", "B_s"), map(with_roots, slow), strict=True))
    of_both = prove(
        "Dynamic influence of both parts",
        "The two cases of the load on both faces are added. " + load.argument,
        lambda total, stated: {
            "stated": stated.subs(forms) - total,
            "deflection": in_sines(in_p_and_q(total) - sum(part.f.subs(z, 1) for part in parts)),
        },
        *(total, stated),
    )
    both = Formula(
        "dynamic_influence", r"C(\phi_j, \omega)",
        "deflection of the contact face per coefficient of an oscillating pressure",
        total, "m/Pa", "", ("B_a", "B_s"), of_both, stated=stated,
    )  # fmt: skip
    return (*parts_of_both, both)


@cache
def static_limit() -> Proof:
    """Prove the limit kap -> 0: step 6's influence coefficient, and its two parts."""
    top, _, half = (formula.expression for formula in influence_coefficients())
    plate = {lam: mu * (1 / gam - 2), phi: x_h / h}
    T = 2 * x_h
    parts = [form.subs(kap, 0).subs(shc(p - q), 1) for form in slow_stiffness()]
    bent, stretched = (part.subs({p: x_h, q: x_h}) for part in parts)
    E = (half * phi / 2).subs(plate)
    antisymmetric = (sp.cosh(T) + 1) / (sp.sinh(T) - T) * E / x_h
    symmetric = (sp.cosh(T) - 1) / (sp.sinh(T) + T) * E / x_h
    return prove(
        "Static load",
        r"$p$ and $q$ tend to $x$, and $\sinh(p - q)/(p - q)$ tends to 1.",
        {
            "bending": in_sines(1 / bent - mu * antisymmetric),
            "extension": in_sines(1 / stretched - mu * symmetric),
            "sum": in_sines(antisymmetric + symmetric - (top / h).subs(plate)),
        },
    )


@cache
def kinetic_identity() -> Proof:
    """Prove Lagrange's identity of two motions, and its limit for neighbouring frequencies."""
    other = sp.Symbol("omega_1", positive=True)
    names = [sp.Function(name)(z) for name in ("f_1", "g_1", "f_2", "g_2")]
    pairs = ((names[0], names[1], omega), (names[2], names[3], other))
    stress, motion = [], {}
    for one, two, rate in pairs:
        stresses = hooke(two * phi * BESSEL_J1, one * BESSEL_J0)
        stress.append((factor_of(stresses.zz, BESSEL_J0), factor_of(stresses.rz, BESSEL_J1)))
        radial, axial = (
            formula.expression.subs({f: one, g: two, omega: rate}).doit()
            for formula in wave_equations()
        )
        motion[sp.diff(two, z, 2)] = sp.solve(radial, sp.diff(two, z, 2))[0]
        motion[sp.diff(one, z, 2)] = sp.solve(axial, sp.diff(one, z, 2))[0]
    (zz_1, rz_1), (zz_2, rz_2) = stress
    f_1, g_1, f_2, g_2 = names
    flow = zz_1 * f_2 - zz_2 * f_1 + phi * (rz_1 * g_2 - rz_2 * g_1)
    grown = sp.diff(flow, z).subs(motion)
    kinetic = rho * (other**2 - omega**2) * (f_1 * f_2 + phi**2 * g_1 * g_2)
    return prove(
        "Lagrange's identity",
        "The flow of force times displacement is differentiated with respect to z, with the "
        "equations of both motions.",
        {"flow": sp.expand(without_functions(grown - kinetic, *names))},
    )


@cache
def kinetic_slope() -> Proof:
    """Prove d(1/B)/dkap as the loaded motion's int (f^2 + phi^2 g^2) dz, both sides in full."""
    kinetic_identity()
    residuals = {}
    for bends, name in ((True, "B_a"), (False, "B_s")):
        part, tanh = loaded_wave(bends), sp.tanh if bends else sp.coth
        value = 1 / with_roots(stiffness(tanh(p), tanh(q)))
        change = in_p_and_q(sp.diff(value, kap))
        even, odd = (sp.cosh, sp.sinh) if bends else (sp.sinh, sp.cosh)
        energy = sp.Integer(0)
        for shape, weight, function in ((part.f, 1, even), (part.g, x_h**2, odd)):
            first, second = (sp.cancel(sp.expand(shape).coeff(function(k * z))) for k in (p, q))
            squares, product = _integrals(function)
            energy += weight * (
                first**2 * squares(p) + second**2 * squares(q) + 2 * first * second * product
            )
        residuals[name] = in_sines(change - energy)
    return prove(
        "Slope of the compliance",
        "1/B is differentiated with respect to kap, and the squares of f and g are integrated.",
        residuals,
    )


def _integrals(shape: type[sp.Function]) -> tuple[Callable[[sp.Expr], sp.Expr], sp.Expr]:
    """Return integrals over (-1, 1) of shape(k z)^2, by k, and of shape(p z) shape(q z)."""
    cosh_p, sinh_p, cosh_q, sinh_q = (f(k * z) for k in (p, q) for f in (sp.cosh, sp.sinh))
    turned = sinh_p * cosh_q, cosh_p * sinh_q
    sign = 1 if shape is sp.cosh else -1
    flow = (p * turned[0] - q * turned[1], p * turned[1] - q * turned[0])[::sign][0]
    mixed = flow / (p**2 - q**2)
    single = z / 2 * sign + sp.sinh(2 * p * z) / (4 * p)
    prove(
        "Integrals of hyperbolic functions",
        "The antiderivatives are differentiated.",
        {
            "mixed": in_sines(sp.diff(mixed, z) - shape(p * z) * shape(q * z)),
            "single": in_sines(sp.diff(single, z) - shape(p * z) ** 2),
        },
    )
    whole = 2 * single.subs(z, 1)
    return lambda k: whole.subs(p, k), 2 * mixed.subs(z, 1)


def in_sines(expression: sp.Expr) -> sp.Expr:
    """Return an expression's numerator as a polynomial in hyperbolic functions, without cosh^2.

    It is 0 only if it vanishes: sinh p, cosh p, sinh q and cosh q have no other relation.
    """
    single = sp.expand_trig(expression)
    single = single.replace(sp.tanh, lambda y: sp.sinh(y) / sp.cosh(y))
    single = single.replace(sp.coth, lambda y: sp.cosh(y) / sp.sinh(y))
    arguments = {atom.args[0] for atom in single.atoms(sp.sinh, sp.cosh)}
    named = {y: sp.symbols(f"s_{i} c_{i}") for i, y in enumerate(sorted(arguments, key=str))}
    sines = {sp.sinh(y): sine for y, (sine, _) in named.items()}
    cosines = {sp.cosh(y): cosine for y, (_, cosine) in named.items()}
    numerator = sp.numer(sp.together(single.subs(sines | cosines)))
    for sine, cosine in named.values():
        numerator = sp.rem(numerator, cosine**2 - sine**2 - 1, cosine)
    return sp.expand(numerator)


def dynamic_modes() -> tuple[Formula, ...]:
    """Return the formulas of the step."""
    kinetic_slope()
    return (*wave_equations(), *wave_shapes(), *dynamic_influence())
