"""Test the derived formulas against limits, quadrature, plate theory and Navier's equations."""

import dataclasses
import json
from collections.abc import Callable, Mapping

import mpmath as mp
import pytest
import sympy as sp

from derivation.engine.formula.proof import SYMBOLIC, Proof, ProofError, prove
from derivation.plate import derived
from derivation.plate.back_face import theory as back_face
from derivation.plate.chain import MOTION_STEPS, STEPS
from derivation.plate.edge.theory import clamped
from derivation.plate.edge.theory import sums as edge_sums
from derivation.plate.edge_modes.theory import modes as thin_modes
from derivation.plate.impact.theory import sensitivity, substitution
from derivation.plate.modes.theory.face_conditions import loaded, tractions
from derivation.plate.modes.theory.mode_shapes import characteristic_roots, substitute
from derivation.plate.plasticity.theory import contact as plastic
from derivation.plate.pressure.theory import integral_equation as pressure
from derivation.plate.viscosity.theory import bounds as viscous_bounds
from derivation.plate.viscosity.theory import contact as viscous_contact
from derivation.plate.vocabulary import C1, C2, C3, C4, A_j, Formula, T, h, lam, mu, phi, r, z
from derivation.plate.waves.theory import bending_branch, dynamic_modes

Formulas = Mapping[str, Formula]
POINT = {"h": "0.3", "b": "1.7", "R": "2.1", "a": "0.4", "lam": "1.3", "mu": "0.8", "phi": "2.9"}


@pytest.fixture(autouse=True)
def _digits():
    with mp.workdps(40):
        yield


def value(expression: sp.Expr, **more: object) -> mp.mpf:
    """Return an expression at the point, evaluated by SymPy and not by this project."""
    numbers = {name: sp.Rational(text) for name, text in POINT.items()} | more
    by_name = {symbol: numbers[str(symbol)] for symbol in expression.free_symbols}
    return mp.mpf(str(expression.subs(by_name).evalf(45)))


def close(got: mp.mpf, expected: mp.mpf, tolerance: str = "1e-35") -> bool:
    return bool(abs(got - expected) <= mp.mpf(tolerance) * max(1, abs(expected)))


def test_formulas_are_verified_symbolically(formulas: Formulas) -> None:
    """Every formula of the chain has a symbolic proof, and a form for JSON and for notebooks."""
    assert len(formulas) > 200
    assert {formula.proof.method for formula in formulas.values()} == {SYMBOLIC}
    for formula in formulas.values():
        assert formula.proof.residuals
        assert json.loads(json.dumps(formula.to_json()))["name"] == formula.name
        assert formula._repr_latex_().startswith("$")


UNDETERMINED = {
    "Phi", "c_1_roots", "c_3_roots", "c_5_roots", "c_7_roots", "F_roots",
    "F_edge_thin", "F_edge_roots", "S_edge_thin", "S_edge_roots", "S_edge_bound",
    "clamp_rotation", "clamp_deflection", "hertz_radius_ratio", "delta_non_hertzian",
    "back_face_sum_thin", "back_face_sum_roots", "back_face_sum_wide",
    "bending_kap_thin", "residue_thin", "bending_fraction_thin", "gap_energy", "coupling_loss",
}  # fmt: skip
"""Formulas whose proof is not known to determine their expression. They are sums over complex
roots, which have no interval evaluation, fits, bounds, truncated series, and terms of a sum. No
formula may be added."""


def test_proofs_determine_the_expressions_of_their_formulas(formulas: Formulas) -> None:
    found = {name for name, formula in formulas.items() if not formula.proof.determines}
    assert found == UNDETERMINED


@pytest.mark.parametrize(
    "derive",
    [plastic.yielding, thin_modes.thin_plate_modes, viscous_contact.weak_restitution],
    ids=lambda derive: derive.__name__,
)
def test_a_formula_with_one_changed_number_is_rejected(derive: Callable[[], object]) -> None:
    """Each number of the expression is increased by 1 in turn."""
    found = derive()
    for formula in found if isinstance(found, tuple) else (found,):
        for number in sorted(formula.expression.atoms(sp.Rational)):
            changed = formula.expression.xreplace({number: number + 1})
            with pytest.raises(ValueError, match="expected an expression that the proof"):
                dataclasses.replace(formula, expression=changed)


def test_every_derivation_step_has_a_formula() -> None:
    assert len(derived.chain()) == len(STEPS) + len(MOTION_STEPS)
    assert all(records for _, records in derived.chain())


@pytest.mark.parametrize(
    "lemma",
    [
        back_face.pole_at_zero,
        bending_branch.rise_anywhere,
        clamped.amplitudes,
        clamped.reciprocity,
        clamped.strip,
        dynamic_modes.kinetic_identity,
        dynamic_modes.kinetic_slope,
        dynamic_modes.static_limit,
        edge_sums.half_plane,
        edge_sums.residues,
        pressure.motion_of_the_edge,
        pressure.profiles,
        pressure.representation,
        sensitivity.scaling,
        substitution.lemma,
        viscous_contact.polar,
        lambda: pressure.results().proof,
        lambda: pressure.substitution()[-1],
        lambda: viscous_bounds.bounds().proof,
    ],
)
def test_lemmas_are_verified_symbolically(lemma: Callable[[], Proof]) -> None:
    assert lemma().method == SYMBOLIC


