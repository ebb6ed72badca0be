"""Step 19: corrections of the paper's edge for a simply supported edge.

The paper's modes have w = 0 and u' + u/r = 0 at r = b, hence sigma_rr = -(2 mu/b) u there: an
elastically restrained edge, in plate theory a rotational spring of stiffness (1 - nu) D/b. Its mean
motion is that of two polynomial states, both in equilibrium and without traction on the faces,

    extension   u = e r,    w = -2 lam e z/(lam + 2 mu),
    bending     u = k r z,  w = k (b^2 - r^2)/2 - lam k z^2/(lam + 2 mu),

with w = 0 at r = b in the middle plane z = 0. To suppress the mean motion of the edge, e and k are
chosen such that neither the mean of u at r = b nor its rotation, int u z dz/int z^2 dz, remains.
A simple support removes the edge's force int sigma_rr dz and moment int sigma_rr z dz. These are
-2 mu/b times the mean motion, so that its effect is (1 - nu)/(1 + nu) times that of suppressing the
mean motion. The latter is X, in delta R/a^2 = 1 + F, linear in the force like F:

    X = (alpha/pi) [ (1 - 2 n eta^2)/eta^3 sum g (1 + 3 n - n Q)/(j^3 J1)
                     + (8/3) n^2 sum g H/(j^2 J1) ],   n = lam/(lam + 2 mu) = nu/(1 - nu),
    Q = T (cosh T - 1)/(sinh T - T),  H = (cosh T - 1)/(sinh T + T),  T = 2 eta j,

with g(y) = 3 (sin y - y cos y)/y^3, y = alpha j. In the slope S = (R/2a) d delta/da, (3/2) sin y/y
replaces g. The other tractions at the edge are self-balanced, and their effect decays within one
thickness (Saint-Venant); the states do not remove it. A clamp requires more than suppressing the
mean motion: see `clamped`.
"""

from dataclasses import dataclass
from functools import cache

import sympy as sp

from derivation.engine.formula.proof import prove
from derivation.plate.contact.theory.hertz import SINE_MINUS, pressure_coefficient
from derivation.plate.modes.theory.equilibrium import force_balance, hooke
from derivation.plate.modes.theory.face_conditions import loaded
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.modes.theory.mode_shapes import mode_shapes
from derivation.plate.modes.theory.stresses import modal_stresses
from derivation.plate.vocabulary import (
    J1,
    A_j,
    Formula,
    R,
    T,
    a,
    alpha,
    b,
    eta,
    h,
    j_n,
    lam,
    mu,
    phi,
    r,
    z,
)

RATIO = lam / (lam + 2 * mu)
"""n = nu/(1 - nu): relative thinning of a plate in extension."""
_y = alpha * j_n


@dataclass(frozen=True)
class PlateState:
    """A polynomial state of unit size: displacements, edge force and moment per length."""

    u: sp.Expr
    w: sp.Expr
    force: sp.Expr
    moment: sp.Expr


def bending_function() -> sp.Expr:
    """Return Q(T) = T (cosh T - 1)/(sinh T - T), which is 3 at T = 0."""
    return T * (sp.cosh(T) - 1) / (sp.sinh(T) - T)


def stretching_function() -> sp.Expr:
    """Return H(T) = (cosh T - 1)/(sinh T + T), twice the symmetric part of the plate factor G."""
    return (sp.cosh(T) - 1) / (sp.sinh(T) + T)


def _through(expression: sp.Expr) -> sp.Expr:
    """Return the integral over the thickness."""
    return sp.integrate(sp.expand(expression), (z, -h, h))


