"""Results of a search as a file of hard cases, as a table and as plain data."""

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from derivation.engine.files import expect_writable, write_file
from derivation.engine.measure.case import CAUSE_TEXTS, HardCase, read_cases
from derivation.engine.measure.point import Point, in_both_forms
from derivation.engine.measure.search import LargeError, Progress, Search, point_error, search
from derivation.engine.measure.target import Target
from derivation.engine.outputs import plain
from derivation.engine.text import with_items

COLUMNS = ("function", "#evaluations", "#ratio", "#ULP", "#allowed", "new")
"""Headings of the table; `ratio` is the largest error over its allowance, and the next two columns
are that error and that allowance."""

GROUP = "search"
"""Group of the cases found by a search."""

_SECONDS = {"s": 1, "m": 60, "h": 3600}
_HEADER = """\
# Worst cases of `platecontact check search`, as cases for the hard-case suite.
"""


def seconds_of(duration: str) -> int:
    """Return a duration in seconds, from a whole number followed by s, m or h.

    Raises
    ------
    ValueError
        If the duration has another form or is zero.
    """
    match = re.fullmatch(r"([1-9][0-9]{0,6})([smh])", duration)
    if match is None:
        raise ValueError(f"--time: expected a duration like 30s, 5m or 1h, got {duration!r}")
    return int(match[1]) * _SECONDS[match[2]]


# --- a search with its record


def recorded(
    check: Path, other: Path | None = None
) -> tuple[dict[str, float], dict[str, list[str]]]:
    """Return the worst ratios of a saved check, and the worst arguments of another one."""
    rows = json.loads(check.read_text())["rows"] if check.is_file() else []
    ratios = {row["kernel"]: row["double"]["ratio"] for row in rows}
    worst = json.loads(other.read_text())["rows"] if other and other.is_file() else []
    return (
        # An infinity is text there.
        {kernel: float(ratio) for kernel, ratio in ratios.items() if ratio is not None},
        {row["kernel"]: row["worst"] for row in worst},
    )


def search_and_record(
    chosen: Sequence[Target],
    known: tuple[dict[str, float], dict[str, list[str]]],
    seconds: int,
    seed: int,
    path: Path,
    progress: Progress | None = None,
) -> "tuple[Search, SearchRecord]":
    """Search for some time, and write each case that is worse than the known ones to a file.

    Raises
    ------
    ValueError
        If the file exists and does not contain worst cases.
    OSError
        If the file cannot be written.
    """
    expect_writable(path)
    book = SearchRecord(path, chosen, *known)
    result = search(chosen, seed, seconds, progress=progress, keep=book.keep)
    book.keep(result)
    return result, book


# --- cases


def case_of(kernel: str, error: LargeError, seed: int) -> HardCase:
    """Return a point of the search as a case, with an array if it has a second point."""
    points = [error.point] if error.second is None else [error.point, error.second]
    inputs = {name: tuple(p.values[name].hex() for p in points) for name in error.point.values}
    form = "scalar" if error.second is None else "array"
    cause = f"Found by search, seed {seed}."
    return HardCase(GROUP, kernel, cause, inputs, form, error.point.modes)


def points_of(case: HardCase) -> list[Point]:
    """Return a case's points: the point itself, and the second one if there is one."""
    return [Point(values, case.modes) for values in case.points]


def measured_case(case: HardCase, targets: Mapping[str, Target]) -> LargeError | None:
    """Return the error of a case; None if its function is not searched, or without a reference.

    Raises
    ------
    ValueError
        If the inputs are not those of the function.
    """
    target = targets.get(case.kernel)
    if target is None:
        return None
    if set(case.inputs) != set(target.domain.arguments):
        expected = ", ".join(target.domain.arguments)
        raise ValueError(f"{target.name} takes {expected}; got {', '.join(case.inputs)}")
    point, *second = points_of(case)
    return point_error(target, point, second[0] if second else None)


def read(path: Path) -> list[HardCase]:
    """Return the cases in the file of an earlier search; empty if there is no file.

    Raises
    ------
    ValueError
        If it is another kind of file, which is not overwritten.
    """
    if not path.exists():
        return []
    try:
        cases = read_cases(path)
        if not all(case.group == GROUP and case.points for case in cases):
            raise ValueError("a case of another group")
    except (ValueError, KeyError, TypeError, AttributeError, IndexError) as error:
        raise ValueError(
            f"{path} is not a file of searched cases ({error}): name another one with --out FILE"
        ) from error
    return cases


def to_toml(cases: Sequence[tuple[HardCase, LargeError | None]]) -> str:
    """Return the text of the file: a table per case, with the measured error as a comment."""
    return _HEADER + "".join(_table(case, entry) for case, entry in cases)


