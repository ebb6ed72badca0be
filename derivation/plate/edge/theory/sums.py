"""Step 19, sums: the edge corrections in closed form, the remainder of this form, and a bound.

For k even and entire, |k(z)| <= C e^(alpha |Im z|), alpha < 1, and q even and meromorphic

    sum k(j) q(j)/(j^3 J1(j)) = 1/2 Res_0 + 2 Re sum Res_(z_n),  of k q/(z^3 J0),

the residues of k q/(z^3 J0) over the whole plane: 1/J0 has the residue -1/J1(j) at j, the
integrand is odd, so that its residues at +-z are equal, and those at conjugate points are
conjugate. For Q and H (step 19) the poles are z_n = T_n/(2 eta), T_n the roots of
sinh T = +-T, of even index for Q and of odd index for H; there is none on the axes. Along
the lines Im T = pi n - pi/4, where |sinh T -+ T| > cosh(Re T)/4, and on verticals between
the zeros of J0, where |1/J0| <= C sqrt|z| e^(-|Im z|), the integrand is O(|z|^(-3/2)), and
the contours contribute nothing in the limit.

The remainder decays like e^(-(1 - alpha) Im T_n/(2 eta)): Im T_1 = 4.212 for extension,
Im T_2 = 7.498 for bending. It represents edge effects that plate theory does not contain.

In a thick plate Q -> T and H -> 1, exponentially, and the remaining sum is

    sum k(j)/(j^2 J1(j)) = (1/pi) int_0^oo (1 - k(iy)/I0(y))/y^2 dy,   k(0) = 1:

k/(z^2 J0), even, along the imaginary axis, with a half circle around the double pole at 0.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import flint
import sympy as sp

from derivation.engine.formula.ball import refine
from derivation.engine.formula.proof import Proof, lower_bessel, prove
from derivation.plate.contact.theory.split import imaginary_axis, zero_of_j0
from derivation.plate.contact.theory.thin_roots import numbering
from derivation.plate.edge.theory.supported import (
    RATIO,
    bending_function,
    edge_law,
    stretching_function,
)
from derivation.plate.vocabulary import J1, Formula, PlateRoot, T, alpha, eta, j_n

_z, _u, _y = sp.symbols("z u y", positive=True)
_n = sp.Symbol("n", integer=True, positive=True)
Kernel = Callable[[sp.Expr], sp.Expr]


def indentation_kernel(y: sp.Expr) -> sp.Expr:
    """Return g(y) = 3 (sin y - y cos y)/y^3."""
    return 3 * (sp.sin(y) - y * sp.cos(y)) / y**3


def slope_kernel(y: sp.Expr) -> sp.Expr:
    """Return (3/2) sin y/y, which replaces g in the slope."""
    return sp.Rational(3, 2) * sp.sin(y) / y


@cache
def residues() -> Proof:
    """Prove the basis of the sums over residues: those of 1/J0, Q and H, and their balance."""
    numbering()
    u, sign = sp.symbols("u s", positive=True)
    total, at_zero, real = sp.symbols("S R X")
    j0_slope = lower_bessel(sp.diff(sp.besselj(0, _z), _z))

    def at_root(expression: sp.Expr) -> sp.Expr:
        turned = {sp.sinh(T): sign * sp.sinh(u), sp.cosh(T): sign * sp.cosh(u)}
        return expression.subs(turned).subs(T, sp.sinh(u))

    def residue(quotient: sp.Expr, s: int) -> sp.Expr:
        above, below = sp.fraction(quotient)
        return (at_root(above) / at_root(sp.diff(below, T))).subs(sign, s)

    # Every mode counts twice, z = +-j, with 1/J0' = -1/J1; every root four times.
    (solution,) = sp.solve(-2 * total + at_zero + 4 * real, total)
    Q, H = bending_function(), stretching_function()
    return prove(
        "Sum over all residues",
        "Residues are computed at sinh T = s T with T = sinh u and s = (-1)^n. Q and H are "
        "compared for T and -T.",
        {
            "1/J0": j0_slope + sp.besselj(1, _z),
            "Q even": Q.subs(T, -T) - Q,
            "H odd": H.subs(T, -T) + H,
            "at even roots": residue(Q, 1) - sp.sinh(u),
            "at odd roots": residue(H, -1) - ((sp.cosh(u) + 1) / sp.sinh(u)) ** 2,
            "balance": solution - at_zero / 2 - 2 * real,
        },
    )


@dataclass(frozen=True)
class ClosedSums:
    """Halves of the residues at 0 of k/(z^3 J0), of k (Q - 3)/(z^3 J0) and of k H/(z^2 J0)."""

    plain: sp.Expr
    bending_part: sp.Expr
    extension_part: sp.Expr


def _low(expression: sp.Expr) -> sp.Expr:
    """Return the expression's powers of z up to the second."""
    return sp.expand(sp.series(expression, _z, 0, 3).removeO())


