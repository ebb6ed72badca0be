"""The published pair (1), (2) in the equilibrium equations, unchanged and with a sign reversed."""

from collections.abc import Iterable, Mapping

from derivation.engine.errata.findings import Printed
from derivation.engine.formula.proof import decide_zero
from derivation.plate.modes.theory.equilibrium import force_balance, hooke
from derivation.plate.printed.contact import PRINTED, f_j, g_j


def _printed(name: str) -> Printed:
    return next(record for record in PRINTED if record.name == name)


def balances(signs: Mapping[str, int]) -> bool:
    """Return whether the published u, w and f_j, g_j balance; `signs` multiply each."""
    shapes = {
        f_j: signs.get("f_j", 1) * _printed("f_j").expression,
        g_j: signs.get("g_j", 1) * _printed("g_j").expression,
    }
    u, w = ((signs.get(name, 1) * _printed(name).expression).subs(shapes) for name in ("u", "w"))
    return all(decide_zero(rest) is not None for rest in force_balance(hooke(u, w)))


def signs_that_balance(names: Iterable[str]) -> tuple[str, ...]:
    """Return which of u, w, f_j, g_j makes the published pair balance if its sign is reversed."""
    if balances({}):
        return ()
    return tuple(name for name in names if balances({name: -1}))
