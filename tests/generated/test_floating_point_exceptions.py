"""Functions raise no floating-point exception inside their domain and return NaN outside it.

This includes results that overflow to infinity or underflow to zero.
"""

import importlib
import itertools
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from domains import EXAMPLE, OUTSIDE, POINTWISE, ROWS, TABLES, Values, conditions, holds, violations

from derivation.engine.formula.dimension import unit as dimension_of
from derivation.engine.formula.ulp import DOUBLE, SINGLE
from derivation.engine.measure.point import to_single
from derivation.plate.contact.cases import grid as contact_grid
from derivation.plate.grids import grid
from derivation.plate.judge import generated_kernels
from derivation.plate.vocabulary import BY_NAME
from generated.manifest import CONTACT

UNBOUNDED = [
    name
    for name in POINTWISE
    if ROWS[name] in CONTACT or ROWS[name]["module"] in ("bessel", "series_constants")
]
"""Functions whose domain is not limited to moderate phi h and a phi."""


def function(name: str) -> Callable[..., np.ndarray]:
    """Return a function with one array as result, which raises an error instead of warnings."""
    row = ROWS[name]
    kernel = getattr(importlib.import_module(f"generated.{row['module']}"), name)
    extra = {"modes": 5} if row.get("modes") else {}

    def one(*arguments: Any) -> np.ndarray:
        with np.errstate(all="raise"):
            actual = kernel(*arguments, **extra)
        return np.stack(actual) if isinstance(actual, tuple) else actual

    return one


# --- inside


@pytest.mark.parametrize("kernel", generated_kernels(), ids=lambda kernel: kernel.name)
@pytest.mark.parametrize("fmt", [DOUBLE, SINGLE], ids=lambda fmt: fmt.name)
def test_grid_points_raise_no_exception(kernel: Any, fmt: Any) -> None:
    points = list(grid(kernel.name, kernel.arguments, kernel.modes))
    if fmt is SINGLE:
        points = [single for point in points if (single := to_single(point)) is not None]
    if kernel.name.startswith(("kappa", "finite_part")) or kernel.by_count:
        # Numbers too large for the type are outside the domain.
        points = [p for p in points if max(p.values.values()) <= (15 if fmt is SINGLE else 100)]
    with np.errstate(all="raise"):
        actual = kernel.results(points, fmt)
    assert not np.isnan(actual).any()


@pytest.mark.parametrize("name", POINTWISE)
def test_every_layout_raises_no_exception(name: str) -> None:
    kernel, values = function(name), [EXAMPLE[key] for key in ROWS[name]["arguments"]]
    expected, rtol = np.asarray(kernel(*values)), 2e-15 if ROWS[name] in CONTACT else 0.0
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
        actual = kernel(*arguments)
        shape = np.broadcast_shapes(*(np.shape(x) for x in arguments))
        if name == "plate_coefficients":
            shaped = np.broadcast_to(expected, (*shape, expected.size))
        else:  # several results of a function are along the first axis
            several = np.expand_dims(expected, tuple(range(-len(shape), 0)))
            shaped = np.broadcast_to(several, (*expected.shape, *shape))
        np.testing.assert_allclose(actual, shaped, rtol=rtol, err_msg=layout)
    assert kernel(*(np.empty(0) for _ in values)).size == 0
    single = kernel(*(np.float32(value) for value in values))
    assert single.dtype == np.float32
    np.testing.assert_allclose(single, expected, rtol=2e-5)


def test_integers_are_accepted_as_arguments() -> None:
    whole = {
        "r": 1, "z": 1, "phi": 1, "h": 1, "T": 2, "b": 9, "R": 8, "a": 2, "lam": 3, "mu": 2,
        "P": 5, "A_j": -4, "J1": 1, "x": 3, "n": 7, "k": 4, "delta": 1, "m": 2, "v0": 1, "t": 1,
        "eta": 1, "a_over_R": 0, "a_ratio": 2, "alpha": 0, "rho": 2500,
        "yield_stress": 1, "xi_y": 2, "viscous_time": 1, "x_v": 2, "kap": 2, "nu": 0,
    }  # fmt: skip
    for name in POINTWISE:
        if name == "force_by_series":  # it converges for smaller contacts only
            whole = whole | {"R": 8000, "h": 700, "b": 900}
        arguments = [whole[key] for key in ROWS[name]["arguments"]]
        actual = function(name)(*arguments)
        assert np.isfinite(actual).all(), name
        assert actual.dtype == np.float64
        np.testing.assert_array_equal(actual, function(name)(*(float(x) for x in arguments)))


