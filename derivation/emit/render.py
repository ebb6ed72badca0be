"""Proven formulas and their stable forms in, the text of the package `generated` out.

Stages, each one assignment in `render`:

 1 kernels   formulas, forms, budgets -> rows: what each function is
 2 modules   rows -> one template and its context per module
 3 source    templates -> Python source
 4 files     source -> as ruff formats it
"""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

import sympy as sp

from derivation.emit.budgets import read_budgets, read_promises
from derivation.emit.kernels import (
    MODAL_SUMS,
    AsPrinted,
    Kernel,
    argument_text,
    kernel_of_form,
    kernel_of_sum,
    lines,
    rows_by_module,
    seam_text,
)
from derivation.emit.perturbation import perturbation_context
from derivation.emit.printer import to_numpy
from derivation.emit.source import TEMPLATES, filled, format_files
from derivation.emit.table_rows import contact_rows, notes_of, table_rows
from derivation.formula.record import Formula
from derivation.formula.symbols import BY_NAME, arguments_of
from derivation.paper.printed import PRINTED
from derivation.rewrite.bessel_tables import bessel_context
from derivation.rewrite.blocks import blocks
from derivation.rewrite.contact_tables import contact_context, impact_context, sensitivity_context
from derivation.rewrite.edge_tables import edge_context
from derivation.rewrite.effect_tables import effect_context
from derivation.rewrite.far_face_tables import far_face_context
from derivation.rewrite.form import ONCE, SCALINGS, Block, Form, Seam
from derivation.rewrite.held_tables import held_context
from derivation.rewrite.inertia_tables import inertia_context, waves_context
from derivation.rewrite.moment_tables import moment_context
from derivation.rewrite.pressure_tables import pressure_context
from derivation.rewrite.sections import sections
from derivation.rewrite.simple_impact_tables import simple_impact_context
from derivation.rewrite.viscosity_tables import viscosity_context

CITATION = "Elastodynamic contact in plate-like bodies"
TITLES = {
    "omega": "Integration constants C_k = A_j Omega_k of a mode, scaled by e^(phi h) and plain.",
    "influence": "Influence coefficients of both faces, plate factors and K_j.",
    "pressure": "Hertz pressure and its Fourier-Bessel coefficients.",
    "mode_shapes": "Displacements and stresses of one mode through the thickness.",
    "modal_sum": "Indentation and interior fields as direct sums over the modes.",
}


@dataclass(frozen=True)
class Module:
    """A file to be: its template and what goes in."""

    name: str
    template: str
    context: Mapping[str, Any]


def render(formulas: Mapping[str, Formula], forms: tuple[Form, ...]) -> dict[str, str]:
    """Files of the generated package by name; the same bytes for the same input."""
    kernels = kernel_rows(formulas, forms)
    planned = modules(kernels)
    source = {f"{module.name}.py": fill(module) for module in planned}
    return format_files(source) | {"py.typed": ""}


def kernel_rows(formulas: Mapping[str, Formula], forms: tuple[Form, ...]) -> tuple[Kernel, ...]:
    """Stage 1: a row for every stable form and every modal sum."""
    budgets = read_budgets()
    shares = {f.name: f for f in forms if formulas[f.name].summed}
    closed = (f for f in forms if f.name not in shares)
    of_forms = tuple(kernel_of_form(f, formulas[f.name], budgets[f.name]) for f in closed)
    load = formulas["A_j"], formulas["Omega_1"]
    of_sums = tuple(
        kernel_of_sum(formulas[name], *load, budgets[name], shares.get(name))
        for name in (*shares, *MODAL_SUMS)
    )
    return of_forms + of_sums


