"""Finds stated values that no solid has, which are probably given in other units than SI.

Scenes in other consistent units are valid; therefore these are warnings, not errors. A message of a
scene that cannot be simulated begins with them, because a wrong unit is then the likely cause.
"""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene import scales
from derivation.scene.errors import SceneError
from derivation.scene.input.keys import unit_of
from derivation.scene.input.materials import find, plain
from derivation.scene.input.messages import OWN_MATERIALS
from derivation.scene.scene import Scene

SOFTEST, STIFFEST = 1e4, 1.3e12
"""Elastic moduli of solids [Pa], from soft gels to diamond."""
LIGHTEST, DENSEST = 10.0, 2.3e4
"""Densities of solids [kg/m^3], from foams to osmium."""
SLOWEST, FASTEST = 10.0, 2e4
"""Speeds sqrt(E/rho) [m/s], from gels to diamond. With a modulus in MPa or a density in g/cm^3 the
speed is outside this range, even if the value itself is within its own range."""
WEAKEST, STRONGEST = 1e-6, 0.2
"""Yield stress or strength over Young's modulus [1]."""
BALL, PLATE, FAST = 2.0, 100.0, 1000.0
"""Largest radii of a sphere and a plate [m], and impact speed [m/s]."""
THICK = 4.0
"""Largest thickness of a plate over its radius; blocks that act as half-spaces are thinner."""
GRAMS = 500.0, 2000.0
"""Mass over that of a solid sphere of its material if it is given in grams [1]."""

MODULI = {"GPa": 1e9, "MPa": 1e6}
DENSITIES = {"g/cm^3": 1e3, "t/mm^3": 1e12}
LENGTHS = {"mm": 1e-3}
Array = NDArray[np.float64]
Stated = Mapping[str, Any]
"""Given numbers by key `table.key`: floats, or columns of the same length."""


class UnusualValue(NamedTuple):
    """A given value that no solid or usual scene has, probably because of its unit.

    Attributes
    ----------
    key
        Key as the user writes it.
    unusual
        Whether the value is unusual, or in which rows.
    problem
        What solids or usual scenes have instead.
    others
        Units that may be meant, with their size in SI units.
    least, most
        Limits of the value in SI units if one of the other units is meant.
    """

    key: str
    unusual: Any
    problem: str
    others: Mapping[str, float]
    least: Any = 0.0
    most: Any = np.inf

    def in_words(self, stated: Stated, row: int | None = None) -> str:
        """Return a sentence with the value in SI units for each unit that may be meant."""
        value, least, most = (
            float(x if row is None else np.broadcast_to(x, np.shape(self.unusual))[row])
            for x in (stated[self.key], self.least, self.most)
        )
        meant = [
            f"{name}, write {value * size:.6g}"
            for name, size in self.others.items()
            if least <= value * size <= most
        ]
        advice = f"if the value is in {', and if it is in '.join(meant)}" if meant else "check it"
        return f"{self.key} = {value:.6g} {unit_of(self.key)} {self.problem}; {advice}"


@np.errstate(all="ignore")
def unit_warnings(scene: Scene) -> tuple[str, ...]:
    """Return a sentence for each stated value that is probably given in another unit."""
    stated = stated_in(scene)
    return tuple(value.in_words(stated) for value in unusual_values(scene, stated) if value.unusual)


def with_unit_warnings(error: SceneError, warnings: tuple[str, ...]) -> SceneError:
    """Return the error of a scene after the warnings on units, which are its likely cause.

    Each begins on a line of its own.
    """
    return SceneError("\n  ".join((*warnings, str(error))))


@np.errstate(all="ignore")
def unit_warnings_of_rows(scene: Scene, columns: Mapping[str, Array]) -> dict[int, tuple[str, ...]]:
    """Return the `unit_warnings` of each row that has some.

    Parameters
    ----------
    scene
        The scene of one of the rows; all rows give the same keys.
    columns
        Numbers by key, a row for each scene.
    """
    stated, found = stated_in(scene) | dict(columns), dict[int, tuple[str, ...]]()
    count = len(next(iter(columns.values())))
    for value in unusual_values(scene, stated):
        unusual = np.broadcast_to(value.unusual, (count,))
        for row in np.flatnonzero(unusual).tolist():
            text = value._replace(unusual=unusual).in_words(
                {value.key: np.broadcast_to(stated[value.key], (count,))}, row
            )
            found[row] = (*found.get(row, ()), text)
    return found


