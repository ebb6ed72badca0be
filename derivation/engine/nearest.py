"""The known names nearest to an unknown one, which an error message suggests."""

import re
from collections.abc import Iterable
from difflib import get_close_matches

LONGEST = 40
"""Number of letters of a name that are compared."""
SIMILARITY = 0.5
"""Similarity, from 0 to 1, from which a name is suggested."""
LETTERS = 3
"""One letter in so many may be wrong, or one in a shorter name."""


def nearest(name: str, known: Iterable[str], alike: float = SIMILARITY, most: int = 1) -> list[str]:
    """Return the known names most similar to a name, the most similar first.

    A name is similar if few letters differ, or if one name begins with the other or consists of
    words of the other. Upper and lower case, hyphens, spaces and underscores do not matter.

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
    plain_name = _plain(name)
    alike_ones = get_close_matches(plain_name, plain, max(len(plain), 1), alike)
    return [plain[other] for other in alike_ones if _near(plain_name, other)][:most]


def did_you_mean(name: str, known: Iterable[str], alike: float = SIMILARITY, most: int = 1) -> str:
    """Return a question that suggests the nearest names, with a space after it; empty if none.

    The parameters are those of `nearest`.

    Examples
    --------
    >>> did_you_mean("stel", ["steel", "glass"])
    'did you mean steel? '
    """
    names = nearest(name, known, alike, most)
    return f"did you mean {' or '.join(names)}? " if names else ""


def _near(one: str, other: str) -> bool:
    """Return whether two names are similar in more than some letters in common."""
    long, short = sorted((one, other), key=len, reverse=True)
    words = set(re.split(r"[_.]", short)), set(re.split(r"[_.]", long))
    if long.startswith(short) or words[0] <= words[1]:
        return True
    return _differences(one, other) <= max(1, len(long) // LETTERS)


def _differences(one: str, other: str) -> int:
    """Return the number of letters to insert, remove, replace or swap with their neighbour."""
    before: list[int] = []
    row = list(range(len(other) + 1))
    for i, letter in enumerate(one, start=1):
        further, before, row = before, row, [i]
        for j, target in enumerate(other, start=1):
            least = min(before[j] + 1, row[-1] + 1, before[j - 1] + (letter != target))
            if further and j > 1 and one[i - 2 : i] == target + other[j - 2]:
                least = min(least, further[j - 2] + 1)
            row.append(least)
    return row[-1]


def _plain(name: str) -> str:
    """Return a name for comparison."""
    return name[:LONGEST].lower().replace("-", "_").replace(" ", "_")
