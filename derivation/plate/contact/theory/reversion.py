"""Step 15: the contact law solved for the force to any order, by Lagrange inversion.

Two laws are inverted: the paper's formal one, delta = sum gamma_k P^((2k-1)/3), and the corrected
one, delta = (a^2/R)(1 + c_1 A + c_3 A^3 + ...), P = (4/3) E* a^3/R. Both have the shape
y^d = x^d (1 + r_1 x^g + r_2 x^(2g) + ...), and Lagrange's formula gives x^p = sum over n of
p/(p + g n) [x^(g n)] (1 + r_1 x^g + ...)^(-(p + g n)/d) y^(p + g n).
"""

from collections.abc import Sequence
from functools import cache

import flint
import sympy as sp

from derivation.engine.formula.dimension import thirds
from derivation.engine.formula.proof import Proof, prove
from derivation.plate.contact.theory.hertz import contact_radius
from derivation.plate.vocabulary import Formula, R, a, a_ratio, c_A, delta, gamma_k, h, k
from derivation.plate.vocabulary import N as _N

LAST_XI = 6
LAST_P = 8
_RAYS = 200


def power_series(
    series: Sequence[sp.Expr], exponent: sp.Rational, terms: int
) -> tuple[sp.Expr, ...]:
    """Return b = s^exponent, truncated, for a series s = 1 + ..., by b' s = exponent s' b.

    Examples
    --------
    >>> power_series((sp.Integer(1), sp.Symbol("r")), sp.Integer(2), 3)
    (1, 2*r, r**2)
    """
    b: list[sp.Expr] = [sp.Integer(1)]
    for n in range(1, terms):
        top = min(n, len(series) - 1)
        total = sp.Add(
            *(((exponent + 1) * i - n) * series[i] * b[n - i] for i in range(1, top + 1))
        )
        b.append(sp.expand(total / n))
    return tuple(b)


def inverted_coefficients(
    series: Sequence[sp.Expr], d: int, g: int, p: int, terms: int
) -> tuple[sp.Expr, ...]:
    """Return coefficients of y^(p + g n) in x^p, where y^d = x^d (series in x^g), by Lagrange."""
    coefficients = []
    for n in range(terms):
        exponent = sp.Rational(-(p + g * n), d)
        coefficients.append(sp.Rational(p, p + g * n) * power_series(series, exponent, n + 1)[n])
    return tuple(coefficients)


def composition(
    series: Sequence[sp.Expr], inverse: Sequence[sp.Expr], d: int, g: int, p: int
) -> dict[str, sp.Expr]:
    """Return the residuals of the inverse: x, taken from x^p, is inserted into the series.

    x^(d + g n) is the power (d + g n)/p of the inverse series: the coefficient of y^(d + g l) in
    y^d must be 0 for l > 0 up to the truncation order, and the inverse must begin with 1.
    """
    terms = len(inverse)
    total = [sp.Integer(0)] * terms
    for n, r in enumerate(series[:terms]):
        raised = power_series(inverse, sp.Rational(d + g * n, p), terms - n)
        for index, value in enumerate(raised):
            total[n + index] += r * value
    total[0] = inverse[0] - 1
    return {f"order {index}": sp.expand(value) for index, value in enumerate(total)}


@cache
def formal_coefficients(last: int = LAST_XI) -> tuple[Formula, ...]:
    """Return xi_2, ..., xi_last: the paper's formal law delta = sum gamma_k P^((2k-1)/3) inverted.

    x = P^(1/3), y = (delta/gamma_2)^(1/3): d = 3, g = 2, p = 3.
    """
    first = gamma_k[2]
    series = (sp.Integer(1), *(gamma_k[i] / first for i in range(3, last + 1)))
    inverse = inverted_coefficients(series, 3, 2, 3, last - 1)
    powers = [first ** sp.Rational(-(2 * index + 3), 3) for index in range(len(inverse))]
    values = tuple(sp.factor(x) * power for x, power in zip(inverse, powers, strict=True))
    proof = prove(
        "Inversion of the formal law",
        "The inverted series is inserted into the law: every order vanishes.",
        lambda *xi: composition(
            series, [x / power for x, power in zip(xi, powers, strict=True)], 3, 2, 3
        ),
        *values,
    )
    formulas = []
    for index, value in enumerate(values, start=2):
        power = sp.latex(delta ** sp.Rational(2 * index - 1, 3), fold_frac_powers=True)
        formulas.append(
            Formula(
                f"xi_{index}",
                rf"\xi_{{{index}}}",
                f"coefficient of ${power}$ in the force of the paper's series",
                value,
                f"N/{thirds('m', 2 * index - 1)}",
                "10",
                tuple(f"gamma_{i}" for i in range(2, index + 1)),
                proof,
            )
        )
    return tuple(formulas)


