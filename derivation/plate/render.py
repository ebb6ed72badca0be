"""Source text of the package `generated` from proved formulas and their stable forms."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import sympy as sp

from derivation.engine.emit.kernels import (
    AsPrinted,
    EmittedKernel,
    as_printed,
    kernel_of_form,
    rows_by_module,
)
from derivation.engine.emit.modules import CopiedModule, Module, Planned, module_files
from derivation.engine.emit.package import common_modules, kernel_modules, kernel_row
from derivation.engine.emit.printed_fraction import arithmetic_of_modules, expect_printed_fraction
from derivation.engine.formula.record import Record
from derivation.engine.rewrite.form import Form
from derivation.engine.rewrite.truncated_series import truncated_series
from derivation.plate import CITATION
from derivation.plate.blocks import blocks
from derivation.plate.budgets import counted_modules, read_budgets, read_printed_fraction
from derivation.plate.manifest_rows import hand_written_rows
from derivation.plate.modes.kernels.contributions import CONTRIBUTIONS
from derivation.plate.modes.kernels.modal_sums import STYLE, kernel_of_sum
from derivation.plate.modules import (
    computed_modules,
    printed_modules,
    runtime_modules,
)
from derivation.plate.printed.contact import PRINTED
from derivation.plate.vocabulary import BY_NAME, arguments_of

TEMPLATES = Path(__file__).parent / "templates"
SUMMARY = "Contact of a rigid sphere with an elastic plate: functions that need only NumPy."
TITLES = {
    "omega": "Integration constants C_k = A_j Omega_k of a mode, scaled by e^(phi h) and plain.",
    "influence": "Influence coefficients of both faces, plate factors and K_j.",
    "pressure": "Hertz pressure and its Fourier-Bessel coefficients.",
    "mode_shapes": "Displacements and stresses of one mode through the thickness.",
    "modal_sum": "Indentation and interior fields as direct sums over the modes.",
    **{printed.name: printed.title for printed in printed_modules()},
}


def render(formulas: Mapping[str, Record], forms: tuple[Form, ...]) -> dict[str, str]:
    """Return the files of the generated package by name; equal input gives equal bytes.

    Raises
    ------
    ValueError
        If a smaller part of its arithmetic is printed than committed.
    """
    kernels = kernel_rows(formulas, forms)
    planned = modules(kernels, formulas)
    files = module_files(planned)
    sources = {name.removesuffix(".py"): text for name, text in files.items()}
    expect_printed_fraction(
        arithmetic_of_modules(counted_modules(sources)), read_printed_fraction()
    )
    return files


def kernel_rows(
    formulas: Mapping[str, Record], forms: tuple[Form, ...]
) -> tuple[EmittedKernel, ...]:
    """Return a row for every stable form and every modal sum (stage 1)."""
    budgets = read_budgets()
    of_modes = {f.name: f for f in forms if formulas[f.name].summed}
    closed = (f for f in forms if f.name not in of_modes)
    of_forms = tuple(kernel_of_form(f, formulas[f.name], budgets[f.name], STYLE) for f in closed)
    of_sums = tuple(
        kernel_of_sum(formulas[name], formulas, budgets[name], of_modes.get(name))
        for name in (*of_modes, *CONTRIBUTIONS)
    )
    return of_forms + of_sums


def modules(
    kernels: tuple[EmittedKernel, ...], formulas: Mapping[str, Record]
) -> tuple[Planned, ...]:
    """Return the template and context of every file (stage 2)."""
    grouped = rows_by_module(kernels)
    known, budgets = blocks() | truncated_series(), read_budgets()

    listed, others = hand_written_rows(budgets)
    planned: list[Planned] = [
        *common_modules(known),
        own("as_printed", {"functions": printed_rows(formulas)}),
        *(x.make() for x in computed_modules()),
        *(CopiedModule(x.name, x.file, "generated", budgets, x.notes()) for x in runtime_modules()),
        own(
            "manifest",
            {
                "rows": [*map(kernel_row, kernels), *listed],
                "contact": others,
                "citation": CITATION,
            },
        ),
    ]
    planned += (
        own(
            module.name,
            {**module.context, "contributions": [f"{name}_of_mode" for name in CONTRIBUTIONS]},
        )
        if module.name == "modal_sum"
        else module
        for module in kernel_modules(kernels, TITLES, known)
    )
    exported = {name: [k.name for k in group] for name, group in grouped.items()}
    # The module `impact` keeps its name; its function is imported from it.
    for row in (*listed, *(row for row in others if row["module"] != "impact")):
        exported.setdefault(row["module"], []).append(row["name"])
    names = sorted(name for group in exported.values() for name in group)
    package = {"summary": SUMMARY, "modules": exported, "all_names": names}
    planned.append(Module("__init__", "package", package))
    return tuple(planned)


def own(name: str, context: Mapping[str, Any]) -> Module:
    """Return a module with a template of the paper."""
    return Module(name, name, context, TEMPLATES)


def printed_rows(formulas: Mapping[str, Record]) -> tuple[AsPrinted, ...]:
    """Return the published formulas as functions, without modal sums and composed formulas."""
    rows = []
    for printed in PRINTED:
        expression = printed.expression if printed.solved is None else printed.solved
        named = {str(symbol) for symbol in expression.free_symbols}
        if expression.has(sp.besselj) or not named <= set(BY_NAME):
            continue
        rows.append(
            as_printed(
                formulas[printed.name],
                printed.equation,
                expression,
                arguments_of(expression),
                "generated.as_printed",
            )
        )
    return tuple(rows)
