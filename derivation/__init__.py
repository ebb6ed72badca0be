"""platecontact: derive, correct and stabilise the contact law of a sphere on a plate.

    >>> from derivation import formula, diagnose
    >>> formula("G").unit
    '1'

Importing this package alone loads neither SymPy nor anything else that is slow.
"""

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import sympy as sp

    from derivation.engine.errata.text import TextDiagnosis
    from derivation.engine.formula.record import Record

# python-flint would silently become SymPy's ground types and change printed forms.
os.environ["SYMPY_GROUND_TYPES"] = "python"
# SymPy keeps 1000 results per function; derivation and generation are an eighth faster with all.
os.environ.setdefault("SYMPY_CACHE_SIZE", "None")


def formula(name: str) -> "Record":
    """Return a derived formula with its proof; a notebook displays it as LaTeX.

    Parameters
    ----------
    name
        Name of the formula, as `platecontact derive` lists it.

    Returns
    -------
    derivation.engine.formula.record.Record
        The formula with its unit, meaning and proof.

    Raises
    ------
    KeyError
        If no formula has that name; the message suggests the nearest names.

    Examples
    --------
    >>> import platecontact as pc
    >>> pc.formula("K_j").unit
    'm'
    """
    from derivation.engine.nearest import did_you_mean, one_of
    from derivation.plate import derived

    known = derived.formulas()
    if name not in known:
        suggestion = did_you_mean(str(name), known, most=3)
        raise KeyError(f"no formula {name!r}: {suggestion}expected one of {one_of(known)}")
    return known[name]


def diagnose(
    name: str,
    text: "str | sp.Expr",
    latex: bool = False,
    at: "str | Mapping[str, object]" = "",
    digits: int = 50,
) -> "TextDiagnosis":
    """Compare a formula of your own with the derived one of the same name.

    Parameters
    ----------
    name
        Name of the derived formula, for example ``K_j``.
    text
        Your formula in SymPy syntax, which is parsed, not executed; or a SymPy expression. For a
        sum over modes, give one term or ``Sum(..., (j, 1, oo))``.
    latex
        Whether `text` is LaTeX instead of SymPy syntax.
    at
        Point at which both are evaluated, in SI units, like ``phi=2.5,h=0.1`` or
        ``{"phi": 2.5, "h": 0.1}``; the decimals are taken as exact. Symbols that are not given have
        default values.
    digits
        Number of significant digits of both values, from 1 to 1000.

    Returns
    -------
    derivation.engine.errata.text.TextDiagnosis
        Whether the formulas are equal, how to correct yours, and both values at the point.

    Raises
    ------
    ValueError
        If the name, formula, point or number of digits is invalid, or the comparison exceeds its
        limit of time or memory.

    Examples
    --------
    >>> import platecontact as pc
    >>> diagnosis = pc.diagnose("P", "16*mu*(lam + mu)*a**2/(3*R*(lam + 2*mu))")
    >>> diagnosis.verdict
    'different'
    >>> diagnosis.repair
    'read a**3 instead of a**2'
    """
    from derivation.plate import derived

    return derived.diagnose(str(name), str(text), latex, at, digits)
