"""Impact by the contact law alone, proved equal to that of the theory.

With D_n as in the theory, q = a/a_m and E the work over C a^5, the code computes for each contact

    lift = 1 + F = sum D_n q^(n-2),   slope = A F' = sum (n - 2) D_n q^(n-2),
    quotient = (1 - W(q)/W(1))/(1 - q),   W(q) = sum n D_n/(n + 3) q^(n+3).
"""

import sympy as sp

from derivation.engine.emit.modules import Routines
from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Facts, Let
from derivation.plate.contact.theory.hertz import contact_radius
from derivation.plate.impact.kernels.extremes import hertz_impact, number_of_energy, peak_ratios
from derivation.plate.impact.theory.impact import (
    contact_time,
    geometric,
    orders,
    weight,
    work_of_contact,
)
from derivation.plate.vocabulary import a, u_t

q, s, A, A_h, near, radius_ratio, ratio = sp.symbols(
    "q s A A_h near radius_ratio ratio", positive=True
)
lift, slope, quotient, peak_ratio, energy, rate = sp.symbols(
    "lift slope quotient peak_ratio energy rate", positive=True
)
F, extra, by_first, square, inner, relative_work = sp.symbols(
    "F extra by_first square inner relative_work", positive=True
)
added, goal, known, mean, left, short, rise = sp.symbols(
    "added goal known mean left short rise", positive=True
)


NUMBERS = orders()
"""Indices n of the D_n in the proofs."""


def lifted(at: sp.Expr) -> sp.Expr:
    """Return 1 + F."""
    return sp.Add(*(weight(n) * at ** (n - 2) for n in NUMBERS))


def sloped(at: sp.Expr) -> sp.Expr:
    """Return A F'."""
    return at * sp.diff(lifted(s), s).subs(s, at)


def work(at: sp.Expr) -> sp.Expr:
    """Return the work up to q, over C a_m^5."""
    return sp.integrate(sp.expand(s**3 * sp.diff(s**2 * lifted(s), s)), (s, 0, at))


def _left(at: sp.Expr) -> sp.Expr:
    """Return (W(1) - W(q))/(1 - q)."""
    return sp.cancel((work(sp.Integer(1)) - work(at)) / (1 - at))


WHOLE = work_of_contact()
SHAPE: Facts = {
    lift: lifted(q),
    slope: sloped(q),
    quotient: _left(q),
    peak_ratio: lifted(sp.Integer(1)),
    energy: WHOLE,
}
"""Quantities in the code at one point of an impact."""


@named_routine
def shapes() -> Claims:
    """Return (1 + F)/(1 + F_m), d(delta/delta_m)/dq and (1 - E/E_m)/(1 - q)."""
    return Claims(
        (q, lift, slope, quotient, peak_ratio, energy),
        (),
        (lift / peak_ratio, q * (2 * lift + slope) / peak_ratio, quotient / energy),
        (
            lifted(q) / lifted(sp.Integer(1)),
            sp.diff(q**2 * lifted(q), q) / lifted(sp.Integer(1)),
            (1 - work(q) / work(sp.Integer(1))) / (1 - q),
        ),
        SHAPE,
    )


@named_routine
def time_density() -> Claims:
    """Return dt/dw in units of delta_m/v0, w = 1 - sqrt(1 - q)."""
    at = 1 - u_t**2
    meaning: Facts = {
        rate: sp.diff(s**2 * lifted(s), s).subs(s, at) / lifted(sp.Integer(1)),
        quotient: _left(at) / WHOLE,
    }
    claim = sp.sqrt(WHOLE) / lifted(sp.Integer(1)) * contact_time()[0].expression
    return Claims((rate, quotient), (), (2 * rate / sp.sqrt(quotient),), (claim,), meaning)


