"""Sensitivity indices of functions whose indices are known."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import platecontact as pc
import pytest
from scipy.stats import qmc
from studies import QUICK, scene

from derivation.cli import main
from derivation.scene.result import UNITS
from derivation.scene.rows.rows import Rows
from derivation.sweep import run, sensitivity
from derivation.sweep.plots import figure

SPREAD = {"distribution": "uniform", "low": 1.0, "high": 2.0}
KEYS = ("impact.speed", "sphere.radius", "plate.radius")


def rows(_: object, columns: dict[str, np.ndarray], *__: object) -> Rows:
    """Return results that include a sum, a product, a constant, and noise below the bound."""
    x, y, z = (columns[key] for key in KEYS)
    made = [x + 2 * y, (x - 1.5) * (y - 1.5) + z, 0 * x + 1, 1 + 1e-9 * x, x, y, z]
    texts = [np.full(len(x), text, dtype=object) for text in ("", "hertz")]
    bound = np.full(len(x), 1e-6)
    status = np.full(len(x), "finished")
    return Rows(
        dict(zip(UNITS, made, strict=True)),
        dict.fromkeys(UNITS, bound),
        bound,
        0 * bound,
        status,
        *texts,
    )


def test_indices_of_known_functions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "solve", rows)
    monkeypatch.setattr(sensitivity, "RESAMPLES", 100)
    vary = dict.fromkeys(KEYS, SPREAD)
    data = pc.sweep(scene(), vary, sample=1024, sensitivity=True)
    assert data.sizes["sample"] == 1024 * 5
    variance = 1 / 12
    joint = variance**2 / (variance**2 + variance)
    names = list(UNITS)
    reference = {
        names[0]: ([0.2, 0.8, 0], [0.2, 0.8, 0]),
        names[1]: ([0, 0, 1 - joint], [joint, joint, 1 - joint]),
        names[4]: ([1, 0, 0], [1, 0, 0]),
    }
    for name, (first, total) in reference.items():
        one = data.sel(result=name)
        np.testing.assert_allclose(one["first_order"].sel(key=list(KEYS)), first, atol=0.03)
        np.testing.assert_allclose(one["total_order"].sel(key=list(KEYS)), total, atol=0.03)
        for order in ("first_order", "total_order"):
            assert (one[f"{order}_low"] <= one[order] + 1e-12).all()
            assert (one[order] <= one[f"{order}_high"] + 1e-12).all()
    for name in names[2:4]:
        assert np.isnan(data.sel(result=name)["first_order"]).all()


def test_results_without_a_bound_have_no_indices(monkeypatch: pytest.MonkeyPatch) -> None:
    """A bound on the restitution is no bound on the force, which omitted effects may change."""
    monkeypatch.setattr(run, "solve", rows)
    monkeypatch.setattr(sensitivity, "RESAMPLES", 9)
    vary, names = dict.fromkeys(KEYS, SPREAD), list(UNITS)
    for outputs, known in (
        (["restitution"], ["restitution"]),
        (["max_force", "restitution"], ["restitution", "max_tensile_stress"]),  # P is constant
        (["contact_time"], ["contact_time"]),
    ):
        accuracy = pc.Accuracy(rtol=0.1, outputs=outputs)
        given = scene().model_copy(update={"accuracy": accuracy})
        data = pc.sweep(given, vary, sample=64, sensitivity=True)
        found = np.isfinite(data["first_order"]).all(dim="key")
        assert [name for name in names if found.sel(result=name)] == known


def test_confidence_intervals_have_their_coverage(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(run, "solve", rows)
    monkeypatch.setattr(sensitivity, "RESAMPLES", 100)
    inside = []
    for seed in range(20):
        data = pc.sweep(
            scene(), dict.fromkeys(KEYS, SPREAD), sample=64, sensitivity=True, seed=seed
        ).sel(result=next(iter(UNITS)), key="sphere.radius")
        inside.append(data["first_order_low"] < 0.8 < data["first_order_high"])
    assert sum(map(bool, inside)) >= 17


@pytest.mark.one_version
def test_few_points_have_wide_intervals() -> None:
    """Bootstrap intervals alone contained 81 % of the indices with 4 points, 85 % with 8."""
    rng, weights = np.random.default_rng(0), np.array([1.0, 2.0])
    index = weights**2 / np.sum(weights**2)
    inside = []
    for base in (4, 8):
        for _ in range(60):
            points = qmc.Sobol(4, rng=rng).random(base)
            one, other = points[:, :2], points[:, 2:]
            mixed = [np.where(np.arange(2) == key, other, one) for key in range(2)]
            values = np.stack([x @ weights for x in (one, other, *mixed)], axis=-1)
            _, low, high = sensitivity._with_intervals(values[None])
            inside.append(((low[:, 0] <= index) & (index <= high[:, 0])).mean())
    assert np.mean(inside) > 0.9


def test_intervals_do_not_depend_on_the_number_of_studies_evaluated_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    values = np.random.default_rng(1).normal(size=(3, 6, 5))
    together = sensitivity._with_intervals(values)
    monkeypatch.setattr(sensitivity, "BLOCK", 1)
    assert sensitivity._with_intervals(values) == pytest.approx(together, rel=1e-12)


def test_indices_of_one_result_and_key() -> None:
    """SciPy's function fails for them."""
    points = qmc.Sobol(2, rng=0).random(64)
    [first], [total] = sensitivity._indices(points[None][:, :, [0, 1, 1]])
    assert [*first, *total] == pytest.approx([1.0, 1.0], abs=0.05)


