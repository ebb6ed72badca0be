"""Step 19, clamped edge: u = w = 0 on the whole edge in three-dimensional elasticity.

With n = nu/(1 - nu) and D the flexural rigidity, at the edge of a plate in bending

    psi = chi eta psi',   w(b, 0) = n G h^2 (kappa_r + kappa_t):

because a clamp on the whole edge also prevents thinning of the plate there. A strip in plane
strain, clamped at its end and bent far away, gives both constants, chi = n^2 turn(n) and
G = level(n), computed by spectral elements (`edge.strip`) and fitted. Both are the work of n z^2/2
on the shear stress at the clamp: chi under a moment, G under a shear force (Betti), so that chi has
the factor n^2. If the mean of w were 0, G would be 1/6.

The state of bending with that w, u = k r z and

    w = k [(b^2 - r^2)/2 - n z^2 + 2 n G h^2],

deflects the contact face by (k b^2/2)(1 - r^2/b^2 - s), s = 2 n (1 - 2 G) eta^2. In Betti's theorem
with this state as the virtual field, the work of a load on it gives the rotation due to the load:
this deflection occurs twice in X_c, averaged over the load and at the centre. The mean rotation of
the edge alone, int u z dz, would omit the work of the shear stress at the edge. Hence

    X_c = alpha/(8 pi eta^3) [(1 - s)(1 - 2 alpha^2/5 - s) + 2 chi eta (1 - 2 alpha^2/5)
                              + eta^3/5 + (16/3) n^2 eta^4],

where the last terms come from shear at the edge, for nu = 0 (`edge.strip`: 0.19935), and from
extension. Neglected terms begin with eta^3 n; `edge.remainder` computes their size. Modes of a
clamped plate, without s and these terms, have an effective chi (`edge_modes.theory.waves.CHI`).
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import Proof, prove
from derivation.plate.contact.theory.hertz import contact_radius
from derivation.plate.edge.theory.supported import RATIO, states
from derivation.plate.modes.theory.equilibrium import hooke
from derivation.plate.modes.theory.face_conditions import loaded
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.modes.theory.mode_shapes import mode_shapes
from derivation.plate.modes.theory.stresses import modal_stresses
from derivation.plate.vocabulary import J1, A_j, Formula, R, a, alpha, b, eta, h, lam, mu, phi, r, z

TURN_FIT = (7436, 3168, -976, 204)
"""1000 n^2/chi by powers of n: within 0.2 % of the computed values, for -1/2 < n < 1."""
LEVEL_FIT = (7638, 801, -316, 255)
"""1000/G by powers of n, with the same accuracy."""
SHEAR_TERM = sp.Rational(1, 5)
"""Contribution of shear at the edge to X_c 8 pi eta^3/alpha, over eta^3; 0.19935 for nu = 0."""
HERTZ_MEAN = sp.Rational(2, 5)
"""Mean of r^2/a^2 under Hertz pressure."""
_n, _G, _chi, _k, _s = sp.symbols("n G chi k s", real=True)


def _fitted(powers: tuple[int, ...]) -> sp.Expr:
    """Return 1000 divided by a polynomial in n."""
    return 1000 / sp.Add(*(c * RATIO**i for i, c in enumerate(powers)))


def turn() -> sp.Expr:
    """Return the constant chi of psi = chi eta psi' at a clamped edge."""
    return RATIO**2 * _fitted(TURN_FIT)


def level() -> sp.Expr:
    """Return the constant G of w(b, 0) = n G h^2 (kappa_r + kappa_t) at a clamped edge."""
    return _fitted(LEVEL_FIT)


def indentation_loss() -> sp.Expr:
    """Return s = 2 n (1 - 2 G) eta^2, the reduction of the bending state's w/(k b^2/2)."""
    return 2 * RATIO * (1 - 2 * level()) * eta**2


@cache
def strip() -> Proof:
    """Prove the strip's state far from its end, from which chi has the factor n^2."""
    x = sp.Symbol("x", real=True)
    E = PLANE_STRAIN_MODULUS
    u, w = x * z, -(x**2) / 2 - RATIO * z**2 / 2
    xx, zz, xz = sp.diff(u, x), sp.diff(w, z), sp.diff(u, z) + sp.diff(w, x)
    along, across = ((lam + 2 * mu) * p + lam * q for p, q in ((xx, zz), (zz, xx)))
    bent = states()[1]
    # Betti's theorem for v and the clamped strip bent by M: theta M = int sigma_xz n z^2/2 dz;
    # sigma_xz itself is linear in n z^2/2.
    return prove(
        "Strip in plane strain",
        "In bending without traction on the faces, the strip thins by $n$ times its curvature, "
        "the circular plate by $n$ times the sum of both curvatures.",
        {
            "faces": across,
            "shear": mu * xz,
            "balance": sp.diff(along, x),
            "stress": along - E * z,
            "moment": sp.integrate(along * z, (z, -h, h)) - 2 * h**3 / 3 * E,
            "thinning of the strip": w.subs(x, 0) + RATIO * z**2 / 2,
            "thinning of the plate": bent.w.subs(r, b) + 2 * RATIO * z**2 / 2,
        },
    )


