"""Contact laws as the code of one scene needs them; `modulus` is E* of the contact.

    P = (4/3) E* (a^3/R) p,   delta = (a^2/R) (1 + a F)

with F = p - 1 = 0 for Hertz's law and a constant F for a plate that only bends; otherwise p and F
are functions of the contact radius.
"""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import GUARDED, RAISED, Choice, Facts, Let
from derivation.engine.formula.functions import unspecified_function
from derivation.plate.contact.theory.hertz import contact_radius
from derivation.plate.impact.theory.impact import hertz_time, work_of_contact
from derivation.plate.impact.theory.sensitivity import reduced_modulus
from derivation.plate.vocabulary import R, a, m, v0

modulus, flat, depth, power = sp.symbols("modulus flat depth power", positive=True)
HERTZ_TIME = sp.Symbol("HERTZ_TIME", positive=True)
_FIFTH = sp.Rational(1, 5)
bend, growth, growth_a, pressure, pressure_a = sp.symbols(
    "bend growth growth_a pressure pressure_a", real=True
)
hertz, w, shape, theta = sp.symbols("hertz w shape theta", positive=True)
Growth, Pressure = (
    unspecified_function(name, unspecified_function(f"{name}Slope"))(a)
    for name in ("Growth", "Pressure")
)
FORCE, DEPTH = contact_radius().expression, a**2 / R
CODE = (
    4 * modulus / 3 * a**2 * flat * pressure,
    a * flat * (1 + a * growth),
    4 * modulus / 3 * a * flat * (3 * pressure + a * pressure_a),
    flat * (2 + a * (3 * growth + a * growth_a)),
)
"""Force, indentation, and the derivatives of both by the contact radius."""
MEANING: Facts = {
    modulus: reduced_modulus(),
    growth: Growth,
    growth_a: sp.diff(Growth, a),
    pressure: Pressure,
    pressure_a: sp.diff(Pressure, a),
}


def _law(arguments: tuple[sp.Symbol, ...], code: Facts, exact: Facts) -> Claims:
    """Return the law with some of its quantities replaced, in the code and in the claims."""
    force, depth = (x.subs(exact) for x in (FORCE * Pressure, DEPTH * (1 + a * Growth)))
    return Claims(
        (a, R, modulus, *arguments),
        (Let(flat, a / R, within=not arguments),),
        tuple(x.subs(code) for x in CODE),
        (force, depth, sp.diff(force, a), sp.diff(depth, a)),
        MEANING,
        sp.cancel,
    )


@named_routine
def hertz_law() -> Claims:
    """Return force, indentation and their slopes at a contact radius, by Hertz's law."""
    code = {pressure: 1, pressure_a: 0, growth: 0, growth_a: 0}
    return _law((), code, {Pressure: 1, Growth: 0})


@named_routine
def bent_law() -> Claims:
    """Return the same for a plate that bends by `bend a` times Hertz's indentation."""
    code = {pressure: 1, pressure_a: 0, growth: bend, growth_a: 0}
    return _law((bend,), code, {Pressure: 1, Growth: bend})


@named_routine
def growth_law() -> Claims:
    """Return the same where the plate adds `growth a` times Hertz's indentation."""
    return _law((growth, growth_a), {pressure: 1, pressure_a: 0}, {Pressure: 1})


@named_routine
def pressure_law() -> Claims:
    """Return the same where the force is also `pressure` times that of Hertz's law."""
    return _law((growth, growth_a, pressure, pressure_a), {}, {})


def _of_triple_angle(expression: sp.Expr) -> sp.Expr:
    """Simplify arccos(cos 3 theta) to 3 theta, 0 <= 3 theta <= pi, and likewise for arccosh."""
    triple = 4 * sp.Symbol("c") ** 3 - 3 * sp.Symbol("c")

    def whole(x: sp.Expr, inverse: type[sp.Function], cosine: type[sp.Function]) -> sp.Expr:
        same = sp.expand(x - triple.subs(sp.Symbol("c"), cosine(theta))) == 0
        return 3 * theta if same else inverse(x)

    expression = expression.replace(sp.acos, lambda x: whole(x, sp.acos, sp.cos))
    expression = expression.replace(sp.acosh, lambda x: whole(x, sp.acosh, sp.cosh))
    return sp.simplify(expression)


@named_routine
def bent_radius() -> Claims:
    """Return the contact radius of `bent_law`; `hertz` is that of Hertz's law, sqrt(R delta)."""

    # With t = hertz/a, t^3 - t = bend hertz, whose root is t = (2/sqrt(3)) cos(arccos(w)/3).
    def side(cosine: sp.Expr) -> Facts:
        ratio = 2 / sp.sqrt(3) * cosine
        return {bend: (ratio**2 - 1) / a, hertz: ratio * a}

    return Claims(
        (hertz, bend),
        (
            Let(w, sp.Rational(3, 2) * sp.sqrt(3) * bend * hertz),
            Choice(
                shape,
                w <= 1,
                sp.cos(sp.acos(GUARDED(w, 1)) / 3),
                sp.cosh(sp.acosh(RAISED(w, 1)) / 3),
                side(sp.cos(theta)),
                side(sp.cosh(theta)),
            ),
        ),
        (sp.sqrt(3) / 2 * hertz / shape,),
        (a,),
        {},
        _of_triple_angle,
    )


@named_routine
def hertz_impact() -> Claims:
    """Return contact time, largest indentation, force and radius of an impact by Hertz's law."""
    work = FORCE / a**3 / R * work_of_contact(0)
    largest = (m * v0**2 / 2 / work) ** _FIFTH
    # The power of the speed stands apart, because its square may overflow.
    radius = power**_FIFTH * v0 ** (2 * _FIFTH)
    claims = hertz_time().expression * DEPTH / v0, DEPTH, FORCE, a
    return Claims(
        (R, m, v0, modulus),
        (
            Let(power, 15 * m * R**2 / (16 * modulus), within=True),
            Let(a, radius),
            Let(depth, a**2 / R, within=True),
        ),
        (HERTZ_TIME / v0 * depth, depth, 4 * modulus / 3 * a * depth, a),
        tuple(claim.subs(a, largest) for claim in claims),
        {**MEANING, HERTZ_TIME: hertz_time().expression},
        sp.simplify,
    )


ROUTINES = hertz_law, bent_law, growth_law, pressure_law, bent_radius
