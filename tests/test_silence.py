"""Inside its domain every kernel is silent under all="raise"; outside it gives NaN, nothing else.

A true value beyond the doubles is an infinity or zero there, and silent too.
"""

import importlib
import itertools
import math
import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
import pytest

from derivation.measure import contact_grid
from derivation.measure.grids import Point, grid
from derivation.measure.judge import call, to_single
from derivation.measure.kernels import generated_kernels
from derivation.formula.ulp import DOUBLE, SINGLE
from generated.manifest import CONTACT, KERNELS

ROWS = {row["name"]: row for row in (*KERNELS, *CONTACT)}
TABLES = [name for name, row in ROWS.items() if row["arguments"] == ("count",)]
POINTWISE = [name for name in ROWS if name not in TABLES]
EXAMPLE = {
    "r": 0.002, "z": 0.004, "phi": 24.0, "h": 0.01, "T": 0.48, "b": 0.1, "R": 0.13, "a": 0.004,
    "lam": 0.36e9, "mu": 0.43e9, "P": 1000.0, "A_j": -1e6, "J1": 0.52, "x": 1.3, "n": 7.0,
    "k": 4.0, "delta": 1e-5, "m": 0.2, "v0": 1.5, "t": 1e-4, "eta": 0.1,
}  # fmt: skip
Values = Mapping[str, Any]


def function(name: str) -> Callable[..., np.ndarray]:
    """A kernel that takes its arguments alone and gives one array."""
    row = ROWS[name]
    kernel = getattr(importlib.import_module(f"generated.{row['module']}"), name)
    extra = {"modes": 5} if row.get("modes") else {}

    def one(*arguments: Any) -> np.ndarray:
        found = kernel(*arguments, **extra)
        return np.stack(found) if isinstance(found, tuple) else found

    return one


@pytest.fixture(autouse=True)
def _every_warning_is_an_error() -> Iterator[None]:
    with np.errstate(all="raise"):
        yield


# --- inside


@pytest.mark.parametrize("kernel", generated_kernels(), ids=lambda kernel: kernel.name)
@pytest.mark.parametrize("fmt", [DOUBLE, SINGLE], ids=lambda fmt: fmt.name)
def test_hard_points_are_silent(kernel: Any, fmt: Any) -> None:
    points = list(grid(kernel.name, kernel.arguments, kernel.modes))
    if fmt is SINGLE:
        points = [single for point in points if (single := to_single(point)) is not None]
    if kernel.name.startswith(("kappa", "finite_part")) or kernel.by_count:
        points = [p for p in points if max(p.values.values()) <= 100]
    assert not np.isnan(call(kernel, points, fmt)).any()


@pytest.mark.parametrize("name", POINTWISE)
def test_every_layout_is_silent(name: str) -> None:
    kernel, values = function(name), [EXAMPLE[key] for key in ROWS[name]["arguments"]]
    expected = kernel(*values)
    assert np.isfinite(expected).all()
    columns = [np.full((2, 6), value) for value in values]
    for column in columns:
        column.flags.writeable = False
    layouts = {
        "zero-dimensional": [np.asarray(value) for value in values],
        "array": columns,
        "non-contiguous": [column[:, ::3] for column in columns],
        "fortran": [np.asfortranarray(column) for column in columns],
        "broadcast": [column[: 1 + i % 2, :1] for i, column in enumerate(columns)],
        "list": [[value] for value in values],
    }
    for layout, arguments in layouts.items():
        found = np.moveaxis(kernel(*arguments).reshape(-1, 1), 0, -1).ravel()
        assert np.isin(found, expected).all(), layout
    assert kernel(*(np.empty(0) for _ in values)).size == 0
    single = kernel(*(np.float32(value) for value in values))
    assert single.dtype == np.float32
    np.testing.assert_allclose(single, expected, rtol=2e-5)


def test_whole_numbers_are_numbers() -> None:
    whole = {
        "r": 1, "z": 1, "phi": 1, "h": 1, "T": 2, "b": 9, "R": 8, "a": 2, "lam": 3, "mu": 2,
        "P": 5, "A_j": -4, "J1": 1, "x": 3, "n": 7, "k": 4, "delta": 1, "m": 2, "v0": 1, "t": 1,
        "eta": 1,
    }  # fmt: skip
    for name in POINTWISE:
        if name == "force_by_series":  # its radius is smaller
            whole = whole | {"R": 800, "h": 100, "b": 900}
        arguments = [whole[key] for key in ROWS[name]["arguments"]]
        found = function(name)(*arguments)
        assert np.isfinite(found).all(), name
        assert found.dtype == np.float64
        np.testing.assert_array_equal(found, function(name)(*(float(x) for x in arguments)))


