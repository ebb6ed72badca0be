"""Impacts whose contacts are followed in part: what was found is kept, and shown as incomplete."""

import json
import pickle
import re
from pathlib import Path
from typing import Any

import pytest

from derivation.cli import main
from derivation.scene import contact_sequence, flight, waves
from derivation.scene.effects import WHOLE_PLATE
from derivation.scene.law import ContactLaw
from derivation.scene.model import InertiaSettings, Model
from derivation.scene.scene import IncompleteError

BALL = Model(
    R=0.02, m=0.25, v0=1.0, h=0.005, b=0.15, lam=40e9, mu=27e9, density=2700.0,
    inertia=InertiaSettings(modes=8),
)  # fmt: skip
SCENE = """
[sphere]
radius = 0.02
material = "steel"
[plate]
radius = 0.2
thickness = 0.01
material = "aluminium"
[impact]
speed = 1.0
[effects]
inertia = true
[inertia]
modes = 8
"""


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("CONTACTS", 1, "had not left the plate for good after 1 contacts"),
        ("BLOCKS", 0, "moved side by side without contact"),
        ("ELEMENTS", 0, "limit of .* time steps"),
    ],
)
def test_contacts_before_one_that_does_not_end_are_kept(
    name: str, value: int, says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = waves.problem_of(ContactLaw(BALL, WHOLE_PLATE | {"hertz", "inertia"}), 8)
    whole = contact_sequence.impact_history(problem, 10)
    assert whole.complete
    assert len(whole.contacts) == 2
    limit = value or len(whole.contacts[0].pieces) + (1 if name == "ELEMENTS" else 0)
    module = flight if name == "BLOCKS" else contact_sequence
    monkeypatch.setattr(module, name, limit if name == "ELEMENTS" else value)
    part = contact_sequence.impact_history(problem, 10)
    assert not part.complete
    assert len(part.contacts) == 1
    assert part.contacts[0].end == whole.contacts[0].end
    assert re.search(says, part.reason)


def test_an_incomplete_impact_is_shown_as_one(
    monkeypatch: pytest.MonkeyPatch, capsys: Any, tmp_path: Path
) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(SCENE)
    waves.impact.cache_clear()
    monkeypatch.setattr(contact_sequence, "CONTACTS", 1)
    status = main(["simulate", str(file), "--json", "-"])
    data = json.loads(capsys.readouterr().out)
    waves.impact.cache_clear()
    assert not data["dynamics"]["complete"]
    assert status == 1
    assert data["restitution"] is None
    assert data["accuracy"]["bound"] is None
    assert data["max_force"] > 0.0


def test_the_error_reaches_another_process_whole() -> None:
    told = pickle.loads(pickle.dumps(IncompleteError("it ends", "mend it")))
    assert str(told) == "effects.inertia: it ends; mend it"
