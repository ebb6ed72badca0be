"""The hard cases of the plate: written cases, generated families, functions and references."""

import importlib
from functools import cache
from pathlib import Path

from derivation.engine.measure.case import HardCase, read_cases
from derivation.engine.measure.kernels import Kernel
from derivation.engine.measure.suite import Suite
from derivation.mathematics.bessel import oracle as zeros
from derivation.plate.cases.calls import special_calls
from derivation.plate.cases.families import families
from derivation.plate.cases.laws import LAWS
from derivation.plate.contact.oracle import moments
from derivation.plate.judge import generated_kernels, printed_kernels
from derivation.plate.oracle import ORACLE

WRITTEN = Path(__file__).with_name("hard_cases.toml")


def suite() -> Suite:
    """Return the suite of all hard cases with functions and references."""
    return Suite(
        cases(),
        kernels(),
        {kernel.name: kernel for kernel in printed_kernels()},
        ORACLE,
        LAWS,
        (zeros.__name__, moments.__name__),
        # Plates are enlarged and contacts reduced, so that no contact exceeds the edge.
        outwards=("b", "h", "R", "lam", "mu"),
    )


def cases() -> tuple[HardCase, ...]:
    """Return every hard case, those written by hand first."""
    return (*read_cases(WRITTEN), *families())


@cache
def kernels() -> dict[str, Kernel]:
    """Return every function that a hard case can test, by name."""
    manifest = importlib.import_module("generated.manifest")
    by_name = {kernel.name: kernel for kernel in generated_kernels()}
    for row in manifest.CONTACT:
        call = getattr(importlib.import_module(f"generated.{row['module']}"), row["name"])
        by_name[row["name"]] = Kernel(
            row["name"], row["module"], tuple(row["arguments"]), call, float(row["budget"])
        )
    return by_name | {kernel.name: kernel for kernel in special_calls()}
