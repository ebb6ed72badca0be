"""Cosines of the kernel and profile of the sphere, each proved equal to that of step 20.

The kernel is a sum of cosines, with imaginary arguments for the lateral surface. The code uses
1 - cos = q x^2 - e and the slope of e with respect to x = t/a, divided by x.
"""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Let, Routine, routine
from derivation.plate.edge.theory.curvature import bent_face
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.pressure.theory import results as theory
from derivation.plate.pressure.theory.integral_equation import kernel, profile
from derivation.plate.pressure.theory.remaining_curvature import parts_of_wave
from derivation.plate.pressure.theory.waves import force_of_wave, mean_deflection
from derivation.plate.vocabulary import R, a, alpha, r

phase, rise, x, y, c = sp.symbols("phase rise x y c", positive=True)


def _shape(of_lateral: bool, turn: sp.Expr) -> sp.Expr:
    """Return the kernel's cosine."""
    expression = kernel()[of_lateral].expression
    (cosine,) = expression.atoms(sp.cosh if of_lateral else sp.cos)
    return cosine.subs(alpha, turn * alpha / cosine.args[0])


def _by_exponentials(expression: sp.Expr) -> sp.Expr:
    return sp.expand(expression.rewrite(sp.exp))


def _parts(cosine: sp.Expr) -> tuple[sp.Expr, ...]:
    """Return 1 - cos = q x^2 - e, then e, its slope with respect to x divided by x, and q."""
    risen, deviation, parabola = parts_of_wave(cosine, x)
    return risen, deviation, sp.diff(deviation, x) / x, parabola


@named_routine
def wave() -> Claims:
    """Return 1 - cos(phase x) = q x^2 - e, then e, its slope over x, and q."""
    turns, risen = sp.symbols("turns risen", positive=True)
    return Claims(
        (x, phase),
        (
            Let(turns, phase * x),
            Let(risen, 2 * sp.sin(turns / 2) ** 2),
        ),
        (risen, turns**2 / 2 - risen, phase / x * (turns - sp.sin(turns)), phase**2 / 2),
        _parts(_shape(False, phase * x)),
        {},
        _by_exponentials,
    )


@named_routine
def lateral_wave() -> Claims:
    """Return 1 - cosh(rise x) = q x^2 - e, then e, its slope over x, and q, all divided by e^y."""
    grown, rising, falling, risen, line = sp.symbols("grown rising falling risen line")
    return Claims(
        (x, rise, y),
        (
            Let(grown, rise * x),
            Let(rising, sp.exp((grown - y) / 2)),
            Let(falling, sp.exp(-(grown + y) / 2)),
            Let(risen, (rising - falling) ** 2 / 2),
            Let(line, grown * sp.exp(-y)),
        ),
        (
            -risen,
            risen - grown * line / 2,
            rise / x * ((rising - falling) * (rising + falling) / 2 - line),
            -(rise**2) * sp.exp(-y) / 2,
        ),
        tuple(sp.exp(-y) * part for part in _parts(_shape(True, rise * x))),
        {},
        _by_exponentials,
    )


@named_routine
def edge_wave() -> Claims:
    """Return 2 t^2/b^2 = q x^2 of the state by which an edge differs, and q; alpha = a/b."""
    parabola = 2 * alpha**2
    risen, _, exact = parts_of_wave(bent_face(alpha * x), x)
    return Claims((x, alpha), (), (parabola * x**2, parabola), (risen, exact), {}, sp.expand)


@named_routine
def force_of_waves() -> Claims:
    """Return the change of the force at a contact radius a by waves; growth is sum q ds/da."""
    growth = sp.Symbol("growth", real=True)
    return Claims(
        (modulus, a, growth),
        (),
        (2 * modulus * a**2 * growth,),
        (force_of_wave().expression,),
        {modulus: PLANE_STRAIN_MODULUS, growth: sp.diff(mean_deflection(), a)},
        sp.simplify,
    )


def _profile(of_sphere: bool) -> sp.Expr:
    """Return f R/a^2 at t = a x, c = a/R."""
    shapes = profile()
    (t,) = shapes[0].free_symbols - {R}
    return shapes[of_sphere].subs(t, c * R * x) / (c**2 * R)


def _by_logarithms(expression: sp.Expr) -> sp.Expr:
    reduced = expression.replace(sp.log, lambda v: sp.log(sp.cancel(v)))
    return reduced.replace(sp.atanh, lambda v: sp.log((1 + v) / (1 - v)) / 2)


