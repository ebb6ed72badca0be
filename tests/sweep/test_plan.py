"""Points of a study: each depends on its index only, and has the given distribution."""

import itertools
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from studies import NORMAL, UNIFORM

from derivation.scene import SceneError
from derivation.sweep import plan
from derivation.sweep.distributions import load_distributions, read_distributions
from derivation.sweep.store import FILE

TWO = read_distributions({"plate.thickness": UNIFORM, "impact.speed": NORMAL})
SKEWED = read_distributions(
    {
        "plate.thickness": {"distribution": "loguniform", "low": 1e-3, "high": 1e2},
        "impact.speed": {"distribution": "lognormal", "mean": 0.13, "std": 0.05},
    }
)
PLANS = [
    plan.grid(["plate.thickness=0.1:0.3:7", "impact.speed=1:3:5", "sphere.radius=0.1:0.2:30"]),
    plan.sample(TWO, 5000, 3, "random"),
    plan.sample(TWO, 1000, 3, "latin-hypercube"),
    plan.sample(TWO, 1024, 3, "sobol"),
    plan.saltelli(TWO, 256, 3),
    plan.sample(SKEWED, 5000, 3, "random"),
]


@pytest.mark.parametrize("one", PLANS, ids=lambda one: getattr(one, "method", type(one).__name__))
def test_points_do_not_depend_on_the_batches(one: plan.Plan) -> None:
    whole = one.points(0, one.size)
    ends = [0, 1, 5, 200, 201, 777, one.size]
    for start, stop in [*itertools.pairwise(ends), (3, 9)]:
        for key, values in one.points(start, stop).items():
            np.testing.assert_array_equal(values, whole[key][start:stop])


@pytest.mark.parametrize("one", PLANS[3:5], ids=["sobol", "saltelli"])
def test_points_do_not_depend_on_other_threads(one: plan.Plan) -> None:
    whole, usual = one.points(0, one.size), sys.getswitchinterval()
    starts = [37 * number % (one.size - 9) for number in range(200)]
    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(8) as pool:
            parts = list(pool.map(lambda start: one.points(start, start + 9), starts))
    finally:
        sys.setswitchinterval(usual)
    for start, points in zip(starts, parts, strict=True):
        for key, values in points.items():
            np.testing.assert_array_equal(values, whole[key][start : start + 9])


def test_grid_has_every_combination_once() -> None:
    points = PLANS[0].points(0, PLANS[0].size)
    assert len(set(zip(*points.values(), strict=True))) == 7 * 5 * 30
    assert points["sphere.radius"][1] != points["sphere.radius"][0]
    assert points["plate.thickness"][1] == points["plate.thickness"][0]


@pytest.mark.parametrize(("text", "ratio"), [("1:100:5:log", 10**0.5), ("1:16:5:log", 2)])
def test_logarithmic_spacing_has_a_constant_ratio(text: str, ratio: float) -> None:
    [values] = plan.grid([f"impact.speed={text}"]).axes.values()
    np.testing.assert_allclose(np.divide(values[1:], values[:-1]), ratio, rtol=1e-14)


@pytest.mark.parametrize("method", plan.METHODS)
@pytest.mark.parametrize(
    ("given", "law"),
    [
        (UNIFORM, stats.uniform(0.15, 0.1)),
        (NORMAL, stats.norm(1.0, 0.1)),
        ({"distribution": "loguniform", "low": 1e-3, "high": 1e2}, stats.loguniform(1e-3, 1e2)),
    ],
)
def test_samples_follow_their_distribution(method: str, given: dict, law: object) -> None:
    made = plan.sample(read_distributions({"impact.speed": given}), 4096, 7, method)
    values = made.points(0, 4096)["impact.speed"]
    assert stats.kstest(values, law.cdf).pvalue > 1e-3  # type: ignore[attr-defined]


