"""A tested NumPy module for a formula of several variables, or with conditions on its variables."""

import textwrap
from collections.abc import Callable, Sequence
from functools import partial
from importlib.metadata import version

import numpy as np
import sympy as sp

from derivation.engine.emit.copies import function_text
from derivation.engine.emit.kernels import lines
from derivation.engine.emit.modules import Module, module_source
from derivation.engine.emit.package import RUNTIME, block_text
from derivation.engine.emit.printer import to_numpy
from derivation.engine.emit.source import format_files
from derivation.engine.emit.standalone import WIDTH, compiled_function
from derivation.engine.formula.domain import sides
from derivation.engine.formula.proof import ProofError
from derivation.engine.formula.vocabulary import Argument, Vocabulary
from derivation.engine.rewrite.accuracy_test import KNOWN
from derivation.engine.rewrite.form import Step, form
from derivation.engine.rewrite.identities import by_identities, prove_identity
from derivation.engine.rewrite.products import GivenFormula, ProductForm, of_products
from derivation.engine.rewrite.search import without_series
from derivation.engine.rewrite.several_products import several_products
from derivation.engine.rewrite.several_variables import (
    LARGEST_VALUE,
    LEAST_VALUE,
    MOST_CONDITIONING,
    STATED,
    SeveralCheck,
    check_several,
)
from derivation.engine.rewrite.terms import UnreachableError, collected
from derivation.engine.rewrite.useful_range import ENDS, ENOUGH

HELPERS = {
    "polynomial": ("polynomials.py",),
    "times": ("ranges.py",),
    "times_closely": ("ranges.py", "halves", "lost_by_halves"),
    "rounding_error": ("ranges.py", "halves", "lost_by_halves"),
}
"""File of each function that a form may call, and the functions that it calls itself."""
Tested = tuple[ProductForm, SeveralCheck]
WIDE = 1e30
"""Upper end of a range that is wide enough."""
RESERVED = {"np", *HELPERS, *(part for parts in HELPERS.values() for part in parts)}
"""Names that the module uses itself."""


def standalone_several(
    expression: sp.Expr, variables: Sequence[sp.Symbol], domain: Vocabulary | None = None
) -> tuple[ProductForm, str, SeveralCheck]:
    """Return the stable form, the source of a module with it as a function `f`, and its test.

    Parameters
    ----------
    expression
        The formula.
    variables
        Its variables, in the order of the function's arguments.
    domain
        The variables with the conditions on them; by default all are positive.

    Raises
    ------
    UnreachableError
        If a factor depends on several products of the variables, or no accurate form is found.
    """
    names = {str(variable) for variable in variables}
    positive = Vocabulary(tuple(Argument(v, "1", str(v), "", (f"{v} > 0",)) for v in variables))
    conditions = _conditions(domain)
    within = _compared(variables, conditions)

    def accepted(share: float, made: ProductForm) -> Tested:
        if taken := names & (RESERVED | {str(step.symbol) for step in made.steps}):
            raise UnreachableError(
                f"expected a variable with another name than {min(taken)}, which the generated "
                "code uses; rename it"
            )
        _prove_equal(expression, made)
        code = compiled_function(_source(expression, variables, made, *ENDS, "", conditions))
        return made, check_several(expression, variables, code, share, domain, within)

    best, tested = _best(expression, domain or positive, accepted)
    where = ", ".join(f"{name} = {x!r}" for name, x in tested.at.items())
    statement = (
        f"Error at most {tested.limit:g} ULP plus {tested.share} times the sum of the condition "
        f"numbers, for values of magnitudes from {LEAST_VALUE:g} to {LARGEST_VALUE:g} and sums of "
        f"condition numbers up to {MOST_CONDITIONING:g}. Tested, not proved: with NumPy "
        f"{np.__version__} against exact values at {tested.points} points, including the ends of "
        "the range and points at which variables are nearly equal; largest error "
        f"{tested.worst:.2f} ULP, at {where}."
    )
    ends = tested.low, tested.high
    source = _source(expression, variables, best, *ends, statement, conditions)
    return best, format_files({"f.py": source})["f.py"], tested


def _conditions(domain: Vocabulary | None) -> tuple[tuple[str, str], ...]:
    """Return each condition as text and as NumPy code."""
    stated = [c for argument in domain.arguments for c in argument.domain] if domain else []
    both = [sides(condition) for condition in dict.fromkeys(stated)]
    return tuple(
        (f"{left} {sign} {right}", f"({to_numpy(left)} {sign} {to_numpy(right)})")
        for left, sign, right in both
    )


def _compared(
    variables: Sequence[sp.Symbol], conditions: Sequence[tuple[str, str]]
) -> Callable[..., bool]:
    """Return the function that compares the conditions as the generated code does."""
    compared = " & ".join(code for _, code in conditions) or "True"
    names: dict[str, Callable[..., bool]] = {}
    exec(f"def within({', '.join(map(str, variables))}): return {compared}", {"np": np}, names)
    return names["within"]