def test_solution_space_has_double_roots() -> None:
    assert characteristic_roots() == {phi: 2, -phi: 2}


def test_wrong_step_is_reported_with_its_residual(formulas: Formulas) -> None:
    f_j, g_j = formulas["f_j"].expression, formulas["g_j"].expression
    radial, axial = substitute(f_j, -g_j)
    with pytest.raises(ProofError, match=r"Step with g_j flipped: radial ODE leaves .*phi"):
        prove("Step with g_j flipped", "", {"axial ODE": axial - axial, "radial ODE": radial})


@pytest.mark.parametrize("constant", [C1, C2, C3, C4])
def test_wrong_sign_of_a_constant_violates_a_traction(constant: sp.Symbol) -> None:
    broken = {
        where: loaded(traction.subs(constant, -constant)) for where, traction in tractions().items()
    }
    with pytest.raises(ProofError, match="sigma_"):
        prove("Face conditions", "", broken)


def test_displacements_satisfy_the_navier_equations(formulas: Formulas) -> None:
    """The displacements satisfy Navier's equations, by numerical derivatives in mpmath."""
    lam_v, mu_v, phi_v = (mp.mpf(POINT[name]) for name in ("lam", "mu", "phi"))
    constants = {C1: 1, C2: -2, C3: 3, C4: 5}
    numbers = constants | {phi: sp.Rational(POINT["phi"])}
    numbers |= {lam: sp.Rational(POINT["lam"]), mu: sp.Rational(POINT["mu"])}
    u = sp.lambdify((r, z), formulas["u"].expression.subs(numbers), "mpmath")
    w = sp.lambdify((r, z), formulas["w"].expression.subs(numbers), "mpmath")

    def divergence(at: mp.mpf, height: mp.mpf) -> mp.mpf:
        radial = mp.diff(lambda x: u(x, height), at) + u(at, height) / at
        return radial + mp.diff(lambda x: w(at, x), height)

    def laplace(field, at: mp.mpf, height: mp.mpf) -> mp.mpf:
        along = mp.diff(lambda x: field(x, height), at, 2)
        across = mp.diff(lambda x: field(x, height), at) / at
        return along + across + mp.diff(lambda x: field(at, x), height, 2)

    with mp.workdps(60):
        at, height = mp.mpf("0.7"), mp.mpf("0.21")
        radial = (lam_v + mu_v) * mp.diff(lambda x: divergence(x, height), at)
        radial += mu_v * (laplace(u, at, height) - u(at, height) / at**2)
        axial = (lam_v + mu_v) * mp.diff(lambda x: divergence(at, x), height)
        axial += mu_v * laplace(w, at, height)
        scale = mu_v * phi_v**2 * abs(w(at, height))
    assert abs(radial) < mp.mpf("1e-15") * scale
    assert abs(axial) < mp.mpf("1e-15") * scale


def test_stresses_are_derivatives_of_displacements(formulas: Formulas) -> None:
    """S_rz = mu phi (g' - f) and the J0 part of sigma_zz agree with numerical derivatives."""
    f_j, g_j = (
        sp.lambdify(z, loaded(formulas[n].expression).subs(_numbers(A_j=3)), "mpmath")
        for n in ("f_j", "g_j")
    )
    at = mp.mpf("0.11")
    lam_v, mu_v, phi_v = (mp.mpf(POINT[name]) for name in ("lam", "mu", "phi"))
    shear = mu_v * phi_v * (mp.diff(g_j, at) - f_j(at))
    axial = lam_v * phi_v**2 * g_j(at) + (lam_v + 2 * mu_v) * mp.diff(f_j, at)
    point = {"z": sp.Rational("0.11"), "A_j": 3}
    assert close(value(formulas["mode_rz"].expression, **point), shear, "1e-20")
    assert close(value(formulas["mode_zz"].expression, **point), axial, "1e-20")


def _numbers(**more: object) -> dict[sp.Symbol, sp.Expr]:
    by_name = {name: sp.Rational(text) for name, text in POINT.items()} | more
    return {s: by_name[str(s)] for s in (phi, h, lam, mu, A_j)}


def test_thin_plate_limit_agrees_with_kirchhoff(formulas: Formulas) -> None:
    """C_top tends to Kirchhoff's 1/(D phi^4) as phi h tends to 0, D = E H^3/(12 (1 - nu^2))."""
    lam_v, mu_v, phi_v = (mp.mpf(POINT[name]) for name in ("lam", "mu", "phi"))
    E = mu_v * (3 * lam_v + 2 * mu_v) / (lam_v + mu_v)
    nu = lam_v / (2 * (lam_v + mu_v))
    thin = mp.mpf("1e-10")
    D = E * (2 * thin) ** 3 / (12 * (1 - nu**2))
    actual = value(formulas["C_top"].expression, h=sp.Rational("1e-10"))
    assert close(actual * D * phi_v**4, mp.mpf(1), "1e-18")