@named_routine
def near_quotient() -> Claims:
    """Return (E_near - E)/((1 - s) A_near^5) from the first of the tails, and the sum of others."""
    first, rest, cube, fourth = sp.symbols("first rest cube fourth", positive=True)
    terms = [sp.Rational(n, n + 3) * weight(n) for n in NUMBERS[1:]]
    tails = [sp.Add(*terms[k:]) for k in range(len(terms))]
    return Claims(
        (s, first, rest),
        (
            Let(square, s**2),
            Let(cube, square * s),
            Let(fourth, 1 + s * (1 + s * (1 + s * (1 + s)))),
            Let(by_first, first * (fourth + cube * square)),
        ),
        (2 * fourth / 5 + by_first + cube**2 * (1 + s) * rest,),
        (sp.Add(*(sp.Rational(n, n + 3) * weight(n) * geometric(n + 3, s) for n in NUMBERS)),),
        {
            first: tails[0],
            rest: sp.Add(*(t * s ** (2 * k) for k, t in enumerate(tails[1:]))),
        },
    )


@named_routine
def work_factor() -> Claims:
    """Return the contribution of D_n to the work, over D_n."""
    n = sp.Symbol("n", positive=True)
    claim = sp.integrate(s ** (n + 2), (s, 0, 1)) * n
    return Claims((n,), (), (n / (n + 3),), (claim,), {})


@named_routine
def whole_work() -> Claims:
    """Return E/A^5 from the plate's contribution in addition to Hertz's."""
    return Claims(
        (extra,), (), (extra + sp.Rational(2, 5),), (WHOLE,), {extra: WHOLE - work_of_contact(0)}
    )


@named_routine
def ratio_of_work() -> Claims:
    """Return A over Hertz's radius, from the plate's contribution to E/A^5 at A."""
    return Claims(
        (extra,),
        (),
        ((1 + 5 * extra / 2) ** sp.Rational(-1, 5),),
        ((work_of_contact(0) / WHOLE) ** sp.Rational(1, 5),),
        {extra: WHOLE - work_of_contact(0)},
    )


def _in_radius(expression: sp.Expr, at: sp.Expr = A) -> sp.Expr:
    """Return the expression with D_n = c_(n-2) A^(n-2); the symbols D_n are values at A = 1."""
    return expression.subs({weight(n): weight(n) * at ** (n - 2) for n in NUMBERS[1:]})


ENERGY = A**5 * _in_radius(WHOLE)
"""Work up to A, over (4/3) E* h^5/R^2."""
DENSITY = A * sp.diff(ENERGY, A) / A**5


@named_routine
def deeper_step() -> Claims:
    """Return the work over that at A, minus 1, and the relative increase of A in the step."""
    residual, exponent = sp.symbols("residual exponent", positive=True)
    missing = work_of_contact(0) * A_h**5 / ENERGY - 1
    power = ENERGY / (A * sp.diff(ENERGY, A))
    step = sp.series((1 + residual) ** exponent - 1, residual, 0, 3).removeO()
    plain = _in_radius(WHOLE) - work_of_contact(0)
    return Claims(
        (radius_ratio, extra, slope),
        (
            Let(relative_work, extra + sp.Rational(2, 5)),
            Let(square, radius_ratio**2),
            Let(residual, 2 / (5 * (square * (square * radius_ratio))) / relative_work - 1),
            Let(exponent, relative_work / (5 * relative_work + slope)),
            Let(inner, residual * (exponent - 1) / 2),
        ),
        (residual, exponent * residual * (1 + inner)),
        (missing, step.subs({residual: missing, exponent: power})),
        {radius_ratio: A / A_h, extra: plain, slope: A * sp.diff(plain, A)},
    )


@named_routine
def work_density() -> Claims:
    """Return P d delta/dq over C a_m^5."""
    return Claims(
        (q, F, slope),
        (Let(square, q**2),),
        (square**2 * (2 * (1 + F) + slope),),
        (q**3 * sp.diff(q**2 * lifted(q), q),),
        {F: lifted(q) - 1, slope: sloped(q)},
        sp.expand,
    )


