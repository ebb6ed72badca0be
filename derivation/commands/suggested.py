"""Tighter error budgets, as the commands that measure errors show them if asked."""

from collections.abc import Sequence
from typing import Any

from derivation.engine.console import OUT


def as_data(rows: Sequence[Any], wanted: bool) -> dict[str, Any]:
    """Return the suggested budgets by function, as an entry of a JSON result."""
    if not wanted:
        return {}
    from derivation.engine.measure.suggest import suggestions

    return {"suggested_budgets": {found.name: found.ulp for found in suggestions(rows)}}


def show(rows: Sequence[Any], wanted: bool) -> None:
    """Print the suggested budgets as lines of `budgets.toml`."""
    if not wanted:
        return
    from derivation.engine.measure.suggest import suggestions

    lines = [str(found) for found in suggestions(rows)]
    OUT.say("\n".join(["[ulp]", *lines] if lines else ["# no budget can be tighter"]))
