"""Names of a paper's functions, arguments and modules that the generated code uses itself.

Constants, which have no arguments, are rejected too.
"""

from collections.abc import Iterable, Sequence

from derivation.engine.formula.record import Record
from derivation.engine.rewrite.form import SCALINGS

MODULES = "arrays", "polynomials", "ranges", "blocks", "manifest"
"""Modules of every package."""
IN_MODULES = (
    "np",
    "ArrayLike",
    "annotations",
    "as_doubles",
    "as_result",
    "inside",
    "patched",
    "quiet",
)
IN_FUNCTIONS = "kind", "below", "polynomial", "shape"


def expect_free_names(
    modules: Sequence[str], formulas: Iterable[Record], blocks: Iterable[str]
) -> None:
    """Reject names that the generated code uses itself.

    Raises
    ------
    ValueError
        If two modules have one name, or a module, formula or argument has such a name, or a formula
        has no arguments.
    """
    for name in modules:
        if name in MODULES or modules.count(name) > 1 or not name.isidentifier():
            raise ValueError(
                f"expected modules with different Python names other than {', '.join(MODULES)}, "
                f"got {name!r}; rename it"
            )
    imported = {*IN_MODULES, *blocks, *(scaling.__name__ for scaling in SCALINGS)}
    for formula in formulas:
        if not formula.arguments:
            raise ValueError(
                f"{formula.name}: expected a formula with arguments, got a constant; remove it "
                "from the module, and write its value in your code"
            )
        inside = [argument.name for argument in formula.arguments]
        used = {formula.name} & imported or {*inside} & {*imported, *IN_FUNCTIONS}
        if used:
            raise ValueError(
                f"{formula.name}: expected another name than {min(used)}, which the generated code "
                "uses; rename the formula or symbol"
            )