_E, _E_near = sp.symbols("E E_near", positive=True)
_E_m = sp.Symbol("E_m", positive=True)


@named_routine
def far_quotient() -> Claims:
    """Return (E_m - E)/((1 - q) A^5) from its value at the first polynomial's end, q = ratio."""
    return Claims(
        (quotient, short, left, ratio, rise),
        (),
        ((quotient * short * ratio**4 + rise) / left,),
        ((_E_m - _E) / ((1 - q) * A**5),),
        {
            quotient: (_E_near - _E) / ((1 - q / ratio) * (ratio * A) ** 5),
            short: ratio - q,
            left: 1 - q,
            rise: (_E_m - _E_near) / A**5,
        },
    )


@named_routine
def work_beyond() -> Claims:
    """Return (E - E_near)/A^5 from the mean of the work's density between A_near/A and 1."""
    return Claims(
        (A, near, mean),
        (),
        ((A - near) / A * mean,),
        ((_E - _E_near) / A**5,),
        {mean: (_E - _E_near) / A**5 / (1 - near / A)},
    )


@named_routine
def far_work() -> Claims:
    """Return E from its value at A_near and its increase up to A over A^5."""
    return Claims(
        (known, A, rise),
        (),
        (known + A**5 * rise,),
        (_E,),
        {known: _E_near, rise: (_E - _E_near) / A**5},
    )


@named_routine
def far_step() -> Claims:
    """Return A^5, the missing work over it, and the relative increase of A in the step."""
    residual, fifth = sp.symbols("residual fifth", real=True)
    claim = (goal - ENERGY) / A**5
    plain = _in_radius(lifted(sp.Integer(1))) - 1
    return Claims(
        (A, goal, known, rise, F, slope),
        (Let(fifth, A**5), Let(residual, (goal - known) / fifth - rise)),
        (fifth, residual, residual / (2 * (1 + F) + slope)),
        (A**5, claim, claim / DENSITY),
        {rise: (ENERGY - known) / A**5, F: plain, slope: A * sp.diff(plain, A)},
        sp.cancel,
    )


@named_routine
def far_whole() -> Claims:
    """Return E/A^5 from that at A_near = ratio A and the added work over A^5."""
    return Claims(
        (inner, ratio, added),
        (),
        (inner * ratio**5 + added,),
        (_E / A**5,),
        {inner: _E_near / (ratio * A) ** 5, added: (_E - _E_near) / A**5},
    )


@named_routine
def state() -> Claims:
    """Return indentation, velocity and force over their largest values; v is sqrt(1 - q)."""
    root_left = sp.Symbol("v", positive=True)
    return Claims(
        (q, root_left, lift, quotient),
        (Let(square, q**2),),
        (square * lift, root_left * sp.sqrt(quotient), square * q),
        (
            q**2 * lifted(q) / lifted(sp.Integer(1)),
            sp.sqrt(1 - work(q) / work(sp.Integer(1))),
            contact_radius().expression.subs(a, q * a) / contact_radius().expression,
        ),
        {
            root_left: sp.sqrt(1 - q),
            lift: lifted(q) / lifted(sp.Integer(1)),
            quotient: _left(q) / WHOLE,
        },
        lambda e: e.subs(q, 1 / (1 + s)),
    )


ROUTINES = (
    shapes,
    time_density,
    near_quotient,
    work_factor,
    whole_work,
    ratio_of_work,
    deeper_step,
    work_density,
    far_quotient,
    work_beyond,
    far_work,
    far_step,
    far_whole,
    state,
    peak_ratios,
    hertz_impact,
    number_of_energy,
)


def impact_kernels() -> Routines:
    """Return the routines of an impact by the contact law, printed from proved expressions."""
    title = "An impact by the contact law: normalised time history and largest values."
    made = tuple(make() for make in ROUTINES)
    imports = {"ranges": ("product", "root", "root_factors")}
    return Routines("impact_kernels", title, made, imports)
