"""Step 16: motion of the sphere: energy integral (13), contact time, linearisation (15) to (18).

m delta'' + P(delta) = 0 has the integral m delta'^2/2 + int P d delta = m v0^2/2. With the
corrected law both P and delta are polynomials in the contact radius a, so the contact time is an
integral over q = a/a_m; the substitution below removes its singularity at q = 1.
"""

from functools import cache

import sympy as sp

from derivation.engine.cache import in_file
from derivation.engine.formula.proof import Proof, prove
from derivation.plate.contact.theory.hertz import SOURCES, contact_radius
from derivation.plate.contact.theory.reversion import force_formulas
from derivation.plate.vocabulary import D, Formula, R, a, delta, delta_0, h, m, t, u_t, v0, xi_k

_q = sp.Symbol("q", positive=True)
_a_m = sp.Symbol("a_m", positive=True)
SHOWN = 3
"""Number of D_3, D_5, ... in the recorded integrand of the contact time."""


def formal_force(at: sp.Expr, last: int = 3) -> sp.Expr:
    """Return sum over k = 2 ... last of xi_k delta^((2k-1)/3), the paper's form of the force."""
    return sp.Add(*(xi_k[i] * at ** sp.Rational(2 * i - 1, 3) for i in range(2, last + 1)))


@cache
def formal_speed_squared() -> sp.Expr:
    """Return delta'^2 as a function of delta: v0^2 - 2/m int P d delta."""
    work = sp.integrate(sp.expand(formal_force(delta)), (delta, 0, delta))
    return v0**2 - sp.expand(2 / m * work)


@cache
def motion() -> tuple[Formula, Formula]:
    """Return (11) and (13) with the first two terms of the force."""
    force = formal_force(delta)
    squared = formal_speed_squared()
    speed = sp.sqrt(squared)
    # d/dt (delta'^2) = 2 delta' delta'', and delta'' = -P/m.
    acceleration = -force / m
    proof = prove(
        "Energy integral",
        r"$\delta'^2$ is differentiated along the motion and equals $v_0^2$ at $\delta = 0$.",
        lambda acceleration, speed: (
            {
                "along the motion": sp.diff(speed**2, delta) - 2 * acceleration,
                "at contact": speed.subs(delta, 0) - v0,
                "force": m * acceleration + force,
            }
            | {
                f"term {i}": squared.coeff(xi_k[i])
                + 3 / (m * (i + 1)) * delta ** sp.Rational(2 * (i + 1), 3)
                for i in (2, 3)
            }
        ),
        *(acceleration, speed),
    )
    return (
        Formula(
            "acceleration",
            r"\ddot{\delta}",
            "acceleration of the sphere, the force truncated after its second term",
            acceleration,
            "m/s^2",
            "11",
            ("xi_2", "xi_3"),
            proof,
        ),
        Formula(
            "speed",
            r"\dot{\delta}",
            "velocity of the sphere, the force truncated after its second term",
            speed,
            "m/s",
            "13",
            ("acceleration",),
            proof,
        ),
    )


def weight(n: int) -> sp.Expr:
    """Return D_n: D_2 = 1, D_(2k-1) = c_(2k-3) (a_m/h)^(2k-3)."""
    return sp.Integer(1) if n == 2 else D[n]


def orders(shown: int = SHOWN) -> tuple[int, ...]:
    """Return the indices n of D_n: 2, 3, 5, 7, ..."""
    return (2, *(2 * i + 1 for i in range(1, shown + 1)))


def geometric(n: int, q: sp.Expr) -> sp.Expr:
    """Return 1 + q + ... + q^(n-1)."""
    return sp.Add(*(q**i for i in range(n)))


@cache
def work_of_contact(shown: int = SHOWN) -> sp.Expr:
    """Return sum n D_n/(n + 3), the work up to a_m over C a_m^5, C = 4 E*/(3 R^2)."""
    return sp.Add(*(sp.Rational(n, n + 3) * weight(n) for n in orders(shown)))


