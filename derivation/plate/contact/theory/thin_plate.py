"""Step 14: the coefficients c_n of a thin plate, eta = h/b -> 0, up to exponentially small terms.

The Mellin transform turns the modal sum into an integral over s of M(s) (2 eta)^(-s) Z(s - 2k + 4),
with M(s) = int T^(s-1) (G - 1) dT and Z(s) = sum j_n^(-s)/(j_n J1(j_n)^2). If its path is shifted
to the left, it crosses

- the poles of M: simple, one for each power of T in the Laurent series of G - 1;
- the pole of Z at 1, of residue 1/2, which belongs to s = 2k - 3 and yields M_k,
  the finite part of int T^(2k-4) (G - 1) dT.

Where two of them coincide, the double pole gives a logarithm of eta. Z follows from the sum
identity with f = x^(-s): Z(s) = -cos(pi s/2)/pi int y^(-s) K0/I0 dy, so it vanishes at -1, -3, ...,
and the expansion of K0/I0 at 0 gives Z at 1 and 3. There are finitely many other terms. The
remainder is exponentially small; `thin_remainder` gives it as a sum that makes these coefficients
exact.
"""

from dataclasses import dataclass
from functools import cache
from typing import TypeVar

import flint
import sympy as sp

from derivation.engine.cache import in_file
from derivation.engine.formula.ball import LOG2_10, refine
from derivation.engine.formula.proof import Proof, prove
from derivation.plate.contact.theory.hertz import SOURCES
from derivation.plate.contact.theory.plate_series import FIRST, LAST, coefficient, sine_coefficient
from derivation.plate.contact.theory.split import contour, imaginary_axis
from derivation.plate.modes.theory.plate_factor import plate_factors
from derivation.plate.vocabulary import Formula, M, T, eta, kappa

_EULER = sp.Symbol("gamma_E", positive=True)
_LOG = sp.Symbol("L", real=True)
_u = sp.Symbol("u", positive=True)
Ball = TypeVar("Ball", flint.arb, flint.acb)


@dataclass(frozen=True)
class Laurent:
    """Coefficients by power, of part of an expansion."""

    coefficients: dict[int, sp.Expr]
    proof: Proof

    def at(self, power: int) -> sp.Expr:
        """Return the coefficient of a power, 0 if the expansion does not contain it."""
        return self.coefficients.get(power, sp.Integer(0))


@cache
def plate_factor_at_zero(terms: int = 4) -> Laurent:
    """Return G(T) = 6/T^3 + (6/5)/T + ..., the quotient of the two power series."""
    G = plate_factors()[0].expression
    above = (sp.sinh(2 * T) + 2 * T) / 2
    below = sp.sinh(T) ** 2 - T**2
    n = [_taylor_above(i) for i in range(terms)]
    d = [_taylor_below(i) for i in range(terms)]
    g: list[sp.Expr] = []
    for i in range(terms):
        g.append((n[i] - sp.Add(*(g[j] * d[i - j] for j in range(i)))) / d[0])
    length = 2 * terms + 4
    top, bottom = (sp.series(part, T, 0, length).removeO() for part in (above, below))
    series = sp.Add(*(value * T ** (2 * i - 3) for i, value in enumerate(g)))
    residual = sp.expand(series * bottom - top)
    proof = prove(
        "Plate factor at T = 0",
        "The truncated Laurent series times sinh^2 T - T^2 is sinh T cosh T + T.",
        {"plate factor": G * below - above}
        | {f"T^{2 * i + 1}": residual.coeff(T, 2 * i + 1) for i in range(terms)},
    )
    return Laurent({2 * i - 3: value for i, value in enumerate(g)}, proof)


def _taylor_above(i: int) -> sp.Rational:
    """Return the coefficient of T^(2i+1) in sinh T cosh T + T."""
    return sp.Rational(4**i, sp.factorial(2 * i + 1)) + (1 if i == 0 else 0)


def _taylor_below(i: int) -> sp.Rational:
    """Return the coefficient of T^(2i+4) in sinh^2 T - T^2."""
    return sp.Rational(2 ** (2 * i + 3), sp.factorial(2 * i + 4))


