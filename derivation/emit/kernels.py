"""Formulas, forms and budgets -> rows: what each generated function is and how it reads."""

import re
import textwrap
from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from derivation.emit.budgets import Budget
from derivation.emit.inertia_rows import INERTIA_FUNCTIONS, VISCOSITY_FUNCTIONS
from derivation.emit.printer import to_numpy
from derivation.formula.record import Formula
from derivation.formula.symbols import ARGUMENTS, C1, C3, Argument, applicable
from derivation.rewrite.form import Branch, Form, Seam, Step

MODAL_SUMS = {
    "u": "mode_g(z, phi, h, lam, mu, A) * phi * bessel_j1(phi * r)",
    "w": "mode_f(z, phi, h, lam, mu, A) * bessel_j0(phi * r)",
    # Their sum is small where Poisson's ratio is almost -1: it is rounded as little as can be.
    "sigma_rr": "((radial + hoop) * chord + radial * twist) * (A / unit)",
    "sigma_tt": "((radial + hoop) * chord + hoop * twist) * (A / unit)",
    "sigma_zz": "mode_zz(z, phi, h, lam, mu, A) * bessel_j0(phi * r)",
    "sigma_rz": "mode_rz(z, phi, h, lam, mu, A) * bessel_j1(phi * r)",
}
"""One mode's share of each sum that is put in terms of the other kernels."""


@dataclass(frozen=True)
class Line:
    """A line of code: a name, its value and a comment."""

    name: str
    code: str
    comment: str = ""


@dataclass(frozen=True)
class BranchText:
    """One side of a seam as text."""

    guards: tuple[Line, ...]
    steps: tuple[Line, ...]
    value: str


@dataclass(frozen=True)
class SeamText:
    """A choice between two branches as text."""

    mask: str
    variable: str
    at: str
    branches: tuple[BranchText, BranchText]


@dataclass(frozen=True)
class ArgumentText:
    """An argument as the docstring and the manifest name it."""

    name: str
    unit: str
    meaning: str
    domain: str


@dataclass(frozen=True)
class Kernel:
    """A generated function: everything templates and manifest say about it."""

    name: str
    module: str
    summary: str
    meaning: str
    symbol: str
    latex: str
    unit: str
    equation: str
    formula: tuple[str, ...]
    original: tuple[str, ...]
    arguments: tuple[ArgumentText, ...]
    conditions: tuple[str, ...]
    budget: Budget
    modes: bool
    steps: tuple[Line, ...] = ()
    value: str = ""
    seam: SeamText | None = None

    @property
    def loaded(self) -> bool:
        """Whether the sum's share needs the pressure coefficient."""
        return self.modes and ("A)" in self.value or self.in_plane)

    @property
    def in_plane(self) -> bool:
        """Whether the sum's share is made of both stresses in plane and the chord of J1."""
        return self.modes and "chord" in self.value

    @property
    def carried(self) -> tuple[str, ...]:
        """Of a value that does not depend on all arguments: the last it needs, then the idle."""
        code = set(re.findall(r"\w+", repr((self.value, self.steps, self.seam))))
        idle = [x.name for x in self.arguments if x.name not in code and not self.modes]
        return ([x.name for x in self.arguments if x.name in code][-1], *idle) if idle else ()

    @property
    def notes(self) -> tuple[str, ...]:
        """What the docstring promises about the error."""
        return budget_notes(self.budget)


def budget_notes(budget: Budget) -> tuple[str, ...]:
    """A budget's three parts as lines of a docstring."""
    promise = f"Error budget: {budget.ulp:g} units in the last place of {budget.rule}."
    where = f"Domain: {budget.domain or 'all real numbers'}; wherever the value is representable."
    return (*textwrap.wrap(promise, 84), *textwrap.wrap(where, 84, break_on_hyphens=False))


def kernel_of_form(stable: Form, formula: Formula, budget: Budget) -> Kernel:
    """Row of a kernel that evaluates a stable form."""
    seam = seam_text(stable.value, whole=True) if isinstance(stable.value, Seam) else None
    return _kernel(
        formula,
        formula.arguments,
        stable.module,
        budget,
        steps=lines(stable.steps),
        value="" if seam else to_numpy(stable.value),
        seam=seam,
    )