def shapes() -> list[dict[str, float]]:
    """Contacts of every thickness and width, with what belongs to them."""
    found = [shape._asdict() for shape in contact_grid.grid("indentation")]
    law = function("indentation")
    for i, values in enumerate(found):
        values["delta"] = float(law(*(values[key] for key in ("a", "R", "h", "b"))))
        values["eta"] = values["h"] / values["b"]
        stiff = 16 / 3 * values["mu"] * (values["lam"] + values["mu"])
        stiff /= values["lam"] + 2 * values["mu"]
        values["P"] = stiff * values["a"] ** 3 / values["R"]
        values["v0"] = math.sqrt(0.5 * values["P"] * values["delta"] / values["m"])
        values["t"] = (i % 9) / 3 * values["delta"] / values["v0"]
    return found


@pytest.mark.parametrize("row", CONTACT, ids=lambda row: row["name"])
@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_contacts_are_silent(row: dict[str, Any], kind: type) -> None:
    columns = [np.array([v[key] for v in shapes()], dtype=kind) for key in row["arguments"]]
    found = function(row["name"])(*columns)
    assert found.dtype == kind
    if row["name"] != "force_by_series":  # NaN beyond its radius
        known = np.isfinite(found)
        assert known.mean() > 0.9 if kind == np.float32 else known.all()


# --- extreme scales: the same contact in units of length, stress and time that are powers of two

UNITS = {
    "a": (1, 0, 0), "R": (1, 0, 0), "h": (1, 0, 0), "b": (1, 0, 0), "delta": (1, 0, 0),
    "lam": (0, 1, 0), "mu": (0, 1, 0), "P": (2, 1, 0), "m": (1, 1, 2), "v0": (1, 0, -1),
    "t": (0, 0, 1), "eta": (0, 0, 0),
}  # fmt: skip
"""Powers of length, stress and time by argument."""
RESULTS = {
    "indentation": [(1, 0, 0)], "contact_radius": [(1, 0, 0)], "force": [(2, 1, 0)],
    "force_of_radius": [(2, 1, 0)], "radius_of_force": [(1, 0, 0)], "stiffness": [(1, 1, 0)],
    "max_pressure": [(0, 1, 0)], "force_by_series": [(2, 1, 0)], "plate_coefficients": [(0, 0, 0)],
    "impact": [(0, 0, 1), (1, 0, 0), (2, 1, 0), (1, 0, 0)],
    "history": [(1, 0, 0), (1, 0, -1), (1, 0, 0), (2, 1, 0)],
}  # fmt: skip
SCALES = [
    (length, stress, time)
    for length, stress, time in itertools.product((-960, -333, 0, 333, 960), (-960, 0, 960), (-400, 0, 400))
]
"""Exponents of two."""


@pytest.mark.parametrize("name", RESULTS)
def test_units_do_not_matter_however_extreme(name: str) -> None:
    """To a few roundings, wherever arguments and results are normal doubles; silent everywhere."""
    names = ROWS[name]["arguments"]
    some = shapes()[::5]
    base = {key: np.array([v[key] for v in some]) for key in names}
    kernel = function(name)
    expected = np.atleast_2d(kernel(*base.values()))
    judged = 0
    for scale in SCALES:
        powers = {key: int(np.dot(UNITS[key], scale)) for key in names}
        columns = {key: np.ldexp(base[key], powers[key]) for key in names}
        if any(not normal(column[base[key] != 0]) for key, column in columns.items()):
            continue
        found = np.atleast_2d(kernel(*columns.values()))
        for got, want, dimension in zip(found, expected, RESULTS[name], strict=False):
            with np.errstate(over="ignore", under="ignore"):
                right = np.ldexp(want, int(np.dot(dimension, scale)))
            fit = np.isfinite(right) & (np.abs(right) > 1e-305) | (want == 0)
            np.testing.assert_allclose(got[fit], right[fit], rtol=2e-15, err_msg=str(scale))
            judged += int(fit.sum())
            assert not np.isnan(got[~np.isnan(want)]).any()
    assert judged > 10 * len(some)


def normal(values: np.ndarray) -> bool:
    size = np.abs(values)
    return bool(((size > 1e-305) & (size < 1e305)).all())


@pytest.mark.parametrize("row", CONTACT, ids=lambda row: row["name"])
def test_extreme_arguments_one_by_one_and_in_pairs_are_silent(row: dict[str, Any]) -> None:
    names, kernel = row["arguments"], function(row["name"])
    ends = {key: (1e-300, 1e-150, EXAMPLE[key], 1e150, 1e300) for key in names}
    for one, two in itertools.combinations_with_replacement(names, 2):
        for first, second in itertools.product(ends[one], ends[two]):
            values = EXAMPLE | {one: first, two: second}
            found = kernel(*(values[key] for key in names))
            assert np.shape(found) == np.shape(kernel(*(EXAMPLE[key] for key in names)))
