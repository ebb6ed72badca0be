"""Step 18: bounds of the change of an impact if its law is replaced by a simpler one.

With S = (R/2a) d delta/da = 1 + F + A F'/2 the work is W = K int_0^a x^4 S dx and the contact time
2 int d delta/v. Two statements are proved.

Bounds of the law. Modes add (4 alpha/pi) w_n sinc(alpha j_n) to S, w_n > 0, and the finite radius
subtracts (4/pi^2) int sinh(alpha y)/y K0/I0 dy. The inequalities 1 - y^2/6 <= sinc y <= 1 and alpha
y <= sinh(alpha y) <= alpha y + alpha^3 (sinh y - y) give for every a < b

    1 + 3/2 c_1 A - K_3 A^3 <= S <= 1 + 3/2 c_1 A,
    K_3 = eta^3 [2/(3 pi) sum w_n j_n^2 + (4/pi^2) int (sinh y - y)/y K0/I0 dy].

Substitution. Let l S_1 <= S <= u S_1 on [0, a_top], where S_1 > 0 and d log S_1/d log a is between
-p and q. Then W lies between l W_1 and u W_1, pointwise, and so does its part between any a and
a_m. At equal energy, with e = 5 - p the least elasticity of W_1,

    u^(-1/e) <= a_m/a_1 <= l^(-1/e)                    if l^(-1/e) a_1 <= a_top.

The force changes by the cube of this. Indentation and time have the additional factors [l, u] and
[l/sqrt u, u/sqrt l] and change with a_m by `exponents`.
"""

from collections.abc import Callable, Mapping
from functools import cache

import flint
import sympy as sp

from derivation.engine.formula.ball import refine
from derivation.engine.formula.proof import Proof, prove
from derivation.plate.contact.theory.plate_series import coefficient, sine_coefficient
from derivation.plate.contact.theory.split import LATERAL, lateral_tail, reduced_split
from derivation.plate.contact.theory.thin_roots import SIZE_OVER_INDEX
from derivation.plate.impact.theory.impact import geometric
from derivation.plate.modes.theory.plate_factor import plate_factors
from derivation.plate.vocabulary import J1, Formula, T, a_ratio, alpha, c_A, eta, j_n, kappa

_y = sp.Symbol("y", positive=True)
_x, _a, _q = sp.symbols("x a q", positive=True)
_p, _r = sp.symbols("p r", nonnegative=True)


@cache
def slope_law() -> Formula:
    """Return the finite radius's part of S; that of the modes is in step 17."""
    lateral, mode = reduced_split()

    def sloped(part: sp.Expr) -> sp.Expr:
        return part + alpha * sp.diff(part, alpha) / 2

    weight = plate_factors()[2].expression.subs(T, 2 * eta * j_n) / (j_n * J1**2)
    y = alpha * j_n
    density = -4 / sp.pi**2 * sp.sinh(alpha * _y) / _y
    (height,) = lateral.expression.variables
    kernel = (lateral.expression.function / LATERAL).subs(height, _y)
    value = sp.Integral(density * LATERAL.subs(height, _y), (_y, 0, sp.oo))
    proof = prove(
        "Slope of the law",
        r"The expression $F + \alpha F'/2$ is evaluated for one mode and for the integrand of "
        r"the lateral surface.",
        lambda lateral: {
            "modes": sloped(mode.expression) - 4 * alpha / sp.pi * sp.sin(y) / y * weight,
            "finite radius": sp.expand(
                (
                    sloped(kernel) - lateral.function.subs(height, _y) / LATERAL.subs(height, _y)
                ).rewrite(sp.exp)
            ),
        },
        value,
    )
    return Formula(
        "slope_lateral",
        r"\frac{R}{2a}\frac{\mathrm{d}\delta_b}{\mathrm{d}a}",
        r"contribution of the finite radius to $d \delta/da$, divided by the half-space's",
        value,
        "1",
        "6",
        ("F_lateral",),
        proof,
    )