def kernel_of_sum(
    formula: Formula, coefficient: Formula, factor: Formula, budget: Budget, share: Form | None
) -> Kernel:
    """Row of a modal sum: its arguments are those of its parts, less phi and J1.

    One mode's share has a stable form of its own, or is one of `MODAL_SUMS`.
    """
    expression = formula.expression
    parts: tuple[Formula, ...] = (formula,)
    if any(str(symbol).startswith("C") for symbol in expression.free_symbols):
        parts += (coefficient, factor)
    names = {x.name for part in parts for x in part.arguments}
    names -= {"phi", "J1", "A_j", "C1", "C2", "C3", "C4"}
    arguments = tuple(x for x in ARGUMENTS if x.name in names)
    steps = () if share is None else lines(share.steps)
    value = MODAL_SUMS[formula.name] if share is None else to_numpy(share.value)
    return _kernel(formula, arguments, "modal_sum", budget, steps=steps, value=value, modes=True)


def _kernel(
    formula: Formula,
    arguments: tuple[Argument, ...],
    module: str,
    budget: Budget,
    *,
    steps: tuple[Line, ...] = (),
    value: str,
    seam: SeamText | None = None,
    modes: bool = False,
) -> Kernel:
    names = {x.name for x in arguments}
    where = conditions(arguments, formula.where)
    if budget.domain != ", ".join(where):
        raise ValueError(
            f"the budget of {formula.name} names the domain {budget.domain!r}; "
            f"the formula's is {', '.join(where)!r}"
        )
    total = "sum over j of " if modes else ""
    stated = formula.expression if formula.stated is None else formula.stated
    constants = ", C_k = A_j*Omega_k" if stated.has(C1) or stated.has(C3) else ""
    return Kernel(
        name=formula.name,
        module=module,
        summary=formula.meaning[0].upper() + formula.meaning[1:] + ".",
        meaning=formula.meaning,
        symbol=formula.latex,
        latex=f"{formula.latex} = {formula.right_hand_side}",
        unit=formula.unit,
        equation=formula.equation,
        formula=_wrap(f"{formula.name} = {total}{sp.sstr(stated)}{constants}"),
        original=() if stated == formula.expression else _wrap(sp.sstr(formula.expression)),
        arguments=tuple(argument_text(x, names) for x in arguments),
        conditions=where,
        budget=budget,
        modes=modes,
        steps=steps,
        value=value,
        seam=seam,
    )


def _wrap(text: str) -> tuple[str, ...]:
    """Lines of at most 88 characters, broken at spaces only."""
    return tuple(
        textwrap.wrap(
            text, 88, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False
        )
    )


def argument_text(argument: Argument, names: set[str]) -> ArgumentText:
    """An argument's line, with those of its conditions that apply."""
    domain = ", ".join(applicable(argument.domain, names))
    return ArgumentText(argument.name, argument.unit, argument.meaning, domain)


def conditions(arguments: tuple[Argument, ...], extra: tuple[str, ...]) -> tuple[str, ...]:
    """Every condition on the arguments that names nothing but arguments."""
    own = (condition for x in arguments for condition in x.domain)
    return applicable((*own, *extra), {x.name for x in arguments})


def lines(steps: tuple[Step, ...]) -> tuple[Line, ...]:
    """Steps as lines of code."""
    return tuple(Line(str(s.symbol), to_numpy(s.expression), s.comment) for s in steps)


def seam_text(seam: Seam, *, whole: bool = False) -> SeamText:
    """A seam as text: the branch above guards itself against points below.

    The one below is given those alone, by itself or, in a whole function, by that.
    """
    name = str(seam.variable)
    clamped = {seam.variable: f"np.maximum({name}, {float(seam.at)})"}
    below = _branch_text(seam.below, {} if whole else _picked(seam.below), "low")
    return SeamText(
        "below", name, to_numpy(seam.at), (below, _branch_text(seam.above, clamped, "high"))
    )


def _picked(branch: Branch) -> dict[sp.Symbol, str]:
    """What a branch needs, at its own points alone."""
    used = sp.Tuple(branch.value, *(step.expression for step in branch.steps)).free_symbols
    given = sorted(used - {step.symbol for step in branch.steps}, key=str)
    return {symbol: f"np.asarray({symbol})[below]" for symbol in given}


