"""Random points in the domain of every function, for the search.

The dimensionless variables x = phi h, y = a phi, h/b, a/h, z/h, r/b, nu are drawn. Most are
uniform over the floats, not over the numbers, so that all decades are equally likely, and
they are converted to arguments in random units.
"""

import math
from collections.abc import Sequence
from random import Random
from typing import Any

from derivation.engine.formula.ulp import from_ordinal, ordinal
from derivation.engine.measure.point import Point
from derivation.engine.measure.target import Domain
from derivation.plate.impact.oracle.agreement import FIRST
from derivation.plate.impact.oracle.impact import stored_energy

WHOLE = ("count", "n", "k")
"""Arguments that are integers."""

LAW = ("indentation", "contact_radius", "stiffness", "force_of_radius", "impact")
"""Functions of the contact law, which are not in the manifest."""

WAVES = 1e-150, 1e6
"""Range of phi h and a phi."""

THICKNESSES = 1e-4, 1e2
"""Range of h/b."""

CONTACTS = 1e-8, 6.0
"""Range of a/h."""

NEAR = 1e3, 10.0
"""Factors around 1, near the switch points, within which about 2/3 of the points lie."""

LENGTH, STRESS, MASS, FORCE = 9.0, 12.0, 9.0, 12.0
"""Decades to either side of 1 from which units and magnitudes are drawn."""

MOST_MODES = 60
LAST = {"kappa": 200.0, "finite_part": 105.0, "bessel": 1e5}
"""Largest indices: above the first two the value exceeds the range of doubles; above the last
tables are long."""

_SEARCHED = (
    "1e-150 <= phi * h <= 1e6",
    "1e-150 <= a * phi <= 1e6",
    "1e-150 <= T <= 2e6",
    "abs(x) <= 1e8",
    "1e-4 <= h / b <= 1e2",
    "1e-8 <= a / h <= 6.0",
    "1 <= count <= 1e5",
    "n <= 2e6",
    "k <= 2e6",
)
_OF_LAW = (
    "a > 0", "a < b", "a < R", "R > 0", "h > 0", "b > 0", "3 * lam > -2 * mu", "mu > 0",
    "delta > 0", "m > 0", "v0 > 0",
)  # fmt: skip
_TRIES = 1000
_DIGITS = 20


def domain_of(
    name: str, arguments: Sequence[str], modes: bool, conditions: Sequence[str]
) -> Domain:
    """Return the domain of a function within the searched ranges."""
    whole = arguments[0] in WHOLE
    return Domain(name, tuple(arguments), modes, (*conditions, *_SEARCHED), whole)


def domain_of_row(row: Any) -> Domain:
    """Return the domain that a row of the manifest states."""
    conditions = tuple(part.strip() for part in row["domain"].split(",") if part.strip())
    return domain_of(row["name"], row["arguments"], bool(row["modes"]), conditions)


def domain_of_law(name: str, arguments: Sequence[str]) -> Domain:
    """Return the domain of a function of the contact law."""
    return domain_of(name, arguments, False, _OF_LAW)


# --- drawing


def draw(domain: Domain, generator: Random) -> Point:
    """Return a random point of the domain.

    Raises
    ------
    ValueError
        If no point is found after _TRIES trials.
    """
    for _ in range(_TRIES):
        values = _values(domain, generator)
        modes = int(_between(generator, 1.0, MOST_MODES)) if domain.modes else None
        point = Point({name: values[name] for name in domain.arguments}, modes)
        if domain.holds(point):
            return point
    raise ValueError(f"no point found in the domain of {domain.name}")


def _values(domain: Domain, generator: Random) -> dict[str, float]:
    if domain.whole:
        return {domain.arguments[0]: _index(domain.name, generator)}
    if domain.arguments == ("x",):
        return {"x": generator.choice((-1, 1)) * _between(generator, 1e-150, 1e8)}
    values = _sizes(generator, "phi" in domain.arguments)
    if domain.name == "contact_radius":
        shape: list[Any] = [values[key] for key in ("a", "R", "h", "b")]
        values["delta"] = float(FIRST["indentation"](*shape, digits=_DIGITS))
    if domain.name == "impact":
        a, R, h, b, lam, mu = (values[key] for key in ("a", "R", "h", "b", "lam", "mu"))
        energy = float(stored_energy(a, R, h, b, lam, mu, _DIGITS))
        values["m"] = _unit(generator, MASS)
        values["v0"] = math.sqrt(2.0 * energy / values["m"])
    return values


def _index(name: str, generator: Random) -> float:
    """Return an integer index; small ones are as likely as large ones."""
    first = 2 if name.startswith("finite_part") else 0 if name.startswith("kappa") else 1
    last = next((end for start, end in LAST.items() if name.startswith(start)), 1e6)
    if name.endswith("_ratio"):
        last = 1e6
    return float(int(_between(generator, 1.0, last)) - 1 + first)


def _sizes(generator: Random, of_mode: bool) -> dict[str, float]:
    """Return every quantity that may be an argument; for a mode, phi follows from h or a."""
    wave, b = _between(generator, *WAVES), _unit(generator, LENGTH)
    h = b * _between(generator, *THICKNESSES)
    widest = min(CONTACTS[1] * h, b)
    a = h * _between(generator, *CONTACTS)
    if a >= widest or generator.random() < 0.25:
        a = min(widest * _fraction(generator), math.nextafter(widest, 0.0))
    mu = _unit(generator, STRESS)
    nu = _poisson(generator)
    sign = generator.choice((-1, 1))
    values = {
        "T": 2 * wave,
        "phi": wave / h,
        "h": h,
        "b": b,
        "a": a,
        "R": a / _fraction(generator),
        "r": generator.choice((0.0, b, b * _fraction(generator), b * _fraction(generator))),
        "z": sign * h * generator.choice((0.0, 1.0, *(_fraction(generator) for _ in range(6)))),
        "mu": mu,
        "lam": 2 * mu * nu / (1 - 2 * nu),
        "P": _unit(generator, FORCE),
        "A_j": sign * mu * _unit(generator, FORCE),
        "J1": generator.choice((-1, 1)) * _between(generator, 1e-6, 0.6),
    }
    if of_mode and generator.random() < 0.5:
        values["phi"] = wave / a
    return values


def _between(generator: Random, low: float, high: float) -> float:
    """Return a float of a range, uniform over the floats; often one near 1 if 1 is inside."""
    parts = [(low, high)]
    parts += [(max(low, 1 / w), min(high, w)) for w in NEAR if low < 1 < high]
    first, last = generator.choice(parts)
    return from_ordinal(generator.randint(ordinal(first), ordinal(last)))


def _fraction(generator: Random) -> float:
    """Return a number in (0, 1): any, a float near 0, or one near 1."""
    fraction = from_ordinal(generator.randint(ordinal(2.0**-53), ordinal(0.5)))
    return generator.choice((generator.uniform(2.0**-20, 1.0), fraction, 1.0 - fraction))


def _poisson(generator: Random) -> float:
    """Return Poisson's ratio in (-1, 1/2); its ends and 0 are as likely as the middle."""
    ratio = from_ordinal(generator.randint(ordinal(2.0**-52), ordinal(0.25)))
    signed = generator.choice((-1, 1)) * ratio
    return generator.choice((generator.uniform(-1.0, 0.5), -1.0 + ratio, 0.5 - ratio, signed))


def _unit(generator: Random, decades: float) -> float:
    return float(10.0 ** generator.uniform(-decades, decades))
