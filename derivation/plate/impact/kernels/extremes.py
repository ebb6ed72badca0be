"""Largest values of an impact, proved: by Hertz's law, and relative to these."""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Several
from derivation.plate.contact.kernels.law import MODULUS, root
from derivation.plate.contact.theory.hertz import contact_radius
from derivation.plate.impact.theory.impact import work_of_contact
from derivation.plate.impact.theory.sensitivity import energy_number
from derivation.plate.vocabulary import R, a, h, m, mu, v0

radius_ratio, lift, modulus = sp.symbols("radius_ratio lift modulus", positive=True)


@named_routine
def peak_ratios() -> Claims:
    """Return largest indentation and force over those by Hertz's law, by the ratio of the radii."""
    return Claims(
        (radius_ratio, lift),
        (),
        (radius_ratio**2 * lift, radius_ratio**3),
        (
            (radius_ratio * a) ** 2 / R * lift / (a**2 / R),
            contact_radius().expression.subs(a, radius_ratio * a) / contact_radius().expression,
        ),
        {},
    )


@named_routine
def hertz_impact() -> Claims:
    """Return the largest radius by Hertz's law; indentation and force as three factors each."""
    one, brought = sp.Integer(1), (sp.Rational(5, 4), m, v0, v0)
    radius = sp.Symbol("radius", positive=True)
    C = contact_radius().expression / a**3 / R
    fifth = m * v0**2 / 2 / (C * work_of_contact(0))
    largest = fifth ** sp.Rational(1, 5)
    force = contact_radius().expression.subs(a, largest)

    def factors(letter: str, above: tuple[sp.Expr, ...], below: tuple[sp.Expr, ...]) -> Several:
        exact = (sp.Mul(*above) / sp.Mul(*below)) ** sp.Rational(1, 5)
        names = sp.symbols(f"{letter}1:4", positive=True)
        divisors = (sp.Tuple(*below),) if below else ()
        given = (sp.Integer(5), sp.Tuple(*above), *divisors)
        return Several(names, "root_factors", given, (exact, one, one))

    depth = factors("depth", brought * 2, (mu, modulus, mu, modulus, R))
    load = factors("load", (*brought * 3, R, mu, modulus, mu, modulus), ())
    return Claims(
        (R, m, v0, mu, modulus),
        (root(radius, 5, (*brought, R, R), mu, modulus), depth, load),
        (radius, *depth.symbols, *load.symbols),
        (largest, largest**2 / R, one, one, force, one, one),
        {modulus: MODULUS},
        lambda e: sp.powsimp(sp.powdenest(sp.expand_power_base(e, force=True), force=True)),
    )


@named_routine
def number_of_energy() -> Claims:
    """Return the impact energy over (4/3) E* h^5/R^2."""
    number = sp.Symbol("number", positive=True)
    above = sp.Rational(1, 2), m, v0, v0, R, R
    below = mu, modulus, h, h, h, h, h
    exact = sp.Mul(*above) / sp.Mul(*below)
    given = sp.Tuple(*above), sp.Tuple(*below)
    return Claims(
        (R, m, v0, h, mu, modulus),
        (Several((number,), "product", given, (exact,)),),
        (number,),
        (energy_number().expression,),
        {modulus: MODULUS},
    )
