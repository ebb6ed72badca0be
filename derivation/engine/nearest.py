"""The known names nearest to an unknown one, which an error message suggests."""

from collections.abc import Iterable
from difflib import get_close_matches

LONGEST = 40
"""Number of letters of a name that are compared."""
ALIKE = 0.5
"""Similarity, from 0 to 1, from which a name is suggested."""


def nearest(name: str, known: Iterable[str], alike: float = ALIKE, most: int = 1) -> list[str]:
    """Return the known names most similar to a name, the most similar first.

    Upper and lower case, hyphens, spaces and underscores do not matter.

    Parameters
    ----------
    name
        The unknown name.
    known
        The known names.
    alike
        Least similarity, from 0 to 1.
    most
        Largest number of names.

    Examples
    --------
    >>> nearest("Radius_m", ["thickness", "radius"])
    ['radius']
    """
    plain: dict[str, str] = {}
    for other in known:
        plain.setdefault(_plain(other), other)
    return [plain[other] for other in get_close_matches(_plain(name), plain, most, alike)]


def did_you_mean(name: str, known: Iterable[str], alike: float = ALIKE, most: int = 1) -> str:
    """Return a question that suggests the nearest names, with a space after it; empty if none.

    The parameters are those of `nearest`.

    Examples
    --------
    >>> did_you_mean("stel", ["steel", "glass"])
    'did you mean steel? '
    """
    found = nearest(name, known, alike, most)
    return f"did you mean {' or '.join(found)}? " if found else ""


def _plain(name: str) -> str:
    """Return a name for comparison."""
    return name[:LONGEST].lower().replace("-", "_").replace(" ", "_")
