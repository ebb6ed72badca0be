"""The budgets of the plate's functions."""

from pathlib import Path

from derivation.engine.emit import budgets

BUDGETS = Path(__file__).parent / "budgets.toml"


def read_budgets() -> dict[str, budgets.Budget]:
    """Budgets by kernel, as committed."""
    return budgets.read_budgets(BUDGETS)


def read_promises(table: str = "impact") -> dict[str, float]:
    """Relative errors, of the impact or of another table, measured, not proven, as committed."""
    return budgets.read_promises(BUDGETS, table)