@cache
def lateral_at_zero() -> Laurent:
    """Return K0/I0 = -log(y/2) - gamma + y^2/4 + ...: coefficients without the logarithm, by power.

    K0 = -(log(y/2) + gamma) I0 + sum H_m (y/2)^(2m)/m!^2, so the logarithm appears only with the
    zeroth power of y.
    """
    imaginary_axis()
    y = sp.Symbol("y", positive=True)
    orders = range(3)
    i0 = sp.Add(*((y / 2) ** (2 * m) / sp.factorial(m) ** 2 for m in orders))
    extra = sp.Add(*(sp.harmonic(m) * (y / 2) ** (2 * m) / sp.factorial(m) ** 2 for m in orders))
    ratio = sp.series(extra / i0, y, 0, 6).removeO()
    coefficients = {0: sp.log(2) - _EULER} | {power: ratio.coeff(y, power) for power in (2, 4)}
    residual = sp.expand(ratio * i0 - extra)
    proof = prove(
        "K0/I0 at y = 0",
        "The series without its logarithm, times I0, is that of K0 + (log(y/2) + gamma) I0.",
        {f"y^{power}": residual.coeff(y, power) for power in (0, 2, 4)},
    )
    return Laurent(coefficients, proof)


@cache
def zero_sum(s: int) -> Laurent:
    """Return Z(s + u) = sum j_n^(-s-u)/(j_n J1^2) near an integer s <= 3: powers u^-1 and u^0.

    int_0^1 y^(-s-u) y^p dy = -1/(u + s - p - 1), and with the factor log y the integral is minus
    its square; the rest of the integral is regular. For s < 1 it is kappa_(-s).
    """
    contour()
    lateral = lateral_at_zero()
    # -cos(pi (s + u)/2)/pi: value and slope at u = 0.
    angle = sp.pi * (s + _u) / 2
    value, slope, bend = (sp.diff(-sp.cos(angle) / sp.pi, _u, n).subs(_u, 0) for n in range(3))
    if s < 1:
        regular = kappa[-s] if -s in kappa else sp.Symbol("kappa", positive=True)
        coefficients = {0: sp.expand(value * regular)}
        residuals = {"odd": value if s % 2 else sp.Integer(0)}
    else:
        # The power y^(s-1) of K0/I0 gives a pole: -(c)/u, and -log y gives 1/u^2 at s = 1.
        simple, double = -lateral.at(s - 1), sp.Integer(1 if s == 1 else 0)
        coefficients = {-1: slope * double, 0: slope * simple + bend / 2 * double}
        residuals = {"value": value, "bend": bend}
    proof = prove(
        f"Z near {s}",
        "Z is -cos(pi s/2)/pi times the integral of y^(-s) K0/I0, continued analytically.",
        residuals,
    )
    return Laurent(coefficients, proof)


@cache
def thin_modal_sum(k: int) -> sp.Expr:
    """Return sum j_n^(2k-5) (G(2 eta j_n) - 1)/J1(j_n)^2 for eta -> 0: all its residues.

    In eta, M_k, kappa_(2k-4), Euler's constant (as a symbol) and L = log(2 eta).
    """
    g = plate_factor_at_zero().coefficients
    own = 2 * k - 3
    # All other poles of M are at s = -1, -3, ..., where Z(s - 2k + 4) = 0.
    poles = {-power: value for power, value in g.items() if power < 0} | {0: sp.Integer(-1)}
    total = sp.Integer(0)
    for s in sorted({own, *poles}):
        mellin = {-1: poles.get(s, sp.Integer(0))}
        mellin[0] = M[k] if s == own else sp.Symbol(f"regular_{s}", real=True)
        sum_part = zero_sum(s - 2 * k + 4)
        power = {0: (2 * eta) ** (-s), 1: -_LOG * (2 * eta) ** (-s)}
        total += _residue(mellin, {-1: sum_part.at(-1), 0: sum_part.at(0)}, power)
    return sp.expand(total)


