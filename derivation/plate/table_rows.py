"""Functions whose modules are made of tables: their manifest rows, and what they promise."""

from collections.abc import Mapping

from derivation.engine.emit.budgets import Budget
from derivation.engine.emit.copies import ListedFunction, listed_functions
from derivation.plate.budgets import read_domains
from derivation.plate.modules import runtime_files, template_modules

TABLES = (
    # name, module, argument, symbol, meaning
    ("bessel_j0", "bessel", "x", "J_0(x)", "Bessel function J0"),
    ("bessel_j1", "bessel", "x", "J_1(x)", "Bessel function J1"),
    ("bessel_j0_zeros", "bessel", "count", "j_n", "the first zeros of J0"),
    ("bessel_j1_zeros", "bessel", "count", "j_{1,n}", "the first positive zeros of J1"),
    ("bessel_j1_at_j0_zeros", "bessel", "count", "J_1(j_n)", "J1 at the first zeros of J0"),
    ("kappa", "series_constants", "n", r"\kappa_n", "integral of y^n K0/I0 over y > 0"),
    (
        "kappa_ratio",
        "series_constants",
        "n",
        r"2^{n+1}\kappa_n/(\pi n!)",
        "kappa_n over its leading term for large n",
    ),
    (
        "finite_part",
        "series_constants",
        "k",
        "M_k",
        "finite part of the integral of T^(2k-4) (G - 1) over T > 0",
    ),
    (
        "finite_part_ratio",
        "series_constants",
        "k",
        "2^{2k-3}M_k/(2k-2)!",
        "M_k over its leading term for large k",
    ),
)


def table_rows(budgets: Mapping[str, Budget]) -> list[dict[str, object]]:
    """Manifest rows of the functions of one number each."""
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
        | {"domain": read_domains()[name]}
        | budgets[name].row()
        for name, module, argument, symbol, meaning in TABLES
    ]


PLATE = ("R", "h", "b")
ELASTIC = ("lam", "mu")
IMPACT = ("R", "m", "v0", *PLATE[1:], *ELASTIC)
TableRow = tuple[str, str, tuple[str, ...], str, str, str, str]
CONTACT_FUNCTIONS: tuple[TableRow, ...] = (
    # name, module, arguments, unit, symbol, equation, meaning
    (
        "force_by_series",
        "reversed_series",
        ("delta", *PLATE, *ELASTIC),
        "N",
        "P",
        "10",
        "contact force by the truncated reversed series",
    ),
    ("impact", "impact", IMPACT, "s, m, N, m", "", "13", "time and peaks of an impact"),
    *((row[0], module.name, *row[1:]) for module in template_modules() for row in module.functions),
    ("history", "impact", ("t", *IMPACT), "m, m/s, m, N", "", "13", "an impact over time"),
)


def contact_rows(budgets: Mapping[str, Budget]) -> list[dict[str, object]]:
    """Manifest rows of the contact law and the impact, whose modules are made of tables."""
    keys = ("name", "module", "arguments", "unit", "symbol", "equation", "meaning")
    rows = [dict(zip(keys, row, strict=True)) for row in CONTACT_FUNCTIONS]
    domains = read_domains()
    of_templates = [
        row | {"domain": domains[str(row["name"])]} | budgets[str(row["name"])].row()
        for row in rows
    ]
    return of_templates + [
        listed_row(name, function, budgets)
        for name, file in runtime_files().items()
        for function in listed_functions(file)
    ]


def listed_row(
    module: str, function: ListedFunction, budgets: Mapping[str, Budget]
) -> dict[str, object]:
    """Manifest row of a function that is written by hand."""
    return {
        "name": function.name,
        "module": module,
        "arguments": tuple(x.name for x in function.arguments),
        "unit": function.unit,
        "symbol": function.symbol,
        "equation": function.equation,
        "meaning": function.meaning,
        "domain": function.domain,
    } | budgets[function.name].row()


def notes_of(module: str, budgets: Mapping[str, Budget]) -> dict[str, tuple[str, ...]]:
    """Notes of the functions of a module made of tables, by name."""
    rows = [row[:2] for row in TABLES] + [row[:2] for row in CONTACT_FUNCTIONS]
    names = [name for name, place in rows if place == module]
    domains = read_domains()
    return {name: budgets[name].notes(domains[name]) for name in names}
