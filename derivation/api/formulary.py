"""Derived formulas, the paper's misprints, and stable code for a formula of your own."""

from dataclasses import dataclass

from derivation import pipeline
from derivation.engine.errata.findings import Finding
from derivation.engine.formula.record import Record
from derivation.engine.rewrite.stabilise import Stable
from derivation.engine.rewrite.tested import CodeCheck
from derivation.plate import derived


@dataclass(frozen=True)
class Rewritten:
    """A numerically stable form of a formula.

    Parameters
    ----------
    form
        The form, proved equal to the formula, with the rules that were applied.
    source
        A module with one function that evaluates it; it imports NumPy alone.
    tested
        The range in which the function was tested, and the error found there.
    """

    form: Stable
    source: str
    tested: CodeCheck

    def __str__(self) -> str:
        return self.source


def formulas() -> dict[str, Record]:
    """Return every derived formula by name, each with its proof.

    Examples
    --------
    >>> import platecontact as pc
    >>> pc.formulas()["P"].unit
    'N'
    """
    return derived.formulas()


def misprints() -> tuple[Finding, ...]:
    """Return each printed formula of the paper with what it turns out to be.

    Examples
    --------
    >>> import platecontact as pc
    >>> sum(finding.kind == "correct as published" for finding in pc.misprints()) > 0
    True
    """
    return derived.misprints()


def rewrite(formula: str, variable: str = "x") -> Rewritten:
    """Find a numerically stable form of a formula of one variable, and test it.

    Parameters
    ----------
    formula
        The formula in SymPy syntax; nothing in it is executed.
    variable
        Its variable, a positive real number.

    Raises
    ------
    ValueError
        If the formula cannot be read, no rule applies to it, or it takes too much time or memory.

    Examples
    --------
    >>> import platecontact as pc
    >>> found = pc.rewrite("(x - sin(x))/x**3")
    >>> found.tested.limit < 8
    True
    """
    return Rewritten(*pipeline.rewritten(formula, variable))
