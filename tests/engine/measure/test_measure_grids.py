"""Test points of the contact law, and errors raised if there is nothing to measure."""

import importlib
from types import SimpleNamespace

import numpy as np
import pytest

from derivation.engine.measure import judge, record
from derivation.plate.contact.cases import check as contact
from derivation.plate.contact.cases import grid as contact_grid
from derivation.plate.judge import generated_kernels
from generated import contact_law
from generated.impact import impact


@pytest.mark.parametrize("name", contact.KERNELS)
def test_arguments_describe_the_drawn_contact(name: str) -> None:
    """The generated law gives the contact radius, force and pressure of Hertz theory."""
    for shape in contact_grid.grid(name)[:30:6]:
        given = contact_grid.arguments(name, shape, 20)
        a, R, lam, mu = shape.a, shape.R, shape.lam, shape.mu
        assert 0.0 < a < min(R, shape.b)
        load = 16 * mu * (lam + mu) / (3 * (lam + 2 * mu)) * a**3 / R
        expected = {
            "indentation": contact_law.indentation(a, R, shape.h, shape.b),
            "contact_radius": a,
            "radius_of_force": a,
            "force": load,
            "force_of_radius": load,
            "max_pressure": 1.5 * load / (np.pi * a * a),
            "impact": a,
        }
        if name == "impact":
            actual = impact(*given).max_contact_radius
        else:
            actual = getattr(contact_law, name)(*given)
        if name == "stiffness":  # dP/d(delta) from central differences
            ends = [
                (contact_law.force_of_radius(x, R, lam, mu),
                 contact_law.indentation(x, R, shape.h, shape.b))
                for x in (a * (1 - 1e-5), a * (1 + 1e-5))
            ]  # fmt: skip
            slope = (ends[1][0] - ends[0][0]) / (ends[1][1] - ends[0][1])
            assert actual == pytest.approx(slope, rel=1e-4)
        else:
            assert actual == pytest.approx(expected[name], rel=1e-9)


def test_grid_of_impacts_is_reproducible_and_has_the_listed_ratios() -> None:
    assert contact_grid.grid("impact") == contact_grid.grid("impact")
    assert len(contact_grid.grid("impact")) == len(contact_grid.IMPACTS)
    ratios = [(s.h / s.b, s.a / s.h) for s in contact_grid.grid("impact")]
    np.testing.assert_allclose(ratios, contact_grid.IMPACTS, rtol=1e-12)


def test_measurement_without_points_is_rejected() -> None:
    with pytest.raises(ValueError, match="no point to measure force at"):
        contact.check({"force": contact_law.force}, {"force": []})
    [kernel] = [kernel for kernel in generated_kernels() if kernel.name == "G"]
    with pytest.raises(ValueError, match="no point at which float64 can hold G"):
        judge.measured_errors(kernel, [], 3)


def test_root_mean_square_of_zeros_and_of_large_numbers() -> None:
    assert judge._rms([0.0, 0.0]) == judge._rms([]) == 0.0
    assert judge._rms([3e200, 4e200]) == pytest.approx(5e200 / 2**0.5, rel=1e-15)


def test_package_without_files_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    """Python imports an empty folder as a namespace package, which has no file."""
    original = importlib.import_module
    monkeypatch.setattr(
        record.importlib, "import_module",
        lambda name: SimpleNamespace(__file__=None) if name == "generated" else original(name),
    )  # fmt: skip
    with pytest.raises(FileNotFoundError, match="run `platecontact generate`"):
        record.generated_hash("generated")