def shapes() -> list[dict[str, float]]:
    """Return contacts of many thicknesses and widths, with values for all other arguments."""
    actual = [shape._asdict() for shape in contact_grid.grid("indentation")]
    law = function("indentation")
    for i, values in enumerate(actual):
        values["delta"] = float(law(*(values[key] for key in ("a", "R", "h", "b"))))
        values["eta"] = values["h"] / values["b"]
        values["a_over_R"] = values["a"] / values["R"]
        values["a_ratio"] = values["a"] / values["h"]
        values["alpha"], values["rho"] = values["a"] / values["b"], 2500.0
        stiff = 16 / 3 * values["mu"] * (values["lam"] + values["mu"])
        stiff /= values["lam"] + 2 * values["mu"]
        values["P"] = stiff * values["a"] ** 3 / values["R"]
        values["v0"] = math.sqrt(0.5 * values["P"] * values["delta"] / values["m"])
        values["viscous_time"] = values["delta"] / values["v0"] / 10 ** (i % 7)
        values["x_v"] = 10.0 ** (1 - i % 9)
        values["yield_stress"] = values["P"] / values["a"] ** 2 / 10.0 ** (i % 5)
        values["xi_y"] = 1.0 + 10.0 ** (i % 15 - 10)
        values["x"], values["kap"] = 10.0 ** (i % 11 - 8), 10.0 ** (i % 13 - 9)
        values["nu"] = values["lam"] / (2 * (values["lam"] + values["mu"]))
        values["t"] = (i % 9) / 3 * values["delta"] / values["v0"]
    return actual


@pytest.mark.parametrize(
    "row", [row for row in CONTACT if row["name"] in POINTWISE], ids=lambda row: row["name"]
)
@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_contacts_raise_no_exception(row: dict[str, Any], kind: type) -> None:
    some = shapes()[:: 16 if row["name"] == "force_by_series" else 1]
    columns = [np.array([v[key] for v in some], dtype=kind) for key in row["arguments"]]
    actual = function(row["name"])(*columns)
    assert actual.dtype == kind
    if "a <= 0.9 * b" in row["domain"]:
        a, b = (columns[row["arguments"].index(key)].astype(float) for key in ("a", "b"))
        np.testing.assert_array_equal(np.isnan(actual), a > 0.9 * b)
    elif row["name"] != "force_by_series":  # NaN beyond its radius of convergence
        known = np.isfinite(actual)
        assert known.mean() > 0.9 if kind == np.float32 else known.all()


# --- extreme scales: the same contact in units of length, stress and time that are powers of two

CLOSED = [
    name
    for name, row in ROWS.items()
    if row["module"] in ("omega", "influence", "pressure") and name not in TABLES
]
LAW = ("contact_law", "impact", "reversed_series")
SCALES = [
    (length, stress, time)
    for length, stress, time in itertools.product(
        (-960, -333, 0, 333, 960), (-960, -333, 0, 333, 960), (-400, 0, 400)
    )
]
"""Exponents of two."""


def power(unit: str, length: int, stress: int, time: int) -> int:
    """Return the exponent of two by which a change of units multiplies a quantity."""
    of = dimension_of(unit)
    return int(of.mass * (length + stress + 2 * time) + of.length * length + of.time * time)