def _branch_text(branch: Branch, guards: Mapping[sp.Symbol, str], suffix: str) -> BranchText:
    copies = {symbol: sp.Symbol(f"{symbol}_{suffix}", real=True) for symbol in guards}
    own = tuple(Line(str(copies[symbol]), code) for symbol, code in guards.items())
    steps = tuple(Step(s.symbol, s.expression.xreplace(copies), s.comment) for s in branch.steps)
    return BranchText(own, lines(steps), to_numpy(branch.value.xreplace(copies)))


@dataclass(frozen=True)
class AsPrinted:
    """A printed formula as a function."""

    name: str
    summary: str
    equation: str
    arguments: tuple[ArgumentText, ...]
    value: str


def rows_by_module(kernels: tuple[Kernel, ...]) -> Mapping[str, list[Kernel]]:
    """Kernels grouped by module, in order of first appearance."""
    grouped: dict[str, list[Kernel]] = {}
    for kernel in kernels:
        grouped.setdefault(kernel.module, []).append(kernel)
    return grouped


TABLES = (
    # name, module, argument, symbol, meaning
    ("bessel_j0", "bessel", "x", "J_0(x)", "Bessel function J0"),
    ("bessel_j1", "bessel", "x", "J_1(x)", "Bessel function J1"),
    ("bessel_j0_zeros", "bessel", "count", "j_n", "the first zeros of J0"),
    ("bessel_j1_zeros", "bessel", "count", "j_{1,n}", "the first positive zeros of J1"),
    ("bessel_j1_at_j0_zeros", "bessel", "count", "J_1(j_n)", "J1 at the first zeros of J0"),
    ("kappa", "moments", "n", r"\kappa_n", "integral of y^n K0/I0 over y > 0"),
    (
        "kappa_ratio",
        "moments",
        "n",
        r"2^{n+1}\kappa_n/(\pi n!)",
        "kappa_n over its leading term for large n",
    ),
    (
        "finite_part",
        "moments",
        "k",
        "M_k",
        "finite part of the integral of T^(2k-4) (G - 1) over T > 0",
    ),
    (
        "finite_part_ratio",
        "moments",
        "k",
        "2^{2k-3}M_k/(2k-2)!",
        "M_k over its leading term for large k",
    ),
)


def table_rows(budgets: Mapping[str, Budget]) -> list[dict[str, object]]:
    """Manifest rows of the functions whose modules are made of tables, of one argument each."""
    return [
        {
            "name": name,
            "module": module,
            "arguments": [argument],
            "argument_units": ["1"],
            "unit": "1",
            "symbol": symbol,
            "latex": symbol,
            "meaning": meaning,
            "equation": "",
            "modes": False,
        }
        | promise(budgets[name])
        for name, module, argument, symbol, meaning in TABLES
    ]


