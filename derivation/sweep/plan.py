"""The points of a study, each computed from its index, so that they need not fit in memory."""

import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from itertools import pairwise, product
from math import prod
from threading import Lock
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from derivation.engine.nearest import did_you_mean
from derivation.scene.errors import SceneError
from derivation.scene.input.keys import rivals, takes_names, varied_key
from derivation.scene.sweep import Values, parse, values_in
from derivation.sweep.distributions import Distribution, UniformChoice, names_in
from derivation.sweep.values import different, names_among, numbers_among

Array = NDArray[np.float64]
Column = NDArray[Any]
"""Numbers in SI units, or names."""
Distributions = Mapping[str, Distribution | UniformChoice]

MOST_POINTS = 10**9
"""Largest number of points of a study."""
MOST_LATIN = 10**6
"""Largest Latin hypercube, which is held in memory."""
METHODS = ("random", "latin-hypercube", "sobol")
BLOCK = 4096
"""Number of points of a random sample that are drawn from one seed."""
LEAST_BASE = 4
"""Smallest number of base points of sensitivity indices: the scatter of two shows no interval."""
LEAST_PROBABILITY = 2.0**-40
"""Smallest distance of probabilities from 0 and 1, where a normal distribution has no value."""


@dataclass(frozen=True)
class GridPlan:
    """All combinations of the values of each key.

    Attributes
    ----------
    axes
        The values of each key, in SI units or names; the last key varies fastest.
    """

    axes: dict[str, Values]
    seed: ClassVar[None] = None

    @property
    def keys(self) -> tuple[str, ...]:
        """The varied keys."""
        return tuple(self.axes)

    @property
    def names(self) -> dict[str, tuple[str, ...]]:
        """The names of each key that takes names."""
        return names_in(self.axes)

    @property
    def dims(self) -> dict[str, int]:
        """Names and lengths of the dimensions of the results."""
        return {key: len(values) for key, values in self.axes.items()}

    @property
    def size(self) -> int:
        """Number of points."""
        return prod(self.dims.values())

    def points(self, start: int, stop: int) -> dict[str, Column]:
        """Return the values of each key at the points from `start` to `stop` (exclusive)."""
        indices = np.unravel_index(np.arange(start, stop), tuple(self.dims.values()))
        return {
            key: np.asarray(values)[index]
            for (key, values), index in zip(self.axes.items(), indices, strict=True)
        }

    def probes(self, most: int) -> dict[str, Column]:
        """Return at most `most` corners of the grid, with all names, for a forecast."""
        ends = [
            list(range(length)) if key in self.names else sorted({0, length - 1})
            for key, length in self.dims.items()
        ]
        corners = np.array([corner for corner, _ in zip(product(*ends), range(most), strict=False)])
        columns = zip(self.axes.items(), corners.T, strict=True)
        return {key: np.asarray(values)[indices] for (key, values), indices in columns}

    def to_json(self) -> dict[str, Any]:
        """Return the plan as JSON data, from which the hash of the study follows."""
        return {"grid": {key: list(values) for key, values in self.axes.items()}}


