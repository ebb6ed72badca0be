"""platecontact: derive, correct and stabilise the contact law of a sphere on a plate.

    >>> from derivation import formula, diagnose
    >>> formula("G").unit
    '1'

Importing this package alone loads neither SymPy nor anything else that is slow.
"""

import os
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from derivation.engine.errata.text import TextDiagnosis
    from derivation.engine.formula.record import Record

# python-flint would silently become SymPy's ground types and change printed forms.
os.environ["SYMPY_GROUND_TYPES"] = "python"


def formula(name: str) -> "Record":
    """Return a derived formula with its proof; a notebook displays it as LaTeX.

    Parameters
    ----------
    name
        Name of the formula, as `platecontact derive` lists it.

    Returns
    -------
    Record
        The formula, with its expression, unit, meaning and proof.

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
    from derivation.engine.nearest import did_you_mean
    from derivation.plate import derived

    known = derived.formulas()
    if name not in known:
        near = did_you_mean(name, known, most=3)
        raise KeyError(f"no formula {name!r}: {near}expected one of {', '.join(known)}")
    return known[name]


def diagnose(
    name: str, text: str, latex: bool = False, at: str = "", digits: int = 50
) -> "TextDiagnosis":
    """Compare a formula of your own with the derived one of that name.

    For a sum over the modes, one term is compared.

    Parameters
    ----------
    name
        Name of the derived formula, such as ``K_j``.
    text
        Your formula; it is parsed, not executed.
    latex
        Whether `text` is LaTeX instead of SymPy syntax.
    at
        Point at which both are evaluated, in SI units, such as ``phi=2.5,h=0.1``; each decimal
        number is used exactly. Symbols that are not given have default values.
    digits
        Number of significant digits of both values, 1 to 1000.

    Returns
    -------
    TextDiagnosis
        The verdict ("equal" or "different"), the misprint that explains a difference, and the
        values.

    Raises
    ------
    ValueError
        If the name, formula, point or number of digits is invalid, or the comparison exceeds its
        limit of time or memory.

    Examples
    --------
    >>> import platecontact as pc
    >>> pc.diagnose("G", "1 + 4*T*exp(-2*T)").verdict
    'different'
    """
    from derivation.plate import derived

    return derived.diagnose(name, text, latex, at, digits)