@cache
def contact_time(shown: int = SHOWN) -> tuple[Formula, ...]:
    """Return the integrand of the contact time and the largest work, with their proofs.

    delta = (a_m^2/R) sum D_n q^n and P = C R a_m^3 q^3: the work between q and 1 is C a_m^5 sum n
    D_n/(n+3) (1 - q^(n+3)), each term of which has the factor 1 - q. With q = 1 - u^2 this factor
    is u^2, its root cancels against dq = -2 u du, and the integrand 2 (sum n D_n q^(n-1))/sqrt(sum
    n D_n/(n+3) geo_(n+3)(q)) is analytic in u.
    """
    q = 1 - u_t**2
    rate = sp.Add(*(n * weight(n) * q ** (n - 1) for n in orders(shown)))
    stored = sp.Add(
        *(sp.Rational(n, n + 3) * weight(n) * geometric(n + 3, q) for n in orders(shown))
    )
    integrand = 2 * rate / sp.sqrt(stored)
    stated, work = _in_quotients(shown), work_of_contact(shown)
    proof = prove_contact_time(shown, integrand, stated, work)
    return (
        Formula(
            "contact_integrand",
            r"\mathrm{d}I/\mathrm{d}u",
            r"integrand for $q = 1 - u^2$; half the contact time is its integral times "
            r"$\sqrt{m/2} (a_m^2/R)/\sqrt{C a_m^5}$",
            integrand,
            "1",
            "13",
            ("delta_reduced", "P"),
            proof,
            stated=stated,
        ),
        Formula(
            "contact_work",
            r"\frac{m v_0^2}{2 C a_m^5}",
            "impact energy divided by $C a_m^5$, which determines $a_m$",
            work,
            "1",
            "13",
            ("delta_reduced", "P"),
            proof,
        ),
    )


def _in_quotients(shown: int) -> sp.Expr:
    """Return the integrand in q = a/a_m, with geometric sums as (1 - q^n)/(1 - q)."""
    rate = sp.Add(*(n * weight(n) * _q ** (n - 1) for n in orders(shown)))
    stored = sp.Add(
        *(sp.Rational(n, n + 3) * weight(n) * (1 - _q ** (n + 3)) for n in orders(shown))
    )
    return 2 * sp.sqrt(1 - _q) * rate / sp.sqrt(stored)


def prove_contact_time(shown: int, integrand: sp.Expr, stated: sp.Expr, work: sp.Expr) -> Proof:
    """Prove the energy, its factor 1 - q, and the substitution, with all D_n at once."""
    scale = contact_radius().expression / a**3
    C = scale / R
    travel = _a_m**2 / R * sp.Add(*(weight(n) * _q**n for n in orders(shown)))
    force = scale * (_a_m * _q) ** 3
    done = sp.integrate(sp.expand(force * sp.diff(travel, _q)), (_q, 0, _q))
    left = sp.Add(
        *(sp.Rational(n, n + 3) * weight(n) * geometric(n + 3, _q) for n in orders(shown))
    )
    # (dt/dq)^2 = (d travel/dq)^2/speed^2 against the square of prefactor, integrand, du/dq.
    speed_squared = 2 / m * C * _a_m**5 * (1 - _q) * left
    prefactor_squared = m / 2 * _a_m**4 / R**2 / (C * _a_m**5)

    def residuals(integrand: sp.Expr, stated: sp.Expr, work: sp.Expr) -> dict[str, sp.Expr]:
        total, in_q = C * _a_m**5 * work, integrand.subs(u_t, sp.sqrt(1 - _q))
        by_u = in_q**2 / (4 * (1 - _q))
        return {
            "work": total - done.subs(_q, 1),
            "factor": sp.expand(total - done - C * _a_m**5 * (1 - _q) * left),
            "time": sp.diff(travel, _q) ** 2 - speed_squared * prefactor_squared * by_u,
            "in quotients": in_q**2 - stated**2,
        }

    return prove(
        "Contact time",
        r"The work $\int P d \delta$ is taken over $a$, with $q = 1 - u^2$ and $1 - q^{n+3} = (1 "
        r"- q)(1 + q + \ldots + q^{n+2})$.",
        residuals,
        *(integrand, stated, work),
    )


