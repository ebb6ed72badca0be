"""Test points of the contact law's functions: thin and thick plates, small and wide contacts."""

import math
import random
from typing import NamedTuple

from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import forces as contact_forces
from derivation.plate.impact.oracle import impact as contact_impact

ROOT = 0.5301974990742511
"""The double nearest to the h/b at which c_1 passes zero."""

THICKNESSES = (
    1e-4, 1e-3, 1e-2, 0.05, 0.0908, 0.0911, 0.1, 0.3, 0.3332, 0.3335, ROOT, 0.6, 1.0, 3.0, 10.0,
    100.0,
)  # fmt: skip
"""h/b, including both sides of 1/11 and 1/3, where the functions change their method."""

RATIOS = (1e-8, 1e-5, 1e-2, 0.1, 0.48, 0.52, 1.0, 2.0, 2.95, 3.1, 4.1, 6.0)
"""a/h, including both sides of 1/2 and 3, where the functions change their method, and of 4, the
radius of convergence of the series in a/h."""

JITTER = 0.97
"""Ratios are drawn between this fraction of their value and the value."""

WIDE = (0.9, 0.999)
"""The largest a/b is drawn between these two values; wider contacts are reduced to it."""

LENGTHS = (1.0, 1e-3, 25.4, 640.0)

IMPACTS = (
    (6.9e-6, 5.9999), (7e-6, 3.01), (8e-6, 0.01), (2e-5, 2.99), (5e-5, 0.3), (1e-4, 5.99),
    (1e-4, 1e-6), (3e-4, 2.9), (1e-3, 4.1), (1e-3, 0.45), (1e-2, 5.9), (1e-2, 0.55), (0.03, 2.99),
    (0.04, 3.01), (0.09, 2.9), (0.092, 5.99), (0.1, 1e-8), (0.15, 5.9), (0.3, 3.1), (0.3, 2.9),
    (0.33, 3.01), (0.34, 2.9), (0.5, 0.6), (ROOT, 0.05), (ROOT, 1.0), (ROOT, 1.85), (0.6, 1.6),
    (1.0, 0.5), (1.0, 0.99), (3.0, 0.1), (3.0, 0.324), (3.0, 0.332), (10.0, 0.0985),
    (100.0, 1e-6), (100.0, 0.005), (100.0, 0.0097), (100.0, 0.00999),
)  # fmt: skip
"""h/b and largest a/h of the impacts: c_1 A from -0.369 to 1.0e10."""

PAPER_IMPACT = (0.13, 72.2, 1.0, 0.1, 1.0, 0.36e9, 0.43e9)
"""R, m, v0, h, b, lam, mu of the paper's example."""

Point = tuple[float, ...]


class ContactShape(NamedTuple):
    """A contact, and the arguments that lead to it."""

    a: float
    R: float
    h: float
    b: float
    lam: float
    mu: float
    m: float


def grid(name: str) -> tuple[ContactShape, ...]:
    """Return the contacts at which a function is measured, the same in every run."""
    generator = random.Random(name)
    if name == "impact":
        return tuple(_random_contact(generator, i, *case) for i, case in enumerate(IMPACTS))
    shapes = []
    for i, eta in enumerate(THICKNESSES):
        for k, ratio in enumerate(RATIOS):
            narrowed = ratio * generator.uniform(JITTER, 1.0)
            widest = generator.uniform(*WIDE) / eta
            shapes.append(_random_contact(generator, i + k, eta, min(narrowed, widest)))
    return tuple(shapes)


def _random_contact(generator: random.Random, i: int, eta: float, ratio: float) -> ContactShape:
    """Return a contact of given h/b and a/h in a plate of some size and material."""
    b = LENGTHS[i % len(LENGTHS)] * generator.uniform(0.5, 2.0)
    R = b * generator.uniform(1.5, 60.0)
    mu = 10 ** generator.uniform(0.0, 11.0)
    lam = mu * generator.uniform(-0.6, 50.0)
    m = 10 ** generator.uniform(-3.0, 3.0)
    return ContactShape(b * eta * ratio, R, b * eta, b, lam, mu, m)


def arguments(name: str, shape: ContactShape, digits: int) -> Point:
    """Return the arguments for which a function gives this contact, up to their rounding."""
    a, R, h, b, lam, mu, m = shape
    if name == "indentation":
        return (a, R, h, b)
    if name == "stiffness":
        return (a, R, h, b, lam, mu)
    if name in ("force_of_radius", "max_pressure"):
        return (a, R, lam, mu)
    if name == "radius_of_force":
        return (float(contact_forces.force_of_radius(a, R, lam, mu, digits)), R, lam, mu)
    if name in ("contact_radius", "force"):
        delta = float(contact_balls.indentation(a, R, h, b, digits))
        return (delta, R, h, b) if name == "contact_radius" else (delta, R, h, b, lam, mu)
    energy = float(contact_impact.stored_energy(a, R, h, b, lam, mu, digits))
    return (R, m, math.sqrt(2.0 * energy / m), h, b, lam, mu)
