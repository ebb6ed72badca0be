"""Modules of a generated package, and their source code, from the forms of a paper."""

import hashlib
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import sympy as sp

from derivation.engine.emit import copies, tables
from derivation.engine.emit.budgets import HALF, Budget, read_budgets
from derivation.engine.emit.found_form import cached_form
from derivation.engine.emit.kernels import (
    EmittedKernel,
    Style,
    kernel_of_form,
    lines,
    rows_by_module,
    switch_text,
)
from derivation.engine.emit.names import expect_free_names
from derivation.engine.emit.printed_fraction import expect_reason
from derivation.engine.emit.printer import to_numpy
from derivation.engine.emit.routine import ARRAYS, QUIET_SCALARS, Dialect, Routine
from derivation.engine.emit.routine import text as routine_text
from derivation.engine.emit.routine_check import check_routine, imported
from derivation.engine.emit.source import TEMPLATES, format_files, rendered_template
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary_check import expect_assumed_signs
from derivation.engine.nearest import did_you_mean
from derivation.engine.rewrite.blocks import HYPERBOLIC, Definition, build_blocks
from derivation.engine.rewrite.form import SCALINGS, Block, Form, Step, Switch, form
from derivation.engine.rewrite.products import ProductForm
from derivation.engine.rewrite.scales import Scales
from derivation.engine.rewrite.terms import UnreachableError

RUNTIME = Path(__file__).parents[1] / "runtime"
Shape = tuple[tuple[Step, ...], sp.Expr | Switch]
"""Steps and value of a form."""


@dataclass(frozen=True)
class Module:
    """A module from a template: its name, template, context, and the template's folder."""

    name: str
    template: str
    context: Mapping[str, Any]
    folder: Path = TEMPLATES


@dataclass(frozen=True)
class Numbers:
    """A module of constants: its name, the first line of its docstring, and the constants."""

    name: str
    title: str
    constants: tuple[tables.Constant, ...]


@dataclass(frozen=True)
class Routines:
    """A module of routines.

    Parameters
    ----------
    name, title
        Name of the module, and first line of its docstring.
    routines
        Its functions, in order.
    imports
        For each other module of the package, names that the functions may import from it.
    dialect
        The way in which expressions are printed: for arrays or for single numbers.
    """

    name: str
    title: str
    routines: tuple[Routine, ...]
    imports: Mapping[str, tuple[str, ...]]
    dialect: Dialect = ARRAYS


@dataclass(frozen=True)
class CopiedModule:
    """A handwritten module that is copied.

    Parameters
    ----------
    name
        Name of the module in the package.
    file
        The original.
    package
        Import name of the package in the original.
    budgets
        Error budgets of the functions that the manifest lists, by name.
    notes
        Lines about errors, by function, for functions that the manifest does not list.
    """

    name: str
    file: Path
    package: str = "generated"
    budgets: Mapping[str, Budget] = field(default_factory=dict)
    notes: Mapping[str, Sequence[str]] = field(default_factory=dict)


Planned = Module | Numbers | Routines | CopiedModule


@dataclass(frozen=True)
class FormulaModule:
    """A module of functions for formulas: its name, its first line, and the formulas' names."""

    name: str
    title: str
    formulas: tuple[str, ...]


NO_SCALES = Scales()


def _nothing(_: Mapping[str, Block]) -> Mapping[str, Shape]:
    return {}


