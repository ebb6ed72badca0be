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

    Parameters
    ----------
    name
        For instance ``K_j``.
    text
        The formula in SymPy syntax, or in LaTeX if `latex`; nothing in it is executed.
    at
        Point to evaluate both at, like ``phi=2.5,h=0.1``; exact decimals.
    digits
        Digits of both values.

    Raises
    ------
    ValueError
        For a name, formula or point that cannot be used.
    """
    from derivation.plate import derived

    return derived.diagnose(name, text, latex, at, digits)
