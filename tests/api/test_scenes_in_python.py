"""Scenes from Python without files: the messages of a file, and results for pandas and xarray."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import platecontact as pc
import pytest
from hypothesis import given
from hypothesis import strategies as st

GOOD: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.01, "material": "steel"},
    "plate": {"radius": 0.3, "thickness": 0.05, "material": "glass"},
    "impact": {"speed": 1.0},
    "effects": {"inertia": False},
}
CLASSES: dict[str, Any] = {
    "sphere": pc.Sphere, "plate": pc.Plate, "impact": pc.Impact, "effects": pc.Effects,
    "inertia": pc.Inertia, "accuracy": pc.Accuracy,
}  # fmt: skip
WORDS = st.sampled_from([*GOOD["plate"], "mass", "density", "sped", "rtol", "", "a b"])
VALUES = st.one_of(
    st.none(), st.booleans(), st.integers(-3, 3), st.floats(), st.text(max_size=4),
    st.sampled_from(["steel", "tennis ball", "paper"]), st.lists(st.integers(), max_size=2),
    st.dictionaries(WORDS, st.floats(), max_size=2),
)  # fmt: skip


def message(make: Any, *args: Any, **keys: Any) -> str:
    """What a call is refused with; empty if it is not."""
    try:
        make(*args, **keys)
    except pc.SceneError as error:
        return str(error)
    return ""


def by_classes(tables: Mapping[str, Mapping[str, Any]]) -> pc.Scene:
    made = {name: CLASSES[name](**keys) for name, keys in tables.items()}
    return pc.Scene(**made)


def test_classes_dictionaries_and_a_file_s_tables_make_the_same_scene() -> None:
    scene = by_classes(GOOD)
    assert scene == pc.Scene(**GOOD) == pc.read(GOOD)  # type: ignore[arg-type]
    assert scene.to_json() == GOOD
    assert pc.simulate(scene).contact_time == pc.simulate(pc.read(GOOD)).contact_time


@given(
    st.dictionaries(
        st.sampled_from([*CLASSES, "materials", "spher"]),
        st.dictionaries(WORDS, VALUES, max_size=4) | VALUES,
        max_size=5,
    )
)
def test_whatever_is_wrong_the_messages_are_those_of_a_file(tables: dict[str, Any]) -> None:
    wrong = {**GOOD, **tables}
    given = {name: keys for name, keys in wrong.items() if keys is not None}
    assert message(pc.Scene, **wrong) == message(pc.read, given)


@given(st.sampled_from([*CLASSES]), st.dictionaries(WORDS, VALUES, max_size=4))
def test_a_table_s_problems_are_those_it_has_in_a_scene(table: str, keys: dict[str, Any]) -> None:
    """But for the hint that an unknown key belongs to another table, of which it knows nothing."""
    said, *more = message(CLASSES[table], **keys).removeprefix(f"{table}: ").splitlines() or [""]
    whole = message(pc.read, {**GOOD, table: keys})
    for line in more or [said]:
        assert line.partition(";")[0] in whole


def test_all_problems_are_told_at_once() -> None:
    text = message(
        pc.Scene,
        sphere={"radius": -1},
        plate={"radius": 1.0, "thik": 2.0},
        impact=pc.Impact(speed=1),
    )
    for key in ("sphere.radius", "[sphere]", "plate.thik", "[plate]"):
        assert f"  - {key}: " in text
    assert message(pc.Sphere, radius=-1, mass=1).startswith("sphere.radius: ")


def test_numbers_of_numpy_are_numbers() -> None:
    sphere = pc.Sphere(radius=np.float32(0.5), mass=np.int64(2))
    assert (sphere.radius, sphere.mass) == (0.5, 2.0)
    assert type(sphere.radius) is float
    scene = pc.read(GOOD | {"impact": {"speed": np.float64(2.0)}})
    assert json.dumps(scene.to_json())
    assert "got true" in message(pc.Impact, speed=True)
    assert "got nan" in message(pc.Impact, speed=np.float64("nan"))


def test_old_names_are_accepted_with_a_notice() -> None:
    with pytest.warns(FutureWarning, match=r"plate\.retardation_time"):
        scene = pc.Scene(**GOOD | {"plate": GOOD["plate"] | {"viscous_time": 1e-6}})  # type: ignore[arg-type]
    assert scene.plate.retardation_time == 1e-6


@pytest.fixture(scope="module", params=[False, "auto"], ids=["quasi-static", "dynamic"])
def result(request: pytest.FixtureRequest) -> pc.Result:
    return pc.simulate(pc.read(GOOD | {"effects": {"inertia": request.param}}), rtol=1e-2)


def test_a_data_set_holds_results_and_history_with_units(result: pc.Result) -> None:
    data, history = result.to_xarray(), result.history()
    assert float(data["max_force"]) == result.max_force
    assert data["max_force"].attrs == {"long_name": "max force", "units": "N"}
    assert data["time"].units == "s"
    assert all(data[name].units for name in data.data_vars)
    for name, column in history._asdict().items():
        np.testing.assert_array_equal(data[name], column)
    # The impulse is the change of momentum.
    mass = result.model.m
    lost = mass * float(data["velocity"][0] - data["velocity"][-1])
    assert float(data["force"].integrate("time")) == pytest.approx(lost, rel=1e-3)
    assert pc.read(json.loads(data.attrs["scene"])) == result.scene


def test_a_data_frame_holds_the_history_over_time(result: pc.Result) -> None:
    frame = result.to_pandas(50)
    assert len(frame) == 50
    assert frame.index.name == "time"
    assert frame.index.is_monotonic_increasing
    assert set(frame.attrs["units"]) == {"time", *frame.columns}
    assert frame["force"].max() == pytest.approx(result.max_force, rel=1e-2)


def test_a_plot_is_a_figure_to_be_saved(result: pc.Result) -> None:
    from matplotlib.figure import Figure

    figure = result.plot()
    assert isinstance(figure, Figure)
    assert len(figure.axes) >= 3
