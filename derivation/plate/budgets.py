"""The budgets of the plate's functions: of the whole paper, and of single subjects."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from derivation.engine.emit import budgets

BUDGETS = Path(__file__).parent / "budgets.toml"


def read_tables() -> dict[str, Any]:
    """Read all tables; the subjects' own budgets are added to those of the paper.

    Raises
    ------
    ValueError
        If a subject states again what stands elsewhere.
    """
    found = tomllib.loads(BUDGETS.read_text())
    for file in sorted(BUDGETS.parent.glob("*/budgets.toml")):
        own = tomllib.loads(file.read_text())
        if twice := own["ulp"].keys() & found["ulp"].keys():
            raise ValueError(f"{file.parent.name}: a second budget for {', '.join(twice)}")
        found["ulp"] |= own["ulp"]
    return found


def read_budgets() -> dict[str, budgets.Budget]:
    """Budgets by kernel, as committed."""
    return budgets.parse_budgets(read_tables())


def read_printed_share() -> float:
    """The part of the package's arithmetic that is printed at least [1], as committed."""
    share: float = read_tables()["package"]["printed"]
    return share


def read_promises(table: str = "impact") -> dict[str, float]:
    """Relative errors, of the impact or of another table, measured, not proven, as committed."""
    return budgets.read_promises(BUDGETS, table)


def counted(sources: Mapping[str, str]) -> dict[str, str]:
    """The modules that the printed share is of, by name.

    The one that repeats the paper's formulas, misprints included, is not among them.
    """
    return {name: text for name, text in sources.items() if name != "as_printed"}
