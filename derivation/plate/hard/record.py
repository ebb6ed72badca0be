"""References of hard cases found one by one: those that stand are kept, all saved as they come."""

import json
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from derivation.engine.files import write_file
from derivation.engine.measure.check import Progress
from derivation.engine.measure.kernels import Kernel
from derivation.plate.hard.case import HardCase
from derivation.plate.hard.origin import origin
from derivation.plate.hard.truth import Known, known_of, references

SAVED_EVERY = 30.0
"""Seconds."""


def find_references(
    given: Sequence[HardCase], kernels: Mapping[str, Kernel], recorded: Path, part: Path,
    tell: Progress | None = None,
) -> dict[str, Known]:  # fmt: skip
    """The truth of every case by its key, from the original expressions: minutes.

    Parameters
    ----------
    given
        The cases.
    kernels
        What they are about, by name.
    recorded
        The record so far. References that follow from what they would follow from now are
        taken over.
    part
        Where references are saved while others are sought, for a run after one that was stopped.
    tell
        Told about every case that is done.
    """
    known = _standing(recorded) | _standing(part)
    found: dict[str, Known] = {}
    saved = time.monotonic()
    try:
        for number, case in enumerate(given, start=1):
            here, old = origin(case.kernel), known.get(case.key)
            stands = old is not None and old.origin == here and case.expect == "value"
            found[case.key] = (
                old if old and stands else Known(here, references(case, kernels[case.kernel]))
            )
            if time.monotonic() - saved > SAVED_EVERY:
                _save(part, found)
                saved = time.monotonic()
            if tell is not None:
                tell(case.kernel, number, len(given))
    finally:
        _save(part, found)
    return found


def _standing(path: Path) -> dict[str, Known]:
    return known_of(json.loads(path.read_text())) if path.is_file() else {}


def _save(part: Path, found: Mapping[str, Known]) -> None:
    rows = [{"key": key, **known._asdict()} for key, known in found.items()]
    write_file(part, json.dumps({"cases": rows}))