@cache
def closed_sums(kernel: Kernel) -> ClosedSums:
    """Return the sums over the modes without the contribution of the roots."""
    residues()
    j0 = sp.Add(*((-1) ** m * (_z / 2) ** (2 * m) / sp.factorial(m) ** 2 for m in range(3)))
    size = 2 * eta * _z
    quotients = {
        "1/J0": (sp.Integer(1), j0),
        "k": (kernel(alpha * _z), sp.Integer(1)),
        "Q": tuple(part.subs(T, size) for part in sp.fraction(bending_function())),
        "H": tuple(part.subs(T, size) for part in sp.fraction(stretching_function())),
    }
    series = {name: _low(above / below) for name, (above, below) in quotients.items()}

    def left(name: str) -> sp.Expr:
        """Return the difference of the quotient and its first powers, over z^2, at 0."""
        above, below = quotients[name]
        order = sp.series(below, _z, 0, 6).removeO().as_poly(_z).monoms()[-1][0]
        return sp.series(above - series[name] * below, _z, 0, order + 3).removeO()

    wave = sp.expand(series["k"] * series["1/J0"])
    bending_part, extension_part = (sp.expand(wave * series[name]) for name in ("Q", "H"))
    sums = ClosedSums(
        wave.coeff(_z, 2) / 2,
        (bending_part - 3 * wave).expand().coeff(_z, 2) / 2,
        extension_part.coeff(_z, 1) / 2,
    )
    prove(
        "Residues at 0",
        "Each truncated series times its denominator is the numerator, up to higher powers.",
        {name: sp.expand(left(name)) for name in quotients}
        | {"even": wave.coeff(_z, 1), "Q at 0": series["Q"].subs(_z, 0) - 3},
    )
    return sums


def _assembled(bending_part: sp.Expr, extension_part: sp.Expr) -> sp.Expr:
    """Return X from the sums of k (1 + 3 n - n Q)/(j^3 J1) and of k H/(j^2 J1)."""
    bending = (1 - 2 * RATIO * eta**2) / eta**3 * bending_part
    return alpha / sp.pi * (bending + sp.Rational(8, 3) * RATIO**2 * extension_part)


def _roots(kernel: Kernel) -> tuple[sp.Expr, sp.Expr]:
    """Return 2 Re of the residues of -n k Q/(z^3 J0) at even, of k H/(z^2 J0) at odd roots."""

    def total(at: sp.Expr, weight: sp.Expr) -> sp.Expr:
        z = at / (2 * eta)
        term = weight * kernel(alpha * z) / sp.besselj(0, z)
        return 2 * sp.re(sp.Sum(term, (_n, 1, sp.oo)))

    even, odd = PlateRoot(2 * _n), PlateRoot(2 * _n - 1)
    # T/(2 eta)/z^3 = (2 eta)^2/T^2, and the square (sqrt(1 + T^2) + 1)^2/T^2 over 2 eta z^2.
    bending_part = total(even, -RATIO * (2 * eta) ** 2 / even**2)
    extension_part = total(odd, 2 * eta * (1 + sp.sqrt(1 + odd**2)) ** 2 / odd**4)
    return bending_part, extension_part


@cache
def thin_edge() -> tuple[Formula, ...]:
    """Return X and its slope in closed form, and the sums over roots that make them exact."""
    formulas = []
    rows = (
        ("F_edge", indentation_kernel, "X"),
        ("S_edge", slope_kernel, r"\frac{R}{2a}\frac{\mathrm{d}}{\mathrm{d}a}\frac{a^2 X}{R}"),
    )
    modes = {formula.name: formula.expression for formula in edge_law()}
    for name, kernel, latex in rows:
        half, one = closed_sums(kernel), kernel(alpha * j_n)
        Q, H = (f.subs(T, 2 * eta * j_n) for f in (bending_function(), stretching_function()))
        mode = _assembled(
            one * (1 + 3 * RATIO - RATIO * Q) / (j_n**3 * J1), one * H / (j_n**2 * J1)
        )
        value = _assembled(half.plain - RATIO * half.bending_part, half.extension_part)
        proof = prove(
            f"Closed form of {name}",
            "The term of one mode is a combination of the sums whose residues are known.",
            {"mode": modes[name] - mode},
        )
        what = (
            "reduction of "
            + (r"$\delta R/a^2$" if name == "F_edge" else r"$(R/2a) d \delta/da$")
            + " without mean motion of the edge"
        )
        thin = Formula(
            f"{name}_thin",
            rf"\left({latex}\right)^{{\mathrm{{thin}}}}",
            f"{what}, for a thin plate",
            value,
            "1",
            "6",
            (name,),
            proof,
        )
        rest = Formula(
            f"{name}_roots",
            rf"{latex} - \left({latex}\right)^{{\mathrm{{thin}}}}",
            f"{what}: correction of the thin-plate form for every $h/b$",
            _assembled(*_roots(kernel)),
            "1",
            "6",
            (name, f"{name}_thin"),
            proof,
        )
        formulas += [thin, rest]
    return tuple(formulas)


