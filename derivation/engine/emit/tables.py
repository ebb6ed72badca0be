"""Modules of constants that are computed in advance."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
import sympy as sp

WIDTH = 96


@dataclass(frozen=True)
class Constant:
    """A named number, or a table of numbers.

    Parameters
    ----------
    name
        Name of the constant, in capitals.
    value
        A number, or nested tuples of numbers; an array is written as an array.
    meaning
        Meaning of the constant, in a sentence.
    """

    name: str
    value: object
    meaning: str


def module_text(title: str, header: str, constants: Sequence[Constant]) -> str:
    """Return the source of a module of constants."""
    arrays = any(isinstance(part.value, np.ndarray) for part in constants)
    lines = [f'"""{title}"""', header, ""]
    lines += ["import numpy as np", ""] if arrays else []
    lines.append("# fmt: off")
    for part in constants:
        lines += [f"{part.name} = {literal(part.value)}", f'"""{part.meaning}"""']
    return "\n".join(lines) + "\n"


def literal(value: object) -> str:
    """Return a number, a text, an array, or nested tuples of numbers as Python source.

    Raises
    ------
    TypeError
        For any other type.
    """
    if isinstance(value, np.ndarray):
        return f"np.array({literal(_tuples(value))})"
    if isinstance(value, bool | int | float | str):
        return repr(value)
    if isinstance(value, Fraction | sp.Rational):
        above, below = value.numerator, value.denominator
        return f"{above}" if below == 1 else f"{above} / {below}"
    if isinstance(value, tuple):
        return _wrapped([literal(part) for part in value])
    raise TypeError(f"expected numbers or tuples of them, got {value!r}")


def _tuples(values: np.ndarray) -> object:
    if values.ndim:
        return tuple(_tuples(part) for part in values)
    return values.item()


def _wrapped(parts: Sequence[str]) -> str:
    """Return a tuple as source, on several lines if it is long or nested."""
    line = ", ".join(parts) + ("," if len(parts) == 1 else "")
    if len(line) < WIDTH and "\n" not in line:
        return f"({line})"
    lines = [""]
    for part in parts:
        if lines[-1] and len(lines[-1]) + len(part) > WIDTH - 4:
            lines.append("")
        lines[-1] += f"{' ' if lines[-1] else ''}{part},"
    return "(\n    " + "\n    ".join("\n    ".join(lines).split("\n    ")) + "\n)"