@pytest.mark.filterwarnings("ignore:overflow encountered in ldexp")
@pytest.mark.parametrize(
    "name", [*CLOSED, *(row["name"] for row in CONTACT if row["module"] in LAW)]
)
def test_results_do_not_depend_on_extreme_units(name: str) -> None:
    """Results of closed formulas are equal, others agree to rounding; no exception is raised.

    Only arguments and results that are normal doubles are compared.
    """
    names, kernel = ROWS[name]["arguments"], function(name)
    if name in CLOSED:
        some: Sequence[Values] = [point.values for point in grid(name, names)[::5]]
    else:
        some = shapes()[:: 40 if name == "force_by_series" else 7]
    base = {key: np.array([v[key] for v in some]) for key in names}
    expected = np.atleast_2d(kernel(*base.values()))
    compared = 0
    for scale in SCALES[:: 2 if name == "force_by_series" else 1]:
        columns = {key: np.ldexp(base[key], power(BY_NAME[key].unit, *scale)) for key in names}
        inside = np.all([normal(column) | (base[key] == 0) for key, column in columns.items()], 0)
        if not inside.any() or (name not in CLOSED and not inside.all()):
            continue
        actual = np.atleast_2d(kernel(*(column[inside] for column in columns.values())))
        units = ROWS[name]["unit"].split(", ")
        for got, want, unit in zip(actual, expected[:, inside], units, strict=False):
            exact = np.ldexp(want, power(unit, *scale))
            fit = (normal(want) & normal(exact)) | ((want == 0) & (name not in CLOSED))
            rtol = 0.0 if name in CLOSED else 2e-15
            np.testing.assert_allclose(got[fit], exact[fit], rtol=rtol, err_msg=str(scale))
            compared += int(fit.sum())
            assert not np.isnan(got[~np.isnan(want)]).any()
    assert compared > 4 * len(some)


def normal(values: np.ndarray) -> np.ndarray:
    size = np.abs(values)
    return (size > 1e-289) & (size < 1e289)


ENDS = (5e-324, 1e-300, 1e-150, 1e150, 1e300, 1.7e308)


@pytest.mark.parametrize("name", UNBOUNDED)
def test_extreme_arguments_alone_and_in_pairs_raise_no_exception(name: str) -> None:
    names = ROWS[name]["arguments"]
    ends = (1e-300, 1e300) if name == "force_by_series" else ENDS
    cases = [
        EXAMPLE | {one: first, two: second}
        for one, two in itertools.combinations_with_replacement(names, 2)
        for first, second in itertools.product(ends, ends)
    ]
    columns = [np.array([case[key] for case in cases]) for key in names]
    assert function(name)(*columns).dtype == np.float64


# --- outside

NOT_FINITE = (math.nan, math.inf, -math.inf)


@pytest.mark.parametrize("name", POINTWISE)
def test_results_outside_the_domain_are_nan(name: str) -> None:
    names, kernel = ROWS[name]["arguments"], function(name)
    base = {key: EXAMPLE[key] for key in names}
    cases = [(condition, dict(moved)) for condition, moved in violations(name)]
    cases += [
        (f"{key} = {invalid}", base | {key: invalid}) for key in names for invalid in NOT_FINITE
    ]
    own = OUTSIDE.get(name, {})
    cases += [(f"{key} = {invalid}", base | {key: invalid}) for key in own for invalid in own[key]]
    for condition, values in cases:
        for kind in (np.float64, np.float32):
            with np.errstate(all="ignore"):
                arguments = [kind(values[key]) for key in names]
            exact = dict(zip(names, map(float, arguments), strict=True))
            if kind == np.float32 and all(
                holds(c, exact) for c in conditions(name) if exact.get("b", 1)
            ):
                continue  # rounding has moved the point into the domain
            assert np.isnan(kernel(*arguments)).all(), (condition, values)
    everything = [np.array([values[key] for _, values in cases]) for key in names]
    assert np.isnan(kernel(*everything)).all()


@pytest.mark.parametrize("name", TABLES)
def test_table_of_length_zero_is_empty_and_invalid_lengths_are_rejected(name: str) -> None:
    table, others = function(name), [EXAMPLE[key] for key in ROWS[name]["arguments"][1:]]
    assert table(0, *others).size == 0
    for count in (-1, 1.5, math.nan, math.inf):
        with pytest.raises(ValueError, match=r"number of (zeros|modes)"):
            table(count, *others)


@pytest.mark.parametrize("name", ["impact", "history", "impact_sensitivities"])
def test_impact_beyond_the_edge_of_a_thick_plate_is_nan_without_warning(name: str) -> None:
    """At b = 2 h, the interval of the second polynomial of the contact law has zero width."""
    given = EXAMPLE | {"h": 0.1, "b": 0.2, "R": 2.0, "m": 3e4, "v0": 1.6, "t": 1e-3}
    assert np.isnan(function(name)(*(given[key] for key in ROWS[name]["arguments"]))).all()
