"""Named materials: constants with sources, and look-up by name."""

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from derivation.engine.nearest import nearest
from derivation.scene.input.messages import shown


@dataclass(frozen=True)
class KnownMaterial:
    """An isotropic elastic material.

    Attributes
    ----------
    name
        Name in the catalogue, or in the scene that defines it.
    youngs_modulus, poissons_ratio
        Young's modulus [Pa] and Poisson's ratio [1].
    lam, mu
        Lame constants [Pa].
    density
        Density [kg/m^3]; None if the source gives none.
    yield_stress
        Yield stress [Pa]; None if the source gives none.
    retardation_time
        Retardation time of the material [s]; None if it is elastic.
    source
        Source of the constants; empty if none is given.
    also
        Other names.
    """

    name: str
    youngs_modulus: float
    poissons_ratio: float
    lam: float
    mu: float
    density: float | None = None
    yield_stress: float | None = None
    retardation_time: float | None = None
    source: str = ""
    also: tuple[str, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """Return the constants in SI units, without those that the source does not give."""
        constants = {
            "name": self.name,
            "youngs_modulus": self.youngs_modulus,
            "poissons_ratio": self.poissons_ratio,
            "density": self.density,
            "yield_stress": self.yield_stress,
            "retardation_time": self.retardation_time,
            "source": self.source,
            "also": list(self.also),
        }
        return {key: value for key, value in constants.items() if value is not None}


def lame_constants(E: float, nu: float) -> tuple[float, float]:
    """Return both Lame constants [Pa] from Young's modulus [Pa] and Poisson's ratio [1]."""
    mu = E / (2 * (1 + nu))
    return 2 * mu * nu / (1 - 2 * nu), mu


def engineering_constants(lam: Any, mu: Any) -> tuple[Any, Any]:
    """Return Young's modulus [Pa] and Poisson's ratio [1] from the Lame constants [Pa]."""
    return mu * (3 * lam + 2 * mu) / (lam + mu), poissons_ratio(lam, mu)


def poissons_ratio(lam: float, mu: float) -> float:
    """Return Poisson's ratio [1] from the Lame constants [Pa]."""
    return lam / (2.0 * (lam + mu))


def plane_strain_modulus(lam: float, mu: float) -> float:
    """Return E* = E/(1 - nu^2) = 4 mu (lam + mu)/(lam + 2 mu) [Pa]."""
    return 4.0 * mu * ((lam + mu) / (lam + 2.0 * mu))


def material_of(name: str, keys: Mapping[str, Any]) -> KnownMaterial:
    """Return a material from a table with E and nu or, in the catalogue, Lame constants."""
    if "lame_mu" in keys:
        lam, mu = keys["lame_lambda"], keys["lame_mu"]
        E, nu = engineering_constants(lam, mu)
    else:
        E, nu = keys["youngs_modulus"], keys["poissons_ratio"]
        lam, mu = lame_constants(E, nu)
    rest = ("density", "yield_stress", "retardation_time")
    known = {key: keys.get(key) for key in rest}
    also = tuple(keys.get("also", ()))
    return KnownMaterial(name, E, nu, lam, mu, **known, source=keys.get("source") or "", also=also)


def _catalogue() -> dict[str, KnownMaterial]:
    with Path(__file__).with_suffix(".toml").open("rb") as stream:
        return {name: material_of(name, keys) for name, keys in tomllib.load(stream).items()}


MATERIALS = _catalogue()
"""The built-in materials by name."""


def plain(name: str) -> str:
    """Return a name in lower case without spaces, hyphens and underscores."""
    return name.casefold().translate({ord(c): None for c in " -_"})


_BY_PLAIN = {plain(name): m for m in MATERIALS.values() for name in (m.name, *m.also)}

ALIKE = 0.7
"""Similarity from which a material is suggested; with less, a tile would be taken for ice."""
HOLLOW = {
    plain(name)
    for name in (
        "tennis ball", "table tennis ball", "ping-pong ball", "squash ball", "football",
        "soccer ball", "basketball", "volleyball", "handball", "rugby ball", "water polo ball",
        "beach ball", "balloon",
    )
}  # fmt: skip
"""Names of hollow balls."""


def find(name: str, materials: Mapping[str, KnownMaterial] | None = None) -> KnownMaterial | None:
    """Return a material by name, from the scene or else from the catalogue; None if unknown.

    Parameters
    ----------
    name
        Name or other name; case, spaces, hyphens and underscores do not matter.
    materials
        Materials that a scene defines, by name.
    """
    of_scene = {plain(known): material for known, material in (materials or {}).items()}
    return of_scene.get(plain(name)) or _BY_PLAIN.get(plain(name))


def unknown(name: str, materials: Iterable[str] = ()) -> str:
    """Return the message for an unknown material, with the nearest name; hollow balls differ."""
    if plain(name) in HOLLOW or "hollow" in plain(name):
        return (
            f"expected the material of a solid sphere, got {shown(name)}, which is hollow; the "
            "model does not include the bending of a shell"
        )
    names = {key: material.name for key, material in _BY_PLAIN.items()}
    names |= {plain(known): known for known in materials}
    suggestions = nearest(plain(name), names, ALIKE)
    meant = f"did you mean {names[suggestions[0]]}? " if suggestions else ""
    return (
        f"expected the name of a material, got {shown(name)}; {meant}`platecontact materials` "
        "lists them, and a table [materials.NAME] in the scene file defines another one"
    )