def modules(kernels: tuple[Kernel, ...]) -> tuple[Module, ...]:
    """Stage 2: every file's template and context."""
    grouped = rows_by_module(kernels)
    known, budgets = blocks() | sections(), read_budgets()

    def tables(name: str, context: Mapping[str, Any]) -> Module:
        return Module(name, name, {**context, "notes": notes_of(name, budgets)})

    planned = [
        Module("arrays", "arrays", {}),
        Module("ranges", "ranges", {"once": ONCE}),
        Module("blocks", "blocks", {"functions": [block_text(b) for b in known.values()]}),
        tables("bessel", bessel_context()),
        tables("moments", moment_context()),
        Module("as_printed", "as_printed", {"functions": printed_rows()}),
        tables("contact_series", contact_context()),
        tables("contact_law", {}),
        tables("reversed_series", {}),
        tables("impact", {**impact_context(), "promises": read_promises()}),
        tables("sensitivity", sensitivity_context()),
        tables("edge", edge_context()),
        tables("far_face", far_face_context()),
        tables("held_modes", held_context()),
        tables("effects", effect_context()),
        tables("viscosity", viscosity_context()),
        tables("inertia", inertia_context()),
        Module("plate_waves", "plate_waves", waves_context()),
        Module("simple_impact", "simple_impact", simple_impact_context()),
        Module("perturbation", "perturbation", perturbation_context()),
        Module("true_pressure", "true_pressure", pressure_context() | read_promises("pressure")),
        Module(
            "manifest",
            "manifest",
            {
                "rows": manifest_rows(kernels),
                "contact": contact_rows(budgets),
                "citation": CITATION,
            },
        ),
    ]
    for name, group in grouped.items():
        template = "modal_sum" if name == "modal_sum" else "kernels"
        text = repr(group)
        used = [block for block in known if f"{block}(" in text]
        scalings = [f.__name__ for f in SCALINGS if f"{f.__name__}(" in text]
        context = {"title": TITLES[name], "functions": group, "blocks": used, "scalings": scalings}
        planned.append(Module(name, template, context))
    exported = {name: [k.name for k in group] for name, group in grouped.items()}
    for row in table_rows(budgets):
        exported.setdefault(str(row["module"]), []).append(str(row["name"]))
    # The module `impact` keeps its name: its function is reached through it.
    for row in contact_rows(budgets):
        if row["module"] != "impact":
            exported.setdefault(str(row["module"]), []).append(str(row["name"]))
    names = sorted(name for group in exported.values() for name in group)
    planned.append(Module("__init__", "init", {"modules": exported, "all_names": names}))
    return tuple(planned)


def block_text(block: Block) -> dict[str, Any]:
    """Context of a building block."""
    seam = seam_text(block.value) if isinstance(block.value, Seam) else None
    return {
        "name": block.name,
        "variable": str(block.arguments[0]),
        "summary": block.summary,
        "domain": ", ".join(block.domain),
        "truncation": block.truncation,
        "steps": lines(block.steps),
        "seam": seam,
        "value": "" if seam else to_numpy(block.value),
    }


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


def manifest_rows(kernels: tuple[Kernel, ...]) -> list[dict[str, Any]]:
    """What the manifest says of each kernel."""
    rows = [
        {
            "name": k.name,
            "module": k.module,
            "arguments": [x.name for x in k.arguments],
            "argument_units": [x.unit for x in k.arguments],
            "unit": k.unit,
            "symbol": k.symbol,
            "latex": k.latex,
            "meaning": k.meaning,
            "equation": k.equation,
            "modes": k.modes,
        }
        | k.budget.row()
        for k in kernels
    ]
    return rows + table_rows(read_budgets())


def fill(module: Module) -> str:
    """Stage 3: a module's source, its header naming versions and the hash of what it came from."""
    header = "# " + "\n# ".join(header_lines(module))
    return filled(module.template, {"header": header, **module.context})


def header_lines(module: Module) -> tuple[str, str]:
    """Who generated a module, from what."""
    digest = hashlib.sha256(repr(sorted(module.context.items())).encode())
    digest.update((TEMPLATES / f"{module.template}.py.j2").read_bytes())
    digest.update((TEMPLATES / "macros.j2").read_bytes())
    versions = f"platecontact {version('platecontact')} with SymPy {sp.__version__}"
    return (
        f"Generated by {versions} from {digest.hexdigest()[:16]}.",
        "Do not edit: `platecontact generate` writes it anew.",
    )