@dataclass(frozen=True)
class SamplePlan:
    """A sample of the distributions of the keys.

    Attributes
    ----------
    distributions
        The distribution of each key.
    size
        Number of points.
    seed
        Random seed; points are reproducible.
    method
        One of `METHODS`.
    """

    distributions: dict[str, Distribution | UniformChoice]
    size: int
    seed: int
    method: str

    @property
    def keys(self) -> tuple[str, ...]:
        """The varied keys."""
        return tuple(self.distributions)

    @property
    def names(self) -> dict[str, tuple[str, ...]]:
        """The names of each key that takes names."""
        return names_in(self.distributions)

    @property
    def dims(self) -> dict[str, int]:
        """Names and lengths of the dimensions of the results."""
        return {"sample": self.size}

    def points(self, start: int, stop: int) -> dict[str, Column]:
        """Return the values of each key at the points from `start` to `stop` (exclusive)."""
        return _values(self.distributions, self._probabilities(start, stop))

    def probes(self, most: int) -> dict[str, Column]:
        """Return the first points, at most `most`, for a forecast."""
        return self.points(0, min(most, self.size))

    def to_json(self) -> dict[str, Any]:
        """Return the plan as JSON data, from which the hash of the study follows."""
        tables = {key: one.to_json() for key, one in self.distributions.items()}
        return {"vary": tables, "sample": self.size, "seed": self.seed, "method": self.method}

    def _probabilities(self, start: int, stop: int) -> Array:
        """Return points of the unit cube, one in each row."""
        if self.method == "latin-hypercube":
            return self._latin[start:stop]
        if self.method == "sobol":
            return _sobol(len(self.keys), self.seed, start, stop)
        first = start // BLOCK
        blocks = [self._block(number) for number in range(first, -(-stop // BLOCK))]
        return np.concatenate(blocks)[start - first * BLOCK : stop - first * BLOCK]

    def _block(self, number: int) -> Array:
        """Return a block of random points from its own seed."""
        seed = np.random.SeedSequence((self.seed, number))
        return np.random.default_rng(seed).random((BLOCK, len(self.keys)))

    @cached_property
    def _latin(self) -> Array:
        from scipy.stats import qmc

        made = qmc.LatinHypercube(len(self.keys), rng=np.random.default_rng(self.seed))
        return np.asarray(made.random(self.size))


@dataclass(frozen=True)
class SaltelliPlan:
    """Points for variance-based sensitivity indices (Saltelli et al. 2010).

    Each of `base` points of a Sobol sequence in 2 d dimensions, d being the number of keys, gives
    d + 2 points: A, B, and for each key A with the value of that key from B.

    Attributes
    ----------
    distributions
        The distribution of each key.
    base
        Number of base points, a power of two.
    seed
        Random seed of the scrambled sequence.
    """

    distributions: dict[str, Distribution | UniformChoice]
    base: int
    seed: int

    @property
    def keys(self) -> tuple[str, ...]:
        """The varied keys."""
        return tuple(self.distributions)

    @property
    def names(self) -> dict[str, tuple[str, ...]]:
        """The names of each key that takes names."""
        return names_in(self.distributions)

    @property
    def each(self) -> int:
        """Number of points for each base point."""
        return len(self.keys) + 2

    @property
    def size(self) -> int:
        """Number of points."""
        return self.base * self.each

    @property
    def dims(self) -> dict[str, int]:
        """Names and lengths of the dimensions of the results."""
        return {"sample": self.size}

    def points(self, start: int, stop: int) -> dict[str, Column]:
        """Return the values of each key at the points from `start` to `stop` (exclusive)."""
        number, each = len(self.keys), self.each
        first = start // each
        both = _sobol(2 * number, self.seed, first, -(-stop // each))
        a, b = both[:, :number], both[:, number:]
        rows = np.stack([a, b, *([a] * number)], axis=1)
        for key in range(number):
            rows[:, 2 + key, key] = b[:, key]
        probabilities = rows.reshape(-1, number)[start - first * each : stop - first * each]
        return _values(self.distributions, probabilities)

    def probes(self, most: int) -> dict[str, Column]:
        """Return the first points, at most `most`, for a forecast."""
        return self.points(0, min(most, self.size))

    def to_json(self) -> dict[str, Any]:
        """Return the plan as JSON data, from which the hash of the study follows."""
        tables = {key: one.to_json() for key, one in self.distributions.items()}
        return {"vary": tables, "saltelli": self.base, "seed": self.seed}


Plan = GridPlan | SamplePlan | SaltelliPlan


def grid(given: Mapping[str, Iterable[float | str] | str] | Sequence[str]) -> GridPlan:
    """Return a grid from texts such as `table.key=first:last:count`, or the values of each key.

    Raises
    ------
    SceneError
        If a key is unknown, given twice or given with a key that it excludes, a number is not
        finite, a value is given twice, or there are too many points.
    """
    if isinstance(given, Mapping):
        axes = [_axis(key, values) for key, values in given.items()]
    else:
        sweeps = [parse(str(text)) for text in given]
        axes = [(one.key, one.values) for one in sweeps]
    _check_keys([key for key, _ in axes])
    made = GridPlan({key: different(key, values) for key, values in axes})
    _check_size(made.size, "use fewer values")
    return made


def sample(distributions: Distributions, size: int, seed: int, method: str) -> SamplePlan:
    """Return a sample of distributions.

    Raises
    ------
    SceneError
        If a key excludes another one, the seed is negative, the method is unknown, or the method
        does not allow this number of points.
    """
    _check_keys(list(distributions))
    if method not in METHODS:
        meant = did_you_mean(str(method), METHODS).rstrip() or "choose one"
        raise SceneError(f"method: expected {', '.join(METHODS)}, got {method!r:.40}; {meant}")
    _check_size(size, "give the sample another size")
    if method == "latin-hypercube" and size > MOST_LATIN:
        raise SceneError(
            f"method: expected at most {MOST_LATIN:,} points of a Latin hypercube, which is held "
            f"in memory, got {size:,}; use sobol or random"
        )
    if method == "sobol":
        _check_power(size, "points of a Sobol sequence")
    return SamplePlan(dict(distributions), size, seed, method)


def saltelli(distributions: Distributions, base: int, seed: int) -> SaltelliPlan:
    """Return the points for sensitivity indices.

    Raises
    ------
    SceneError
        If a key excludes another one, the seed is negative, or the number of base points is not a
        power of two, below `LEAST_BASE` or too large.
    """
    _check_keys(list(distributions))
    made = SaltelliPlan(dict(distributions), base, seed)
    _check_size(base, "give the sample another size")
    _check_power(base, f"base points, each of which makes {made.each} runs", LEAST_BASE)
    return made


def _axis(key: str, values: Iterable[float | str] | str) -> tuple[str, Values]:
    """Return a key and its values from a text, numbers or names."""
    place = varied_key(key)
    if isinstance(values, str):
        return place, values_in(place, values)
    if takes_names(place):
        return place, names_among(place, values)
    return place, numbers_among(place, values)


def _check_keys(keys: list[str]) -> None:
    """Raise an error without a key, for a key given twice, and for keys that exclude each other."""
    if not keys:
        raise SceneError("vary: expected a key to vary, got none; name one, like plate.thickness")
    for number, key in enumerate(keys):
        if key in keys[:number]:
            raise SceneError(f"vary: expected {key} once, got it twice; remove one")
        for other in rivals(key) & set(keys):
            raise SceneError(
                f"vary: expected {key} or {other}, which replace each other, got both; remove one"
            )


def _check_size(size: int, remedy: str) -> None:
    if not 1 <= size <= MOST_POINTS:
        raise SceneError(f"sweep: expected 1 to {MOST_POINTS:,} points, got {size:,}; {remedy}")


def _check_power(size: int, what: str, least: int = 2) -> None:
    """Raise an error unless the size is a power of two, which balances a Sobol sequence."""
    if size & (size - 1) or size < least:
        below = max(least, 2 ** (size.bit_length() - 1))
        raise SceneError(
            f"sample: expected a power of two of {what}, got {size}; take {below} or {2 * below}"
        )


def _values(distributions: Distributions, probabilities: Array) -> dict[str, Column]:
    """Return the values of the keys at points of the unit cube."""
    inside = np.clip(probabilities, LEAST_PROBABILITY, 1 - LEAST_PROBABILITY)
    columns = zip(distributions.items(), inside.T, strict=True)
    return {key: one.quantiles(column) for (key, one), column in columns}


@dataclass
class _Sequence:
    """A scrambled Sobol sequence that keeps its position, because skipping points takes time.

    Several threads may share it.
    """

    dimensions: int
    seed: int
    engine: Any = field(default=None)
    lock: Any = field(default_factory=Lock)

    def between(self, start: int, stop: int) -> Array:
        """Return the points from `start` to `stop` (exclusive)."""
        with self.lock:
            return self._between(start, stop)

    def _between(self, start: int, stop: int) -> Array:
        from scipy.stats import qmc

        if self.engine is None or self.engine.num_generated > start:
            seed = np.random.default_rng(self.seed)
            self.engine = qmc.Sobol(self.dimensions, scramble=True, rng=seed)
        if self.engine.num_generated < start:
            self.engine.fast_forward(start - self.engine.num_generated)
        with warnings.catch_warnings():  # SciPy warns that a part has no power of two of points
            warnings.simplefilter("ignore", UserWarning)
            return np.asarray(self.engine.random(stop - start))


_sequence = lru_cache(8)(_Sequence)


def _sobol(dimensions: int, seed: int, start: int, stop: int) -> Array:
    """Return points of a scrambled Sobol sequence."""
    return _sequence(dimensions, seed).between(start, stop)


def gaps(ranges: Iterable[tuple[int, int]], size: int) -> Iterator[tuple[int, int]]:
    """Return the ranges between 0 and `size` that are not covered by sorted, disjoint ranges."""
    ends = [0, *(end for pair in ranges for end in pair), size]
    return ((a, b) for number, (a, b) in enumerate(pairwise(ends)) if number % 2 == 0 and a < b)