@cache
def states() -> tuple[PlateState, PlateState]:
    """Return extension and bending for e = k = 1, proved to balance and to leave the faces free."""
    pair = []
    for name, u, w in (
        ("Stretching", r, -2 * RATIO * z),
        ("Bending", r * z, (b**2 - r**2) / 2 - RATIO * z**2),
    ):
        stress = hooke(u, w)
        radial, axial = force_balance(stress)
        force, moment = _through(stress.rr), _through(stress.rr * z)
        stiff = 2 * mu * (3 * lam + 2 * mu) / (lam + 2 * mu)
        prove(
            f"{name} of the whole plate",
            "Its stresses are in equilibrium, the faces are free of traction, and w = 0 at r = b, "
            "z = 0.",
            {
                "radial balance": radial,
                "axial balance": axial,
                "pressure": stress.zz,
                "shear": stress.rz,
                "edge": w.subs({r: b, z: 0}),
                "force": force - (2 * h * stiff if name == "Stretching" else 0),
                "moment": moment - (0 if name == "Stretching" else 2 * h**3 / 3 * stiff),
            },
        )
        pair.append(PlateState(u, w, sp.factor(force), sp.factor(moment)))
    stretching, bending = pair
    return stretching, bending


@cache
def edge_resultants() -> tuple[Formula, ...]:
    """Return one mode's mean motion of the edge, its force and its moment.

    By Hooke's law g phi^2 = (S_rr - n S_zz)/E*. S_rz' = phi S_rr gives no force of S_rr, and
    with S_zz' = -phi S_rz the moment A_j/phi^2; S_zz has force and moment.
    """
    raw = {formula.name: formula.expression for formula in (*mode_shapes(), *modal_stresses())}
    g_j, S_rr, S_zz, S_rz = (raw[name] for name in ("g_j", "S_rr", "S_zz", "S_rz"))
    E, size = PLANE_STRAIN_MODULUS, 2 * phi * h
    Q, H = (f.subs(T, size) for f in (bending_function(), stretching_function()))
    force, moment = 2 * H * A_j / phi, (Q - 3) * A_j / phi**2
    # Of u at r = b: phi J1 int g dz and phi J1 int g z dz.
    mean = -J1 * RATIO * force / (E * phi)
    turn = J1 * (A_j / phi**2 - RATIO * moment) / (E * phi)
    moved, turned = (loaded(_through(u)) * phi * J1 for u in (g_j, g_j * z))
    results = (
        mean / (2 * h * b),
        turn * 3 / (2 * h**3 * b),
        -2 * mu / b * mean,
        -2 * mu / b * turn,
    )
    balances = {
        "Hooke": g_j * phi**2 - (S_rr - RATIO * S_zz) / E,
        "radial balance": sp.diff(S_rz, z) - phi * S_rr,
        "axial balance": sp.diff(S_zz, z) + phi * S_rz,
        "force of S_rr": loaded(_through(S_rr)),
        "moment of S_rr": loaded(_through(S_rr * z)) - A_j / phi**2,
        "force of S_zz": loaded(_through(S_zz)) - force,
        "moment of S_zz": loaded(_through(S_zz * z)) - moment,
    }
    proof = prove(
        "Resultants at the edge",
        "The balance of moments and Hooke's law are applied to $g$ and the stresses of one mode, "
        "integrated through the thickness.",
        lambda extension, rotation, edge_force, edge_moment: (
            balances
            | {
                "mean of u": moved - extension * 2 * h * b,
                "moment of u": turned - rotation * _through(z**2) * b,
                "edge force": edge_force + 2 * mu / b * moved,
                "edge moment": edge_moment + 2 * mu / b * turned,
            }
        ),
        *(sp.factor(value) for value in results),
    )
    rows = (
        ("edge_extension", r"\bar e", "mean of $u/b$ at the edge", "1"),
        ("edge_rotation", r"\bar k", "mean rotation of the edge divided by $b$", "1/m"),
        ("edge_force", r"\bar N", "radial force per length at the edge", "N/m"),
        ("edge_moment", r"\bar M", "moment per length at the edge", "N"),
    )
    sources = ("mode_g", "mode_rr", "mode_zz", "sigma_rr")
    return tuple(
        Formula(name, latex, meaning, value, unit, "1", sources, proof, summed=True)
        for (name, latex, meaning, unit), value in zip(rows, proof.claims, strict=True)
    )


