"""The stable form of a paper's formula, found by the rules and tested in all arguments together."""

import hashlib
from collections.abc import Callable, Iterator, Mapping

import sympy as sp

from derivation.engine.cache import cached
from derivation.engine.emit.budgets import SHARES
from derivation.engine.formula.record import Record
from derivation.engine.rewrite.automatic import automatic
from derivation.engine.rewrite.every_variable import DECADES, Accuracy, JointTest
from derivation.engine.rewrite.form import Block, Branch, Step, Switch
from derivation.engine.rewrite.products import (
    GivenFormula,
    ProductForm,
    Stated,
    decaying_last,
    of_products,
)
from derivation.engine.rewrite.scales import Scales
from derivation.engine.rewrite.several_products import several_products
from derivation.engine.rewrite.terms import UnreachableError, collected
from derivation.engine.rewrite.useful_range import ENOUGH

TESTED = {0.5: 0.42, 1.0: 0.7, 1.5: 1.0, 3.0: 2.0}
"""Errors per sum of the condition numbers that are allowed in the test, by those of the budget. A
margin is left because other points next to zeros may have larger errors."""

CLEARLY = 0.75 * ENOUGH
"""Largest error [ULP], with the part that conditioning explains, up to which no other form is
tested."""
Found = tuple[tuple[Step, ...], sp.Expr | Switch, tuple[Block, ...], int]
"""Steps, value and blocks of a form, and the decades in which it was tested."""


def cached_form(
    formula: Record, known: Mapping[str, Block], scales: Scales, share: float
) -> tuple[ProductForm, int]:
    """Return the result of `found_form`, cached until the formula or one of its inputs changes.

    Errors are cached as well, because a search takes longest if it fails.
    """
    words = formula.vocabulary.with_conditions(formula.where)
    given = GivenFormula(formula.name, formula.expression, words)

    def compute() -> Found | str:
        try:
            made, decades = found_form(given, known, scales, share)
        except UnreachableError as error:
            return str(error)
        return made.steps, made.value, made.blocks, decades

    arguments = [(sp.srepr(a.symbol), a.name, a.domain) for a in given.arguments]
    blocks = [(name, sp.srepr(block.total)) for name, block in known.items()]
    inputs = given.name, sp.srepr(given.expression), arguments, blocks, scales, share
    key = hashlib.sha256(repr(inputs).encode()).hexdigest()[:16]
    sources = ("engine/cache.py", "engine/formula", "engine/rewrite", "engine/emit/found_form.py")
    found = cached(f"form-{key}", sources, compute, Block, Step, Branch, Switch)
    if isinstance(found, str):
        raise UnreachableError(found)
    return ProductForm(*found[:3]), found[3]


def found_form(
    formula: Stated, known: Mapping[str, Block], scales: Scales, share: float
) -> tuple[ProductForm, int]:
    """Return the accurate form that the rules find, and the decades in which it was tested.

    It is found by the paper's scales, by products in separate factors, or by several products.

    Parameters
    ----------
    formula
        The formula.
    known
        Building blocks by name.
    scales
        The paper's dimensionless variables.
    share
        Error that its budget allows per sum of the condition numbers.

    Raises
    ------
    UnreachableError
        If no form is accurate; the message states the reason and a remedy.
    """
    if formula.expression.has(sp.Integral):
        raise UnreachableError(
            f"{formula.name}: expected a formula in closed form, got an integral, of which no code "
            "is generated; prove a closed form and generate that, or remove it from the module"
        )

    test = JointTest(formula)
    tested: list[ProductForm] = []
    accepted: list[tuple[ProductForm, Accuracy]] = []
    reasons: list[UnreachableError] = []

    def range_of(made: ProductForm, share: float) -> Accuracy:
        own = {block.name: block for block in made.blocks}
        return test.range_of(made.steps, made.value, {**known, **own}, TESTED[share])

    def passes(made: ProductForm, share: float) -> bool:
        failed: list[UnreachableError] = []
        with collected(failed):
            range_of(made, share)
        return not failed

    def add(made: ProductForm) -> tuple[Accuracy, float]:
        failed: list[UnreachableError] = []
        for form in dict.fromkeys((made, decaying_last(made))):
            tested.append(form)
            with collected(failed):
                accurate = range_of(form, share)
                accepted.append((form, accurate))
                return accurate, accurate.error
        raise failed[0]

    searches: tuple[Callable[[], object], ...] = (
        lambda: add(ProductForm(*automatic(formula.expression, known, scales))),
        lambda: of_products(formula, add),
        lambda: _first_accurate(several_products(formula), add, reasons),
    )
    for search in searches:
        with collected(reasons):
            search()
        if any(one.decades == DECADES[0] and one.whole <= ENOUGH for _, one in accepted):
            break
    if accepted:
        made, best = max(accepted, key=lambda row: (row[1].decades, -row[1].lost))
        return made, best.decades
    for larger in (other for other in SHARES if other > share):
        if any(passes(made, larger) for made in tested):
            raise UnreachableError(
                f"{formula.name} is accurate if an error of {larger:g} times the sum of the "
                "condition numbers is allowed, which matters next to its zeros: write a table "
                f"`[rule.zeros]` in budgets.toml with `share = {larger}` and "
                f'`kernels = ["{formula.name}"]`, or state a form in `stated`'
            )
    reason = min(reversed(reasons), key=lambda reason: reason.worst)
    remedy = "" if "state a form" in str(reason) else "; or state a form"
    raise UnreachableError(f"{formula.name}: {reason}{remedy} in `stated`") from None


def _first_accurate(
    forms: Iterator[ProductForm],
    add: Callable[[ProductForm], tuple[Accuracy, float]],
    reasons: list[UnreachableError],
) -> None:
    """Test forms until one is clearly accurate; reasons why others are not are collected.

    A form with larger errors that conditioning explains is accepted, but the search continues:
    another one may not have them.
    """
    for made in forms:
        with collected(reasons):
            if add(made)[0].whole <= CLEARLY:
                return
