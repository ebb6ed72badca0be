"""Step 20, edge: another edge curves the plate under the contact.

The state of bending by which a support differs from the paper's edge deflects the contact face by
a constant plus kappa P r^2/2. The sphere then meets a profile with 1/R + kappa P instead of 1/R,
and the kernel of the integral equation has the additional terms

    N_s (t^2 + s^2 - 2 t^2 s^2/b^2)/h^3,   N_s = 2 E* h^3 kappa.

The term in t^2 is the curvature, that in s^2 the smaller effect of a load away from the axis; their
coefficients are equal, because the kernel is symmetric (Betti). The last term makes the sum of
these and a constant the product of the same function of t and s: the state, and the work of the
load on it, for a thin plate. There kappa is 1/(8 pi D) clamped, and -(1 - nu)/(1 + nu) times as
much simply supported. kappa is the amplitude of the state under a point load. The coefficient of
s^2 is half the third derivative of the slope S with respect to alpha = a/b, which a clamp confirms.

Finite elements (`edge.remainder`) confirm kappa within 1 % for h/b = 0.2, 2 % for 0.3 and 5 % for
0.5 if simply supported, and within 0.2 %, 0.7 % and 5 % if clamped (Poisson's ratio 0 to 0.45).
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import prove
from derivation.plate.contact.theory.hertz import contact_radius, pressure_coefficient
from derivation.plate.edge.theory.clamped import clamp_constants, clamp_law, indentation_loss
from derivation.plate.edge.theory.supported import (
    RATIO,
    bending_function,
    edge_resultants,
    states,
    support_ratio,
)
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.pressure.theory.integral_equation import profile
from derivation.plate.vocabulary import (
    J1,
    A_j,
    Formula,
    P,
    R,
    T,
    a,
    a_ratio,
    alpha,
    b,
    eta,
    h,
    j_n,
    phi,
    r,
    z,
)

N_s = sp.Symbol("N_s", real=True)
_kappa, _resultant, _chi, _loss = sp.symbols("kappa F chi s", real=True)


def bent_face(width: sp.Expr) -> sp.Expr:
    """Return Abel's transform at t = width b of 1 - r^2/b^2, the face in the bending state."""
    parabola = profile()[0]  # of r^2/(2 R)
    (t,) = parabola.free_symbols - {R}
    transform: sp.Expr = 1 - parabola.subs({R: b**2 / 2, t: width * b})
    return transform


def _curved() -> dict[str, sp.Expr]:
    """Return the profile of the bending state, and the term that it adds to the kernel.

    `_resultant` is int chi ds, so that the load is 2 pi times as much.
    """
    bending = states()[1]
    deflected = -bending.w.subs(z, h)
    parabola = profile()[0]
    (t,) = parabola.free_symbols - {R}
    added = PLANE_STRAIN_MODULUS / sp.pi * parabola.subs(R, 1 / _kappa)
    kernel = 2 * PLANE_STRAIN_MODULUS * _kappa / P * t**2
    s, state = sp.Symbol("s"), bent_face(t / b)
    product = -N_s * b**2 / (2 * h**3) * (state * state.subs(t, s) - 1)
    return {
        "product": product - N_s / h**3 * (t**2 + s**2 - 2 * t**2 * s**2 / b**2),
        "profile": deflected - deflected.subs(r, 0) - r**2 / 2,
        "kernel": added - kernel.subs(P, 2 * sp.pi * _resultant) * _resultant,
        "S": law_of_square()[1] - N_s * a_ratio**3 / 3,
    }


def law_of_square() -> tuple[sp.Expr, sp.Expr]:
    """Return the contributions of `N_s` to delta R/a^2 and to S under Hertz pressure.

    Both follow from k = dS/d alpha and S = (R/2a) d delta/da.
    """
    slope = sp.integrate(N_s * a_ratio**2, (a_ratio, 0, a_ratio))
    return sp.integrate(2 * a_ratio * slope, (a_ratio, 0, a_ratio)) / a_ratio**2, slope


def _of_support() -> sp.Expr:
    """Return one mode's term of N_s for a simple support."""
    Q = bending_function().subs(T, 2 * eta * j_n)
    return -3 / sp.pi * support_ratio().expression * (1 + 3 * RATIO - RATIO * Q) / (j_n**3 * J1)


def _amplitude_of_support() -> sp.Expr:
    """Return 2 E* h^3 times the curvature of one mode's state under a point load."""
    turn = edge_resultants()[1].expression.subs(A_j, pressure_coefficient().expression)
    force = contact_radius().expression
    curvature = support_ratio().expression * turn / force
    whole = 2 * PLANE_STRAIN_MODULUS * h**3 * curvature
    scaled = whole.subs({a: alpha * b, h: eta * b, phi: j_n / b})
    return sp.simplify(sp.limit(sp.simplify(scaled), alpha, 0))


def _of_clamp() -> sp.Expr:
    """Return N_s of a clamped edge."""
    chi = clamp_constants()[0].expression
    return 3 / (8 * sp.pi) * (1 - indentation_loss() + 2 * chi * eta)


def _clamp_residuals(N: sp.Expr) -> dict[str, sp.Expr]:
    """Return N_s minus the same by the slope, and by the rotation that a clamp suppresses."""
    slope = clamp_law()[1].expression
    deflected = b**2 / 2 * (1 - _loss)  # of the bending state, under the load
    stiffness = 2 * sp.pi * b**2 * 2 * PLANE_STRAIN_MODULUS * 2 * h**3 / 3
    rotation = P * (deflected + _chi * eta * b**2) / stiffness
    whole = 2 * PLANE_STRAIN_MODULUS * h**3 * rotation / P
    constants = {_loss: indentation_loss(), _chi: clamp_constants()[0].expression}
    return {
        "reciprocity": N + eta**3 * sp.diff(slope, alpha, 3) / 2,
        "rotation": N - whole.subs(constants),
    }


@cache
def edge_curvature() -> tuple[Formula, Formula]:
    """Return N_s of a simple support, one mode's term, and that of a clamped edge."""
    curved, amplitude = _curved(), _amplitude_of_support()
    proof = prove(
        "Curvature under the contact by an edge",
        r"The bending state deflects the contact face by $\kappa P r^2/2$, which Abel's operator "
        r"turns into $\kappa P t^2$. The curvature is the amplitude of the state under a point "
        r"load; at a clamp it is also minus half the third derivative of the reduction of $S$.",
        lambda support, clamp: (
            curved | {"amplitude": amplitude - support} | _clamp_residuals(clamp)
        ),
        *(_of_support(), _of_clamp()),
    )
    meaning = "coefficient of $(t^2 + s^2)/h^3$ in the kernel by "
    return (
        Formula(
            "kernel_of_support", r"N_s", meaning + "a simply supported edge", _of_support(),
            "1", "", ("edge_rotation", "support_ratio", "k_modes"), proof, summed=True,
        ),
        Formula(
            "kernel_of_clamp", r"N_c", meaning + "a clamped edge", _of_clamp(),
            "1", "", ("S_clamp", "clamp_rotation", "k_modes"), proof,
        ),
    )  # fmt: skip
