"""Distributions of varied quantities, from a TOML file or from mappings."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derivation.engine.nearest import nearest
from derivation.engine.printable import one_line
from derivation.scene.errors import SceneError
from derivation.scene.input.keys import takes_names, varied_key
from derivation.scene.input.messages import shown
from derivation.scene.input.table import is_number, plain_keys
from derivation.scene.input.toml_file import name_of, read_toml
from derivation.scene.scene import VARY
from derivation.scene.sweep import Values
from derivation.sweep.values import different, names_among, numbers_among

Array = NDArray[np.float64]

PARAMETERS = {
    "uniform": ("low", "high"),
    "loguniform": ("low", "high"),
    "normal": ("mean", "std"),
    "lognormal": ("mean", "std"),
    "choice": ("values",),
}
"""Parameters of each distribution, in the unit of the quantity; those of `lognormal` are mean and
standard deviation of the quantity itself, not of its logarithm. The values of a choice are equally
probable."""
WIDEST = 1e100
"""Largest standard deviation of a lognormal distribution, over its mean."""
CHOICE = '{distribution = "choice", values = ["glass", "steel"]}'
EXAMPLE = '"plate.thickness" = {distribution = "uniform", low = 4e-3, high = 12e-3}'


@dataclass(frozen=True)
class Distribution:
    """The distribution of one varied quantity.

    Attributes
    ----------
    distribution
        A name of `PARAMETERS`.
    first, second
        Its two parameters, in SI units.
    """

    distribution: str
    first: float
    second: float

    def quantiles(self, probabilities: Array) -> Array:
        """Return the quantiles of probabilities in (0, 1)."""
        from scipy.special import ndtri  # far faster to import than scipy.stats

        a, b = self.first, self.second
        if self.distribution == "uniform":
            return a + (b - a) * probabilities
        if self.distribution == "loguniform":
            return np.exp(math.log(a) + (math.log(b) - math.log(a)) * probabilities)
        if self.distribution == "normal":
            return np.asarray(a + b * ndtri(probabilities))
        spread = math.sqrt(math.log1p((b / a) ** 2))
        return np.asarray(a * np.exp(spread * ndtri(probabilities) - spread**2 / 2))

    def to_json(self) -> dict[str, Any]:
        """Return the distribution with the keys of a file."""
        first, second = PARAMETERS[self.distribution]
        return {"distribution": self.distribution, first: self.first, second: self.second}


@dataclass(frozen=True)
class UniformChoice:
    """A choice among numbers or names with equal probabilities.

    Attributes
    ----------
    values
        Different numbers in SI units, or different names.
    """

    values: Values

    def quantiles(self, probabilities: Array) -> NDArray[Any]:
        """Return the value for each probability in (0, 1)."""
        count = len(self.values)
        which = np.minimum((probabilities * count).astype(np.intp), count - 1)
        return np.array(self.values)[which]

    def to_json(self) -> dict[str, Any]:
        """Return the choice with the keys of a file."""
        return {"distribution": "choice", "values": list(self.values)}


def load_distributions(path: Path) -> dict[str, Distribution | UniformChoice]:
    """Read the table `[vary]` of a TOML file.

    Raises
    ------
    SceneError
        If it cannot be read, or does not contain valid distributions.
    """
    data = read_toml(path, "the distributions", "check its name", EXAMPLE)
    if set(data) != {VARY}:
        got = ", ".join(one_line(key, 40) for key in data) or "nothing"
        raise SceneError(
            f"{name_of(path)}: expected one table [vary] with lines such as {EXAMPLE}, got {got}"
        )
    return distributions_of(data[VARY], name_of(path))


def distributions_of(table: Any, name: str) -> dict[str, Distribution | UniformChoice]:
    """Return the distributions in the table `[vary]` of a file.

    Raises
    ------
    SceneError
        If it is no table of valid distributions.
    """
    table = table if isinstance(table, Mapping) else {}
    unquoted = next((key for key, given in table.items() if _has_unquoted_dot(given)), None)
    if not table or unquoted is not None:
        got = "none" if unquoted is None else f"a table {one_line(unquoted, 40)} in it"
        raise SceneError(
            f"{name}: expected lines such as {EXAMPLE} in the table [vary], got {got}; put a key "
            "with a dot in quotes"
        )
    try:
        return read_distributions(table)
    except SceneError as error:
        raise SceneError(f"{name}: {error}") from None


def _has_unquoted_dot(given: Any) -> bool:
    """Return whether an entry is a table of distributions, as TOML reads an unquoted dot."""
    return isinstance(given, Mapping) and any(isinstance(x, Mapping) for x in given.values())


def read_distributions(given: Mapping[str, Any]) -> dict[str, Distribution | UniformChoice]:
    """Return distributions by key from mappings of their parameters.

    Raises
    ------
    SceneError
        If a key, a distribution or a parameter is unknown or out of range.
    """
    made = dict[str, Distribution | UniformChoice]()
    for text, distribution in given.items():
        key = varied_key(text)
        if key in made:  # under its old name, or with spaces
            raise SceneError(f"vary: expected {key} once, got it twice; remove one")
        made[key] = _distribution(key, distribution)
    return made


def names_in(values: Mapping[str, Any]) -> dict[str, tuple[str, ...]]:
    """Return the names of each key that takes names, from its values or its distribution."""
    given = {key: one for key, one in values.items() if takes_names(key)}
    return {
        key: tuple(map(str, one.values if isinstance(one, UniformChoice) else one))
        for key, one in given.items()
    }


def _distribution(key: str, given: Any) -> Distribution | UniformChoice:
    """Return the distribution of one key."""
    if isinstance(given, Distribution | UniformChoice):
        return given
    line = f'"plate.material" = {CHOICE}' if takes_names(key) else EXAMPLE
    example = f"write for example {line}"
    if not isinstance(given, Mapping):
        raise SceneError(f"{key}: expected a distribution, got {shown(given)}; {example}")
    given = plain_keys(given)
    name = given.get("distribution")
    if not isinstance(name, str) or name not in PARAMETERS:
        near = next(iter(nearest(name, PARAMETERS)), "") if isinstance(name, str) else ""
        meant = f"did you mean {near}?" if near else example
        got = "none" if name is None else shown(name)
        raise SceneError(
            f"{key}: expected the distribution {', '.join(PARAMETERS)}, got {got}; {meant}"
        )
    wanted = PARAMETERS[name]
    if set(given) != {"distribution", *wanted}:
        got = ", ".join(str(part) for part in given if part != "distribution") or "none"
        raise SceneError(f"{key}: expected {' and '.join(wanted)} of {name}, got {got}; {example}")
    if name == "choice":
        among = names_among if takes_names(key) else numbers_among
        return UniformChoice(different(key, among(key, given["values"])))
    if takes_names(key):
        raise SceneError(
            f"{key}: expected the distribution choice for names, got {name}; {example}"
        )
    first, second = (given[part] for part in wanted)
    if not (is_number(first) and is_number(second)):
        raise SceneError(
            f"{key}: expected finite numbers {' and '.join(wanted)}, got {shown(first)} and "
            f"{shown(second)}; {example}"
        )
    made = Distribution(name, float(first), float(second))
    _check_range(key, made)
    return made


def _check_range(key: str, given: Distribution) -> None:
    """Raise an error if the parameters are out of range."""
    first, second = given.first, given.second
    spread = given.distribution in ("normal", "lognormal")
    fine = second > 0 if spread else first < second
    if given.distribution in ("loguniform", "lognormal"):
        fine = fine and first > 0
    if given.distribution == "lognormal":
        fine = fine and second <= WIDEST * first
    if fine and math.isfinite(first) and math.isfinite(second):
        return
    expected = {
        "uniform": "low < high",
        "loguniform": "0 < low < high",
        "normal": "std > 0",
        "lognormal": f"mean > 0 and 0 < std <= {WIDEST:g} mean",
    }[given.distribution]
    values = {k: v for k, v in asdict(given).items() if k != "distribution"}.values()
    got = ", ".join(shown(value) for value in values)
    raise SceneError(f"{key}: expected {expected} of {given.distribution}, got {got}; change them")
