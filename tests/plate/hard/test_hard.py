"""Test that the hard cases are complete, well-formed, and have correct references."""

import dataclasses
import json
import random
from collections import Counter
from pathlib import Path
from typing import Any

import flint
import pytest

from derivation.engine.formula.ulp import from_ordinal, ordinal
from derivation.engine.measure import origin as hard_origin
from derivation.engine.measure.case import FORMS, HardCase, call_arguments, checked_case, read_cases
from derivation.engine.measure.neighbours import OFFSETS
from derivation.engine.measure.suite import Known, Suite, find_references
from derivation.engine.oracle.reference import Stored, reference_from_text
from derivation.plate.cases.laws import LAWS
from derivation.plate.cases.suite import WRITTEN
from derivation.plate.grids import switches
from derivation.plate.impact.oracle.agreement import agree
from derivation.plate.modes.route import routes
from derivation.plate.paper import PAPER

GROUPS = {
    "found by search": 39,
    "phi h near 0": 20,
    "phi h large": 15,
    "scaled and plain constants": 16,
    "c1 = 0": 10,
    "thin plates": 10,
    "thick plates": 10,
    "contacts beyond 3 h": 10,
    "edge of the plate": 10,
    "zeros of s": 10,
    "reversed series": 8,
    "past the turning point": 4,
    "soft impacts": 6,
    "Poisson's ratio at its ends": 20,
    "systems of units": 12,
    "single precision": 15,
    "subnormal numbers": 12,
    "infinities and NaN": 15,
    "shapes and types": 36,
    "sums over the modes": 8,
    "switch points of the building blocks": 30,
    "switch points of the Bessel functions": 80,
    "switch points of the contact law": 90,
    "Bessel zeros by index": 24,
    "doubles next to zeros of J0 and J1": 12,
    "series constants by index": 30,
    "switch points of the closed formulas": 50,
    "switch points of the sums over modes": 30,
    "switch points of the edge": 56,
    "switch points of the back face": 30,
    "switch points of the sphere": 1,
    "switch points of the non-Hertzian pressure": 15,
    "switch points of the impact": 9,
    "switch points of simple impacts": 10,
    "switch points of the paper's motion": 3,
    "switch points of the plate's waves": 36,
    "switch points of clamped and supported plates": 6,
    "waves of clamped and supported plates": 12,
    "waves of the plate": 100,
}
"""Groups of hard cases, with the least number of cases in each."""


@pytest.fixture(scope="module")
def data() -> dict[str, Any]:
    actual: dict[str, Any] = json.loads(PAPER.hard.read_text())
    return actual


# --- contents


def test_every_group_has_cases(cases: tuple[HardCase, ...]) -> None:
    assert len(cases) >= 150
    counts = Counter(case.group for case in cases)
    short = {name: counts[name] for name, least in GROUPS.items() if counts[name] < least}
    assert not short
    assert set(counts) == set(GROUPS)


def test_every_form_of_arguments_is_used(cases: tuple[HardCase, ...]) -> None:
    for form in FORMS:
        assert len({case.kernel for case in cases if case.form == form}) >= 4, form
    shapes = {case.shape for case in cases}
    assert {(), (0,)} <= shapes
    assert any(len(shape) == 2 for shape in shapes)


def test_every_switch_point_of_the_blocks_has_cases(cases: tuple[HardCase, ...]) -> None:
    points = [
        case.points[0] for case in cases if case.group == "switch points of the building blocks"
    ]
    reached = {
        "T": {p["T"] for p in points if "T" in p},
        "y": {p["phi"] for p in points if p.get("a") == 1.0},
    }
    assert switches()
    for variable, places in switches().items():
        for point in places:
            wanted = {from_ordinal(ordinal(point) + offset) for offset in (-32, -1, 0, 1, 32)}
            assert wanted <= reached[variable]


def test_switch_points_have_cases_at_all_offsets(cases: tuple[HardCase, ...]) -> None:
    assert OFFSETS == (-32, -1, 0, 1, 32)
    arrays = [c for c in cases if c.group == "switch points of the Bessel functions"]
    for case in arrays:
        at = [ordinal(x) for x in case.numbers["x"]]
        assert tuple(point - at[2] for point in at) == OFFSETS


