"""Scenes built in Python: same messages as for files, and results as pandas and xarray objects."""

import json
import pickle
from collections.abc import Mapping
from typing import Any

import numpy as np
import platecontact as pc
import pytest
from hypothesis import given
from hypothesis import strategies as st

VALID: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.01, "material": "steel"},
    "plate": {"radius": 0.3, "thickness": 0.05, "material": "glass"},
    "impact": {"speed": 1.0},
    "effects": {"inertia": False},
}
CLASSES: dict[str, Any] = {
    "sphere": pc.Sphere, "plate": pc.Plate, "impact": pc.Impact, "effects": pc.Effects,
    "inertia": pc.Inertia, "accuracy": pc.Accuracy,
}  # fmt: skip
WORDS = st.sampled_from([*VALID["plate"], "mass", "density", "sped", "rtol", "", "a b"])
VALUES = st.one_of(
    st.none(), st.booleans(), st.integers(-3, 3), st.floats(), st.text(max_size=4),
    st.sampled_from(["steel", "tennis ball", "paper"]), st.lists(st.integers(), max_size=2),
    st.dictionaries(WORDS, st.floats(), max_size=2),
)  # fmt: skip


def message(make: Any, *args: Any, **keys: Any) -> str:
    """Return the message of the error that a call raises; empty if it raises none."""
    try:
        make(*args, **keys)
    except pc.SceneError as error:
        return str(error)
    return ""


def by_classes(tables: Mapping[str, Mapping[str, Any]]) -> pc.Scene:
    objects = {name: CLASSES[name](**keys) for name, keys in tables.items()}
    return pc.Scene(**objects)


def test_classes_and_dictionaries_give_the_same_scene() -> None:
    scene = by_classes(VALID)
    assert scene == pc.Scene(**VALID) == pc.read(VALID)  # type: ignore[arg-type]
    assert scene.to_json() == VALID
    assert pc.simulate(scene).contact_time == pc.simulate(pc.read(VALID)).contact_time


@given(
    st.dictionaries(
        st.sampled_from([*CLASSES, "materials", "spher"]),
        st.dictionaries(WORDS, VALUES, max_size=4) | VALUES,
        max_size=5,
    )
)
def test_messages_equal_those_for_a_file(tables: dict[str, Any]) -> None:
    wrong = {**VALID, **tables}
    given = {name: keys for name, keys in wrong.items() if keys is not None}
    assert message(pc.Scene, **wrong) == message(pc.read, given)


@given(st.sampled_from([*CLASSES]), st.dictionaries(WORDS, VALUES, max_size=4))
def test_messages_of_a_table_equal_those_in_a_scene(table: str, keys: dict[str, Any]) -> None:
    first, *more = message(CLASSES[table], **keys).removeprefix(f"{table}: ").splitlines() or [""]
    whole = message(pc.read, {**VALID, table: keys})
    for line in more or [first]:
        assert line in whole


def test_all_problems_are_reported_at_once() -> None:
    text = message(
        pc.Scene,
        sphere={"radius": -1},
        plate={"radius": 1.0, "thik": 2.0},
        impact=pc.Impact(speed=1),
    )
    for key in ("sphere.radius", "[sphere]", "plate.thik", "[plate]"):
        assert f"  - {key}: " in text
    assert message(pc.Sphere, radius=-1, mass=1).startswith("sphere.radius: ")


def test_numpy_numbers_are_accepted() -> None:
    sphere = pc.Sphere(radius=np.float32(0.5), mass=np.int64(2))
    assert (sphere.radius, sphere.mass) == (0.5, 2.0)
    assert type(sphere.radius) is float
    scene = pc.read(VALID | {"impact": {"speed": np.float64(2.0)}})
    assert json.dumps(scene.to_json())
    assert "got true" in message(pc.Impact, speed=True)
    assert "got true" in message(pc.Impact, speed=np.bool_(True))
    assert pc.Effects(inertia=np.bool_(False)) == pc.Effects(inertia=False)
    assert pc.Impact(speed=np.array(2.0)) == pc.Impact(speed=2.0)
    assert "got nan" in message(pc.Impact, speed=np.float64("nan"))