@cache
def support_ratio() -> Formula:
    """Return the factor (1 - nu)/(1 + nu) of X for a simple support."""
    nu = sp.Symbol("nu")
    stretching, bending = states()
    _, _, force, moment = (formula.expression for formula in edge_resultants())
    mean, turn = (formula.expression for formula in edge_resultants()[:2])
    value = (lam + 2 * mu) / (3 * lam + 2 * mu)
    proof = prove(
        "Simple support",
        "The $e$ and $k$ that suppress the mean motion of the edge are multiplied by this "
        "factor. Force and moment of the states then cancel those of the modes.",
        lambda value: {
            "force": force + value * mean * stretching.force,
            "moment": moment + value * turn * bending.moment,
            "by Poisson's ratio": sp.cancel(
                value.subs(lam, 2 * mu * nu / (1 - 2 * nu)) - (1 - nu) / (1 + nu)
            ),
        },
        value,
    )
    return Formula(
        "support_ratio",
        r"\chi",
        r"factor of $X$ for a simple support, $(1 - \nu)/(1 + \nu)$",
        value,
        "1",
        "6",
        ("edge_force", "edge_moment"),
        proof,
    )


def _reduced(kernel: sp.Expr) -> sp.Expr:
    """Return one mode's term of X, for a weight function in place of g(y)."""
    Q, H = (f.subs(T, 2 * eta * j_n) for f in (bending_function(), stretching_function()))
    bending = (1 - 2 * RATIO * eta**2) / eta**3 * (1 + 3 * RATIO - RATIO * Q) / (j_n**3 * J1)
    stretching = sp.Rational(8, 3) * RATIO**2 * H / (j_n**2 * J1)
    return alpha / sp.pi * kernel * (bending + stretching)


@cache
def edge_law() -> tuple[Formula, Formula]:
    """Return X, the reduction of delta R/a^2 without mean edge motion, and that of S: one mode."""
    stretching, bending = states()
    mean, turn = (formula.expression for formula in edge_resultants()[:2])
    # The indentation -w(0, +h) of both states, for Hertz pressure.
    depth = sp.Add(*(x * s.w.subs({r: 0, z: h}) for x, s in ((mean, stretching), (turn, bending))))
    depth = depth.subs(A_j, pressure_coefficient().expression)
    g = 3 * (sp.sin(_y) - _y * sp.cos(_y)) / _y**3
    sinc = sp.Rational(3, 2) * sp.sin(_y) / _y
    reduction, slope = _reduced(g), _reduced(sinc)
    scale = R / (alpha * b) ** 2
    reduced = {a: alpha * b, h: eta * b, phi: j_n / b}
    proof = prove(
        "Change of the indentation by the edge",
        r"The deflection $w$ of both states at the contact face, centre minus edge, is written "
        r"in $a/b$ and $h/b$; $\alpha^2 X$ is differentiated with respect to $\alpha$.",
        lambda reduction, slope: {
            "indentation": -depth.subs(reduced) * scale - reduction,
            "slope": sp.diff(alpha**2 * reduction, alpha) / (2 * alpha) - slope,
            "pressure": (SINE_MINUS.subs(reduced) / _y**3 * 3) - g,
        },
        *(reduction, slope),
    )
    sources = ("edge_extension", "edge_rotation", "A_j")
    return (
        Formula(
            "F_edge",
            r"X(\alpha, \eta)",
            r"reduction of $\delta R/a^2$ without mean motion of the edge",
            reduction,
            "1",
            "6",
            sources,
            proof,
            summed=True,
        ),
        Formula(
            "S_edge",
            r"\frac{R}{2a}\frac{\mathrm{d}}{\mathrm{d}a}\frac{a^2 X}{R}",
            r"reduction of $(R/2a) d \delta/da$ without mean motion of the edge",
            slope,
            "1",
            "6",
            ("F_edge",),
            proof,
            summed=True,
        ),
    )


def edge() -> tuple[Formula, ...]:
    """Return the edge's motion, the support's factor, and X."""
    return (*edge_resultants(), support_ratio(), *edge_law())