# --- thick plates


@cache
def half_plane() -> Proof:
    """Prove sum k(j)/(j^2 J1) by a contour in the right half-plane around the double pole at 0."""
    imaginary_axis()
    total, finite = sp.symbols("S F")
    radius = sp.Symbol("rho", positive=True)
    # On the imaginary axis dz = -i dy, 1/z^2 = -1/y^2 and J0(iy) = I0(y). The integral of
    # k(iy)/(y^2 I0) from rho on is 1/rho + F.
    down = sp.I * 2 * (finite + 1 / radius)
    circle = sp.integrate(1 / _u**2, (_u, sp.I * radius, -sp.I * radius))
    residues_inside = 2 * sp.pi * sp.I * -total
    (solution,) = sp.solve(down + circle - residues_inside, total)
    odd = lower_bessel(sp.diff(1 / sp.besselj(0, _z), _z)).subs(_z, 0)
    return prove(
        "Alternating sum of a thick plate",
        "The integrals along the axis and along the half circle from i rho to -i rho around 0, and "
        "the residues, add up to zero; k/J0 has no odd power, so that the half circle contributes "
        "nothing else.",
        {"sum": sp.simplify(solution + finite / sp.pi), "odd power": odd},
    )


@cache
def alternating_sums() -> tuple[Formula, Formula]:
    """Return sum k/(j^2 J1) for both weight functions, as functions of alpha alone."""
    half_plane()
    formulas = []
    for name, kernel, factor, what in (
        ("edge_sum", indentation_kernel, "g", r"g(\alpha j)"),
        (
            "edge_slope_sum",
            slope_kernel,
            r"\tfrac{3}{2} \mathrm{sinc}",
            r"(3/2) \operatorname{sinc}(\alpha j)",
        ),
    ):
        at_zero = sp.limit(kernel(_y), _y, 0)
        turned = sp.simplify(kernel(sp.I * alpha * _y))
        value = (at_zero - turned / sp.besseli(0, _y)) / _y**2 / sp.pi
        integral = sp.Integral(value, (_y, 0, sp.oo))
        proof = prove(
            "Alternating sum",
            r"The finite part of $\int_0^{\infty} dy/y^2$ is 0, and $Q - T$ and $H - 1$, the "
            "functions of bending and extension minus their limits, decay like $e^{-T}$.",
            lambda value, at_0=at_zero, kernel=kernel: {
                "integrand": (sp.pi * _y**2 * value.function - at_0) * sp.besseli(0, _y)
                + sp.expand(kernel(sp.I * alpha * _y)),
                "Q": bending_function() - T - T * (T - 1 + sp.exp(-T)) / (sp.sinh(T) - T),
                "H": stretching_function() - 1 + (1 + T - sp.exp(-T)) / (sp.sinh(T) + T),
            },
            integral,
        )
        formulas.append(
            Formula(
                name,
                rf"\sum {factor}(\alpha j_n)/(j_n^2 J_1(j_n))",
                f"sum over the modes of ${what}/(j^2 J_1)$",
                integral,
                "1",
                "6",
                ("F_edge",),
                proof,
            )
        )
    return formulas[0], formulas[1]


# --- bounds of the change by the edge


