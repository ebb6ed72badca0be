"""Derived formulas, misprints of the paper, and stable code for your own formula."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

from derivation.engine.emit import own_formula
from derivation.engine.errata.findings import Finding
from derivation.engine.formula.notation import to_plain
from derivation.engine.formula.record import Record
from derivation.engine.rewrite.code_check import CodeCheck
from derivation.engine.rewrite.products import ProductForm
from derivation.engine.rewrite.several_variables import SeveralCheck
from derivation.engine.rewrite.stabilise import Stable
from derivation.plate import derived
from derivation.scene.output.html import html_table

if TYPE_CHECKING:
    import sympy as sp


@dataclass(frozen=True)
class Rewritten:
    """A numerically stable form of a formula.

    Parameters
    ----------
    form
        The form, equal to the formula except for the truncation error of its series, with the
        applied rules.
    source
        Source of a module with one function that evaluates it; it imports only NumPy.
    tested
        The range in which the function was tested, and the largest error found [ULP].
    """

    form: Stable | ProductForm
    source: str
    tested: CodeCheck | SeveralCheck

    def __str__(self) -> str:
        return self.source

    def _repr_html_(self) -> str:
        """Return the source for a notebook."""
        return f"<pre>{escape(self.source)}</pre>"


class Findings(tuple[Finding, ...]):
    """Comparisons of the published formulas with the derived ones, in the order of the paper."""

    __slots__ = ()

    def __str__(self) -> str:
        """Return a line for each formula."""
        return "\n".join(map(str, self))

    def _repr_html_(self) -> str:
        """Return the comparisons as a table for a notebook."""
        rows = ((x.printed.equation, x.printed.name, x.kind, to_plain(x.repair)) for x in self)
        return html_table(("equation", "formula", "finding", "fix"), rows)


def formulas() -> dict[str, Record]:
    """Return all derived formulas by name, each with its unit and proof.

    Returns
    -------
    dict of str to derivation.engine.formula.record.Record
        The formulas in the order of the derivation.

    Examples
    --------
    >>> import platecontact as pc
    >>> pc.formulas()["P"].unit
    'N'
    """
    return derived.formulas()


def misprints() -> Findings:
    """Return the comparison of each published formula with the derived one, misprint or not.

    Returns
    -------
    Findings
        A tuple with one `derivation.engine.errata.findings.Finding` for each published formula, in
        the order of the paper; `kind` is "correct as published" or names the misprint, `repair` is
        the correction.

    Examples
    --------
    >>> import platecontact as pc
    >>> sum(finding.kind == "correct as published" for finding in pc.misprints()) > 0
    True
    """
    return Findings(derived.misprints())


def rewrite(
    formula: "str | sp.Expr", variable: str = "x", where: str | Sequence[str] = ()
) -> Rewritten:
    """Find a numerically stable form of a formula, and test its code.

    The function returns NaN outside the range in which it was tested. Points at which the formula
    is ill-conditioned, or its code would overflow, may be excluded from the range.

    Parameters
    ----------
    formula
        The formula in SymPy syntax, which is parsed, not executed; or a SymPy expression, whose
        assumptions are ignored. Each factor of a formula of several variables must depend on one
        product of powers of them, such as ``a/b``.
    variable
        Name of the variable of a formula that contains none.
    where
        Condition or conditions on the variables, such as ``"-1 < nu < 0.5"``. All variables are
        positive unless a condition allows other numbers.

    Returns
    -------
    Rewritten
        The stable form, its source code and the test result.

    Raises
    ------
    ValueError
        If the formula cannot be read, no form accurate to 8 ULP is found, or the search needs too
        much time or memory.

    Examples
    --------
    >>> import platecontact as pc
    >>> stable = pc.rewrite("(x - sin(x))/x**3")
    >>> stable.tested.limit < 8
    True
    >>> "R" in pc.rewrite("R - sqrt(R**2 - a**2)").source
    True
    """
    conditions = (where,) if isinstance(where, str) else where
    return Rewritten(*own_formula.rewrite_text(str(formula), variable, conditions))