def plate_law(orders: int) -> tuple[sp.Expr, ...]:
    """Return 1 + c_1 A + c_3 A^3 + ..., as coefficients of A^0, A^1, ..., A^orders."""
    return tuple(sp.Integer(1) if n == 0 else c_A.get(n, sp.Integer(0)) for n in range(orders + 1))


@cache
def force_coefficients(last: int = LAST_P) -> tuple[sp.Expr, ...]:
    """Return p_0 = 1, p_1, ..., p_last: a^3 = h^3 eps^3 sum p_n eps^n, eps = sqrt(R delta)/h.

    x = A, y = eps, as eps^2 = A^2 (1 + c_1 A + ...): d = 2, g = 1, p = 3.
    """
    return inverted_coefficients(plate_law(last), 2, 1, 3, last + 1)


@cache
def force_composition(last: int = LAST_P) -> Proof:
    """Prove p_1, ..., p_last."""
    return prove(
        "Inversion of the contact law",
        "$A = (A^3)^{1/3}$ from the inverted series is inserted into "
        r"$\varepsilon^2 = A^2 (1 + c_1 A + \ldots)$.",
        lambda *p: composition(plate_law(last), (sp.Integer(1), *p), 2, 1, 3),
        *(sp.factor(value) for value in force_coefficients(last)[1:]),
    )


@cache
def force_formulas(shown: int = 4) -> tuple[Formula, ...]:
    """Return p_1, ..., p_shown, the leading part of the force, and its powers of delta."""
    proof = force_composition()
    formulas = [
        Formula(
            f"p_{n}",
            f"p_{n}",
            rf"coefficient of $\varepsilon^{n}$ in $P$ divided by Hertz's force",
            sp.factor(value),
            "1",
            "10",
            ("delta_reduced", "P"),
            proof,
        )
        for n, value in enumerate(force_coefficients()[1 : shown + 1], start=1)
    ]
    modulus = sp.cancel(contact_radius().expression * R / a**3)
    return (*formulas, _hertz_force(modulus), exponent())


def _hertz_force(scale: sp.Expr) -> Formula:
    """Return (4/3) E* sqrt(R) delta^(3/2), the force for p_n = 0."""
    value = scale * sp.sqrt(R) * delta ** sp.Rational(3, 2)
    proof = prove(
        "Hertz's force",
        r"$\delta = a^2/R$ is inserted into the relation between force and contact radius.",
        lambda value: {"force": value.subs(delta, a**2 / R) - scale * a**3 / R},
        value,
    )
    return Formula(
        "P_half",
        r"P_\infty",
        "Hertz's force for the half-space",
        value,
        "N",
        "10",
        ("P",),
        proof,
    )


@cache
def exponent() -> Formula:
    """Return the power of delta in the k-th term of the force, k = 2, 3, ...; Hertz's is k = 2.

    eps^(3 + n) is delta^((3 + n)/2); with n = k - 2 the first is delta^(3/2).
    """
    term = (sp.sqrt(R * delta) / h) ** (3 + _N)
    power = sp.factor(sp.simplify(delta * sp.diff(term, delta) / term).subs(_N, k - 2))
    proof = prove(
        "Powers of the indentation",
        r"$P$ is proportional to $\varepsilon^{3 + n}$ with $n = k - 2$, and $\varepsilon$ to "
        r"the square root of $\delta$.",
        lambda power: {
            "first": power.subs(k, 2) - sp.Rational(3, 2),
            "step": sp.expand(power.subs(k, k + 1) - power) - sp.Rational(1, 2),
        },
        power,
    )
    return Formula(
        "force_power",
        r"\mathrm{power\ of\ }\delta",
        "power of the indentation in the k-th term of the force",
        power,
        "1",
        "10",
        ("P_half",),
        proof,
    )