@cache
def one_sided() -> Formula:
    """Return 1 + 3/2 c_1 A, and prove 1 + 3/2 c_1 A - K_3 A^3 <= S <= 1 + 3/2 c_1 A for a < b."""
    slope_law()
    first = coefficient(2)
    weight = plate_factors()[2].expression.subs(T, 2 * eta * j_n) / (j_n * J1**2)
    chord = 1 - sp.cos(_y)
    order = sp.Symbol("k", integer=True, positive=True)
    rising = sp.diff(_y - sp.sin(_y), _y), sp.diff(sp.sin(_y) - _y + _y**3 / 6, _y)
    proof = prove(
        "Bounds of the law's slope",
        r"$y - \sin y$ vanishes at 0 and increases. It is the derivative of $y^2/2 + \cos y - 1$, "
        r"and this is the derivative of $\sin y - y + y^3/6$; so both also vanish at 0 and "
        r"increase. Each power of $\alpha$ in $\sinh(\alpha y)$ after the first is at most "
        r"$\alpha^3$; all $w_n > 0$, because $G > 1$. The first powers add up to $(3/2) c_1 A$.",
        lambda value: {
            "first powers": value.subs(c_A[1], first.mode + first.side)
            - 1
            - 4 * eta / sp.pi * a_ratio * (weight - kappa[0] / sp.pi),
            "sinc below 1": rising[0] - chord,
            "1 - cos y below y^2/2": sp.diff(_y**2 / 2 - chord, _y) - (_y - sp.sin(_y)),
            "sinc above 1 - y^2/6": rising[1] - (_y**2 / 2 - chord),
            "modes": sp.Rational(3, 2) * first.mode - 4 * eta / sp.pi * weight,
            "finite radius": sp.Rational(3, 2) * first.side + 4 * eta / sp.pi**2 * kappa[0],
            "power": (alpha * _y) ** (2 * order + 1)
            - alpha ** (2 * order - 2) * alpha**3 * _y ** (2 * order + 1),
            "G - 1": plate_factors()[2].expression * (sp.sinh(T) ** 2 - T**2)
            - ((1 - sp.exp(-2 * T)) / 2 + T + T**2),
        },
        1 + sp.Rational(3, 2) * c_A[1] * a_ratio,
    )
    return Formula(
        "S_bound",
        r"S_1",
        r"upper bound of $(R/2a) d \delta/da$ for every $a < b$",
        proof.claims[0],
        "1",
        "6",
        ("c_1_modes", "c_1_lateral", "slope_modes", "slope_lateral"),
        proof,
        where=("a_ratio * eta < 1",),
    )


def exponents(fall: sp.Expr, rise: sp.Expr) -> Mapping[str, sp.Expr]:
    """Return the exponents of `lemma` for -fall <= d log S_1/d log a <= rise.

    `energy` is the least elasticity of W_1, `depth` the largest of delta_1; the contact time of S_1
    decreases with a_m at most like a_m^-shorter and increases at most like a_m^longer.
    """
    half = sp.Rational(1, 2)
    return {
        "energy": 5 - fall,
        "depth": 2 + rise,
        "shorter": half + fall + rise / 2,
        "longer": rise - half + fall / 2,
    }


@cache
def lemma() -> Proof:
    """Prove the exponents: extreme powers for S_1 in work, indentation and time."""
    solution = exponents(_p, _r)

    def power(of: sp.Expr, top: sp.Expr) -> sp.Expr:
        return sp.integrate(_x**of, (_x, 0, top), conds="none")

    # S_1(x) <= S_1(a) (x/a)^-p below a: bounds of the growth of work and indentation.
    work = _a**5 / power(4 - _p, _a) * _a**-_p
    depth = _a**2 / power(1 + _r, _a) * _a**_r
    # S_1(g x) is between g^-p and g^q times S_1(x): distance over speed, both at a_m and at g a_m.
    travel, speed = (2 - _p, 2 + _r), (sp.Rational(5) / 2 - _p / 2, sp.Rational(5) / 2 + _r / 2)
    elasticity = _x / (1 + _x)
    return prove(
        "Substitution of the law",
        "a S_1/int S_1 is least or largest if S_1 is a power with an extreme exponent; the contact "
        "time is the integral of 1/speed.",
        {
            "energy": sp.simplify(work) - solution["energy"],
            "depth": sp.simplify(depth) - solution["depth"],
            "shorter": speed[1] - travel[0] - solution["shorter"],
            "longer": travel[1] - speed[0] - solution["longer"],
            "elasticity of 1 + x": _x * sp.diff(sp.log(1 + _x), _x) - elasticity,
            "elasticity increases": sp.diff(elasticity, _x) - 1 / (1 + _x) ** 2,
        },
    )


def substitution() -> tuple[Formula, ...]:
    """Return the formulas of the step, after proving the lemma."""
    lemma()
    return slope_law(), one_sided()


# --- numbers, as balls


def lateral_rest_ball(digits: int = 12) -> flint.arb:
    """Return (4/pi^2) int_0^oo (sinh y - y)/y K0/I0 dy = (4/pi^2) int (Shi y - y)/(y I0^2) dy.

    By parts, Shi being the integral of sinh y/y and (K0/I0)' = -1/(y I0^2). For y <= 1
    Shi y - y is below y^3/12, and beyond it Shi y is below e^y/2.
    """

    def integrand(y: flint.acb, _: bool) -> flint.acb:
        return (y.shi() - y) / (y * y.bessel_i(0) ** 2)

    return lateral_integral(integrand, digits, "the lateral surface's rest")


