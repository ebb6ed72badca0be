"""Step 1: Hooke's law and equilibrium of one axisymmetric mode -> two ODEs in z.

The mode is u = g(z) phi J1(phi r), w = f(z) J0(phi r). Strains, stresses by
Hooke's law and the two equilibrium equations follow by differentiation; the
radial one is J1(phi r) times an ODE in z, the axial one J0(phi r) times
another. (With the paper's g the sign of u in (1) must be this one.)
"""

from dataclasses import dataclass
from functools import cache

import sympy as sp

from derivation.engine.formula.proof import lower_bessel, prove
from derivation.plate.vocabulary import Formula, f, g, lam, mu, phi, r, z

BESSEL_J0 = sp.besselj(0, phi * r)
BESSEL_J1 = sp.besselj(1, phi * r)


@dataclass(frozen=True)
class Stresses:
    """The four stresses of an axisymmetric field."""

    rr: sp.Expr
    tt: sp.Expr
    zz: sp.Expr
    rz: sp.Expr


def hooke(u: sp.Expr, w: sp.Expr) -> Stresses:
    """Return the stresses of the displacement field u (radial), w (axial) by Hooke's law."""
    strain_rr, strain_tt, strain_zz = sp.diff(u, r), u / r, sp.diff(w, z)
    dilatation = strain_rr + strain_tt + strain_zz
    return Stresses(
        rr=lam * dilatation + 2 * mu * strain_rr,
        tt=lam * dilatation + 2 * mu * strain_tt,
        zz=lam * dilatation + 2 * mu * strain_zz,
        rz=mu * (sp.diff(u, z) + sp.diff(w, r)),
    )


def force_balance(stress: Stresses) -> tuple[sp.Expr, sp.Expr]:
    """Return the radial and axial force per volume that is missing for equilibrium."""
    radial = sp.diff(stress.rr, r) + sp.diff(stress.rz, z) + (stress.rr - stress.tt) / r
    axial = sp.diff(stress.rz, r) + sp.diff(stress.zz, z) + stress.rz / r
    return radial, axial


def factor_of(expression: sp.Expr, bessel: sp.Expr) -> sp.Expr:
    """Return the coefficient of J0(phi r) or J1(phi r) in an expression linear in both."""
    return sp.factor(sp.expand(lower_bessel(expression.doit())).coeff(bessel))


@cache
def equilibrium() -> tuple[Formula, Formula]:
    """Return the ODEs for f and g, as expressions that must vanish.

    Raises
    ------
    ProofError
        If the balance is not J1 (radial) or J0 (axial) times a function of z.
    """
    stress = hooke(g * phi * BESSEL_J1, f * BESSEL_J0)
    balance_r, balance_z = force_balance(stress)
    u, w = g * phi * BESSEL_J1, f * BESSEL_J0
    dilatation, rotation = sp.diff(u, r) + u / r + sp.diff(w, z), sp.diff(u, z) - sp.diff(w, r)
    stiff = lam + 2 * mu
    navier_r = stiff * sp.diff(dilatation, r) + mu * sp.diff(rotation, z)
    navier_z = stiff * sp.diff(dilatation, z) - mu * (sp.diff(rotation, r) + rotation / r)
    radial, axial = factor_of(balance_r, BESSEL_J1), factor_of(balance_z, BESSEL_J0)
    odes = sp.expand(radial / phi), sp.expand(axial)
    proof = prove(
        "Equilibrium of one mode",
        r"With Hooke's law, the two equilibrium equations become $\phi J_1(\phi r)$ times the "
        r"first and $J_0(\phi r)$ times the second ODE. They are Navier's equations, $(\lambda + "
        r"2 \mu) \nabla \nabla \cdot u = \mu \nabla \times \nabla \times u$.",
        lambda radial, axial: {
            "radial balance": without_functions(balance_r - radial * phi * BESSEL_J1),
            "axial balance": without_functions(balance_z - axial * BESSEL_J0),
            "radial Navier": _in_bessel(navier_r - radial * phi * BESSEL_J1),
            "axial Navier": _in_bessel(navier_z - axial * BESSEL_J0),
        },
        *odes,
    )
    return (
        Formula(
            "radial_ode",
            "0",
            "radial equilibrium equation of mode $j$",
            odes[0],
            "Pa",
            "2",
            (),
            proof,
        ),
        Formula(
            "axial_ode",
            "0",
            "axial equilibrium equation of mode $j$",
            odes[1],
            "Pa/m",
            "2",
            (),
            proof,
        ),
    )


def _in_bessel(expression: sp.Expr) -> sp.Expr:
    return without_functions(sp.expand(lower_bessel(expression.doit())))


def without_functions(expression: sp.Expr, *functions: sp.Expr) -> sp.Expr:
    """Return the expression with independent symbols for f, g (or others) and their derivatives."""
    functions_of_z = expression.atoms(sp.Derivative) | set(functions or (f, g))
    atoms = sorted(functions_of_z, key=sp.default_sort_key, reverse=True)
    return expression.subs({atom: sp.Dummy(f"d{i}") for i, atom in enumerate(atoms)})