def _residue(*factors: dict[int, sp.Expr]) -> sp.Expr:
    """Return the coefficient of 1/u in a product of expansions in u."""
    product = sp.Mul(*(sp.Add(*(c * _u**n for n, c in factor.items())) for factor in factors))
    return sp.expand(product).coeff(_u, -1)


@in_file(SOURCES, Formula, Proof)  # modules of kernels need it when they are imported
def thin_coefficient(k: int) -> Formula:
    """Return c_(2k-3) of a thin plate."""
    order = 2 * k - 3
    size = sine_coefficient(k)
    exact = coefficient(k)
    modes = eta**order * size * 8 / sp.pi * thin_modal_sum(k)
    total = sp.expand(modes + exact.side)
    leading = total.coeff(M[k])
    rest = sp.expand(total - leading * M[k])
    value = _collected(total, k)
    known = {sp.log(4 * eta): _LOG + sp.log(2), sp.EulerGamma: _EULER}
    proof = prove(
        f"Thin plate's c_{order}",
        "The coefficients are residues of a Mellin integral. The pole of $G - 1$ at $s = 0$ "
        "cancels the finite-radius term; for $k > 3$ only the finite part $M_k$ remains.",
        lambda value: {
            "collected": sp.expand(value.subs(known) - total),
            "kappa cancels": total.coeff(kappa[2 * k - 4]),
            "finite part": leading - size * 8 / sp.pi / 2 ** (2 * k - 2),
            "remaining terms": rest if k > 3 else _low_rest(k, size) - rest,
        },
        value,
    )
    return Formula(
        f"c_{order}_thin",
        rf"c_{{{order}}}^{{\mathrm{{thin}}}}",
        rf"coefficient of $(a/h)^{order}$ in $\delta R/a^2$, thin plate",
        value,
        "1",
        "10",
        (f"c_{order}_modes", f"c_{order}_lateral", "G"),
        proof,
    )


def _low_rest(k: int, size: sp.Rational) -> sp.Expr:
    """Return c_1 or c_3 without M_k: SymPy's residue of the double pole, plus the bending term."""
    g = plate_factor_at_zero()
    pole = g.at(3 - 2 * k)
    lateral = lateral_at_zero()
    near = sp.cos(sp.pi * (1 + _u) / 2) / sp.pi * (-1 / _u**2 + lateral.at(0) / _u)
    double = sp.series(_u * pole / _u * near * sp.exp(-_u * _LOG), _u, 0, 1).removeO()
    result = size * 8 / sp.pi * double.coeff(_u, 0) / 2 ** (2 * k - 3)
    if k == 2:
        bending = sp.limit(sp.cos(sp.pi * (3 + _u) / 2) / sp.pi / _u, _u, 0) * lateral.at(2)
        result += size * 8 / sp.pi * g.at(-3) * bending / (8 * eta**2)
    return sp.expand(result)


def _collected(total: sp.Expr, k: int) -> sp.Expr:
    """Return the coefficient with M_k, the logarithm and Euler's constant in one bracket."""
    log_4 = sp.Symbol("log_4", real=True)
    fused = sp.expand(total.subs(_LOG, log_4 - sp.log(2)))
    factor = fused.coeff(M[k])
    bracket = sp.Add(*(t for t in sp.Add.make_args(fused) if not t.has(eta)))
    inner = sp.expand(bracket / factor).subs({log_4: sp.log(4 * eta), _EULER: sp.EulerGamma})
    return fused - bracket + factor * inner


@cache
def finite_part(k: int) -> sp.Expr:
    """Return M_k in terms of convergent integrals and the finite parts of the powers on (0, 1)."""
    G = plate_factors()[0].expression
    power = 2 * k - 4
    singular = {n: c for n, c in plate_factor_at_zero().coefficients.items() if n < 0}
    laurent = sp.Add(*(c * T**n for n, c in singular.items()))
    inner = sp.Integral(T**power * (G - laurent), (T, 0, 1))
    outer = sp.Integral(T**power * (G - 1), (T, 1, sp.oo))
    return inner + outer + _finite_powers(k)


