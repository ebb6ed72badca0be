"""Values of a varied key that are given in Python or in a table, and checks of them."""

from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np

from derivation.engine.printable import one_line
from derivation.scene.errors import SceneError
from derivation.scene.sweep import Values

Given = TypeVar("Given", bound=Values)


def names_among(key: str, values: Any) -> tuple[str, ...]:
    """Return the names of a key `table.key` from a list or an array; true and false are names too.

    Raises
    ------
    SceneError
        If they are not names.
    """
    names = () if isinstance(values, str) else tuple(np.atleast_1d(np.asarray(values, object)))
    texts = tuple(str(name).lower() if isinstance(name, bool) else name for name in names)
    if not texts or not all(isinstance(text, str) for text in texts):
        raise SceneError(
            f"{key}: expected names, got {one_line(repr(values))}; give a list such as "
            '["glass", "steel"]'
        )
    return tuple(map(str, texts))


def numbers_among(key: str, values: Any) -> tuple[float, ...]:
    """Return the numbers of a key `table.key` from a number, a list or an array.

    Raises
    ------
    SceneError
        If they are not finite numbers, or some of them are masked.
    """
    remedy = (
        "give sample=N"
        if isinstance(values, Mapping)
        else "give a list such as [1e-3, 2e-3], or of names only"
    )
    error = SceneError(
        f"{key}: expected finite numbers, at least one, got {one_line(repr(values))}; {remedy}"
    )
    try:
        given = np.asarray(values)
        if given.dtype.kind in "bmM" or np.ma.is_masked(values):
            raise error
        numbers = np.atleast_1d(np.asarray(given, dtype=np.float64))
    except (TypeError, ValueError, OverflowError):
        raise error from None
    if numbers.ndim != 1 or not numbers.size or not np.isfinite(numbers).all():
        raise error
    return tuple(numbers.tolist())


def different(key: str, values: Given) -> Given:
    """Return values if none of them is given twice.

    Raises
    ------
    SceneError
        If one is given twice.
    """
    if len(set(values)) < len(values):
        raise SceneError(f"{key}: expected different values, got one twice; remove one")
    return values