@named_routine
def sphere() -> Claims:
    """Return f R/a^2 - x^2 of a sphere, and its slope with respect to x over x; c = a/R."""
    angle, excess = sp.symbols("angle excess", positive=True)
    deviation = _profile(True) - _profile(False)
    return Claims(
        (x, c),
        (Let(angle, c * x), Let(excess, sp.atanh(angle) / angle - 1)),
        (x**2 * excess, excess + angle**2 / ((1 - angle) * (1 + angle))),
        (deviation, sp.diff(deviation, x) / x),
        {},
        _by_logarithms,
    )


modulus, plate_modulus, compliance = sp.symbols("modulus plate_modulus compliance", positive=True)
first, per = sp.symbols("first per", positive=True)
GIVEN = a, R, modulus, plate_modulus, compliance, first, per
SOLVED = (
    theory.force, theory.depth, theory.work, theory.firm, theory.rim, theory.bend, theory.centre,
)  # fmt: skip
MEANING = {
    modulus: theory.E,
    compliance: theory.support,
    first: theory.N_0 * per * plate_modulus / theory.E,
}
"""`first` is the kernel's constant, lengths over `per`, for the plate's own modulus."""


@named_routine
def contact_results() -> Claims:
    """Return force, indentation, stiffness, slope, energy, central and mean pressure."""
    ratio, deep, stiff, series = sp.symbols("ratio deep stiff series", positive=True)
    pressed, peak, reach, relative_modulus = sp.symbols(
        "pressed peak reach relative_modulus", positive=True
    )
    results = theory.results()
    return Claims(
        (*GIVEN, *SOLVED),
        (
            Let(ratio, a / R),
            Let(deep, a * ratio),
            Let(stiff, 2 * modulus * a),
            Let(reach, a / per),
            Let(relative_modulus, modulus / plate_modulus),
            Let(series, first * reach * relative_modulus + stiff * compliance),
            Let(pressed, stiff * deep),
            Let(peak, modulus * ratio / sp.pi),
        ),
        (
            pressed * theory.force,
            deep * (theory.depth + theory.force * series),
            stiff / (theory.firm + series),
            ratio * theory.bend / theory.rim * (theory.firm + series),
            pressed * deep * (theory.work + theory.force**2 * series) / 2,
            peak * theory.centre,
            2 * peak * theory.force,
        ),
        results[:7],
        MEANING,
        sp.cancel,
    )


def pressure_unit() -> Routine:
    """Return the routine of the unit of the sums of -c'/x."""
    unit = theory.results().centre_pressure / theory.centre
    return _unit(
        "pressure_unit",
        modulus / sp.pi * a / R,
        unit,
        "Return the unit of the pressure, E* a/(pi R).",
    )


def chi_unit() -> Routine:
    """Return the routine of the unit of c."""
    return _unit(
        "chi_unit",
        modulus / sp.pi * a**2 / R,
        theory.results().chi,
        "Return the unit of chi, E* a^2/(pi R).",
    )


def _unit(name: str, value: sp.Expr, exact: sp.Expr, summary: str) -> Routine:
    ratio = sp.Symbol("ratio", positive=True)
    by_ratio = value / a * R * ratio
    start = (Let(ratio, a / R),)
    return routine(name, (a, R, modulus), start, (by_ratio,), (exact,), summary, MEANING)


@named_routine
def pressure_points() -> Claims:
    """Return t/a for the pressure at r/a, and the factor of its sum."""
    within, node, gap = sp.symbols("within node gap", positive=True)
    t, front, _ = theory.substitution()
    (u,) = t.free_symbols - {a, r}
    there = {r: within * a, u: node}

    def squares(expression: sp.Expr) -> sp.Expr:
        left, right = sp.Add.make_args(expression)
        return sp.expand(left**2 - right**2)

    return Claims(
        (within, node),
        (Let(gap, (1 - within) * (1 + within)),),
        (sp.sqrt(within**2 + gap * node**2), sp.sqrt(gap)),
        tuple(value.subs(there) / a for value in (t, front)),
        {},
        squares,
    )


ROUTINES = (
    wave,
    lateral_wave,
    edge_wave,
    force_of_waves,
    sphere,
    contact_results,
    chi_unit,
    pressure_unit,
    pressure_points,
)