@cache
def reciprocity() -> Proof:
    """Prove Betti's theorem for one mode of the paper's plate and the bending state, for any G."""
    raw = {formula.name: formula.expression for formula in (*mode_shapes(), *modal_stresses())}
    g_j, S_rz = raw["g_j"], raw["S_rz"]
    bent, E = states()[1], PLANE_STRAIN_MODULUS
    w = bent.w + _k
    stress = hooke(bent.u, bent.w).rr / z
    # int_0^b r J0 dr and int_0^b r^3 J0 dr with J0(phi b) = 0.
    first, third = b * J1 / phi, b**3 * J1 / phi - 4 * b * J1 / phi**3
    on_face = sp.Poly(sp.expand(w.subs(z, h)), r)
    load = -A_j * (on_face.coeff_monomial(1) * first + on_face.coeff_monomial(r**2) * third)

    def through(expression: sp.Expr) -> sp.Expr:
        return loaded(sp.integrate(sp.expand(expression), (z, -h, h)))

    u = phi * J1 * g_j
    rotation, warp = through(u * z), through(S_rz * J1 * w.subs(r, b))
    edge = -2 * mu * rotation + warp - sp.expand(stress) * rotation
    return prove(
        "Reciprocity of a mode and the bending state",
        "The work of the mode's tractions on the state equals that of the state's tractions on the "
        "mode. The tractions at the edge are sigma_rr = -(2 mu/b) u, by Hooke's law, and the shear "
        "stress.",
        {"work": load - b * edge, "stiffness": 2 * mu + stress - 2 * E},
    )


@cache
def amplitudes() -> Proof:
    """Prove the rotation and extension that a clamp suppresses, and their effect on the centre."""
    strip()
    reciprocity()
    E = PLANE_STRAIN_MODULUS
    start, more = sp.symbols("psi_0 k_c", real=True)
    stretching, bending = states()
    # For Hertz pressure, 1 - r^2/a^2 is the square of its relative height.
    height = sp.sqrt(1 - _s**2)
    mean = sp.integrate(_s**3 * height, (_s, 0, 1)) / sp.integrate(_s * height, (_s, 0, 1))
    deep = bending.w.subs(z, h) + 2 * RATIO * _G * h**2
    lost = 2 * RATIO * (1 - 2 * _G) * eta**2
    plate = {h: eta * b, a: alpha * b}
    force = contact_radius().expression
    # psi = psi_0 and psi' = -psi_0 on the paper's edge, k r and k of the state; b = 1.
    (clamped,) = sp.solve(start + more - _chi * eta * (more - start), more)
    loaded_deep = deep.subs(r**2, HERTZ_MEAN * a**2)
    rotation = force * loaded_deep / (2 * sp.pi * b**2 * 2 * E * 2 * h**3 / 3)
    strain = force * -stretching.w.subs(z, h) / (2 * sp.pi * b**2 * 2 * E * 2 * h)
    scale = R / a**2 * 8 * sp.pi * eta**3 / alpha
    return prove(
        "Motion suppressed by a clamp",
        "Reciprocity gives the rotation from the work of the load. psi = chi eta psi' adds 2 chi "
        "eta times this rotation, in first order. The state gives the deflection at the centre.",
        {
            "Hertz": mean - HERTZ_MEAN,
            "central deflection": (deep - (b**2 - r**2) / 2 + lost * b**2 / 2).subs(plate),
            "rotation": clamped + start * (1 + _chi * eta) / (1 - _chi * eta),
            "first power": sp.diff(clamped, _chi).subs(_chi, 0) + 2 * eta * start,
            "mean of w": lost.subs(_G, sp.Rational(1, 6)) - 4 * RATIO * eta**2 / 3,
            "bending": (scale * rotation * deep.subs(r, 0)).subs(plate)
            - (1 - lost) * (1 - HERTZ_MEAN * alpha**2 - lost),
            "extension": (scale * strain * -stretching.w.subs(z, h)).subs(plate)
            - sp.Rational(16, 3) * RATIO**2 * eta**4,
        },
    )


def _bracket(factor: sp.Expr, lost: sp.Expr, chi: sp.Expr) -> sp.Expr:
    """Return X_c 8 pi eta^3/alpha, where w under the load is 1 - factor alpha^2 - s."""
    wide = 1 - factor * alpha**2
    rest = SHEAR_TERM * eta**3 + sp.Rational(16, 3) * RATIO**2 * eta**4
    return (1 - lost) * (wide - lost) + 2 * chi * eta * wide + rest


@cache
def clamp_constants() -> tuple[Formula, Formula]:
    """Return chi and G as fitted functions of n."""
    proof = strip()
    return (
        Formula(
            "clamp_rotation", r"\chi_c", (
                r"rotation constant of a clamped edge under a moment, $\psi = \chi \eta \psi'$"
            ),
            turn(), "1", "", ("edge_rotation",), proof,
        ),
        Formula(
            "clamp_deflection", "G_c", (
                "deflection of a clamped edge's middle plane, divided by $n h^2$ and the sum of "
                "the curvatures"
            ),
            level(), "1", "", ("edge_rotation",), proof,
        ),
    )  # fmt: skip


