"""Error budgets of the plate's functions, collected from the paper and its subjects."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from derivation.engine.emit import budgets

BUDGETS = Path(__file__).parent / "budgets.toml"


def read_tables() -> dict[str, Any]:
    """Read all tables; budgets of the subjects are added to those of the paper.

    Raises
    ------
    ValueError
        If a subject repeats a budget that is stated elsewhere.
    """
    tables = tomllib.loads(BUDGETS.read_text())
    for file in sorted(BUDGETS.parent.glob("*/budgets.toml")):
        table = tomllib.loads(file.read_text())
        if twice := table["ulp"].keys() & tables["ulp"].keys():
            raise ValueError(f"{file.parent.name}: a second budget for {', '.join(twice)}")
        tables["ulp"] |= table["ulp"]
    return tables


def read_budgets() -> dict[str, budgets.Budget]:
    """Return the committed error budgets by function."""
    return budgets.parse_budgets(read_tables())


def read_printed_fraction() -> float:
    """Return the committed lower limit for the printed part of the package's arithmetic [1]."""
    fraction: float = read_tables()["package"]["printed"]
    return fraction


def read_stated_limits(table: str = "impact") -> dict[str, float]:
    """Return the committed relative errors of a table; they are tested, not proved."""
    return budgets.read_stated_limits(BUDGETS, table)


def counted_modules(sources: Mapping[str, str]) -> dict[str, str]:
    """Return the modules whose arithmetic is counted for the printed fraction, by name.

    `as_printed`, which repeats the paper's formulas with their misprints, is not counted.
    """
    return {name: text for name, text in sources.items() if name != "as_printed"}