PLATE = ("R", "h", "b")
ELASTIC = ("lam", "mu")
IMPACT = ("R", "m", "v0", *PLATE[1:], *ELASTIC)
ContactRow = tuple[str, str, tuple[str, ...], str, str, str, str]
EDGE_FUNCTIONS: tuple[ContactRow, ...] = tuple(
    (f"{kind}_edge{part}", "edge", ("a", *PLATE[1:], *ELASTIC), "1", "", "6", f"{what}: {meaning}")
    for part, meaning in (
        ("", "addition to delta R/a^2"),
        ("_slope", "addition to (R/2a) d delta/da"),
        ("_bound", "bound of the addition to (R/2a) d delta/da up to this contact"),
    )
    for kind, what in (("supported", "simple support"), ("clamped", "clamp"))
)
FAR_FACE_FUNCTIONS: tuple[ContactRow, ...] = tuple(
    (
        f"{kind}far_stress",
        "far_face",
        ("P", "a", *PLATE[1:], *ELASTIC),
        "Pa",
        r"\sigma_{rr}(0, -h)",
        "",
        f"tension of the far face under the axis{what}",
    )
    for kind, what in (("", ""), ("supported_", ", simple support"), ("clamped_", ", clamp"))
)
CONTACT_FUNCTIONS: tuple[ContactRow, ...] = (
    # name, module, arguments, unit, symbol, equation, meaning
    ("indentation", "contact_law", ("a", *PLATE), "m", r"\delta", "6", "indentation"),
    ("contact_radius", "contact_law", ("delta", *PLATE), "m", "a", "6", "contact radius"),
    ("force", "contact_law", ("delta", *PLATE, *ELASTIC), "N", "P", "10", "contact force"),
    ("force_of_radius", "contact_law", ("a", "R", *ELASTIC), "N", "P", "7", "contact force"),
    ("radius_of_force", "contact_law", ("P", "R", *ELASTIC), "m", "a", "7", "contact radius"),
    (
        "stiffness",
        "contact_law",
        ("a", *PLATE, *ELASTIC),
        "N/m",
        r"\mathrm{d}P/\mathrm{d}\delta",
        "10",
        "force per indentation added",
    ),
    ("max_pressure", "contact_law", ("a", "R", *ELASTIC), "Pa", "p_0", "7", "largest pressure"),
    (
        "force_by_series",
        "reversed_series",
        ("delta", *PLATE, *ELASTIC),
        "N",
        "P",
        "10",
        "contact force by the truncated reversed series",
    ),
    (
        "plate_coefficients",
        "contact_series",
        ("eta",),
        "1",
        "S_k",
        "",
        "coefficients of the contact law of a plate",
    ),
    ("impact", "impact", IMPACT, "s, m, N, m", "", "13", "time and peaks of an impact"),
    (
        "indentation_slope",
        "sensitivity",
        ("a", *PLATE),
        "1",
        r"\mathrm{d}\delta/\mathrm{d}a",
        "6",
        "indentation per contact radius added",
    ),
    (
        "impact_sensitivities",
        "sensitivity",
        IMPACT,
        "1",
        "",
        "13",
        "logarithmic derivatives of time and peaks by every parameter",
    ),
    *EDGE_FUNCTIONS,
    *FAR_FACE_FUNCTIONS,
    ("clamped_modes", "held_modes", ("count",), "1", "k_n, c, W_n", "", "modes, clamp"),
    ("supported_modes", "held_modes", ("count", "nu"), "1", "k_n, c, W_n", "", "modes, support"),
    ("history", "impact", ("t", *IMPACT), "m, m/s, m, N", "", "13", "an impact over time"),
    ("sphere_contact", "effects", ("a_over_R",), "1", "", "7", "a sphere over a paraboloid"),
    (
        "zener_number",
        "effects",
        ("R", "m", "v0", "h", *ELASTIC, "rho"),
        "1",
        r"\lambda_Z",
        "",
        "how much of the impact the plate's waves carry away",
    ),
    *VISCOSITY_FUNCTIONS,
    *INERTIA_FUNCTIONS,
    ("bending_period", "effects", ("h", "b", *ELASTIC, "rho"), "s", "T_1", "", "bending period"),
    ("echo_time", "effects", ("h", *ELASTIC, "rho"), "s", "T_e", "", "time of two echoes"),
    ("side_wall", "effects", ("alpha",), "1", "F_W", "6", "what the finite radius adds"),
    ("bending", "effects", ("a_ratio", "eta"), "1", "F_B", "6", "what a thin plate's bending adds"),
)


def contact_rows(budgets: Mapping[str, Budget]) -> list[dict[str, object]]:
    """Manifest rows of the contact law and the impact, whose modules are made of tables."""
    keys = ("name", "module", "arguments", "unit", "symbol", "equation", "meaning")
    rows = [dict(zip(keys, row, strict=True)) for row in CONTACT_FUNCTIONS]
    return [row | promise(budgets[str(row["name"])]) for row in rows]


def promise(budget: Budget) -> dict[str, object]:
    """A budget's three parts under the manifest's keys."""
    return {"domain": budget.domain, "budget": budget.ulp, "rule": budget.rule}


def notes_of(module: str, budgets: Mapping[str, Budget]) -> dict[str, tuple[str, ...]]:
    """Notes of the functions of a module made of tables, by name."""
    rows = [row[:2] for row in TABLES] + [row[:2] for row in CONTACT_FUNCTIONS]
    names = [name for name, place in rows if place == module]
    return {name: budget_notes(budgets[name]) for name in names}