def _best(
    expression: sp.Expr, words: Vocabulary, accepted: Callable[[float, ProductForm], Tested]
) -> Tested:
    """Return the formula unchanged, by identities, or in a form by products of the variables.

    The result is the first one that is accurate in a wide range, else the one with the widest.

    Raises
    ------
    UnreachableError
        If none is accurate; the message is that for the most accurate one.
    """
    reasons: list[UnreachableError] = []
    for share in STATED:
        with collected(reasons):
            return _best_for(expression, words, partial(accepted, share), reasons)
    raise min(reasons, key=lambda reason: reason.worst)


def _best_for(
    expression: sp.Expr,
    words: Vocabulary,
    accepted: Callable[[ProductForm], Tested],
    reasons: list[UnreachableError],
) -> Tested:
    """Return the best form as `_best`, for one stated share; reasons of others are collected."""
    results: list[Tested] = []
    known = {f.func.__name__ for f in expression.atoms(sp.Function)} <= KNOWN
    plain = (expression, sp.factor(expression), *by_identities(expression)) if known else ()
    forms = [ProductForm((), value) for value in dict.fromkeys(plain)]
    with collected(reasons):
        forms += _with_parameters(expression)
    for made in forms:
        with collected(reasons):
            results.append(accepted(made))
            if _is_wide(results[-1][1]):
                return results[-1]

    def add(made: ProductForm) -> tuple[Tested, float]:
        results.append(accepted(made))
        return results[-1], results[-1][1].worst

    given = GivenFormula("f", expression, words)
    with collected(reasons):
        of_products(given, add)
    if not any(_is_wide(check) for _, check in results):
        with collected(reasons):
            for made in several_products(given):
                with collected(reasons):
                    if _is_wide(add(made)[0][1]):
                        break
    if not results:
        raise min(reasons, key=lambda reason: reason.worst)
    return max(results, key=lambda result: (result[1].high, -result[1].worst))


def _is_wide(check: SeveralCheck) -> bool:
    """Return whether code is so accurate in such a wide range that no other form is tried."""
    return check.high >= WIDE and check.worst <= ENOUGH / 2


def _with_parameters(expression: sp.Expr) -> list[ProductForm]:
    """Return the form of a formula whose functions depend on one product; others are parameters."""
    functions = expression.atoms(sp.exp, sp.sin, sp.cos, sp.sinh, sp.cosh, sp.tanh, sp.coth, sp.log)
    products = {function.args[0].as_coeff_Mul()[1] for function in functions}
    if len(products) != 1:
        return []
    (product,) = products
    linear = [symbol for symbol, power in product.as_powers_dict().items() if power == 1]
    if not product.is_Symbol and not (linear and all(s.is_Symbol for s in linear)):
        return []
    x = product if product.is_Symbol else sp.Symbol(_PRODUCT, positive=True)
    reduced = expression if x == product else expression.subs(linear[0], x * linear[0] / product)
    stable = without_series(reduced, x, ENDS)  # its error depends on the parameters
    first = () if x == product else (Step(x, product),)
    return [ProductForm((*first, *stable.steps), stable.value)]


_PRODUCT = "product_of_variables"


def _prove_equal(expression: sp.Expr, made: ProductForm) -> None:
    """Reject a form that is not proved equal to the formula."""
    if made.value == expression:
        return
    if isinstance(made.value, sp.Expr) and not made.steps and made.value.has(sp.Min, sp.Max):
        prove_identity(made.value, expression)
        return
    try:
        form("f", "f", expression, made.steps, made.value, {}, made.blocks)
    except ProofError as error:
        raise UnreachableError(f"no form of {expression} could be proved: {error}") from None


def _source(
    expression: sp.Expr,
    variables: Sequence[sp.Symbol],
    form: ProductForm,
    low: float,
    high: float,
    statement: str,
    conditions: Sequence[tuple[str, str]],
) -> str:
    blocks = [block_text(block) for block in form.blocks]
    rows, value = lines(form.steps), to_numpy(form.value)
    used = repr((blocks, rows, value))
    parts = dict.fromkeys(
        (file, part)
        for name, (file, *parts) in HELPERS.items()
        if f"{name}(" in used
        for part in (*parts, name)
    )
    helpers = [
        function_text(RUNTIME / file, part).replace("Double", "np.ndarray") for file, part in parts
    ]
    context = {
        "summary": f"Stable form of a formula, by platecontact {version('platecontact')}.",
        "header": f"# Generated by platecontact with SymPy {sp.__version__}.",
        "helpers": helpers,
        "blocks": blocks,
        "variables": [str(variable) for variable in variables],
        "formula": sp.sstr(expression),
        "low": repr(low),
        "high": repr(high),
        "conditions": [text for text, _ in conditions],
        "inside": " & ".join(code for _, code in conditions),
        "statement": textwrap.wrap(statement, WIDTH),
        "steps": rows,
        "value": value,
    }
    return module_source(Module("f", "several", context))
