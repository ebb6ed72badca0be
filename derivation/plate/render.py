"""The plate's package `generated`: proven formulas and their stable forms in, text out."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import sympy as sp

from derivation.engine.emit.kernels import (
    AsPrinted,
    EmittedKernel,
    argument_text,
    kernel_of_form,
    rows_by_module,
)
from derivation.engine.emit.package import (
    Copy,
    Module,
    Planned,
    kernel_modules,
    kernel_row,
    shared,
    written,
)
from derivation.engine.emit.printer import to_numpy
from derivation.engine.formula.record import Record
from derivation.engine.rewrite.form import Form
from derivation.engine.rewrite.sections import sections
from derivation.mathematics.bessel.kernels import bessel_context
from derivation.plate.blocks import blocks
from derivation.plate.budgets import read_budgets, read_promises
from derivation.plate.contact.kernels.moments import moment_context
from derivation.plate.contact.kernels.tables import impact_context
from derivation.plate.impact.kernels.perturbation import perturbation_context
from derivation.plate.impact.kernels.simple import simple_impact_context
from derivation.plate.modes.kernels.modal_sums import MODAL_SUMS, STYLE, kernel_of_sum
from derivation.plate.modules import (
    computed_modules,
    printed_modules,
    runtime_modules,
    template_modules,
)
from derivation.plate.pressure.kernels import pressure_context
from derivation.plate.printed.contact import PRINTED
from derivation.plate.table_rows import contact_rows, notes_of, table_rows
from derivation.plate.vocabulary import BY_NAME, arguments_of

TEMPLATES = Path(__file__).parent / "templates"
CITATION = "Elastodynamic contact in plate-like bodies"
TITLES = {
    "omega": "Integration constants C_k = A_j Omega_k of a mode, scaled by e^(phi h) and plain.",
    "influence": "Influence coefficients of both faces, plate factors and K_j.",
    "pressure": "Hertz pressure and its Fourier-Bessel coefficients.",
    "mode_shapes": "Displacements and stresses of one mode through the thickness.",
    "modal_sum": "Indentation and interior fields as direct sums over the modes.",
    **{printed.name: printed.title for printed in printed_modules()},
}


def render(formulas: Mapping[str, Record], forms: tuple[Form, ...]) -> dict[str, str]:
    """Files of the generated package by name; the same bytes for the same input."""
    kernels = kernel_rows(formulas, forms)
    planned = modules(kernels)
    return written(planned)


def kernel_rows(
    formulas: Mapping[str, Record], forms: tuple[Form, ...]
) -> tuple[EmittedKernel, ...]:
    """Stage 1: a row for every stable form and every modal sum."""
    budgets = read_budgets()
    shares = {f.name: f for f in forms if formulas[f.name].summed}
    closed = (f for f in forms if f.name not in shares)
    of_forms = tuple(kernel_of_form(f, formulas[f.name], budgets[f.name], STYLE) for f in closed)
    load = formulas["A_j"], formulas["Omega_1"]
    of_sums = tuple(
        kernel_of_sum(formulas[name], *load, budgets[name], shares.get(name))
        for name in (*shares, *MODAL_SUMS)
    )
    return of_forms + of_sums


def modules(kernels: tuple[EmittedKernel, ...]) -> tuple[Planned, ...]:
    """Stage 2: every file's template and context."""
    grouped = rows_by_module(kernels)
    known, budgets = blocks() | sections(), read_budgets()

    def tables(name: str, context: Mapping[str, Any], folder: Path = TEMPLATES) -> Module:
        notes = notes_of(name, budgets)
        return Module(name, name, {**context, "notes": notes} if notes else context, folder)

    planned: list[Planned] = [
        *shared(known),
        tables("bessel", bessel_context()),
        tables("series_constants", moment_context()),
        own("as_printed", {"functions": printed_rows()}),
        tables("reversed_series", {}),
        tables("impact", {**impact_context(), "promises": read_promises()}),
        *(tables(x.name, x.context(), x.folder) for x in template_modules()),
        *(x.make() for x in computed_modules()),
        *(Copy(x.name, x.file, "generated", budgets, x.notes()) for x in runtime_modules()),
        own("simple_impact", simple_impact_context()),
        own("perturbation", perturbation_context()),
        own("non_hertzian_pressure", pressure_context() | read_promises("pressure")),
        own(
            "manifest",
            {
                "rows": manifest_rows(kernels),
                "contact": contact_rows(budgets),
                "citation": CITATION,
            },
        ),
    ]
    planned += (
        replace(module, template="modal_sum", folder=TEMPLATES)
        if module.name == "modal_sum"
        else module
        for module in kernel_modules(kernels, TITLES, known)
    )
    exported = {name: [k.name for k in group] for name, group in grouped.items()}
    for row in table_rows(budgets):
        exported.setdefault(str(row["module"]), []).append(str(row["name"]))
    # The module `impact` keeps its name: its function is reached through it.
    for row in contact_rows(budgets):
        if row["module"] != "impact":
            exported.setdefault(str(row["module"]), []).append(str(row["name"]))
    names = sorted(name for group in exported.values() for name in group)
    planned.append(own("__init__", {"modules": exported, "all_names": names}, "init"))
    return tuple(planned)


def own(name: str, context: Mapping[str, Any], template: str = "") -> Module:
    """A module with a template of the paper's."""
    return Module(name, template or name, context, TEMPLATES)


def printed_rows() -> tuple[AsPrinted, ...]:
    """The paper's formulas as functions: those that need neither modes nor other formulas."""
    rows = []
    for printed in PRINTED:
        expression = printed.expression if printed.solved is None else printed.solved
        named = {str(symbol) for symbol in expression.free_symbols}
        if expression.has(sp.besselj) or not named <= set(BY_NAME):
            continue
        arguments = arguments_of(expression)
        rows.append(
            AsPrinted(
                printed.name,
                f"{printed.name} as printed.",
                printed.equation,
                tuple(argument_text(x, named) for x in arguments),
                to_numpy(expression),
            )
        )
    return tuple(rows)


def manifest_rows(kernels: tuple[EmittedKernel, ...]) -> list[dict[str, Any]]:
    """What the manifest says of each kernel, tables included."""
    return [kernel_row(k) for k in kernels] + table_rows(read_budgets())