@dataclass(frozen=True, eq=False)
class PackageSettings:
    """Settings for the generated package of a paper.

    Parameters
    ----------
    summary
        First line of the package's docstring.
    citation
        Citation in the manifest.
    parts
        The modules of the package, in order.
    budgets
        File with the error budget of every function.
    scales
        Dimensionless variables of the formulas whose forms are found by the rewriting rules.
    stated
        Function from the building blocks by name to the forms of the other formulas by name; each
        form is proved.
    blocks
        Definitions of the building blocks.
    routines
        Further modules, of functions with several steps or results, each proved.
    """

    summary: str
    citation: str
    parts: tuple[FormulaModule, ...]
    budgets: Path
    scales: Scales = NO_SCALES
    stated: Callable[[Mapping[str, Block]], Mapping[str, Shape]] = _nothing
    blocks: tuple[Definition, ...] = HYPERBOLIC
    routines: tuple[Routines, ...] = ()

    def forms(self, formulas: Mapping[str, Record]) -> tuple[Form, ...]:
        """Return the stable form of every formula of the parts.

        Raises
        ------
        ProofError
            If a form differs from its formula; the message states which.
        UnreachableError
            If the rules find no accurate form of some formulas; the message has a line for each.
        ValueError
            If a part names an unknown formula.
        """
        known = build_blocks(self.blocks)
        stated, budgets = self.stated(known), read_budgets(self.budgets)
        self._expect({name for part in self.parts for name in part.formulas}, formulas, known)

        def shape(name: str) -> tuple[ProductForm, int]:
            if name in stated:
                return ProductForm(*stated[name]), 0
            share = budgets[name].share if name in budgets else HALF
            return cached_form(formulas[name], known, self.scales, share)

        def stable(name: str, module: str) -> Form:
            given, (made, decades) = formulas[name].expression, shape(name)
            proved = form(name, module, given, made.steps, made.value, known, made.blocks)
            return replace(proved, decades=decades)

        refused: list[str] = []
        made: list[Form] = []
        for part in self.parts:
            for name in part.formulas:
                try:
                    made.append(stable(name, part.name))
                except UnreachableError as error:
                    refused.append(str(error))
        if refused:
            raise UnreachableError("\n".join(refused))
        return tuple(made)

    def _expect(
        self, names: set[str], formulas: Mapping[str, Record], blocks: Iterable[str]
    ) -> None:
        """Reject names that are not those of formulas, or that the code uses itself."""
        for name in sorted(names - formulas.keys()):
            suggestion = did_you_mean(name, formulas)
            raise ValueError(
                f"parts of the package: no formula {name!r}: {suggestion}expected some of "
                f"{', '.join(formulas)}"
            )
        chosen = [formulas[name] for name in sorted(names)]
        modules = [*(part.name for part in self.parts), *(part.name for part in self.routines)]
        expect_free_names(modules, chosen, blocks)
        for formula in chosen:
            expect_assumed_signs(formula)

    def files(self, formulas: Mapping[str, Record], forms: tuple[Form, ...]) -> dict[str, str]:
        """Return the contents of the package's files by name.

        Raises
        ------
        ProofError
            If the code of a routine does not compute its claim; the message states the point.
        ValueError
            If a function has no error budget.
        """
        own = {block.name: block for stable in forms for block in stable.blocks}
        known, budgets = {**build_blocks(self.blocks), **own}, read_budgets(self.budgets)
        if missing := [f.name for f in forms if f.name not in budgets]:
            raise ValueError(
                f"{self.budgets.name}: expected an error budget for {', '.join(missing)}; "
                f"add for example `{missing[0]} = 4` to the table [ulp]"
            )
        style = Style()
        kernels = tuple(kernel_of_form(f, formulas[f.name], budgets[f.name], style) for f in forms)
        titles = {part.name: part.title for part in self.parts}
        exported = {part.name: list(part.formulas) for part in self.parts}
        names = sorted(name for group in exported.values() for name in group)
        manifest = {"rows": [kernel_row(k) for k in kernels], "citation": self.citation}
        package = {"summary": self.summary, "modules": exported, "all_names": names}
        planned = (
            *common_modules(known),
            *kernel_modules(kernels, titles, known),
            *self.routines,
            Module("manifest", "catalogue", manifest),
            Module("__init__", "package", package),
        )
        files = module_files(planned)
        if self.routines:
            words = next(iter(formulas.values())).vocabulary
            with imported(files) as module:
                for part in self.routines:
                    for one in part.routines:
                        check_routine(one, getattr(module(part.name), one.name), words)
        return files


def common_modules(known: Mapping[str, Block]) -> tuple[Planned, ...]:
    """Return the modules that every package contains."""
    return (
        CopiedModule("arrays", RUNTIME / "arrays.py"),
        CopiedModule("polynomials", RUNTIME / "polynomials.py"),
        CopiedModule("ranges", RUNTIME / "ranges.py"),
        Module("blocks", "blocks", {"functions": [block_text(b) for b in known.values()]}),
    )


def kernel_modules(
    kernels: tuple[EmittedKernel, ...], titles: Mapping[str, str], known: Mapping[str, Block]
) -> tuple[Module, ...]:
    """Return a module for every group of functions."""
    planned = []
    for name, group in rows_by_module(kernels).items():
        text = repr(group)
        used = [block for block in known if f"{block}(" in text]
        scalings = [f.__name__ for f in SCALINGS if f"{f.__name__}(" in text]
        context = {"title": titles[name], "functions": group, "blocks": used, "scalings": scalings}
        planned.append(Module(name, "kernels", context))
    return tuple(planned)