@in_file((*SOURCES, "plate/impact/theory"), Formula, Proof)  # kernels need it at their import
def hertz_time() -> Formula:
    """Return the contact time on the half-space over delta_max/v0: 2 int_0^1 dx/sqrt(1 - x^(5/2)).

    x = s^(2/5) turns it into Euler's Beta integral B(2/5, 1/2).
    """
    s = sp.Symbol("s", positive=True)
    x = s ** sp.Rational(2, 5)
    integrand = sp.diff(x, s) / sp.sqrt(1 - sp.powdenest(x ** sp.Rational(5, 2), force=True))
    euler = s ** (sp.Rational(2, 5) - 1) * (1 - s) ** (sp.Rational(1, 2) - 1)
    factor = sp.simplify(integrand / euler)
    value = 2 * factor * sp.gamma(sp.Rational(2, 5)) * sp.sqrt(sp.pi) / sp.gamma(sp.Rational(9, 10))
    beta, largest = sp.beta(sp.Rational(2, 5), sp.Rational(1, 2)), sp.Symbol("d", positive=True)
    C = sp.Symbol("C", positive=True)
    # a_m from the work, and the prefactor of I, with D_2 alone.
    speed = sp.sqrt(2 * C * _a_m**5 * work_of_contact(0) / m)
    prefactor = sp.sqrt(m / 2) * largest / sp.sqrt(C * _a_m**5)
    ratio = sp.simplify(prefactor * speed / largest)
    q = 1 - u_t**2
    direct = sp.sqrt(sp.Rational(2, 5)) * 4 * q / sp.sqrt(sp.Rational(2, 5) * geometric(5, q))
    proof = prove(
        "Hertz's contact time",
        "The substitution $x = s^{2/5}$ gives Euler's Beta integral. The substitutions $x = "
        "q^2$ and $q = 1 - u^2$ give the integral of the contact time with $D_2$ alone.",
        lambda value: {
            "Beta": integrand - factor * euler,
            "value": sp.gammasimp(value / beta.rewrite(sp.gamma)) - 2 * factor,
            "prefactor": ratio - sp.sqrt(work_of_contact(0)),
            "same integral": direct**2 - 16 * q**2 * u_t**2 / sp.expand(1 - q**5),
        },
        value,
    )
    return Formula(
        "hertz_time",
        r"2 t_c v_0/\delta_{\max}",
        r"contact time on the half-space divided by $\delta_{\max}/v_0$",
        value,
        "1",
        "13",
        ("contact_integrand",),
        proof,
    )


@cache
def linear_motion() -> Formula:
    """Return (15): the motion under the first term of the force, xi_2 delta."""
    value = v0 * sp.sqrt(m / xi_k[2]) * sp.sin(sp.sqrt(xi_k[2] / m) * t)
    proof = prove(
        "Linear motion",
        r"The motion solves $m \delta'' + \xi_2 \delta = 0$ with $\delta(0) = 0$ and $\delta'(0) = "
        "v_0$.",
        lambda value: {
            "equation of motion": m * sp.diff(value, t, 2) + xi_k[2] * value,
            "initial position": value.subs(t, 0),
            "initial velocity": sp.diff(value, t).subs(t, 0) - v0,
        },
        value,
    )
    return Formula(
        "delta_0",
        r"\delta_0(t)",
        "indentation under the first term of the force alone",
        value,
        "m",
        "15",
        ("acceleration",),
        proof,
    )


def linearised(force: sp.Expr, first: sp.Expr, at: sp.Symbol) -> tuple[sp.Expr, sp.Expr]:
    """Return F and G of eta' + F eta + G = 0, for any force and any first part of it, both in `at`.

    delta' = V(delta), delta_0' = V_0(delta_0), V^2 = v0^2 - 2/m int P: with
    delta = delta_0 + eta, eta' = V(delta_0) - V_0(delta_0) + V'(delta_0) eta, so
    that F = -V' = P/(m V) and G = V_0 - V.
    """
    V, V_0 = (
        sp.sqrt(v0**2 - sp.expand(2 / m * sp.integrate(sp.expand(part), (at, 0, at))))
        for part in (force, first)
    )
    return force / (m * V), V_0 - V


