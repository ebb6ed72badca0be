"""The accuracy measurement: accurate functions pass, and each kind of defect is detected."""

import dataclasses
import json
import math
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from derivation.engine.files import write_file
from derivation.engine.measure import check as checking
from derivation.engine.measure.check import Row
from derivation.engine.measure.judge import PointReference, measured_errors
from derivation.engine.measure.kernels import Kernel
from derivation.engine.measure.point import Point, to_single
from derivation.engine.measure.record import COLUMNS, as_data, cells, to_json
from derivation.engine.oracle.agreement import OracleError
from derivation.mathematics.bessel.oracle import j0_zero
from derivation.plate.grids import grid, switches
from derivation.plate.judge import check, kernel_of_row, reference_values
from derivation.plate.modes.route import routes
from derivation.plate.oracle import reference

G_PRINTED = "(sinh(T)*cosh(T) + T) / (sinh(T)**2 - T**2)"


def rounded(formula: str) -> Callable[..., Any]:
    """Return a function that computes in extended precision and rounds the result once."""
    code = compile(formula, "formula", "eval")

    def one(number: float) -> float:
        T = mpf(float(number))
        with mp.workdps(60 + int(5 * max(0, -mp.log10(T))) + int(min(4 * T, 2000))):
            return float(eval(code, {"sinh": mp.sinh, "cosh": mp.cosh, "T": T}))

    return lambda T: np.array([one(x) for x in T]).astype(np.result_type(T))


def kernel_G(formula: str = G_PRINTED) -> Kernel:
    return Kernel("G", "influence", ("T",), rounded(formula), 1.0)


@pytest.fixture(scope="module")
def references_of_G() -> list[PointReference]:
    return reference_values("G", grid("G", ("T",)), 50)


def test_accurate_function_passes() -> None:
    (row,) = check(50, [kernel_G()])
    assert row.passed is True
    assert row.double.points >= 60
    assert row.double.max_ulp <= 0.5
    assert row.single is not None
    assert row.single.max_ulp <= 0.5
    assert row.single.dtype == "float32"
    assert row.oracles == checking.AGREEMENTS


NAMES_F = ("z", "phi", "h", "lam", "mu", "A_j")


def test_published_form_in_double_precision_fails(references_of_G: list[PointReference]) -> None:
    def naive(T: Any) -> Any:
        with np.errstate(all="ignore"):
            return (np.sinh(T) * np.cosh(T) + T) / (np.sinh(T) ** 2 - T**2)

    errors = measured_errors(Kernel("G", "influence", ("T",), naive, 8.0), references_of_G)
    assert errors.ratio == math.inf
    assert errors.not_finite > 0
    assert errors.max_ulp > 1e12


def test_single_nan_fails(references_of_G: list[PointReference]) -> None:
    accurate = kernel_G().call

    def with_nan(T: Any) -> Any:
        result = accurate(T)
        result[37] = np.nan
        return result

    errors = measured_errors(dataclasses.replace(kernel_G(), call=with_nan), references_of_G)
    assert errors.not_finite == 1
    assert errors.ratio == math.inf
    assert errors.worst.got[1] == "nan"
    assert errors.worst.arguments[0][1] == references_of_G[37].point.values["T"].hex()


def test_wrong_dtype_and_warnings_fail() -> None:
    accurate = kernel_G().call

    def always_double(T: Any) -> Any:
        return accurate(T).astype(np.float64)

    def noisy(T: Any) -> Any:
        warnings.warn("overflow encountered", RuntimeWarning, stacklevel=1)
        return accurate(T)

    for call in (always_double, noisy):
        (row,) = check(30, [dataclasses.replace(kernel_G(), call=call)])
        assert row.passed is False


def test_wrong_shape_is_rejected(references_of_G: list[PointReference]) -> None:
    kernel = dataclasses.replace(kernel_G(), call=lambda T: np.float64(1.0))  # noqa: ARG005
    with pytest.raises(ValueError, match="gave shape"):
        measured_errors(kernel, references_of_G)