def test_limits_of_the_plate_factors(formulas: Formulas) -> None:
    """G and G_m tend to 6/T^3 for thin plates; for thick plates G tends to 1 and G_m to 0."""
    G, G_m = formulas["G"].expression, formulas["G_m"].expression
    assert sp.limit(G * T**3, T, 0) == 6
    assert sp.limit(G_m * T**3, T, 0) == 6
    assert close(value(G, T=sp.Integer(60)), mp.mpf(1), "1e-35")
    assert abs(value(G_m, T=sp.Integer(90))) < mp.mpf("1e-35")


def test_sonine_integral_agrees_with_quadrature(formulas: Formulas) -> None:
    a, phi_v = mp.mpf(POINT["a"]), mp.mpf(POINT["phi"])
    integral = mp.quad(
        lambda t: t * mp.sqrt(1 - (t / a) ** 2) * mp.besselj(0, phi_v * t), [0, a / 2, a]
    )
    assert close(value(formulas["sonine"].expression), integral, "1e-20")


def test_hertz_pressure_closes_the_gap_under_the_sphere(formulas: Formulas) -> None:
    """On a half-space the displacement due to the pressure closes the gap inside the contact.

    The surface displacement of a point force is 1/(pi E* d) (Boussinesq). It is integrated
    directly, without a transform, at the centre and at half the contact radius.
    """
    a, R = mp.mpf(POINT["a"]), mp.mpf(POINT["R"])
    lam_v, mu_v = mp.mpf(POINT["lam"]), mp.mpf(POINT["mu"])
    E_star = 4 * mu_v * (lam_v + mu_v) / (lam_v + 2 * mu_v)
    force = value(formulas["P"].expression)
    assert close(force, mp.mpf(4) / 3 * E_star * a**3 / R)
    peak = 3 * force / (2 * mp.pi * a**2)

    def ring(at: mp.mpf) -> mp.mpf:
        def along(theta: mp.mpf) -> mp.mpf:
            """Return int p ds along a ray from the point at `at`, part of a half-ellipse."""
            c = at * mp.cos(theta)
            chord = mp.sqrt(a**2 - (at * mp.sin(theta)) ** 2)
            return (chord**2 * (mp.pi / 2 + mp.asin(c / chord)) + c * mp.sqrt(chord**2 - c**2)) / 2

        return 2 * peak / a / (mp.pi * E_star) * mp.quad(along, [0, mp.pi / 2, mp.pi])

    assert close(ring(mp.mpf(0)), a**2 / R, "1e-20")
    assert close(ring(a / 2), a**2 / R - (a / 2) ** 2 / (2 * R), "1e-20")


def test_pressure_series_gives_the_pressure(formulas: Formulas) -> None:
    """The Fourier-Bessel series with A_j gives p(r) inside and outside the contact."""
    a, b = (mp.mpf(POINT[name]) for name in ("a", "b"))
    force = value(formulas["P"].expression)
    expression = formulas["A_j"].expression
    wanted = {symbol.name: symbol for symbol in expression.free_symbols}
    free = [wanted.pop("phi"), wanted.pop("J1")]
    numbers = {symbol: sp.Rational(POINT[name]) for name, symbol in wanted.items()}
    coefficient = sp.lambdify(free, expression.subs(numbers), "mpmath")
    with mp.workdps(15):
        zeros = [mp.besseljzero(0, n) for n in range(1, 400)]
        for at, expected in (
            (a / 2, -3 * force / (2 * mp.pi * a**2) * mp.sqrt(mp.mpf(3) / 4)),
            (b / 2, 0),
        ):
            total = mp.fsum(
                coefficient(j / b, mp.besselj(1, j)) * mp.besselj(0, j * at / b) for j in zeros
            )
            assert abs(total - expected) < mp.mpf("2e-3") * force / a**2


def test_contact_law_is_the_negative_deflection(formulas: Formulas) -> None:
    """K_j s(a phi) = -A_j C_top, and K_j is the published 8 G/(pi R b^2 phi^4 J1^2)."""
    J1 = sp.Rational("0.34")
    K = value(formulas["K_j"].expression, J1=J1)
    G = value(formulas["G"].expression, T=2 * sp.Rational(POINT["phi"]) * sp.Rational(POINT["h"]))
    b, R, phi_v = (mp.mpf(POINT[name]) for name in ("b", "R", "phi"))
    assert close(K, 8 * G / (mp.pi * R * b**2 * phi_v**4 * mp.mpf("0.34") ** 2))
    product = -value(formulas["A_j"].expression, J1=J1) * value(formulas["C_top"].expression)
    y = phi_v * mp.mpf(POINT["a"])
    assert close(K * (mp.sin(y) - y * mp.cos(y)), product)