def test_cases_of_zeros_reach_from_index_1_to_a_million(cases: tuple[HardCase, ...]) -> None:
    counts = {c.numbers["count"][0] for c in cases if c.kernel == "bessel_j0_zeros"}
    assert {1.0, 10.0, 1e3, 1e6} <= counts


def test_causes_are_sentences_and_inputs_are_exact(cases: tuple[HardCase, ...]) -> None:
    for case in cases:
        assert len(case.cause.split()) >= 3
        for texts in case.inputs.values():
            assert all(text.lstrip("-").startswith(("0x", "nan", "inf")) for text in texts)


# --- references


def test_references_have_40_digits(references: dict[str, Known]) -> None:
    with flint.ctx.workprec(400):
        for key, known in references.items():
            for row in known.references:
                if row["value"] in ("nan", "inf", "-inf", "0"):
                    continue
                ball = reference_from_text(row).value
                assert ball.rad() <= abs(ball) * flint.arb(10) ** -40, key


def test_record_agrees_with_the_definitions(
    cases: tuple[HardCase, ...], data: dict[str, Any]
) -> None:
    kept = {row["key"]: row for row in data["cases"]}
    assert [case.key for case in cases] == [row["key"] for row in data["cases"]]
    for case in cases:
        row = kept[case.key]
        assert (row["group"], row["cause"], row["expect"]) == (case.group, case.cause, case.expect)
        assert {name: tuple(texts) for name, texts in row["inputs"].items()} == case.inputs


def test_references_are_reproducible(suite: Suite, references: dict[str, Known]) -> None:
    generator = random.Random(7)
    values = [c for c in suite.cases if c.expect == "value" and 0 < len(c.points) < 6]
    closed = [case for case in values if case.kernel not in LAWS]
    laws = [c for c in values if c.kernel in ("indentation", "stiffness") and not c.shape]
    quick = ("sphere_contact", "plate_of", "back_face_stress", "contact", "clamped_edge_bound",
             "dynamic_influence", "bending_fraction", "symmetric_residue")  # fmt: skip
    switches = [next(c for c in values if c.kernel == kernel) for kernel in quick]
    for case in (*generator.sample(closed, 24), *generator.sample(laws, 3), *switches):
        fresh = suite.references(case)
        for old, new in zip(references[case.key].references, fresh, strict=True):
            if new["value"] in ("nan", "inf", "-inf"):
                assert old == new
                continue
            with flint.ctx.workprec(400):
                assert reference_from_text(old).value.overlaps(reference_from_text(new).value), (
                    case.key
                )


def test_second_reference_agrees(suite: Suite, references: dict[str, Known]) -> None:
    generator = random.Random(3)
    moderate = {"systems of units", "shapes and types", "contacts beyond 3 h"}
    values = [c for c in suite.cases if c.expect == "value" and not c.shape]
    values = [c for c in values if c.group in moderate]
    sizes = [c for c in values if all(1e-9 < abs(x[0]) < 1e12 for x in c.numbers.values())]
    laws = [case for case in sizes if case.kernel in ("indentation", "stiffness")]
    closed = [case for case in sizes if case.kernel in ("K_j", "C_top", "G", "mode_f")]
    for case in (*generator.sample(laws, 3), *generator.sample(closed, 3)):
        (row,), (point,) = references[case.key].references, case.points
        arguments = [point[name] for name in suite.kernels[case.kernel].arguments]
        if case in laws:
            (value,) = agree(case.kernel, arguments, 24).values
        else:
            value = routes.agree(case.kernel, point, 24)
        with flint.ctx.workprec(200):
            assert abs(reference_from_text(row).value - value) < abs(value) * flint.arb(10) ** -23


def test_references_are_those_of_the_present_expressions(
    suite: Suite, references: dict[str, Known]
) -> None:
    """The references of closed formulas were computed from the present expressions.

    Laws are excluded: changing the code of their Arb reference does not change a correct value.
    """
    closed = {case.kernel: case for case in suite.cases if case.kernel not in LAWS}
    assert {name: references[case.key].origin for name, case in closed.items()} == {
        name: suite.origin(name) for name in closed
    }


# --- computing the references