def _table(case: HardCase, large_error: LargeError | None) -> str:
    lines = [""]
    if large_error is not None:
        error = large_error.error
        lines.append(f"# {large_error.ratio:.4g} of the allowance: {error.ulp:.6g} ULP, "
                     f"{error.allowed:.6g} allowed.")  # fmt: skip
    said = {key: value for key, value in case.table.items() if key in CAUSE_TEXTS}
    lines += [f"[[{case.group}]]", *(f"{key} = {json.dumps(x)}" for key, x in said.items())]
    # Python's shortest decimal numbers are TOML's too, and exact.
    numbers = {name: x[0] if case.form == "scalar" else [*x] for name, x in case.numbers.items()}
    lines.append(f"{case.kernel} = {{ {', '.join(f'{k} = {x}' for k, x in numbers.items())} }}")
    return "\n".join(lines) + "\n"


# --- what is new


class SearchRecord:
    """The file of worst cases, which is updated during a search.

    Parameters
    ----------
    path
        Path of the file; cases of an earlier search are kept.
    targets
        The functions, with which earlier cases are measured again.
    ratios
        Largest recorded ratio by function.
    worst
        For functions without a recorded ratio, the arguments of the largest recorded error as
        hexadecimal doubles; the ratio is measured there.

    Raises
    ------
    ValueError
        If it is another kind of file.
    """

    def __init__(
        self,
        path: Path,
        targets: Sequence[Target],
        ratios: Mapping[str, float],
        worst: Mapping[str, Sequence[str]],
    ) -> None:
        self.path = path
        self._targets = {target.name: target for target in targets}
        self._earlier = [(case, measured_case(case, self._targets)) for case in read(path)]
        self._known, self._unmeasured = dict(ratios), dict(worst)
        for case, entry in self._earlier:
            self._learn(case.kernel, entry)
        self._written = ""

    def _learn(self, kernel: str, error: LargeError | None) -> None:
        if error is not None:
            self._known[kernel] = max(error.ratio, self._known.get(kernel, 0.0))

    def _best_known(self, kernel: str) -> float:
        """Return the largest known ratio; if it is not recorded, it is measured once."""
        texts = self._unmeasured.pop(kernel, None)
        if texts is not None and kernel in self._targets:
            names = self._targets[kernel].domain.arguments
            inputs = {name: (text,) for name, text in zip(names, texts, strict=True)}
            self._learn(kernel, measured_case(HardCase(GROUP, kernel, "", inputs), self._targets))
        return self._known.get(kernel, 0.0)

    def is_new(self, kernel: str, error: LargeError | None) -> bool:
        """Return whether an unrecorded point exceeds the largest known ratio, or its allowance."""
        if error is None or any(
            case.kernel == kernel and points_of(case)[0] == error.point for case, _ in self._earlier
        ):
            return False
        return error.ratio > min(self._best_known(kernel), 1.0)

    def keep(self, search: Search) -> None:
        """Write earlier and new cases, if there are new ones that are not written yet."""
        new = [
            (case_of(kernel, state.worst, search.seed), state.worst)
            for kernel, state in search.states.items()
            if state.worst is not None and self.is_new(kernel, state.worst)
        ]
        text = to_toml([*self._earlier, *new])
        if new and text != self._written:
            write_file(self.path, text)
            self._written = text

    @property
    def written(self) -> bool:
        """Whether a new case was written."""
        return bool(self._written)


# --- results


def cells(kernel: str, search: Search, book: SearchRecord) -> tuple[str, ...]:
    """Return a function's entries under `COLUMNS`."""
    state = search.states[kernel]
    worst = state.worst
    if worst is None:
        return (kernel, str(state.evaluations), "", "", "", "")
    numbers = (f"{x:.3g}" for x in (worst.ratio, worst.error.ulp, worst.error.allowed))
    new = "yes" if book.is_new(kernel, worst) else ""
    return (kernel, str(state.evaluations), *numbers, new)


def arguments(kernel: str, search: Search) -> str:
    """Return a function's worst arguments, decimal and hexadecimal."""
    worst = search.states[kernel].worst
    if worst is None:
        return f"{kernel}:"
    inputs = case_of(kernel, worst, search.seed).inputs.items()
    texts = [f"{name}={', '.join(map(in_both_forms, exact))}" for name, exact in inputs]
    modes = [] if worst.point.modes is None else [f"modes={worst.point.modes}"]
    return with_items(f"{kernel}:", texts + modes)


def as_data(search: Search) -> dict[str, Any]:
    """Return a search as plain data, equal for equal seeds and numbers of evaluations."""
    return {
        "seed": search.seed,
        "interrupted": search.interrupted,
        "evaluations": search.evaluations,
        "rows": [_row(kernel, search) for kernel in search.states],
    }


def _row(kernel: str, search: Search) -> dict[str, Any]:
    state = search.states[kernel]
    counts = {"evaluations": state.evaluations, "unjudged": state.unjudged}
    if state.worst is None:
        return {"kernel": kernel, **counts, "ratio": None, "ulp": None, "allowed": None}
    error, entry = state.worst.error, case_of(kernel, state.worst, search.seed).table
    numbers: dict[str, float] = {"ratio": error.ratio, "ulp": error.ulp, "allowed": error.allowed}
    where = {key: entry[key] for key in ("inputs", "form", "modes") if key in entry}
    return {"kernel": kernel, **counts, **plain(numbers), **where}


def all_within_allowance(search: Search) -> bool:
    """Return whether every error is within its allowance."""
    return all(state.ratio <= 1.0 for state in search.states.values())
