"""Finds stated values that no solid has, which are probably given in other units than SI.

Scenes in other consistent units are valid, so that these are warnings. A message of a scene that
cannot be simulated begins with them, because a wrong unit is then the likely cause.
"""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene.effects.effect import Array
from derivation.scene.materials import find, plain
from derivation.scene.messages import OWN_MATERIALS
from derivation.scene.scene import Scene, SceneError

SOFTEST, STIFFEST = 1e4, 1.3e12
"""Elastic moduli of solids [Pa], from soft gels to diamond."""
LIGHTEST, DENSEST = 10.0, 2.3e4
"""Densities of solids [kg/m^3], from foams to osmium."""
SLOWEST, FASTEST = 10.0, 2e4
"""Speeds sqrt(E/rho) [m/s], from gels to diamond. The speed of a modulus in MPa or of a density in
g/cm^3 is outside, where the value itself is not."""
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
Stated = Mapping[str, Any]
"""Given numbers by key `table.key`: floats, or columns of the same length."""


class Doubt(NamedTuple):
    """A stated value that may be given in another unit.

    Attributes
    ----------
    key
        Key as the user writes it.
    doubtful
        Whether the value is doubtful, or in which rows.
    unit
        SI unit of the key.
    why
        What solids or usual scenes have instead.
    others
        Units that may be meant, with their size in SI units.
    least, most
        Limits within which a value in the unit that is meant must be.
    """

    key: str
    doubtful: Any
    unit: str
    why: str
    others: Mapping[str, float]
    least: Any = 0.0
    most: Any = np.inf

    def in_words(self, stated: Stated, row: int | None = None) -> str:
        """Return the doubt as a sentence, with the value in SI units for each unit in question."""
        value, least, most = (
            float(x if row is None else np.broadcast_to(x, np.shape(self.doubtful))[row])
            for x in (stated[self.key], self.least, self.most)
        )
        meant = [
            f"{name}, write {value * size:.6g}"
            for name, size in self.others.items()
            if least <= value * size <= most
        ]
        advice = f"if the value is in {', and if it is in '.join(meant)}" if meant else "check it"
        return f"{self.key} = {value:.6g} {self.unit} {self.why}; {advice}"


@np.errstate(all="ignore")
def unit_warnings(scene: Scene) -> tuple[str, ...]:
    """Return a sentence for each stated value that is probably given in another unit."""
    stated = stated_in(scene)
    return tuple(doubt.in_words(stated) for doubt in doubts(scene, stated) if doubt.doubtful)


def doubted(error: SceneError, doubts: tuple[str, ...]) -> SceneError:
    """Return the error of a scene with doubts about its units, which are its likely cause."""
    return SceneError("; ".join((*doubts, str(error))))


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
    for doubt in doubts(scene, stated):
        doubtful = np.broadcast_to(doubt.doubtful, (count,))
        for row in np.flatnonzero(doubtful).tolist():
            text = doubt._replace(doubtful=doubtful).in_words(
                {doubt.key: np.broadcast_to(stated[doubt.key], (count,))}, row
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


def doubts(scene: Scene, stated: Stated) -> Iterator[Doubt]:
    """Yield the doubts about the stated values, whether they apply or not."""
    for name in ("sphere", "plate", *(f"{OWN_MATERIALS}.{own}" for own in scene.materials)):
        yield from _of_constants(name, stated)
    yield from _of_sizes(scene, stated)


def _of_constants(name: str, stated: Stated) -> Iterator[Doubt]:
    """Yield the doubts about the material constants of a table."""
    modulus: NDArray[np.float64] | float | None = None
    for key in ("youngs_modulus", "lame_mu"):
        place = f"{name}.{key}"
        if place in stated:
            modulus = stated[place]
            outside = (modulus < SOFTEST) | (modulus > STIFFEST)
            why = f"is outside the range of solids, {SOFTEST:.0e} to {STIFFEST:.1e} Pa"
            limits = 10.0 * SOFTEST, STIFFEST
            yield Doubt(place, outside, "Pa", why, MODULI, *limits)
            if f"{name}.density" in stated:
                slow = modulus < SLOWEST**2 * stated[f"{name}.density"]
                heavy = stated[f"{name}.density"] <= DENSEST
                why = "is too small for a solid of this density"
                yield Doubt(place, ~np.asarray(outside) & slow & heavy, "Pa", why, MODULI, *limits)
    place = f"{name}.density"
    if place in stated:
        density = stated[place]
        doubtful = (density < LIGHTEST) | (density > DENSEST)
        if modulus is not None:  # foams are as light, but soft
            stiff = (density < DENSEST / 1e3) & (modulus > FASTEST**2 * density)
            doubtful = doubtful | (stiff & (modulus <= STIFFEST))
        why = "is outside the range of solids with this elastic modulus"
        if modulus is None:
            why = f"is outside the range of solids, {LIGHTEST:g} to {DENSEST:g} kg/m^3"
        yield Doubt(place, doubtful, "kg/m^3", why, DENSITIES, LIGHTEST, DENSEST)
    for key in ("yield_stress", "tensile_strength"):
        place = f"{name}.{key}"
        if place in stated and modulus is not None:
            why = "is too small for a solid with this elastic modulus"
            least, most = WEAKEST * modulus, STRONGEST * modulus
            yield Doubt(place, stated[place] < least, "Pa", why, MODULI, least, most)


def _of_sizes(scene: Scene, stated: Stated) -> Iterator[Doubt]:
    """Yield the doubts about lengths, mass and speed."""
    radius, wide = stated["sphere.radius"], stated["plate.radius"]
    for key, size, most in (("sphere.radius", radius, BALL), ("plate.radius", wide, PLATE)):
        in_mm = (size > most) & (size * LENGTHS["mm"] <= most)
        yield Doubt(key, in_mm, "m", "is unusually large", LENGTHS)
    for key, factor in (("thickness", 1.0), ("half_thickness", 2.0)):
        place = f"plate.{key}"
        if place in stated:
            thick = factor * stated[place] > THICK * wide
            yield Doubt(place, thick, "m", "is large for a plate of this radius", LENGTHS)
    yield Doubt(
        "impact.speed", stated["impact.speed"] > FAST, "m/s", "is unusually large", {"mm/s": 1e-3}
    )
    density = _solid_density(scene, stated)
    if "sphere.mass" in stated and density is not None:
        ratio = stated["sphere.mass"] / (4.0 / 3.0 * np.pi * radius**3 * density)
        grams = (ratio > GRAMS[0]) & (ratio < GRAMS[1])
        why = "is about 1000 times the mass of a solid sphere of its material"
        yield Doubt("sphere.mass", grams, "kg", why, {"g": 1e-3})


def _solid_density(scene: Scene, stated: Stated) -> Any:
    """Return the density of the sphere's material [kg/m^3]; None if it is unknown."""
    name = scene.sphere.material
    if name is None:
        return None
    for own in scene.materials:
        if plain(own) == plain(name):
            return stated[f"{OWN_MATERIALS}.{own}.density"]
    known = find(name)
    return known.density if known is not None else None