def _finite_powers(k: int) -> sp.Rational:
    """Return Hadamard's finite part of int_0^1 T^(2k-4) (Laurent part - 1) dT; that of 1/T is 0."""
    singular = {n: c for n, c in plate_factor_at_zero().coefficients.items() if n < 0}
    powers = [(n + 2 * k - 3, c) for n, c in (singular | {0: sp.Integer(-1)}).items()]
    return sp.Add(*(c / power for power, c in powers if power != 0))


@cache
def finite_part_ball(k: int, digits: int = 30) -> flint.arb:
    """Return a ball around M_k with a relative radius below 10^-digits."""
    excess_for_large()
    finite = _finite_powers(k)

    def compute() -> flint.arb:
        bits = int(digits * LOG2_10) + 32
        end = flint.arb(max(bits, 4 * k))
        inner = flint.acb.integral(
            lambda x, _: x ** (2 * k - 4) * regular_part(x), flint.acb(0), flint.acb(1)
        )
        outer = flint.acb.integral(
            lambda x, _: x ** (2 * k - 4) * plate_excess(x), flint.acb(1), flint.acb(end)
        )
        # For T >= 2, sinh^2 T - T^2 >= e^(2T)/8 and 1/2 + T + T^2 <= 2 T^2; with
        # T >= 4 k, the logarithm of the integrand decreases by at least 1 per unit of T.
        rest = 16 * end ** (2 * k - 2) * (-2 * end).exp()
        number = flint.arb(flint.fmpq(int(finite.p), int(finite.q)))
        return inner.real + outer.real + number + flint.arb(0, rest.upper())

    return refine(compute, digits, f"M_{k}")


@cache
def excess_for_large() -> Proof:
    """Prove G - 1 = ((1 - e^(-2T))/2 + T + T^2)/(sinh^2 T - T^2), without cancellation."""
    short = ((1 - sp.exp(-2 * T)) / 2 + T + T**2) / (sp.sinh(T) ** 2 - T**2)
    return prove(
        "Excess of the plate factor",
        "Both sides are written over a common denominator.",
        {"G - 1": plate_factors()[2].expression - short},
    )


def plate_excess(x: Ball) -> Ball:
    """Return G - 1 by `excess_for_large`."""
    return ((1 - (-2 * x).exp()) / 2 + x + x * x) / (x.sinh() ** 2 - x * x)


def regular_part(x: flint.acb) -> flint.acb:
    """Return G - 6/T^3 - (6/5)/T as a quotient of power series with bounded tails.

    Its numerator's coefficients are n_i - 6 d_i - (6/5) d_(i-1), T^(2i+1); those
    for i < 2 vanish. In powers of T^2 both series have coefficients below
    64 4^i/(2i)!, so that for 2|T| <= m the tails are at most 128 (2|T|)^(2m)/(2m)!.
    """
    g = plate_factor_at_zero()
    terms = flint.ctx.prec // 4 + 20
    above, below = flint.acb(0), flint.acb(0)
    square = x * x
    for i in reversed(range(terms)):
        q = _taylor_above(i + 2) - g.at(-3) * _taylor_below(i + 2) - g.at(-1) * _taylor_below(i + 1)
        above = above * square + _ball(q)
        below = below * square + _ball(_taylor_below(i))
    size = (2 * abs(x)).upper()
    if not size < terms:
        return flint.acb("nan")
    tail = 128 * flint.arb(size) ** (2 * terms) / flint.arb(2 * terms + 1).gamma()
    spread = flint.arb(0, tail.upper())
    return x * (above + flint.acb(spread, spread)) / (below + flint.acb(spread, spread))


@cache
def _ball_parts(value: sp.Rational) -> tuple[int, int]:
    return int(value.p), int(value.q)


def _ball(value: sp.Rational) -> flint.arb:
    return flint.arb(flint.fmpq(*_ball_parts(value)))


def thin_plate() -> tuple[Formula, ...]:
    """Return the thin plate's recorded coefficients."""
    return tuple(thin_coefficient(k) for k in range(FIRST, LAST + 1))
