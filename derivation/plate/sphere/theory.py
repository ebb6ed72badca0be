"""Step 35: compliance of a finite sphere, and motion of the faces, to first order in a/R.

A pressure sum p_n P_n(cos theta) on a sphere displaces its surface inwards by sum C_n p_n P_n, in
units of R/mu. With the displacements u_r = U P_n and u_theta = V dP_n/dtheta, the dilatation E P_n
and the rotation W dP_n/dtheta,

    E = U' + 2 U/r - n (n + 1) V/r,   W = (r V)'/r - U/r,

Navier's equations and the stresses are

    (lam + 2 mu) E' + mu n (n + 1) W/r = f,   (lam + 2 mu) E/r + mu (r W)'/r = f/r,
    s_rr = lam E + 2 mu U',                   s_rt = mu (V' - V/r + U/r),

where f is the inertia of a uniform acceleration, which balances the pressure of degree 1.

A force P on the pole has p_n = (n + 1/2) P/(2 pi R^2) for all n. With m = n + 1/2,

    m C_n = (1 - nu) + c/m + t_n,   c = (1 - 2 nu)^2/2,   m^2 t_n -> (1 - nu) (16 nu^2 - 1)/4.

The difference of t_n from this limit over m^2 is at most (676 m^2 + 990 m + 306)/(4 m^2 (2 m - 3)^2
(2 m - 1)), by the absolute values of its coefficients for -1 < nu < 1/2: below 23/m^3 for m > 60.

The first part sums to (1 - nu) R/d, d the distance: a half-space. The second is the complete
elliptic integral sum P_n/m = int_0^oo dx/sqrt((1 + x^2) (x^2 + s^2)), s = d/(2 R), which x -> s/x
maps onto itself: it lies between 2 asinh(s^(-1/2)) and the same over sqrt(1 + s), and tends to
log(8 R/d). The rest tends to K = sum t_n. To first order in a/R the displacement by a force is then
that of a half-space plus P/(2 pi mu R) (c log(8 R/d) + K).

At equal force, a small change of the displacement within the contact changes the indentation by its
mean under the pressure of a flat punch (reciprocity). Over that and Hertz's pressure, the mean of
log(a/d) is 19/12 - 2 log 2, so that the indentation a^2/R of a sphere changes by its fraction

    a/R [L (log(2 R/a) + 19/12) + sum S_n],   L = 4 c/(3 pi (1 - nu)),   S_n = L t_n/c.

Strains. The pressure acts at a right angle to the deformed face, and has a part p r/R along the
undeformed one, outwards. It lifts the face by the mean of p r/R over the distance between a point
and the edge of the contact. Points of the face also move by u_r along it, towards the axis, where
the gap is smaller. With g = (1 - r^2/a^2)^(3/2) and F = (2/(3 pi)) (1 - 2 nu)/(1 - nu) a/R, both
change the gap by F a^2/R times g and 1 - g: the sum is uniform. Hertz's pressure remains, and the
indentation decreases by its fraction F at equal force. This is valid for a rigid sphere on a
half-space and for a sphere on a rigid plane. Of two elastic bodies, each turns its face by its part
of the compliance times r/R, and its F is multiplied by the square of this part. Nonlinear terms of
the equations of equilibrium and of Hooke's law are not included; they are of the same order.
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import Proof, prove
from derivation.plate.vocabulary import Formula, k, nu

_r, _x, _m, _s = sp.symbols("r x m s", positive=True)
_first, _second, _f = sp.symbols("first second f")
LAM = 2 * nu / (1 - 2 * nu)
"""lam; mu and R are 1."""
LOGARITHM = (1 - 2 * nu) ** 2 / 2
"""c."""
SCALE = 4 / (3 * sp.pi * (1 - nu))
"""Relative change of Hertz's indentation by a displacement P/(2 pi mu R), over a/R."""
MEAN = sp.Rational(19, 12)
"""Mean of log(4 a/d), d the distance between points of Hertz's and of the flat punch's pressure."""


def compliance() -> sp.Expr:
    """Return C_n of a degree k = n of at least 2, or 0."""
    above = 2 * (1 - nu) * k**2 + nu * k + 2 * nu - 1
    return above / (2 * (k - 1) * (k**2 + k + 1 + nu * (2 * k + 1)))


def uniform_acceleration() -> sp.Expr:
    """Return C_1, relative to the centre of mass."""
    return 3 * (1 - 2 * nu) / (10 * (1 + nu))


def rest(degree: sp.Expr, value: sp.Expr) -> sp.Expr:
    """Return t_n of a degree with this C_n."""
    m = degree + sp.Rational(1, 2)
    return m * value - (1 - nu) - LOGARITHM / m


def tail() -> sp.Expr:
    """Return the limit of t_n m^2."""
    return (1 - nu) * (16 * nu**2 - 1) / 4


