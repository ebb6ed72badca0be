"""Modules of a generated package, and their source code, from the forms of a paper."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import sympy as sp

from derivation.engine.emit.budgets import HALF, Budget, read_budgets
from derivation.engine.emit.copies import listed_functions
from derivation.engine.emit.found_form import cached_form
from derivation.engine.emit.handwritten import expect_imports, manifest_rows, public_functions
from derivation.engine.emit.kernels import (
    EmittedKernel,
    Style,
    kernel_of_form,
    lines,
    rows_by_module,
    switch_text,
)
from derivation.engine.emit.modules import (
    CopiedModule,
    Module,
    Numbers,
    Planned,
    Routines,
    module_files,
)
from derivation.engine.emit.names import MODULES, expect_free_names
from derivation.engine.emit.printer import to_numpy
from derivation.engine.emit.routine_check import check_routine, imported
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
    handwritten
        Further modules: algorithms, which are copied line for line, and tables of numbers.
    """

    summary: str
    citation: str
    parts: tuple[FormulaModule, ...]
    budgets: Path
    scales: Scales = NO_SCALES
    stated: Callable[[Mapping[str, Block]], Mapping[str, Shape]] = _nothing
    blocks: tuple[Definition, ...] = HYPERBOLIC
    routines: tuple[Routines, ...] = ()
    handwritten: tuple[CopiedModule | Numbers, ...] = ()

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

        errors: list[str] = []
        made: list[Form] = []
        for part in self.parts:
            for name in part.formulas:
                try:
                    made.append(stable(name, part.name))
                except UnreachableError as error:
                    errors.append(str(error))
        if errors:
            raise UnreachableError("\n".join(errors))
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
        modules = [part.name for part in (*self.parts, *self.routines, *self.handwritten)]
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
        rows = [kernel_row(k) for k in kernels]
        algorithms = self._algorithms(budgets)
        for part in algorithms:
            exported[part.name] = public_functions(part.file)
            rows += manifest_rows(part.name, part.file, budgets, formulas)
        names = sorted(name for group in exported.values() for name in group)
        if twice := [name for name, after in pairwise(names) if name == after]:
            raise ValueError(f"expected one function {twice[0]}, got two; rename one of them")
        manifest = {"rows": rows, "citation": self.citation}
        package = {"summary": self.summary, "modules": exported, "all_names": names}
        planned = (
            *common_modules(known),
            *kernel_modules(kernels, titles, known),
            *(part for part in self.handwritten if isinstance(part, Numbers)),
            *algorithms,
            *self.routines,
            Module("manifest", "catalogue", manifest),
            Module("__init__", "package", package),
        )
        files = module_files(planned)
        if self.routines:
            words = next(iter(formulas.values())).vocabulary
            with imported(files) as module:
                for group in self.routines:
                    for one in group.routines:
                        check_routine(one, getattr(module(group.name), one.name), words)
        return files

    def _algorithms(self, budgets: Mapping[str, Budget]) -> tuple[CopiedModule, ...]:
        """Return the modules to be copied, each with the budgets of its functions."""
        own = {*MODULES, *(p.name for p in (*self.parts, *self.routines, *self.handwritten))}
        found = []
        for part in self.handwritten:
            if isinstance(part, CopiedModule):
                expect_imports(part.file, part.package, own)
                names = {function.name for function in listed_functions(part.file)}
                known = {name: budgets[name] for name in names & budgets.keys()}
                found.append(replace(part, budgets=known))
        return tuple(found)


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