def test_origin_changes_only_with_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The origin depends on code, also of imported modules of the paper, but not on comments."""
    monkeypatch.syspath_prepend(tmp_path)
    engine = "from derivation.engine.formula.ball import to_ball\n"
    texts = {
        "plain": f"{engine}from .part import g\nA = 1\ndef f(x):\n    return g(x), 'it grows'\n",
        "documented": f'"""What it does."""\n{engine}from .part import g\nA = 1\n"""Its size."""\n'
                'def f(x):\n    """Same."""\n    return g(x), "it increases"  # as it is\n',
        "other": f"{engine}from .part import g\nA = 1\ndef f(x):\n    return -g(x), 'it grows'\n",
        "part": "def g(x):\n    return x\n",
    }  # fmt: skip
    package = tmp_path / "some_paper"
    package.mkdir()
    for name, text in {"__init__": "", **texts}.items():
        (package / f"{name}.py").write_text(text)

    def origins() -> list[str]:
        hard_origin.of_modules.cache_clear()
        names = ("plain", "documented", "other")
        return [hard_origin.of_modules((f"some_paper.{name}",)) for name in names]

    plain, documented, other = before = origins()
    assert plain == documented != other
    (package / "part.py").write_text("def g(x):\n    return 2 * x\n")
    assert not set(before) & set(origins())


def test_interrupted_record_is_continued(
    suite: Suite, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Saved references are not computed again, unless their origin has changed."""
    recorded, part = tmp_path / "hard.json", tmp_path / "hard.part.json"
    given = [case for case in suite.cases if case.kernel == "G" and case.expect == "value"][:4]
    few, references = dataclasses.replace(suite, cases=tuple(given)), Suite.references
    computed: list[str] = []

    def seek(self: Suite, case: HardCase) -> list[Stored]:
        if len(computed) == 2:
            raise KeyboardInterrupt
        computed.append(case.key)
        return references(self, case)

    def find() -> dict[str, Known]:
        return find_references(few, recorded, part)

    monkeypatch.setattr(Suite, "references", seek)
    with pytest.raises(KeyboardInterrupt):
        find()
    assert computed == [case.key for case in given[:2]]
    computed.clear()
    assert list(find()) == [case.key for case in given]
    assert computed == [case.key for case in given[2:]]
    part.rename(recorded)
    computed.clear()
    whole = find()
    assert not computed
    assert [list(whole[case.key].references) for case in given] == [
        references(suite, case) for case in given
    ]
    monkeypatch.setattr(Suite, "origin", lambda *_: "something else")
    with pytest.raises(KeyboardInterrupt):
        find()
    assert computed == [case.key for case in given[:2]]


# --- format of the cases


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"form": "curled"}, "form"),
        ({"expect": "luck"}, "expect must be"),
        ({"cause": "no sentence"}, "ends in a period"),
        ({"inputs": {"T": ("0x1p+0", "0x1p+1")}}, "one number for each"),
        ({"form": "array", "inputs": {"T": ("0x1p+0",) * 2, "z": ("0x1p+0",) * 3}}, "equal length"),
        ({"form": "float32", "inputs": {"T": ("0x1.0000000000001p+0",)}}, "single"),
    ],
)
def test_invalid_cases_are_rejected(change: dict[str, Any], message: str) -> None:
    sound = HardCase("group", "G", "A sentence.", {"T": ("0x1p+0",)})
    assert checked_case(sound) == sound
    with pytest.raises(ValueError, match=message):
        checked_case(dataclasses.replace(sound, **change))


def test_forms_of_arguments_are_as_named() -> None:
    given = {"T": ("0x1p+0", "0x1p+1"), "h": ("0x1p+2",)}
    case = HardCase("group", "G", "A sentence.", given, "strided")
    strided, single = call_arguments(case, ("T", "h"))
    assert single == 4.0
    assert strided.tolist() == [1.0, 2.0]
    assert not strided.flags.c_contiguous
    (fixed, _) = call_arguments(dataclasses.replace(case, form="read-only"), ("T", "h"))
    assert not fixed.flags.writeable
    (whole, number) = call_arguments(dataclasses.replace(case, form="integer"), ("T", "h"))
    assert whole.dtype.kind == "i"
    assert type(number) is int
    grid = dataclasses.replace(case, form="broadcast", inputs={**given, "z": ("0x1p+3",) * 3})
    (column, row) = call_arguments(grid, ("T", "z"))
    assert column.shape == (2, 1)
    assert row.shape == (3,)
    assert grid.shape == (2, 3)
    assert len(grid.points) == 6


def test_most_groups_are_hand_written() -> None:
    assert len({case.group for case in read_cases(WRITTEN)}) >= 18