@cache
def linearisation() -> tuple[Formula, ...]:
    """Return (17), (18) and the radicand at the largest indentation of the linear motion."""
    force = formal_force(delta_0)
    first = formal_force(delta_0, 2)
    F, G = linearised(force, first, delta_0)
    squared = formal_speed_squared().subs(delta, delta_0)
    V = sp.sqrt(squared)
    turned = v0 * sp.sqrt(m / xi_k[2])
    at_turning = sp.powdenest(sp.expand(squared.subs(delta_0, turned)), force=True)
    # (16): eta = (C - I) e^-S with I' = G e^S, S' = F.
    C, integral, S, source, rate = sp.symbols("C I S G F", real=True)
    solution = (C - integral) * sp.exp(-S)
    slope = sp.diff(solution, integral) * source * sp.exp(S) + sp.diff(solution, S) * rate
    proof = prove(
        "Linearisation",
        r"$V(\delta_0 + \eta) - V_0(\delta_0)$ is expanded to first order in $\eta$; (16) is "
        r"inserted into $\eta' + F \eta + G = 0$; the radicand is taken where $V_0$ vanishes.",
        lambda F, G, at_turning: {
            "F": F + sp.diff(V, delta_0),
            "G": G - (sp.sqrt(v0**2 - xi_k[2] / m * delta_0**2) - V),
            "solution": slope + rate * solution + source,
            "turning point": (v0**2 - xi_k[2] / m * delta_0**2).subs(delta_0, turned),
            "radicand": at_turning - squared.subs(delta_0, turned),
        },
        *(F, G, at_turning),
    )

    def record(name: str, symbol: str, what: str, value: sp.Expr, unit: str, eq: str) -> Formula:
        return Formula(name, symbol, what, value, unit, eq, ("speed", "delta_0"), proof)

    return (
        record("F_1", "F(t)", "coefficient in the equation of the correction", F, "1/s", "17"),
        record("G_1", "G(t)", "source term in the equation of the correction", G, "m/s", "18"),
        record(
            "radicand_at_turn",
            r"\dot{\delta}^2(\delta_{0,\max})",
            "radicand of (17), (18) at the turning point of the linear motion",
            at_turning,
            "m^2/s^2",
            "18",
        ),
    )


@cache
def linearisation_about_hertz() -> tuple[Formula, Formula]:
    """Return F and G about Hertz's motion, the first part of the corrected law.

    The force is Hertz's, k delta^(3/2), times 1 + p_1 eps with eps = sqrt(R delta)/h.
    """
    hertz, p_1 = force_formulas(1)[1].expression, force_formulas(1)[0].expression
    first = hertz.subs(delta, delta_0)
    force = first * (1 + p_1 * sp.sqrt(R * delta_0) / h)
    F, G = linearised(force, first, delta_0)
    x = sp.Symbol("x", positive=True)
    stiffness = first / delta_0 ** sp.Rational(3, 2)
    squares = [
        v0**2 - 2 / m * stiffness * (sp.Rational(2, 5) * x**5 + extra)
        for extra in (p_1 * sp.sqrt(R) / h * x**6 / 3, 0)
    ]
    V, V_0 = (sp.sqrt(square.subs(x, sp.sqrt(delta_0))) for square in squares)
    proof = prove(
        "Linearisation about Hertz's motion",
        "Both velocities are the roots of squares that are written out here. $F$ is minus the "
        "derivative of the perturbed velocity with respect to the indentation, $G$ is their "
        "difference.",
        lambda F, G: {"F": F + sp.diff(V, delta_0), "G": G - V_0 + V},
        *(F, G),
    )
    sources = ("P_half", "p_1", "speed")
    return (
        Formula(
            "F_hertz",
            r"F_H(t)",
            "coefficient in the equation of the correction to Hertz's motion",
            F,
            "1/s",
            "17",
            sources,
            proof,
        ),
        Formula(
            "G_hertz",
            r"G_H(t)",
            "source term in the equation of the correction to Hertz's motion",
            G,
            "m/s",
            "18",
            sources,
            proof,
        ),
    )


def impact() -> tuple[Formula, ...]:
    """Return the formulas of the motion."""
    return (
        *motion(),
        *contact_time(),
        hertz_time(),
        linear_motion(),
        *linearisation(),
        *linearisation_about_hertz(),
    )
