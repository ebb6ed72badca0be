"""Reads a quoted number with a unit, such as "10 mm", to suggest its value in the unit of a key."""

import math
import re

PREFIXES = {
    "n": 1e9, "u": 1e6, "µ": 1e6, "μ": 1e6, "m": 1e3, "c": 1e2, "": 1.0, "k": 1e-3, "M": 1e-6,
    "G": 1e-9,
}  # fmt: skip
"""SI prefixes, with the number by which a value with the prefix is divided."""
BASES = {"m": ("m",), "s": ("s", "sec"), "Pa": ("Pa",), "kg": ("g",), "m/s": ("m/s",)}
"""Units that take a prefix, by the unit of the key; for the kilogram this is the gram."""
OTHERS = {
    "m": {"in": 1.0 / 0.0254, "inch": 1.0 / 0.0254, "ft": 1.0 / 0.3048},
    "m/s": {"km/h": 3.6},
    "m/s^2": {"g": 1.0 / 9.80665},
    "Pa": {"N/m^2": 1.0, "N/mm^2": 1e-6, "psi": 1.0 / 6894.757293168, "bar": 1e-5},
    "kg/m^3": {"g/cm^3": 1e-3, "g/cc": 1e-3, "kg/dm^3": 1e-3, "t/m^3": 1e-3},
    "1": {"%": 100.0},
}
"""Other units by the unit of the key, each with the size of the unit of the key in it."""


def in_unit(text: str, unit: str) -> float | None:
    """Return the positive number that a text states in a unit; None if it states none.

    Examples
    --------
    >>> in_unit("10 mm", "m"), in_unit("70GPa", "Pa"), in_unit("2", "m/s"), in_unit("2 kg", "m")
    (0.01, 70000000000.0, 2.0, None)
    """
    found = re.fullmatch(r"([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(\S*)", text.strip())
    try:
        number = float(found[1]) if found else 0.0
    except ValueError:  # several points
        return None
    if found is None or not 0.0 < number < math.inf:
        return None
    named = re.sub(r"(?<=[a-z])([23])$", r"^\1", found[2].replace("²", "^2").replace("³", "^3"))
    if named in ("", unit):
        return number
    size = OTHERS.get(unit, {}).get(named)
    for base in BASES.get(unit, ()):
        if size is None and named.endswith(base):
            size = PREFIXES.get(named.removesuffix(base))
            size = 1e3 * size if size and base == "g" else size
    return number / size if size else None
