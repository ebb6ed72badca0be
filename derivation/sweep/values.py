"""Values of a varied key that are given in Python or in a table, and checks of them."""

from typing import Any, TypeVar

import numpy as np

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
            f'{key}: expected names, got {values!r:.60}; give a list such as ["glass", "steel"]'
        )
    return tuple(map(str, texts))


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