def test_published_formulas_are_measured_without_a_budget() -> None:
    kernel = dataclasses.replace(kernel_G(), module="as_printed", budget=None)
    wrong = dataclasses.replace(kernel, call=rounded("-" + G_PRINTED))
    for chosen, largest in ((kernel, 0.0), (wrong, 1e15)):
        (row,) = check(30, [chosen])
        assert row.passed is None
        assert row.double.ratio is None
        assert row.double.max_ulp >= largest


def test_contradicting_references_stop_the_check(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(routes.ROUTES, "G", lambda v: 2 * v["T"])
    with pytest.raises(OracleError):
        check(30, [kernel_G()])


def test_too_few_digits_are_rejected() -> None:
    with pytest.raises(ValueError, match="at least 20 digits"):
        check(10, [])


def test_table_of_zeros_is_measured_entry_by_entry() -> None:
    def zeros(count: int) -> Any:
        return np.array([float(j0_zero(n, 80)) for n in range(1, count + 1)])

    points = [Point({"count": float(n)}) for n in (1, 2, 50, 1000)]
    reference_result = reference_values("bessel_j0_zeros", points, 30)
    kernel = Kernel("bessel_j0_zeros", "bessel", ("count",), zeros, 1.0)
    assert measured_errors(kernel, reference_result).max_ulp <= 0.5
    shifted = dataclasses.replace(kernel, call=lambda count: zeros(count + 1)[1:])
    assert measured_errors(shifted, reference_result).ratio > 1e6


def test_modal_sum_is_called_once_per_number_of_modes() -> None:
    arguments = ("h", "b", "R", "a")
    points = grid("delta", arguments, modes=True)[:12]
    reference_result = reference_values("delta", points, 30)
    calls = []

    def exact(*columns: Any, modes: int) -> Any:
        calls.append(modes)
        rows = zip(*columns, strict=True)
        values = (dict(zip(arguments, map(float, row), strict=True)) for row in rows)
        return np.array([float(reference("delta", v, 30, modes).value) for v in values])

    kernel = Kernel("delta", "modal_sum", arguments, exact, 1.0, modes=True)
    assert measured_errors(kernel, reference_result).max_ulp <= 0.5
    assert len(calls) == len(set(calls)) > 3

    def one_mode_short(*columns: Any, modes: int) -> Any:
        return exact(*columns, modes=max(1, modes - 1))

    assert (
        measured_errors(dataclasses.replace(kernel, call=one_mode_short), reference_result).ratio
        > 1e3
    )


# --- grids


@pytest.mark.parametrize(
    ("name", "arguments", "modes"),
    [
        ("G", ("T",), False),
        ("C_top", ("phi", "h", "lam", "mu"), False),
        ("mode_f", NAMES_F, False),
        ("A_j", ("phi", "b", "R", "a", "lam", "mu", "J1"), False),
        ("p", ("r", "a", "P"), False),
        ("w", ("r", "z", "h", "b", "R", "a", "lam", "mu"), True),
    ],
)
def test_points_are_in_the_domain_and_reproducible(
    name: str, arguments: tuple[str, ...], modes: bool
) -> None:
    points = grid(name, arguments, modes)
    assert 60 <= len(points) <= 150
    assert points == grid(name, arguments, modes)
    for point in points:
        v = point.values
        assert tuple(v) == arguments
        assert (point.modes is not None) == modes
        assert all(math.isfinite(x) for x in v.values())
        assert v.get("mu", 1) > 0
        assert 3 * v.get("lam", 0) > -2 * v.get("mu", 1)
        assert abs(v.get("z", 0)) <= v.get("h", math.inf)
        assert v.get("a", 0) < min(v.get("b", math.inf), v.get("R", math.inf))
        assert 0 <= v.get("r", 0) <= v.get("b", math.inf)
        if name == "p":
            assert v["r"] < v["a"]


def test_grid_of_a_mode_contains_extreme_arguments() -> None:
    values = [point.values for point in grid("mode_f", NAMES_F)]
    heights = {v["z"] / v["h"] for v in values}
    assert {1.0, -1.0, 0.0} <= heights
    assert any(v["z"] == math.nextafter(v["h"], 0) for v in values)
    phi_h = [v["phi"] * v["h"] for v in values]
    assert min(phi_h) < 1e-149
    assert max(phi_h) > 9e5
    assert any(v["lam"] == 0 for v in values)
    assert any(v["lam"] < 0 for v in values)


def test_both_sides_of_every_switch_point_are_in_the_grid() -> None:
    assert set(switches()) == {"T", "y"}
    in_T = {point.values["T"] for point in grid("G", ("T",))}
    for switch in switches()["T"]:
        assert {switch, math.nextafter(switch, 0), math.nextafter(switch, 9)} <= in_T
    in_y = {p.values["phi"] * p.values["a"] for p in grid("sonine", ("phi", "a"))}
    for switch in switches()["y"]:
        assert {switch, math.nextafter(switch, 0), math.nextafter(switch, 9)} <= in_y


def test_zeros_of_the_sonine_function_are_in_the_grid() -> None:
    """The first two positive roots of tan y = y are used."""
    in_y = [p.values["phi"] * p.values["a"] for p in grid("sonine", ("phi", "a"))]
    assert min(abs(y - 4.493409457909064) for y in in_y) < 1e-15
    assert min(abs(y - 7.725251836937707) for y in in_y) < 2e-15


def test_points_without_an_equivalent_in_single_precision_are_omitted() -> None:
    assert to_single(Point({"T": 0.1})) == Point({"T": float(np.float32(0.1))})
    assert to_single(Point({"T": 1e-60})) is None
    assert to_single(Point({"T": 1e60})) is None
    assert to_single(Point({"r": math.nextafter(0.1, 0), "a": 0.1})) is None
    assert to_single(Point({"z": 0.0, "h": 1.0}, 3)) == Point({"z": 0.0, "h": 1.0}, 3)


# --- rows and records


@pytest.fixture(scope="module")
def row() -> Row:
    (actual,) = check(30, [kernel_G()])
    return actual


def test_kernel_of_a_row_is_the_generated_function() -> None:
    module = pytest.importorskip("generated.arrays")
    kernel = kernel_of_row(
        {"name": "inside", "module": "arrays", "arguments": ("T",), "budget": 8, "modes": False}
    )
    assert kernel.call is module.inside
    assert kernel.budget == 8.0


def test_progress_is_reported_for_every_function() -> None:
    reported: list[tuple[str, int, int]] = []
    check(30, [kernel_G()], lambda *step: reported.append(step))
    assert reported == [("G", 1, 1)]


def test_table_row_matches_the_columns(row: Row) -> None:
    assert len(cells(row)) == len(COLUMNS)
    assert cells(row)[0] == "G"
    assert cells(row)[-1] == "yes"


def test_json_is_reproducible_and_states_its_provenance(row: Row) -> None:
    text = to_json([row], 30, "generated")
    assert text == to_json(check(30, [kernel_G()]), 30, "generated")
    data = json.loads(text)
    assert data["provenance"]["digits"] == 30
    assert {"python", "numpy", "sympy", "python-flint", "mpmath", "generated"} <= set(
        data["provenance"]
    )
    assert data["rows"][0]["double"]["points"] == row.double.points


def test_infinity_is_text_in_json(row: Row) -> None:
    broken = dataclasses.replace(row, double=dataclasses.replace(row.double, ratio=math.inf))
    assert as_data([broken], 30, "generated")["rows"][0]["double"]["ratio"] == "inf"


def test_failed_write_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "accuracy.json"
    write_file(target, "before")

    def fail(self: Path, other: Path) -> None:  # noqa: ARG001
        raise OSError("disk full")

    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(OSError, match="disk full"):
        write_file(target, "after")
    assert target.read_text() == "before"
    assert [path.name for path in tmp_path.iterdir()] == ["accuracy.json"]