def lateral_integral(
    integrand: Callable[[flint.acb, bool], flint.acb], digits: int, what: str
) -> flint.arb:
    """Return (4/pi^2) int_0^oo of a function below y^2/12 for y <= 1 and below e^y/I0^2 beyond."""

    def compute() -> flint.arb:
        bits = flint.ctx.prec
        start, end = flint.arb(2) ** -(bits // 2), flint.arb(bits)
        with flint.ctx.workprec(2 * bits):
            body = flint.acb.integral(integrand, flint.acb(start), flint.acb(end)).real
        rest = start**3 / 36 + end.exp() * lateral_tail(0, end)
        return 4 * (body + flint.arb(0, rest.upper())) / flint.arb.pi() ** 2

    return refine(compute, digits, what)


def roots_bound(k: int) -> flint.arb:
    """Return C: the roots' part of c_(2k-3) is below C sum n^(2k-4) e^(-pi n/eta), eta <= 1/3.

    See `thin_remainder.coefficient_remainder_ball`.
    """
    size = abs(sine_coefficient(k)) * sp.Integer(2) ** (5 - 2 * k)
    return flint.arb(6) * SIZE_OVER_INDEX ** (2 * k - 4) * flint.arb(int(size.p)) / int(size.q)


def time_quadrature_bound(nodes: int, arcs: int = 256, boxes: int = 64) -> flint.arb:
    """Bound the relative error of Gauss' rule on [0, 1] for the contact time of S_1 = 1 + x A/A_m.

    The integrand is f = q (1 - y + y q)/sqrt(6 (1 - y) g_5 + 5 y g_6) up to a factor, q = 1 - u^2,
    y = x/(1 + x), g_n = 1 + ... + q^(n-1), and is valid for -1 <= y <= 1, hence for every
    x >= -1/2. On a Bernstein ellipse with parameter rho about [0, 1], ball arithmetic shows that
    the radicand is nonzero for all y. The number of its zeros inside is therefore the same for
    every y, and 0 for y = 0, where they are fifth roots of unity in q. A polynomial of degree
    2n - 1 is then within 2 M rho^(1-2n)/(rho - 1) of f, and Gauss' rule is exact for it.
    """
    rho = flint.arb(12) / 5
    _no_root_inside(rho)
    worst = flint.arb(0)
    around = [_on_ellipse(rho, flint.arb(2 * k + 1) / (2 * arcs), arcs) for k in range(arcs)]
    along = [flint.acb(_wide(flint.arb(2 * k + 1) / 128, flint.arb(1) / 128)) for k in range(64)]
    for box in range(boxes):
        y = _wide(flint.arb(2 * box + 1) / boxes - 1, flint.arb(1) / boxes)
        largest = max((_size(u, y).abs_upper() for u in around), key=float)
        integral = sum((_size(u, y).abs_lower() for u in along), flint.arb(0)) / 64
        error = 4 * largest * rho ** (1 - 2 * nodes) / (rho - 1)
        worst = worst.max(error / integral)
    if not worst.is_finite():
        raise ArithmeticError("the radicand may vanish on the ellipse")
    return worst.abs_upper()


def _wide(middle: flint.arb, half: flint.arb) -> flint.arb:
    return flint.arb(middle.mid(), (half + middle.rad()).abs_upper())


def _on_ellipse(rho: flint.arb, turn: flint.arb, arcs: int) -> flint.acb:
    """Return u on an arc of the upper half of the ellipse; the lower half is its conjugate."""
    angle = _wide(turn, flint.arb(1) / (2 * arcs))
    z = rho * flint.acb(flint.arb.cos_pi(angle), flint.arb.sin_pi(angle))
    return flint.acb(1) / 2 + (z + 1 / z) / 4


def _size(u: flint.acb, y: flint.arb) -> flint.arb:
    """Return |f|."""
    q = 1 - u * u
    fifth = 1 + q * (1 + q * (1 + q * (1 + q)))
    radicand = abs(6 * (1 - y) * fifth + 5 * y * (1 + q * fifth))
    value: flint.arb = abs(q * (1 - y + y * q)) / radicand.sqrt()
    return value


def _no_root_inside(rho: flint.arb) -> None:
    """Prove that for y = 0 the radicand vanishes only outside: q = e^(2 pi i k/5), u = sqrt(1 - q).

    Raises
    ------
    ArithmeticError
        If a zero is inside.
    """
    product = sp.expand((1 - _q) * geometric(5, _q))
    prove("Fifth roots", "1 - q^5 = (1 - q) g_5.", {"g_5": product - 1 + _q**5})
    for k in (1, 2):  # the others are conjugates; both roots u = +-sqrt(1 - q) count
        angle = flint.arb(2 * k) / 5
        u = (1 - flint.acb(flint.arb.cos_pi(angle), flint.arb.sin_pi(angle))).sqrt()
        for at in (u, -u):
            if not abs(at) + abs(at - 1) > (rho + 1 / rho) / 2:
                raise ArithmeticError("a zero of the radicand lies inside the ellipse")
