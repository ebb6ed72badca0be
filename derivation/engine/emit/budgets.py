"""Error budgets of the generated functions, read from committed data.

A budget is a number of units in the last place (ULP) and a rule. The rule states what the units
refer to, and what is allowed in addition because of conditioning.
"""

import math
import textwrap
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ORDINARY = "value"
"""Name of the rule for functions that no other rule lists."""


@dataclass(frozen=True)
class Budget:
    """The error budget of a function.

    Parameters
    ----------
    ulp
        Allowed error in units in the last place.
    rule
        What the units refer to, and what is allowed in addition.
    """

    ulp: float
    rule: str

    def notes(self, domain: str) -> tuple[str, ...]:
        """Return lines for a docstring: the budget, and the domain to which it applies."""
        units = f"{self.ulp:g} unit{'' if self.ulp == 1 else 's'} in the last place (ULP)"
        limit = f"Tested error budget: {units} of {self.rule}."
        where = (
            f"Domain: {domain or 'all real numbers'}. The budget applies where the value is a "
            "normal floating-point number; smaller values become subnormal or zero."
        )
        return (*textwrap.wrap(limit, 84), *textwrap.wrap(where, 84, break_on_hyphens=False))

    def row(self) -> dict[str, object]:
        """Return the budget under the keys of the manifest."""
        return {"budget": self.ulp, "rule": self.rule}


def read_budgets(file: Path) -> dict[str, Budget]:
    """Return the budgets by function from a TOML file; see `parse_budgets`.

    Raises
    ------
    ValueError
        If the file is not TOML, a number is missing or not positive, or a function has two rules.
    """
    try:
        return parse_budgets(tomllib.loads(file.read_text()))
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"{file.name}: {error}; write each line as `name = 4`") from None


def read_stated_limits(file: Path, table: str) -> dict[str, float]:
    """Return the relative errors of a table in a TOML file; they are measured, not proved."""
    limits: dict[str, float] = tomllib.loads(file.read_text())[table]
    return limits


def parse_budgets(data: Mapping[str, Any]) -> dict[str, Budget]:
    """Return budgets by function from the tables `ulp` and `rule`.

    `ulp` contains a number for each function, and `rule` tables with ``text`` and ``kernels``.

    Raises
    ------
    ValueError
        If a table or a number is missing, a number is not positive, or a function has two rules.
    """
    numbers, rules = data.get("ulp", {}), data.get("rule", {})
    if not isinstance(rules.get(ORDINARY), dict) or "text" not in rules[ORDINARY]:
        raise ValueError(
            f"budgets.toml: expected a table [rule.{ORDINARY}] with the text of the ordinary rule"
        )
    for name, ulp in numbers.items():
        if isinstance(ulp, bool) or not isinstance(ulp, int | float) or not 0 < ulp < math.inf:
            raise ValueError(
                f"budgets.toml: expected a positive number of ULP for {name}, got {ulp!r}; "
                f"write for example `{name} = 4`"
            )
    named = [name for rule in rules.values() for name in rule.get("kernels", ())]
    unmatched = set(named) - set(numbers)
    twice = {name for name in named if named.count(name) > 1}
    if unmatched or twice:
        raise ValueError(
            "expected one number and at most one rule per function in budgets.toml; "
            f"correct {', '.join(sorted(unmatched | twice))}"
        )
    rule_of = {name: rule["text"] for rule in rules.values() for name in rule.get("kernels", ())}
    ordinary = rules[ORDINARY]["text"]
    return {name: Budget(float(ulp), rule_of.get(name, ordinary)) for name, ulp in numbers.items()}