@cache
def radius_estimate() -> tuple[Formula, Formula]:
    """Return the convergence radius with c_1 alone, where d(eps^2)/dA = 0, in eps and in delta."""
    law = a_ratio**2 * (1 + c_A[1] * a_ratio)
    turning = -2 / (3 * c_A[1])
    squared = sp.factor(law.subs(a_ratio, turning))
    value = 2 / (3 * sp.sqrt(3) * sp.Abs(c_A[1]))
    proof = prove(
        "Radius of the inverted series",
        "The inverse is singular where the derivative of $A^2 (1 + c_1 A)$ vanishes.",
        lambda value, depth: {
            "turning point": sp.diff(law, a_ratio).subs(a_ratio, turning),
            "radius": value**2 - squared,
            "indentation": R * depth / h**2 - squared,
        },
        *(value, squared * h**2 / R),
    )
    eps_radius = Formula(
        "eps_radius",
        r"\varepsilon_{\max}",
        "radius of convergence of the inverted series, leading estimate",
        value,
        "1",
        "10",
        ("delta_reduced",),
        proof,
    )
    return eps_radius, Formula(
        "delta_radius",
        r"\delta_{\max}",
        "indentation up to which the inverted series converges, leading estimate",
        squared * h**2 / R,
        "m",
        "10",
        ("eps_radius",),
        proof,
    )


def radius(coefficients: Sequence[float], bits: int = 128) -> float:
    """Return the radius of convergence in eps of the inverted series, for given c_1, c_3, c_5, ...

    The inverse A(eps) is singular at critical values eps(A), where d(eps^2)/dA = 0. Only those
    critical points A count that continuation along the ray from eps = 0 reaches.

    Raises
    ------
    ValueError
        If all coefficients are zero, so that the series ends with its first term.
    """
    with flint.ctx.workprec(bits):
        slope = [flint.arb(2)]
        for index, value in enumerate(coefficients):
            slope += [flint.arb((2 * index + 3) * value), flint.arb(0)]
        while slope and slope[-1] == 0:
            slope.pop()
        if len(slope) < 2:
            raise ValueError("expected a coefficient that is not zero, got none")
        roots = flint.acb_poly(slope).roots()
        critical = sorted(
            ((_eps(coefficients, A), A) for A in roots), key=lambda pair: float(abs(pair[0]))
        )
        for value, A in critical:
            if any(_reaches(coefficients, sign * value, A) for sign in (1, -1)):
                return float(abs(value))
    return float("inf")


def _eps(coefficients: Sequence[float], A: flint.acb) -> flint.acb:
    return A * _law(coefficients, A).sqrt()


def _law(coefficients: Sequence[float], A: flint.acb) -> flint.acb:
    return 1 + sum((v * A ** (2 * i + 1) for i, v in enumerate(coefficients)), flint.acb(0))


def _reaches(coefficients: Sequence[float], target: flint.acb, A: flint.acb) -> bool:
    """Return whether Newton continuation of A(eps) from 0 towards `target` ends near A."""
    here = flint.acb(0)
    for step in range(1, _RAYS):
        # Steps shorten towards the end, where the derivative vanishes like a square root.
        eps_here = (target * (1 - flint.arb(1 - flint.arb(step) / _RAYS) ** 2)).mid()
        here = here if step > 1 else eps_here
        for _ in range(8):
            law = _law(coefficients, here)
            slope = 2 * here + sum(
                ((2 * i + 3) * v * here ** (2 * i + 2) for i, v in enumerate(coefficients)),
                flint.acb(0),
            )
            here = (here - (here**2 * law - eps_here**2) / slope).mid()
    return bool(abs(here - A).mid() < flint.arb(0.05) * abs(A).mid())


def reversion() -> tuple[Formula, ...]:
    """Return the formulas of the inversion: xi_k, p_n, Hertz's force, its powers, the radius."""
    return (*formal_coefficients(), *force_formulas(), *radius_estimate())
