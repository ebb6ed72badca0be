"""Hard cases as data: function, arguments, form of the arguments, and reason."""

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

Plain numbers; arrays of doubles; arrays of shape (0,); each list along its own axis; views with a
negative stride of longer arrays; read-only arrays; integers; single precision.
"""

EXPECTATIONS = ("value", "nan", "zero")
"""Expected results: the reference value; NaN, because the point is outside the domain; or zero,
where no ball around the reference value can be relatively small."""

CAUSE_TEXTS = ("cause", "form", "modes", "expect")
"""Keys of a table in a file that apply to all its cases."""

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
        For each argument, one or several doubles in hexadecimal.
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
        """Text that identifies the case: function, form and inputs."""
        given = " ".join(f"{name}={','.join(texts)}" for name, texts in self.inputs.items())
        modes = "" if self.modes is None else f" modes={self.modes}"
        return f"{self.kernel} {self.form}{modes} {given}"

    @property
    def table(self) -> dict[str, Any]:
        """Description of the case as plain data, without default values."""
        form = {} if self.form == "scalar" else {"form": self.form}
        modes = {} if self.modes is None else {"modes": self.modes}
        expect = {} if self.expect == "value" else {"expect": self.expect}
        scalar = self.form == "scalar"
        inputs = {name: texts[0] if scalar else [*texts] for name, texts in self.inputs.items()}
        said = {"group": self.group, "kernel": self.kernel, "cause": self.cause}
        return {**said, **form, **modes, **expect, "inputs": inputs}

    @property
    def numbers(self) -> dict[str, Numbers]:
        """The inputs as doubles."""
        return {
            name: tuple(float.fromhex(text) for text in texts)
            for name, texts in self.inputs.items()
        }

    @property
    def format(self) -> Format:
        """Floating-point format of arguments and results."""
        return SINGLE if self.form == "float32" else DOUBLE

    @property
    def listed(self) -> tuple[str, ...]:
        """Names of the arguments that are arrays, that is, not single numbers."""
        numbers = self.numbers.items()
        return () if self.form == "scalar" else tuple(k for k, v in numbers if len(v) != 1)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape that the results must have."""
        lengths = [len(self.inputs[name]) for name in self.listed]
        return tuple(lengths) if self.form == "broadcast" else tuple(lengths[:1])

    @property
    def points(self) -> list[dict[str, float]]:
        """Arguments of each point, in the order of the results."""
        numbers, all_points = self.numbers, []
        for index in itertools.product(*(range(length) for length in self.shape)):
            axes = index if self.form == "broadcast" else index * len(self.listed)
            at = dict(zip(self.listed, axes, strict=True))
            all_points.append({name: values[at.get(name, 0)] for name, values in numbers.items()})
        return all_points


def read_cases(path: Path) -> list[HardCase]:
    """Return the cases of a TOML file: for each group, an array of tables with a cause each.

    Each table also contains, for each function, its inputs or a list of inputs.

    Raises
    ------
    ValueError
        If a case is invalid; the message states the case.
    """
    groups = tomllib.loads(path.read_text())
    return [
        checked_case(HardCase(group, name, inputs=_exact(given), **said))
        for group, tables in groups.items()
        for said, functions in map(_parts, tables)
        for name, several in functions.items()
        for given in (several if isinstance(several, list) else [several])
    ]


def _parts(table: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Split a table into the entries for all its cases and the inputs by function."""
    said = {key: value for key, value in table.items() if key in CAUSE_TEXTS}
    return said, {key: value for key, value in table.items() if key not in CAUSE_TEXTS}


def _exact(given: Mapping[str, Any]) -> dict[str, tuple[str, ...]]:
    listed = {name: x if isinstance(x, list) else [x] for name, x in given.items()}
    return {name: tuple(float(x).hex() for x in numbers) for name, numbers in listed.items()}


def checked_case(case: HardCase) -> HardCase:
    """Return the case if it is valid.

    Raises
    ------
    ValueError
        If it is not; the message states the reason.
    """
    if case.form not in FORMS:
        raise ValueError(f"{case.key}: expected a form of {', '.join(FORMS)}, got {case.form}")
    if case.expect not in EXPECTATIONS:
        raise ValueError(
            f"{case.key}: expect must be one of {', '.join(EXPECTATIONS)}, got {case.expect}"
        )
    if not case.cause.endswith(".") or not case.group:
        raise ValueError(f"{case.key}: expected a group, and a cause that ends in a period")
    lengths = {len(case.inputs[name]) for name in case.listed}
    if case.form == "scalar" and any(len(texts) != 1 for texts in case.inputs.values()):
        raise ValueError(f"{case.key}: expected one number for each argument of a scalar case")
    if case.form != "broadcast" and len(lengths) > 1:
        raise ValueError(f"{case.key}: expected lists of equal length, got {sorted(lengths)}")
    if case.form == "float32" and not all(map(_is_single, case.points)):
        raise ValueError(f"{case.key}: expected numbers of single precision")
    return case


def _is_single(point: Mapping[str, float]) -> bool:
    return all(math.isnan(x) or float(np.float32(x)) == x for x in point.values())


def call_arguments(case: HardCase, names: tuple[str, ...]) -> list[Any]:
    """Return a function's arguments in the case's form, in the function's order."""
    numbers = case.numbers
    axes = {name: axis for axis, name in enumerate(case.listed)}
    return [_argument(case, numbers[name], axes.get(name)) for name in names]


def _argument(case: HardCase, values: Numbers, axis: int | None) -> Any:
    if case.form == "integer":
        integers = [int(x) for x in values]
        return integers[0] if axis is None else np.array(integers)
    if case.form == "float32":
        singles = np.array(values, dtype=np.float32)
        return singles[0] if axis is None else singles
    if axis is None:
        return values[0]
    array = np.array(values, dtype=np.float64)
    if case.form == "broadcast":
        return array.reshape((-1,) + (1,) * (len(case.listed) - 1 - axis))
    if case.form == "strided":
        # The values between are outside every domain, so that reading them gives NaN.
        longer = np.full(2 * array.size, -np.inf)
        longer[1::2] = array[::-1]
        return longer[::-2]
    array.setflags(write=case.form != "read-only")
    return array
