"""Functions whose modules are made of tables: their manifest rows, and what they promise."""

from collections.abc import Iterator, Mapping

from derivation.engine.emit.budgets import Budget
from derivation.engine.emit.copies import ListedFunction, listed_functions
from derivation.plate.budgets import read_domains
from derivation.plate.modules import runtime_files, template_modules


def listed() -> Iterator[tuple[str, ListedFunction]]:
    """Names of the modules written by hand, and their functions that the manifest lists."""
    for name, file in runtime_files().items():
        for function in listed_functions(file):
            yield name, function


def table_rows(budgets: Mapping[str, Budget]) -> list[dict[str, object]]:
    """Manifest rows of the functions that are listed with the printed formulas."""
    return [
        listed_row(name, function, budgets)
        | {
            "argument_units": [x.unit for x in function.arguments],
            "latex": function.symbol,
            "modes": False,
        }
        for name, function in listed()
        if function.kernel
    ]


PLATE = ("R", "h", "b")
ELASTIC = ("lam", "mu")
IMPACT = ("R", "m", "v0", *PLATE[1:], *ELASTIC)
TableRow = tuple[str, str, tuple[str, ...], str, str, str, str]
CONTACT_FUNCTIONS: tuple[TableRow, ...] = (
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
        "plate_coefficients",
        "contact_series",
        ("eta",),
        "1",
        "S_k",
        "",
        "coefficients of the contact law of a plate",
    ),
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
    *((row[0], module.name, *row[1:]) for module in template_modules() for row in module.functions),
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
        listed_row(name, function, budgets) for name, function in listed() if not function.kernel
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
    names = [row[0] for row in CONTACT_FUNCTIONS if row[1] == module]
    domains = read_domains()
    return {name: budgets[name].notes(domains[name]) for name in names}
