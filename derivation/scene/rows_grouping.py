"""Groups of almost equal scenes, for which one of them can decide."""

from dataclasses import fields

import numpy as np
from numpy.typing import NDArray

from derivation.scene.model import Model

WIDTH = 0.04
"""Largest sum of the differences of the logarithms of the numbers within a group."""
CLEAR = 2.0
"""Ratio of two bounds in one scene above which the same one is larger in the whole group. A bound
would have to grow with a power above log(CLEAR)/WIDTH = 17 of a number to contradict this."""
SHARE = 0.25
"""Largest number of groups, over that of the scenes, for which groups save time."""
Rows = NDArray[np.intp]


def groups_of(model: Model, count: int) -> tuple[Rows, Rows] | None:
    """Return the first scene of each group and the group of each scene.

    The result is None if there are too many groups to save time, or if a number is not positive.

    Parameters
    ----------
    model
        Numbers of the scenes, as columns.
    count
        Number of scenes.
    """
    columns = (getattr(model, field.name) for field in fields(model))
    varied = [x for x in columns if isinstance(x, np.ndarray) and x.min() < x.max()]
    key, cells = np.zeros(count, dtype=np.int64), 1
    for values in varied:
        if not values.min() > 0.0:
            return None
        places = np.floor(np.log(values[:, 0]) * (len(varied) / WIDTH))
        places -= places.min()
        cells *= (number := int(places.max()) + 1)
        if cells > np.iinfo(np.int64).max:
            return None
        key = key * number + places.astype(np.int64)
    _, first, group = np.unique(key, return_index=True, return_inverse=True)
    return (first, group) if len(first) <= SHARE * count else None