@cache
def clamp_law() -> tuple[Formula, Formula]:
    """Return X_c, the reduction of delta R/a^2 by a clamped edge, and that of the slope S."""
    amplitudes()
    front = alpha / (8 * sp.pi * eta**3)
    reduction = front * _bracket(HERTZ_MEAN, indentation_loss(), turn())
    slope = sp.Rational(3, 2) * front * _bracket(sp.Rational(2, 3), indentation_loss(), turn())
    symbolic = front * _bracket(HERTZ_MEAN, _s, _chi)
    steep = sp.Rational(3, 2) * front * _bracket(sp.Rational(2, 3), _s, _chi)
    known = {_s: indentation_loss(), _chi: turn()}
    proof = prove(
        "Reduction of the indentation by a clamped edge",
        r"The reduction is the sum of bending, rotation of the edge, shear and extension; "
        r"$\alpha^2 X_c$ is differentiated with respect to $\alpha$.",
        lambda reduction, slope: {
            "indentation": reduction - symbolic.subs(known),
            "slope": sp.diff(alpha**2 * reduction, alpha) / (2 * alpha) - slope,
            "slope for any constants": sp.diff(alpha**2 * symbolic, alpha) / (2 * alpha) - steep,
        },
        *(reduction, slope),
    )
    sources = ("clamp_rotation", "clamp_deflection", "P")
    return (
        Formula(
            "F_clamp", r"X_c(\alpha, \eta)", r"reduction of $\delta R/a^2$ by a clamped edge",
            reduction, "1", "6", sources, proof,
        ),
        Formula(
            "S_clamp", r"\frac{R}{2a}\frac{\mathrm{d}}{\mathrm{d}a}\frac{a^2 X_c}{R}",
            r"reduction of $(R/2a) d \delta/da$ by a clamped edge", slope, "1", "6", ("F_clamp",),
            proof,
        ),
    )  # fmt: skip


@cache
def clamp_bound() -> Formula:
    """Return an upper bound of the slope's reduction by a clamp, for all radii up to alpha b.

    The reduction is not negative. With m = (|1 - s| - (1 - s))/2 the bound's bracket is the slope's
    for alpha = 0 plus 2 m/3. It exceeds that by (2/3) [m + alpha^2 (1 - s)] + (4/3) chi eta
    alpha^2 >= 0.

    The reduction is not negative, because s <= 2 |n| eta^2 gives (16/3) n^2 eta^4 >= (4/3) s^2,
    and for 0 <= beta <= 2/3 (1 - s)(1 - beta - s) + (4/3) s^2 = (7/3) (s - 3 (2 - beta)/14)^2 +
    f(beta), where f decreases with beta to 1/7 at 2/3.
    """
    lost, beta = indentation_loss(), sp.Symbol("beta", real=True)
    front = sp.Rational(3, 2) * alpha / (8 * sp.pi * eta**3)
    more = (sp.Abs(1 - lost) - (1 - lost)) / 2
    value = front * (_bracket(sp.Integer(0), lost, turn()) + 2 * more / 3)
    m, third = sp.Symbol("m_s"), sp.Rational(2, 3)
    steep = front * _bracket(third, _s, _chi)
    known = {_s: lost, _chi: turn(), m: more}
    floor = 1 - beta - 3 * (2 - beta) ** 2 / 28
    proof = prove(
        "Bound of the slope's reduction by a clamped edge",
        r"The bracket in the slope is linear in $\alpha^2$; squares are completed. For $-1/2 < n "
        r"< 1$, $1000/G$ is above 7000 and $1000 n^2/\chi$ above 5000, so that $0 < 1 - 2 G < "
        r"1$ and $\chi \ge 0$.",
        lambda value: {
            "above": value
            - (
                steep + front * third * (m + alpha**2 * (1 - _s) + 2 * _chi * eta * alpha**2)
            ).subs(known),
            "square": (1 - _s) * (1 - beta - _s) + sp.Rational(4, 3) * _s**2
            - sp.Rational(7, 3) * (_s - 3 * (2 - beta) / 14) ** 2 - floor,
            "lower bound": floor.subs(beta, third) - sp.Rational(1, 7),
            "decrease": sp.diff(floor, beta) + 1 - 3 * (2 - beta) / 14,
        },
        value,
    )  # fmt: skip
    return Formula(
        "S_clamp_bound",
        r"S_c",
        r"bound of the reduction of $(R/2a) d \delta/da$ by a clamped edge for all radii up to $a$",
        value,
        "1",
        "6",
        ("S_clamp",),
        proof,
        where=("alpha < 1",),
    )


def clamp() -> tuple[Formula, ...]:
    """Return the clamp's constants, the reduction, and the bound."""
    return (*clamp_constants(), *clamp_law(), clamp_bound())