def test_command_prints_and_plots_indices(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(run, "solve", rows)
    monkeypatch.setattr(sensitivity, "RESAMPLES", 100)
    given = tmp_path / "vary.toml"
    line = '{distribution = "uniform", low = 1, high = 2}'
    given.write_text("[vary]\n" + "".join(f'"{key}" = {line}\n' for key in KEYS))
    begin = ["sweep", str(QUICK), "--distributions", str(given), "--sample", "64"]
    picture, path = tmp_path / "bars.png", tmp_path / "found.json"
    more = ["--sensitivity", "--plot", str(picture), "--json", str(path)]
    assert main([*begin, *more]) == 0
    shown = capsys.readouterr().out
    assert "from 320 runs" in shown
    assert "no scatter" in shown
    assert max(map(len, shown.splitlines())) <= 80
    assert picture.read_bytes().startswith(b"\x89PNG")
    data = json.loads(path.read_text())["sensitivities"]
    assert len(data) == len(KEYS) * len(UNITS)


def test_keys_with_long_descriptions_leave_room_for_the_bars(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An earlier version drew bars of a few pixels beside the words of the loss factor."""
    monkeypatch.setattr(run, "solve", rows)
    monkeypatch.setattr(sensitivity, "RESAMPLES", 10)
    data = pc.sweep(scene(), dict.fromkeys(KEYS, SPREAD), sample=8, sensitivity=True)
    keys = ["plate.loss_factor", "materials.ice.density", "materials.my $tile$.density"]
    made = figure(data.assign_coords(key=keys), keys, list(UNITS))
    made.draw_without_rendering()
    for axes in made.axes:
        assert axes.get_position().width * made.get_figwidth() > 2.5  # inches
    names = [" ".join(text.get_text().split()) for text in made.axes[0].get_yticklabels()]
    assert names[0] == "loss factor of the plate vibration"
    assert names[1:] == ["density of ice", r"density of my \$tile\$"]


def test_points_without_a_result_have_no_sensitivities(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def some(_: object, columns: dict[str, np.ndarray], *__: object) -> Rows:
        made = rows(_, dict.fromkeys(KEYS, columns["impact.speed"]))
        status = np.where(columns["impact.speed"] > 0, "finished", "rejected")
        return replace(made, status=status)

    monkeypatch.setattr(run, "solve", some)
    given = tmp_path / "vary.toml"
    given.write_text('[vary]\n"impact.speed" = {distribution = "normal", mean = 0.2, std = 0.2}\n')
    begin = ["sweep", str(QUICK), "--distributions", str(given), "--sample", "8"]
    assert main([*begin, "--sensitivity", "--out", str(tmp_path / "rows.csv")]) == 2
    assert "expected every point to finish, but" in capsys.readouterr().err
    assert (tmp_path / "rows.csv").exists()
