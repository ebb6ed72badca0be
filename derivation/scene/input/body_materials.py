"""Material constants of sphere and plate: those given in its table, else those of its material."""

import math
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from derivation.scene.input.bodies import Material, Plate, Sphere
from derivation.scene.input.materials import (
    KnownMaterial,
    engineering_constants,
    find,
    lame_constants,
    material_of,
    plain,
    unknown,
)
from derivation.scene.input.messages import OWN_MATERIALS, shown

LIGHT_AND_STIFF = 3e5
"""Largest Young's modulus over the square of the density of a solid [Pa m^6/kg^2]: that of balsa
along the grain, the highest in the chart of modulus and density by Ashby, Materials Selection in
Mechanical Design, 4th ed. (2011), fig. 4.3."""
INCOMPRESSIBLE, LIGHTEST_DENSE = 0.4, 400.0
"""Poisson's ratio from which a solid is assumed to have no pores, and a density [kg/m^3] below
those of all solids without pores. Foams have ratios of about 1/3 (Gibson and Ashby, Cellular
Solids, 2nd ed. (1997), ch. 5); lithium, the lightest metal, has 534 kg/m^3, the lightest polymer
830."""


class Body(NamedTuple):
    """Material constants of a body.

    Attributes
    ----------
    lam, mu
        Lame constants [Pa]; infinite for a rigid body.
    density
        Density [kg/m^3], of the table or else of the material; 0 if unknown.
    retardation_time
        Retardation time [s]; 0 for an elastic body.
    yield_stress
        Yield stress [Pa]; infinite if unknown.
    solid_density
        Density of the material [kg/m^3], even if the table gives another one; 0 if unknown.
    lightest
        Density below which no solid has these elastic constants [kg/m^3]; 0 for a rigid body.
    """

    lam: float
    mu: float
    density: float
    retardation_time: float
    yield_stress: float
    solid_density: float
    lightest: float


ELASTIC = ("youngs_modulus", "poissons_ratio"), ("lame_lambda", "lame_mu")
"""Pairs of elastic constants of a body."""
Materials = Mapping[str, KnownMaterial]


def own_materials(tables: Mapping[str, Material]) -> dict[str, KnownMaterial]:
    """Return the materials that a scene defines, by name."""
    return {name: material_of(name, dict(table)) for name, table in tables.items()}


def first_given(*values: Any) -> Any:
    """Return the first value that is not None."""
    return next(value for value in values if value is not None)


def body_of(table: Sphere | Plate, materials: Mapping[str, KnownMaterial]) -> Body:
    """Return the material constants of a sphere or plate of a valid scene."""
    material = find(table.material, materials) if table.material is not None else None
    lam, mu = _lame_constants(table, material)
    return Body(
        lam,
        mu,
        first_given(table.density, material and material.density, 0.0),
        first_given(table.retardation_time, material and material.retardation_time, 0.0),
        first_given(table.yield_stress, material and material.yield_stress, math.inf),
        first_given(material and material.density, 0.0),
        lightest_density(lam, mu),
    )


def lightest_density(lam: Any, mu: Any) -> Any:
    """Return the density below which no solid has these Lame constants [kg/m^3]; 0 if rigid."""
    with np.errstate(all="ignore"):
        modulus, ratio = engineering_constants(lam, mu)
        stiff = np.sqrt(modulus / LIGHT_AND_STIFF)
        least = np.maximum(stiff, np.where(ratio >= INCOMPRESSIBLE, LIGHTEST_DENSE, 0.0))
    least = np.where(np.isfinite(least), least, 0.0)
    return float(least) if np.ndim(least) == 0 else least


def _lame_constants(table: Sphere | Plate, material: KnownMaterial | None) -> tuple[float, float]:
    """Return both Lame constants [Pa]; infinite for a rigid body."""
    if material is not None:
        return material.lam, material.mu
    if isinstance(table, Plate) and table.lame_lambda is not None and table.lame_mu is not None:
        return table.lame_lambda, table.lame_mu
    if table.youngs_modulus is None or table.poissons_ratio is None:
        return math.inf, math.inf
    return lame_constants(table.youngs_modulus, table.poissons_ratio)


def constants_beside(key: str, table: Sphere | Plate, given: Materials) -> dict[str, float]:
    """Return the other material constants of a body if one of its elastic constants is replaced.

    Parameters
    ----------
    key
        The key of the replaced constant, such as youngs_modulus.
    given
        Materials that the scene defines, by name.

    Returns
    -------
    dict
        The constants of the material by key, with the elastic constants in the pair of `key`; empty
        for a rigid body, or if `key` is no elastic constant.
    """
    pair = next((pair for pair in ELASTIC if key in pair), None)
    if pair is None:
        return {}
    material = find(table.material, given) if table.material is not None else None
    lam, mu = _lame_constants(table, material)
    if math.isinf(mu):
        return {}
    E, nu = engineering_constants(lam, mu)
    values = {"youngs_modulus": E, "poissons_ratio": nu, "lame_lambda": lam, "lame_mu": mu}
    if material is not None:
        values |= {name: x for name, x in material.to_json().items() if isinstance(x, float)}
    return {name: x for name, x in values.items() if name in pair or name not in chain(*ELASTIC)}


def material_problems(tables: Mapping[str, Any]) -> list[str]:
    """Return the problems of material names in the tables of a scene, which may be invalid."""
    given = tables.get(OWN_MATERIALS)
    names = [str(name) for name in given] if isinstance(given, Mapping) else []
    problems = list(_name_problems(names))
    for table in ("sphere", "plate"):
        keys = tables.get(table)
        name = keys.get("material") if isinstance(keys, Mapping) else None
        if not isinstance(name, str) or plain(name) in map(plain, names):
            continue
        material = find(name)
        if material is None:
            problems.append(f"{table}.material: {unknown(name, names)}")
        elif table == "sphere" and material.density is None and _massless(tables[table]):
            problems.append(
                f"sphere.material: expected a material of known density, got {shown(name)}; "
                "add for example `density = 7850` to [sphere]"
            )
    return problems


def _massless(sphere: Mapping[str, Any]) -> bool:
    """Return whether the table gives neither mass nor density."""
    return sphere.get("mass") is None and sphere.get("density") is None


def _name_problems(names: Iterable[str]) -> Iterator[str]:
    """Yield a message for each name of an own material that is empty or not unique."""
    first = dict[str, str]()
    for name in names:
        if not plain(name):
            yield (
                f"{OWN_MATERIALS}: expected a name with letters or digits, got {shown(name)}; "
                "rename it"
            )
        elif plain(name) in first:
            yield (
                f"{OWN_MATERIALS}: expected names that differ in more than case, spaces and "
                f"hyphens, got {shown(first[plain(name)])} and {shown(name)}; rename one"
            )
        first.setdefault(plain(name), name)