def _after_limit() -> tuple[sp.Expr, sp.Expr]:
    """Return numerator and denominator of t_n less its limit over m^2."""
    below = 4 * _m**2 * (2 * _m - 3) * (4 * _m**2 + 8 * _m * nu + 3)
    value = rest(k, compliance()).subs(k, _m - sp.Rational(1, 2)) - tail() / _m**2
    return sp.expand(sp.cancel(value * below)), below


class _Field:
    """Displacements U P_n and V dP_n/dtheta with their equations."""

    def __init__(self, degree: sp.Expr, U: sp.Expr, V: sp.Expr, f: sp.Expr = sp.S.Zero) -> None:
        power = degree * (degree + 1)
        dilatation = sp.diff(U, _r) + 2 * U / _r - power * V / _r
        rotation = sp.diff(_r * V, _r) / _r - U / _r
        self.radial = (LAM + 2) * sp.diff(dilatation, _r) + power * rotation / _r - f
        self.tangential = (LAM + 2) * dilatation / _r + sp.diff(_r * rotation, _r) / _r - f
        self.pressure = -(LAM * dilatation + 2 * sp.diff(U, _r)).subs(_r, 1)
        self.shear = (sp.diff(V, _r) - V / _r + U / _r).subs(_r, 1)
        self.inward = -U.subs(_r, 1)