def stated_in(scene: Scene) -> dict[str, Any]:
    """Return the given numbers of bodies, impact and used own materials by key."""
    found = dict[str, Any]()
    for name in ("sphere", "plate", "impact"):
        table = getattr(scene, name)
        found |= {f"{name}.{key}": getattr(table, key) for key in table.model_fields_set}
    for name, own in scene.materials.items():
        keys = own.model_fields_set
        found |= {f"{OWN_MATERIALS}.{name}.{key}": getattr(own, key) for key in keys}
    # Powers of Python's floats raise an error if they overflow.
    return {k: np.float64(x) for k, x in found.items() if isinstance(x, int | float)}


def unusual_values(scene: Scene, stated: Stated) -> Iterator[UnusualValue]:
    """Yield each value that is compared with usual ones, unusual or not."""
    for name in ("sphere", "plate"):
        material = getattr(scene, name).material
        yield from _of_constants(
            name, stated, _of_material(material, "youngs_modulus", scene, stated)
        )
    for own in scene.materials:
        yield from _of_constants(f"{OWN_MATERIALS}.{own}", stated)
    yield from _of_sizes(scene, stated)


def _of_constants(
    name: str, stated: Stated, modulus: Array | float | None = None
) -> Iterator[UnusualValue]:
    """Yield the compared constants of a table; the modulus is that of a named material."""
    for key in (f"{name}.youngs_modulus", f"{name}.lame_mu"):
        if key in stated:
            modulus = stated[key]
            outside = (modulus < SOFTEST) | (modulus > STIFFEST)
            problem = f"is outside the range of solids, {SOFTEST:.0e} to {STIFFEST:.1e} Pa"
            limits = 10.0 * SOFTEST, STIFFEST
            yield UnusualValue(key, outside, problem, MODULI, *limits)
            if f"{name}.density" in stated:
                density = stated[f"{name}.density"]
                slow = (modulus < SLOWEST**2 * density) & (density <= DENSEST)
                problem = "is too small for a solid of this density"
                yield UnusualValue(key, ~np.asarray(outside) & slow, problem, MODULI, *limits)
    key = f"{name}.density"
    if key in stated:
        density = stated[key]
        unusual = unusual_density(density, modulus)
        problem = "is outside the range of solids with this elastic modulus"
        if modulus is None:
            problem = f"is outside the range of solids, {LIGHTEST:g} to {DENSEST:g} kg/m^3"
        yield UnusualValue(key, unusual, problem, DENSITIES, LIGHTEST, DENSEST)
    for key in (f"{name}.yield_stress", f"{name}.tensile_strength"):
        if key in stated and modulus is not None:
            problem = "is too small for a solid with this elastic modulus"
            least, most = WEAKEST * modulus, STRONGEST * modulus
            yield UnusualValue(key, stated[key] < least, problem, MODULI, least, most)


def unusual_density(density: Any, modulus: Any = None) -> Any:
    """Return whether no solid has a density [kg/m^3], or has it with a Young's modulus [Pa]."""
    unusual = (density < LIGHTEST) | (density > DENSEST)
    if modulus is None:
        return unusual
    # Foams are as light, but soft.
    stiff = (density < DENSEST / 1e3) & (modulus > FASTEST**2 * density)
    return unusual | (stiff & (modulus <= STIFFEST))


def _of_sizes(scene: Scene, stated: Stated) -> Iterator[UnusualValue]:
    """Yield the lengths, the mass and the speed that are compared."""
    radius, wide = stated["sphere.radius"], stated["plate.radius"]
    for key, size, most in (("sphere.radius", radius, BALL), ("plate.radius", wide, PLATE)):
        in_mm = (size > most) & (size * LENGTHS["mm"] <= most)
        yield UnusualValue(key, in_mm, "is unusually large", LENGTHS)
    for key, factor in (("plate.thickness", 1.0), ("plate.half_thickness", 2.0)):
        if key in stated:
            thick = factor * stated[key] > THICK * wide
            yield UnusualValue(key, thick, "is large for a plate of this radius", LENGTHS)
    yield UnusualValue(
        "impact.speed", stated["impact.speed"] > FAST, "is unusually large", {"mm/s": 1e-3}
    )
    density = _of_material(scene.sphere.material, "density", scene, stated)
    if "sphere.mass" in stated and density is not None:
        ratio = stated["sphere.mass"] / (scales.volume(radius) * density)
        grams = (ratio > GRAMS[0]) & (ratio < GRAMS[1])
        problem = "is about 1000 times the mass of a solid sphere of its material"
        yield UnusualValue("sphere.mass", grams, problem, {"g": 1e-3})


def _of_material(name: str | None, key: str, scene: Scene, stated: Stated) -> Any:
    """Return a constant of a material [SI units]; None if it is unknown."""
    if name is None:
        return None
    for own in scene.materials:
        if plain(own) == plain(name):
            return stated.get(f"{OWN_MATERIALS}.{own}.{key}")
    return getattr(find(name), key, None)