@cache
def edge_bound() -> Formula:
    """Return an upper bound of the magnitude of `S_edge` for all radii up to alpha b.

    3 <= Q <= 3 + T, 0 <= H <= 1 and |sin y| <= y; sum sinc(alpha j)/(j^3 J1) lies between
    1/24 and 1/8. With s_2 = sum 1/(j^2 |J1|)

        |S| <= (3 alpha/(2 pi)) [|1 - 2 n eta^2|/eta^3 (1/8 + 2 eta |n| s_2) + (8/3) n^2 s_2].
    """
    s_2 = inverse_squares()
    third = 3 * sp.sinh(T) - T * sp.exp(-T) - 2 * T - T**2
    order = sp.Symbol("k", integer=True, nonnegative=True)
    # T cosh T + 2 T - 3 sinh T by powers: (2 k + 1 - 3)/(2 k + 1)!, and 2 more for T itself.
    series = (2 * order - 2) / sp.factorial(2 * order + 1)
    plain = closed_sums(slope_kernel).plain / sp.Rational(3, 2)
    n = sp.Abs(RATIO)
    bracket = sp.Abs(1 - 2 * RATIO * eta**2) / eta**3 * (sp.Rational(1, 8) + 2 * eta * n * s_2)
    value = 3 * alpha / (2 * sp.pi) * (bracket + sp.Rational(8, 3) * RATIO**2 * s_2)
    proof = prove(
        "Bound of the slope's change by the edge",
        r"The proof shows that $3 \le Q \le 3 + T$ and $H \le 1$. The first two derivatives of "
        r"$(3 + T) (\sinh T - T) - T (\cosh T - 1)$ vanish at 0, and the third is "
        r"$3 \cosh T - (3 - T) e^{-T} \ge 0$. The numerator of $Q - 3$ is a power series without "
        r"negative coefficients. $H \le 1$ follows from $e^{-T} \le 1 + T$.",
        {
            "Q - 3 - T": (3 + T - bending_function()) * (sp.sinh(T) - T) - third,
            "third derivative": sp.diff(third, T, 3) - 3 * sp.cosh(T) + (3 - T) * sp.exp(-T),
            **{f"derivative {i} at 0": sp.diff(third, T, i).subs(T, 0) for i in range(3)},
            "Q - 3": (bending_function() - 3) * (sp.sinh(T) - T)
            - (T * sp.cosh(T) + 2 * T - 3 * sp.sinh(T)),
            **{
                f"power {i}": sp.diff(T * sp.cosh(T) + 2 * T - 3 * sp.sinh(T), T, 2 * i + 1).subs(
                    T, 0
                )
                / sp.factorial(2 * i + 1)
                - series.subs(order, i)
                - (2 if i == 0 else 0)
                for i in range(6)
            },
            "1 - H": (1 - stretching_function()) * (sp.sinh(T) + T) - (1 + T - sp.exp(-T)),
            "largest": plain.subs(alpha, 0) - sp.Rational(1, 8),
            "smallest": plain.subs(alpha, 1) - sp.Rational(1, 24),
            "decrease": sp.diff(plain, alpha) + alpha / 6,
        },
    )
    return Formula(
        "S_edge_bound",
        r"S_e",
        r"bound of the reduction of $(R/2a) d \delta/da$ without mean motion of the edge, for all "
        "radii up to $a$",
        value,
        "1",
        "6",
        ("S_edge",),
        proof,
        where=("alpha < 1",),
    )


@cache
def inverse_squares() -> sp.Rational:
    """Return the smallest multiple of 1/2000 above a bound of sum 1/(j^2 |J1|)."""
    steps = (inverse_squares_ball(3) * 2000).upper().ceil().unique_fmpz()
    return sp.Rational(int(steps), 2000)


def inverse_squares_ball(digits: int) -> flint.arb:
    """Return a ball around sum 1/(j^2 |J1(j)|), with its remainder between two integrals.

    x (J0^2 + Y0^2) rises to 2/pi, so that j Y0(j)^2 = 4/(pi^2 j J1^2) < 2/pi gives
    1/|J1| < sqrt(pi j/2), and the zeros lie above (n - 1/4) pi: terms n > N add up to less
    than sqrt(pi/2) (2/pi^(3/2)) (N - 1/4)^(-1/2). At j_N the square is within a factor of
    its limit, which gives a lower bound, because j_n < (n - 1/4) pi + 1/20 is below n pi.
    """

    def compute() -> flint.arb:
        count, pi = 400, flint.arb.pi()
        zeros = [zero_of_j0(n, 128) for n in range(1, count + 1)]
        total = sum((1 / (j * j * abs(j.bessel_j(1))) for j in zeros), flint.arb(0))
        last = 1 / (zeros[-1] * zeros[-1].bessel_j(1) ** 2)
        high = (pi / 2).sqrt() * 2 / pi**1.5 / (count - flint.arb(1) / 4).sqrt()
        low = last.sqrt() * 2 / pi**1.5 / flint.arb(count + 1).sqrt()
        return total + low.union(high)

    return refine(compute, digits, "the sum of 1/(j^2 |J1|)")


def edge_sums() -> tuple[Formula, ...]:
    """Return the sums and the bound for the derivation."""
    return (*thin_edge(), *alternating_sums(), edge_bound())