def test_former_names_are_accepted_with_a_warning() -> None:
    with pytest.warns(FutureWarning, match=r"plate\.retardation_time"):
        scene = pc.Scene(**VALID | {"plate": VALID["plate"] | {"viscous_time": 1e-6}})  # type: ignore[arg-type]
    assert scene.plate.retardation_time == 1e-6


@pytest.fixture(scope="module", params=[False, "auto"], ids=["quasi-static", "dynamic"])
def result(request: pytest.FixtureRequest) -> pc.Result:
    return pc.simulate(pc.read(VALID | {"effects": {"inertia": request.param}}), rtol=1e-2)


def test_xarray_data_set_has_results_and_history_with_units(result: pc.Result) -> None:
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


def test_xarray_data_set_has_the_dent_of_a_plastic_contact(result: pc.Result) -> None:
    """On a quasi-static plate the sphere separates when it has risen to the bottom of the dent."""
    plate = VALID["plate"] | {"yield_stress": 1e6}
    still = VALID | {"plate": plate, "effects": {"inertia": False, "plasticity": True}}
    data = pc.simulate(pc.read(still)).to_xarray()
    assert data["dent"].units == "m"
    assert float(data["dent"]) == pytest.approx(float(data["indentation"][-1]), rel=1e-6)
    assert "dent" not in result.to_xarray()


def test_pandas_data_frame_has_the_history(result: pc.Result) -> None:
    frame = result.to_pandas(50)
    assert len(frame) == 50
    assert frame.index.name == "time"
    assert frame.index.is_monotonic_increasing
    assert set(frame.attrs["units"]) == {"time", *frame.columns}
    assert frame["force"].max() == pytest.approx(result.max_force, rel=1e-2)


def test_plot_returns_a_figure(result: pc.Result) -> None:
    from matplotlib.figure import Figure

    figure = result.plot()
    assert isinstance(figure, Figure)
    assert len(figure.axes) >= 3


def test_result_from_another_process_is_the_same(result: pc.Result) -> None:
    """Processes exchange results by pickle."""
    restored = pickle.loads(pickle.dumps(result))
    assert restored == result
    assert restored.to_json() == result.to_json()
    assert restored.details() == result.details()
    assert restored.to_pandas().equals(result.to_pandas())


def test_changed_copies_are_checked() -> None:
    scene = pc.read(VALID)
    faster = scene.model_copy(update={"impact": {"speed": 2.0}})
    assert faster == pc.read(VALID | {"impact": {"speed": 2.0}})
    rigid = scene.sphere.model_copy(update={"material": None, "mass": 1.0})
    assert rigid.to_json() == {"radius": 0.01, "mass": 1.0}
    both = message(scene.plate.model_copy, update={"half_thickness": 0.01})
    assert both.startswith("[plate]: expected either plate.half_thickness or plate.thickness")
    with pytest.raises(pc.SceneError, match=r"plate.radius: cannot be changed; .*model_copy"):
        scene.plate.radius = 1.0


def test_unknown_result_has_no_bound(result: pc.Result) -> None:
    assert "contact_time, max_indentation" in message(result.bound_of, "max force")


@pytest.mark.parametrize("points", [1, 2.5, "9"])
def test_pressures_need_two_points(result: pc.Result, points: Any) -> None:
    assert message(result.pressures, points).startswith("points: expected a whole number")


def test_static_contacts_take_a_sequence() -> None:
    forces = np.array([[1.0, 10.0]])
    assert "2 dimensions" in message(pc.indent, pc.read(VALID), force=forces)


@pytest.mark.parametrize("wrong", ["scene.toml", VALID])
def test_a_file_or_tables_must_be_read_first(wrong: Any) -> None:
    assert "read a file with load(path)" in message(pc.simulate, wrong)
    assert "tables with read(tables)" in message(pc.sweep, wrong, {"impact.speed": [1.0]})
