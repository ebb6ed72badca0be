"""Functions without a formula; only their derivatives are known."""

from collections.abc import Callable

import sympy as sp


def unspecified_function(name: str, *slopes: Callable[..., sp.Expr]) -> type[sp.Function]:
    """Return a class of SymPy functions that are not evaluated.

    Parameters
    ----------
    name
        Name of the function.
    slopes
        For each argument, a function from the arguments to the derivative by it.
    """

    def fdiff(self: sp.Function, argindex: int = 1) -> sp.Expr:
        return slopes[argindex - 1](*self.args)

    return type(name, (sp.Function,), {"fdiff": fdiff} if slopes else {})