def _lurie(degree: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return the regular solutions U and V of a degree (Lurie 1964)."""
    grow, still = _first * _r ** (degree + 1), _second * _r ** (degree - 1)
    U = (degree + 1) * (degree - 2 + 4 * nu) * grow + degree * still
    return U, (degree + 5 - 4 * nu) * grow + still


@cache
def compliances() -> Proof:
    """Prove C_n, from Navier's equations."""
    general = _Field(k, *_lurie(k))
    found = sp.solve([general.pressure - 1, general.shear], [_first, _second])
    # The accelerated sphere: a gradient carries the inertia, U = 3 w r^2 and V = w r^2.
    carried = _f / (10 * (LAM + 2)) * _r**2
    U, V = (part.subs({k: 1, _second: 0}) for part in _lurie(k))
    moved = _Field(sp.S.One, U + 3 * carried, V + carried, _f)
    solved = sp.solve([moved.pressure - 1, moved.shear], [_first, _f])
    # The mean over the volume of r^2 cos^2(theta) is 1/5, that of r^2 sin^2(theta) 2/5.
    mean = ((U + 3 * carried) + 2 * (V + carried)).subs(_r, 1) / 5
    uniform = _Field(sp.S.Zero, _second * _r, sp.S.Zero)
    last_above, last_below = _after_limit()
    return prove(
        "Compliance of a sphere",
        "Lurie's solutions satisfy Navier's equations for each degree; their amplitudes follow "
        "from the pressure and the absence of shear on the surface.",
        lambda value, accelerated, last: {
            "radial equation": sp.simplify(general.radial),
            "tangential equation": sp.simplify(general.tangential),
            "degree n": sp.cancel(general.inward.subs(found) - value),
            "degree 0": sp.cancel(
                (uniform.inward / uniform.pressure) - value.subs(k, 0)
            ),
            "radial inertia": sp.simplify(moved.radial),
            "tangential inertia": sp.simplify(moved.tangential),
            "balance": solved[_f] + 1,
            "degree 1": sp.cancel((moved.inward + mean).subs(solved) - accelerated),
            "limit of t_n": sp.cancel(
                rest(k, value).subs(k, _m - sp.Rational(1, 2)) - last / _m**2
                - last_above / last_below
            ),
            "order of the difference": last_above.coeff(_m, 3),
        },
        compliance(), uniform_acceleration(), tail(),
    )  # fmt: skip


@cache
def first_order() -> Proof:
    """Prove the change of the indentation by the finite size, to first order."""
    compliances()
    # Parts of the flat punch's and of Hertz's force within x; the larger radius counts.
    u = sp.Symbol("u", nonnegative=True)
    within = (1 - u) * (1 - u**3)
    mean = sp.integrate(sp.cancel(within * u / (1 - u**2)), (u, 0, 1))
    angle = sp.Symbol("cosine", real=True)
    generating = 1 / sp.sqrt(1 - 2 * _x**2 * angle + _x**4)
    series = sp.series(generating, _x, 0, 9).removeO()
    half = sp.sqrt((1 + _x**2) * (_x**2 + _s**2))
    bound = 2 * sp.asinh(1 / sp.sqrt(_s))
    scale = sp.Rational(8, 3) / (1 - nu) / (2 * sp.pi)  # P R/(2 pi mu a^3) by Hertz's law
    first = rest(sp.S.Zero, compliance().subs(k, 0)) + rest(sp.S.One, uniform_acceleration())
    return prove(
        "Indentation of a finite sphere",
        r"The generating function of the Legendre polynomials, with $t = x^2$, gives $\sum P_n/m$ "
        r"as an integral, and $x = e^{-v}$, $\sinh v = t$ turns it into the integral of the text. "
        "Its bounds have the same limit. The mean of a logarithm over two distributions with "
        "circular symmetry is that of the larger radius.",
        lambda growth, start, term, last: {
            "generating function": sp.expand(
                series - sum(sp.legendre(n, angle) * _x ** (2 * n) for n in range(5))
            ),
            "distance": sp.expand(
                (1 - _x**2) ** 2 + 4 * _x**2 * _s**2
                - (1 - 2 * _x**2 * (1 - 2 * _s**2) + _x**4)
            ),
            "map": sp.simplify(half.subs(_x, _s / _x) ** 2 - (_s / _x**2) ** 2 * half**2),
            "limit": sp.limit(bound - sp.log(4 / _s), _s, 0),
            "mean": mean + 2 * sp.log(2) - MEAN,
            "logarithm": scale * LOGARITHM - growth,
            "degrees 0 and 1": sp.expand_log(
                scale * (first + LOGARITHM * (sp.log(8) + mean)) - start
            ),
            "degree n": scale * rest(k, compliance()) - term,
            "tail": scale * tail() - last,
        },
        *size_terms(),
    )  # fmt: skip


def size_terms() -> tuple[sp.Expr, sp.Expr, sp.Expr, sp.Expr]:
    """Return L, L (log 2 + 19/12) + S_0 + S_1, S_n, and the limit of S_n m^2."""
    growth = 2 * (1 - 2 * nu) ** 2 / (3 * sp.pi * (1 - nu))
    start = rest(sp.S.Zero, compliance().subs(k, 0)) + rest(sp.S.One, uniform_acceleration())
    return (
        growth,
        growth * (sp.log(2) + MEAN) + SCALE * sp.factor(start),
        SCALE * sp.factor(rest(k, compliance())),
        sp.cancel(SCALE * tail()),
    )


def strain() -> sp.Expr:
    """Return F over a/R."""
    return 2 * (1 - 2 * nu) / (3 * sp.pi * (1 - nu))


@cache
def motion_of_faces() -> Proof:
    """Prove the change of the indentation by the motion of the faces, to first order."""
    inside = sp.Symbol("rho", positive=True)  # r/a
    g = (1 - inside**2) ** sp.Rational(3, 2)
    largest = 4 / (sp.pi * (1 - nu))  # Hertz's pressure in the centre over mu a/R
    pressure = largest * sp.sqrt(1 - inside**2)
    # The pressure p within a radius moves its edge by -(1 - 2 nu)/(4 pi mu r) times its force.
    load = 2 * sp.pi * sp.integrate(pressure * inside, inside)
    load -= load.subs(inside, 0)
    moved = -(1 - 2 * nu) / (4 * sp.pi * inside) * load
    # By reciprocity, a traction q outwards lifts the face within its radius by (1 - 2 nu)/2 q dr.
    lifted = (1 - 2 * nu) / 2 * sp.integrate(pressure * inside, inside)
    lifted = lifted.subs(inside, 1) - lifted
    return prove(
        "Motion of the faces",
        "Boussinesq's solution gives the displacement along the face; that by a tangential "
        "traction follows by reciprocity. Both are evaluated for Hertz's pressure.",
        lambda value: {
            "lift": sp.simplify(lifted - value * g),
            "motion": sp.simplify(-inside * moved - value * (1 - g)),
            "sum": sp.simplify(lifted - inside * moved - value),
        },
        strain(),
    )


@cache
def finite_sphere() -> tuple[Formula, ...]:
    """Return the formulas of the step."""
    of_degree, of_size, of_face = compliances(), first_order(), motion_of_faces()
    growth, start, term, last = size_terms()
    change = "change of a sphere's indentation by its finite size"
    rows = (
        ("sphere_compliance", "C_k",
         r"inward displacement of a sphere by a pressure $P_k(\cos\theta)$, times $\mu/R$",
         compliance(), (), of_degree),
        ("sphere_logarithm", "L", f"{change}, over (a/R) log(R/a)", growth, (), of_size),
        ("sphere_start", r"L (\log 2 + 19/12) + S_0 + S_1",
         "constant part, up to degree 1, of the change by a finite sphere, over a/R",
         start, (), of_size),
        ("sphere_term", "S_k",
         "constant part, by degree k, of the change by a finite sphere, over a/R",
         term, ("sphere_compliance",), of_size),
        ("sphere_tail", r"\lim (k + 1/2)^2 S_k", "limit of `sphere_term` times (k + 1/2)^2",
         last, ("sphere_term",), of_size),
        ("face_motion", "F", "decrease of the indentation by motion of a face, over a/R",
         strain(), (), of_face),
    )  # fmt: skip
    return tuple(
        Formula(name, latex, meaning, value, "1", "", sources, proof)
        for name, latex, meaning, value, sources, proof in rows
    )
