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

HALF = 0.5
"""Allowed error per sum of the condition numbers, if every argument is rounded."""
SHARES = 0.5, 1.0, 1.5, 3.0
"""Shares that a rule may state. Differences of rounded products, and functions of such products,
have errors of up to 1.5 times the sum of the condition numbers next to their zeros, and sums of
many products more."""
ARITHMETIC = "*", "/", " + ", " - "
"""Signs of conditions whose sides are rounded before they are compared."""
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
    share
        Allowed error per sum of the condition numbers.
    """

    ulp: float
    rule: str
    share: float = HALF

    def notes(self, domain: str, decades: int = 0) -> tuple[str, ...]:
        """Return lines for a docstring: the budget, and the domain to which it applies.

        All arguments were tested together for magnitudes up to ten to the power `decades`, if it is
        given.
        """
        units = f"{self.ulp:g} unit{'' if self.ulp == 1 else 's'} in the last place (ULP)"
        limit = f"Tested error budget: {units} of {self.rule}."
        where = (
            f"Domain: {domain or 'all real numbers'}. The budget applies where the value is a "
            "normal floating-point number; smaller values become subnormal or zero."
        )
        if any(sign in domain for sign in ARITHMETIC):
            where += " Conditions are compared in floating-point arithmetic, rounding included."
        if decades:
            where += f" Arguments other than 0 were tested from 1e-{decades} to 1e{decades}."
        return (*textwrap.wrap(limit, 84), *textwrap.wrap(where, 84, break_on_hyphens=False))

    def row(self) -> dict[str, object]:
        """Return the budget under the keys of the manifest."""
        row: dict[str, object] = {"budget": self.ulp, "rule": self.rule}
        return row if self.share == HALF else {**row, "share": self.share}


def read_budgets(file: Path) -> dict[str, Budget]:
    """Return the budgets by function from a TOML file; see `parse_budgets`.

    Raises
    ------
    ValueError
        If the file is not TOML, a number is missing or not positive, or a function has two rules.
    """
    if not file.is_file():
        raise ValueError(
            f"expected a file {file}; write a table [ulp] with a line `name = 4` for each function"
        )
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

    `ulp` contains a number for each function, and `rule` tables with ``text`` and ``kernels``. A
    table with ``share``, the allowed error per sum of the condition numbers, needs no text. Without
    a table ``value``, the share of functions without a rule is 0.5.

    Raises
    ------
    ValueError
        If a table or a number is missing, a number is not positive, or a function has two rules.
    """
    numbers, rules = data.get("ulp", {}), {ORDINARY: {"share": HALF}} | data.get("rule", {})
    for name, rule in rules.items():
        if not isinstance(rule, dict) or not {"text", "share"} & rule.keys():
            raise ValueError(
                f"budgets.toml: expected a table [rule.{name}] with a text or a share, got {rule!r}"
            )
        share = rule.get("share", HALF)
        if isinstance(share, bool) or not isinstance(share, int | float) or share not in SHARES:
            expected = ", ".join(map(str, SHARES))
            raise ValueError(
                f"budgets.toml: expected one of {expected} as the share of rule.{name}, "
                f"got {share!r}"
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
    rule_of = {name: rule for rule in rules.values() for name in rule.get("kernels", ())}
    return {
        name: _budget(float(ulp), rule_of.get(name, rules[ORDINARY]))
        for name, ulp in numbers.items()
    }


def _budget(ulp: float, rule: Mapping[str, Any]) -> Budget:
    share = float(rule.get("share", HALF))
    stated = f"the value, and on top {share:g} times the sum of the arguments' condition numbers"
    return Budget(ulp, rule["text"] if "share" not in rule else stated, share)
