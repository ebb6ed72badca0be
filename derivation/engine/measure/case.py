"""A hard case as data: what is computed where, in which form, and why that is hard."""

import itertools
import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from derivation.engine.formula.ulp import DOUBLE, SINGLE, Format

FORMS = (
    "scalar", "array", "empty", "broadcast", "strided", "read-only", "integer", "float32",
)  # fmt: skip
"""Ways in which arguments are passed.

Plain numbers; arrays of doubles; arrays of shape (0,); each list along its own axis; every second
number of a longer array, backwards; read-only arrays; integers; single precision.
"""

EXPECTATIONS = ("value", "nan", "zero")
"""What a kernel is to return: the true value, NaN because the point is outside its
domain, or exactly zero where no ball around the reference value can be relatively small."""

SAID = ("cause", "form", "modes", "expect")
"""Entries in a file that apply to all cases of a table."""

Numbers = tuple[float, ...]


@dataclass(frozen=True)
class HardCase:
    """One hard case.

    Parameters
    ----------
    group
        Name of the group of cases.
    kernel
        Name of the function.
    cause
        Reason for the difficulty, in a sentence.
    inputs
        Hexadecimal doubles by argument, one or several.
    form
        How arguments are passed, one of `FORMS`.
    modes
        Number of modes of a modal sum.
    expect
        One of `EXPECTATIONS`.
    """

    group: str
    kernel: str
    cause: str
    inputs: Mapping[str, tuple[str, ...]]
    form: str = "scalar"
    modes: int | None = None
    expect: str = "value"

    @property
    def key(self) -> str:
        """Return the part that distinguishes one case from another, without explanations."""
        given = " ".join(f"{name}={','.join(texts)}" for name, texts in self.inputs.items())
        modes = "" if self.modes is None else f" modes={self.modes}"
        return f"{self.kernel} {self.form}{modes} {given}"

    @property
    def table(self) -> dict[str, Any]:
        """Return the table that describes the case in a file, without default values."""
        form = {} if self.form == "scalar" else {"form": self.form}
        modes = {} if self.modes is None else {"modes": self.modes}
        expect = {} if self.expect == "value" else {"expect": self.expect}
        scalar = self.form == "scalar"
        inputs = {name: texts[0] if scalar else [*texts] for name, texts in self.inputs.items()}
        said = {"group": self.group, "kernel": self.kernel, "cause": self.cause}
        return {**said, **form, **modes, **expect, "inputs": inputs}

    @property
    def numbers(self) -> dict[str, Numbers]:
        """Return the inputs as doubles."""
        return {
            name: tuple(float.fromhex(text) for text in texts)
            for name, texts in self.inputs.items()
        }

    @property
    def format(self) -> Format:
        """Return the format of arguments and results."""
        return SINGLE if self.form == "float32" else DOUBLE

    @property
    def listed(self) -> tuple[str, ...]:
        """Return the arguments that are arrays: those of several numbers; none for `scalar`."""
        numbers = self.numbers.items()
        return () if self.form == "scalar" else tuple(k for k, v in numbers if len(v) != 1)

    @property
    def shape(self) -> tuple[int, ...]:
        """Return the shape that results must have."""
        lengths = [len(self.inputs[name]) for name in self.listed]
        return tuple(lengths) if self.form == "broadcast" else tuple(lengths[:1])

    @property
    def points(self) -> list[dict[str, float]]:
        """Return the arguments point by point, in the order of the results."""
        numbers, found = self.numbers, []
        for place in itertools.product(*(range(length) for length in self.shape)):
            axes = place if self.form == "broadcast" else place * len(self.listed)
            at = dict(zip(self.listed, axes, strict=True))
            found.append({name: values[at.get(name, 0)] for name, values in numbers.items()})
        return found


def read_cases(path: Path) -> list[HardCase]:
    """Return the cases of a TOML file: under the name of each group, tables of a cause.

    A table also has one entry per function: its inputs, or a list of several.

    Raises
    ------
    ValueError
        If a case is not well formed; the message names the case.
    """
    groups = tomllib.loads(path.read_text())
    return [
        checked(HardCase(group, name, inputs=_exact(given), **said))
        for group, tables in groups.items()
        for said, functions in map(_parts, tables)
        for name, several in functions.items()
        for given in (several if isinstance(several, list) else [several])
    ]


def _parts(table: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Split a table into the entries for all its cases and the inputs by function."""
    said = {key: value for key, value in table.items() if key in SAID}
    return said, {key: value for key, value in table.items() if key not in SAID}


def _exact(given: Mapping[str, Any]) -> dict[str, tuple[str, ...]]:
    listed = {name: x if isinstance(x, list) else [x] for name, x in given.items()}
    return {name: tuple(float(x).hex() for x in numbers) for name, numbers in listed.items()}


def checked(case: HardCase) -> HardCase:
    """Return the case if it is well formed.

    Raises
    ------
    ValueError
        If it is not; the message states the reason.
    """
    if case.form not in FORMS:
        raise ValueError(f"{case.key}: a form is one of {', '.join(FORMS)}, got {case.form}")
    if case.expect not in EXPECTATIONS:
        raise ValueError(f"{case.key}: expected one of {', '.join(EXPECTATIONS)}")
    if not case.cause.endswith(".") or not case.group:
        raise ValueError(f"{case.key}: a cause is a sentence, and every case has a group")
    lengths = {len(case.inputs[name]) for name in case.listed}
    if case.form == "scalar" and any(len(texts) != 1 for texts in case.inputs.values()):
        raise ValueError(f"{case.key}: plain numbers come one at a time")
    if case.form != "broadcast" and len(lengths) > 1:
        raise ValueError(f"{case.key}: lists of one length are expected, got {sorted(lengths)}")
    if case.form == "float32" and not all(map(_is_single, case.points)):
        raise ValueError(f"{case.key}: numbers of single precision are expected")
    return case


def _is_single(point: Mapping[str, float]) -> bool:
    return all(math.isnan(x) or float(np.float32(x)) == x for x in point.values())


def handed_over(case: HardCase, names: tuple[str, ...]) -> list[Any]:
    """Return a function's arguments in the case's form, in the function's order."""
    numbers = case.numbers
    axes = {name: axis for axis, name in enumerate(case.listed)}
    return [_argument(case, numbers[name], axes.get(name)) for name in names]


def _argument(case: HardCase, values: Numbers, axis: int | None) -> Any:
    if case.form == "integer":
        whole = [int(x) for x in values]
        return whole[0] if axis is None else np.array(whole)
    if case.form == "float32":
        singles = np.array(values, dtype=np.float32)
        return singles[0] if axis is None else singles
    if axis is None:
        return values[0]
    array = np.array(values, dtype=np.float64)
    if case.form == "broadcast":
        return array.reshape((-1,) + (1,) * (len(case.listed) - 1 - axis))
    if case.form == "strided":
        # What lies between would be noticed: it is outside every domain.
        longer = np.full(2 * array.size, -np.inf)
        longer[1::2] = array[::-1]
        return longer[::-2]
    array.setflags(write=case.form != "read-only")
    return array
