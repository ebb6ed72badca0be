"""Modules of the generated package by subject: printed from formulas, or written by hand."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from derivation.engine.emit.copies import NO_NOTES
from derivation.engine.emit.modules import Numbers, Routines
from derivation.engine.emit.package import Shape
from derivation.mathematics.bessel.kernels import RUNTIME, bessel_numbers
from derivation.mathematics.bessel.routines import bessel_kernels
from derivation.plate.subjects import exports


@dataclass(frozen=True, eq=False)
class PrintedModule:
    """A module of functions that are printed from formulas.

    Parameters
    ----------
    name, title
        Name of the module, and first line of its docstring.
    stated
        Function that returns the stable forms by formula; each is proved.
    """

    name: str
    title: str
    stated: Callable[[], Mapping[str, Shape]]


def _no_notes() -> Mapping[str, Sequence[str]]:
    return NO_NOTES


class RuntimeModule(NamedTuple):
    """A module that is written by hand and copied to the package.

    Attributes
    ----------
    name, file
        Name of the module, and the original file.
    notes
        Lines about errors, by function, for functions that the manifest does not list.
    """

    name: str
    file: Path
    notes: Callable[[], Mapping[str, Sequence[str]]] = _no_notes


@dataclass(frozen=True, eq=False)
class ComputedModule:
    """A module of routines or of numbers: its name, and the function that returns it."""

    name: str
    make: Callable[[], Routines | Numbers]


SubjectModule = PrintedModule | RuntimeModule | ComputedModule


def runtime_modules() -> tuple[RuntimeModule, ...]:
    """Return the handwritten modules of all subjects."""
    return tuple(part for part in _modules() if isinstance(part, RuntimeModule))


def runtime_files() -> dict[str, Path]:
    """Return the original files of these modules by name."""
    return {part.name: part.file for part in runtime_modules()}


def computed_modules() -> tuple[ComputedModule, ...]:
    """Return the modules of routines and of numbers of all subjects."""
    return tuple(part for part in _modules() if isinstance(part, ComputedModule))


def printed_modules() -> tuple[PrintedModule, ...]:
    """Return the printed modules of all subjects."""
    return tuple(module for module in _modules() if isinstance(module, PrintedModule))


MATHEMATICS: tuple[SubjectModule, ...] = (
    ComputedModule("bessel_numbers", bessel_numbers),
    ComputedModule("bessel_kernels", bessel_kernels),
    RuntimeModule("bessel", RUNTIME / "bessel.py"),
)
"""Modules of mathematical functions that are independent of the paper."""


def _modules() -> Iterator[SubjectModule]:
    yield from MATHEMATICS
    for modules in exports("kernels", "MODULES"):
        yield from modules
