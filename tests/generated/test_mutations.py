"""`check` detects changed numbers, signs and operators in printed code, except listed ones."""

import ast
from dataclasses import replace

import pytest
from mutants import of_module
from mutated_code import BEYOND_ALL, Allowed, compiled, source

from derivation.engine.measure.judge import Errors, PointReference, measured_errors
from derivation.engine.measure.kernels import Kernel
from derivation.plate.grids import grid
from derivation.plate.judge import generated_kernels, reference_values

KERNELS = {kernel.name: kernel for kernel in generated_kernels()}
SHOWN_BY = {
    "sinh_minus": "Omega_4_scaled", "sinh_plus": "Omega_2", "sinh_pair": "G",
    "hertz_shape": "sonine", "cosh_square": "mode_zz", "sinh_cubic": "mode_rz",
    "cosh_quartic": "mode_zz", "sinh_quintic": "mode_zz", "cosh_quintic": "mode_rr",
}  # fmt: skip
"""A function that uses each building block."""
SMALL = "the last terms of a series, which are smaller than rounding errors"
BRANCHES = "a choice of branches that are both accurate, up to the effect of rounding the input"
LENGTHS = [f"Omega_{k}{scaled}" for k in (1, 2, 3, 4) for scaled in ("", "_scaled")]
MAY_PASS: Allowed = {
    **dict.fromkeys((*LENGTHS, "sonine", "A_j"), (2, BEYOND_ALL)),
    "mode_f": (7, BRANCHES),
    "mode_g": (13, BRANCHES),
    "mode_zz": (2, BRANCHES),
    "mode_rr": (3, BRANCHES),
    "mode_tt": (7, BRANCHES),
    "sinh_minus": (2, SMALL),
    "sinh_pair": (4, SMALL),
    "hertz_shape": (3, SMALL),
    "cosh_square": (6, SMALL),
    "cosh_quartic": (6, SMALL),
    "sinh_quintic": (3, SMALL),
    "cosh_quintic": (7, SMALL),
}
"""Largest number of undetected mutants of each function, and the reason."""


def detected(kernel: Kernel, actual: list[PointReference], module: str, tree: ast.Module) -> bool:
    """Return whether a function exceeds its budget or fails after a module was changed.

    Most mutants are detected at a few of the points.
    """
    users = () if kernel.module == module else (kernel.module,)
    try:
        changed = replace(kernel, call=getattr(compiled(tree, module, users), kernel.name))
        return any(_exceeds(measured_errors(changed, some)) for some in (actual[::25], actual))
    except (ArithmeticError, LookupError, TypeError, ValueError, NameError):
        return True


def _exceeds(errors: Errors) -> bool:
    return errors.ratio is None or errors.ratio > 1.0 or errors.not_finite > 0


@pytest.mark.one_version
@pytest.mark.parametrize("module", ["omega", "pressure", "mode_shapes", "blocks"])
def test_mutants_are_detected_up_to_the_listed_number(module: str) -> None:
    """Conditions of domains are not changed; `test_floating_point_exceptions` tests them."""
    known: dict[str, list[PointReference]] = {}
    passed: dict[str, list[str]] = {}
    for mutant in of_module(source(module), ("inside",)):
        kernel = KERNELS[SHOWN_BY.get(mutant.home, mutant.home)]
        if kernel.name not in known:
            known[kernel.name] = reference_values(
                kernel.name, grid(kernel.name, kernel.arguments), 30
            )
            whole = ast.parse(source(module))
            assert not detected(kernel, known[kernel.name], module, whole)
        if not detected(kernel, known[kernel.name], module, mutant.tree):
            passed.setdefault(mutant.home, []).append(mutant.change)
    most = {home: count for home, (count, _) in MAY_PASS.items()}
    assert {home: those for home, those in passed.items() if len(those) > most.get(home, 0)} == {}