def module_files(planned: Sequence[Planned]) -> dict[str, str]:
    """Return the contents of a package's files by name; equal modules give equal bytes.

    Copies keep their lines; all other files are formatted by ruff.
    """
    copied = {
        f"{part.name}.py": _copied(part) for part in planned if isinstance(part, CopiedModule)
    }
    printed = {
        f"{part.name}.py": _text(part) for part in planned if not isinstance(part, CopiedModule)
    }
    return copied | format_files(printed) | {"py.typed": ""}


def _copied(part: CopiedModule) -> str:
    expect_reason(part.name, part.file.read_text())
    told = sorted(part.budgets.items()), *sorted(part.notes.items())
    source = f"{part.file.read_text()}{''.join(map(str, told))}"
    return copies.copy_text(part.file, part.package, header(source), part.budgets, part.notes)


def _text(part: Module | Numbers | Routines) -> str:
    if isinstance(part, Numbers):
        return tables.module_text(part.title, header(repr(part.constants)), part.constants)
    if isinstance(part, Routines):
        return _routines_text(part)
    return module_source(part)


def _routines_text(part: Routines) -> str:
    """Return the source of a module of routines.

    Raises
    ------
    ValueError
        If the routines use names that no import provides; the message states them.
    """
    needed = {name for r in part.routines for name in r.calls | r.constants}
    given = {name for names in part.imports.values() for name in names}
    if missing := needed - given - {r.name for r in part.routines}:
        raise ValueError(f"{part.name}: expected modules for {', '.join(sorted(missing))}")
    printed = [routine_text(r, part.dialect) for r in part.routines]
    lines = _first_lines(printed, part.dialect)
    for module, names in sorted(part.imports.items()):
        used = sorted(needed & set(names))
        lines += [f"from .{module} import {', '.join(used)}"] if used else []
    body = "\n\n\n".join(["\n".join(lines), *printed])
    return f'"""{part.title}"""\n{header(body)}\n\n{body}\n'


def _first_lines(printed: Sequence[str], dialect: Dialect) -> list[str]:
    """Return the imports from outside the package."""
    code = "\n".join(printed)
    lines = ["from collections.abc import Sequence"] if dialect.rows in code else []
    if dialect is ARRAYS:
        return [*lines, "import numpy as np", "", "from .arrays import Double"]
    if dialect is QUIET_SCALARS:
        return [*lines, "import numpy as np", ""]
    if functions := sorted(set(re.findall(r"(?<!\.)\b[a-z]+\w*\b", code)) & set(vars(math))):
        lines.append(f"from math import {', '.join(functions)}")
    return [*lines, ""]


def block_text(block: Block) -> dict[str, Any]:
    """Return the template context of a building block."""
    switch = switch_text(block.value) if isinstance(block.value, Switch) else None
    return {
        "name": block.name,
        "variable": str(block.arguments[0]),
        "summary": block.summary,
        "domain": ", ".join(block.domain),
        "truncation": block.truncation,
        "steps": lines(block.steps),
        "switch": switch,
        "value": "" if switch else to_numpy(block.value),
    }


def kernel_row(k: EmittedKernel) -> dict[str, Any]:
    """Return the manifest's row of a function."""
    return {
        "name": k.name,
        "module": k.module,
        "arguments": [x.name for x in k.arguments],
        "argument_units": [x.unit for x in k.arguments],
        "unit": k.unit,
        "symbol": k.symbol,
        "latex": k.latex,
        "meaning": k.meaning,
        "equation": k.equation,
        "domain": k.domain,
        "modes": k.modes,
        "decades": k.decades,
    } | k.budget.row()


def module_source(module: Module) -> str:
    """Return a module's source code; the header states versions and a hash of the input."""
    source = repr(sorted(module.context.items()))
    source += (module.folder / f"{module.template}.py.j2").read_text()
    source += (TEMPLATES / "macros.j2").read_text()
    return rendered_template(
        module.template, {"header": header(source), **module.context}, module.folder
    )


def header(source: str) -> str:
    """Return the comment that names the generator, and a hash of its input."""
    digest = hashlib.sha256(source.encode()).hexdigest()
    versions = f"platecontact {version('platecontact')} with SymPy {sp.__version__}"
    return (
        f"# Generated by {versions} from {digest[:16]}.\n"
        "# Do not edit: run `platecontact generate` instead."
    )