def test_lognormal_samples_have_the_given_mean_and_deviation() -> None:
    given = {"distribution": "lognormal", "mean": 0.13, "std": 0.05}
    made = plan.sample(read_distributions({"sphere.radius": given}), 2**16, 7, "sobol")
    values = made.points(0, made.size)["sphere.radius"]
    np.testing.assert_allclose([values.mean(), values.std()], [0.13, 0.05], rtol=2e-3)


def test_latin_hypercube_has_a_point_in_each_layer() -> None:
    values = PLANS[2].points(0, 1000)["plate.thickness"]
    layers = np.floor((values - 0.15) / 0.1 * 1000)
    assert len(set(layers.tolist())) == 1000


def test_saltelli_points_exchange_one_key_at_a_time() -> None:
    points = PLANS[4].points(0, PLANS[4].size)
    rows = np.stack(list(points.values()), axis=1).reshape(256, 4, 2)
    a, b = rows[:, 0], rows[:, 1]
    np.testing.assert_array_equal(rows[:, 2], np.stack([b[:, 0], a[:, 1]], axis=1))
    np.testing.assert_array_equal(rows[:, 3], np.stack([a[:, 0], b[:, 1]], axis=1))
    assert abs(np.corrcoef(a[:, 0], b[:, 0])[0, 1]) < 0.2


def test_another_seed_gives_other_points() -> None:
    for method in plan.METHODS:
        one, other = (plan.sample(TWO, 64, seed, method).points(0, 64) for seed in (1, 2))
        assert not np.intersect1d(one["impact.speed"], other["impact.speed"]).size


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (["plate.thicknes=1:2:3"], "did you mean plate.thickness?"),
        (["plate.thickness=1:2:3", "plate.thickness=1:2:3"], "got it twice"),
        (["plate.thickness=1:2:3", "plate.half_thickness=1:2:3"], "which replace each other"),
        (["impact.speed=0:2:3:log"], "expected positive ends"),
        (["impact.speed=1:1:2"], "expected different values"),
        ([f"{k}=1:2:99999" for k in ("impact.speed", "sphere.radius")], "expected 1 to"),
    ],
)
def test_invalid_grids_are_rejected(wrong: list[str], message: str) -> None:
    with pytest.raises(SceneError, match="expected") as error:
        plan.grid(wrong)
    assert message in str(error.value)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('"impact.speed" = {distribution = "unifrom", low = 1, high = 2}', "did you mean uniform"),
        ('"impact.speed" = {distribution = "uniform", low = 2, high = 1}', "expected low < high"),
        ('"impact.speed" = {distribution = "normal", low = 2, high = 1}', "mean and std of normal"),
        ('"impact.sped" = {distribution = "normal", mean = 2, std = 1}', "impact.speed"),
        ('"impact.speed" = 3', "expected a distribution"),
        ("impact.speed = [", "not valid TOML"),
    ],
)
def test_invalid_distributions_are_rejected(tmp_path: Path, line: str, message: str) -> None:
    path = tmp_path / "vary.toml"
    path.write_text(f"[vary]\n{line}\n")
    with pytest.raises(SceneError) as error:
        load_distributions(path)
    assert message in str(error.value)
    assert "vary.toml" in str(error.value)


def test_sobol_sequence_has_a_power_of_two_of_points() -> None:
    with pytest.raises(SceneError, match="take 512 or 1024"):
        plan.sample(TWO, 1000, 1, "sobol")
    with pytest.raises(SceneError, match=r"makes 4 runs.* take 512 or 1024"):
        plan.saltelli(TWO, 1000, 1)
    with pytest.raises(SceneError, match="got 2; take 4 or 8"):
        plan.saltelli(TWO, 2, 1)


def test_gaps_complement_the_ranges() -> None:
    assert list(plan.gaps([(2, 4), (4, 5), (8, 10)], 12)) == [(0, 2), (5, 8), (10, 12)]
    assert list(plan.gaps([], 3)) == [(0, 3)]
    assert FILE.fullmatch("0000000002-0000000004-ab12.parquet")
