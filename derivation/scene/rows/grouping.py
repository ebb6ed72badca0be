"""Groups of almost equal scenes, for which one scene can decide the selection."""

import math
from dataclasses import fields
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene.model import Model

WIDTHS = 0.04, 0.08, 0.16
"""Sums of the differences of the logarithms of the numbers within a group; the first sum that gives
few groups is used."""
POWER = 17.0
"""Power of a number with which bounds may grow. If two bounds of a scene differ by more than a
factor of exp(POWER width), the same one is larger in the whole group."""
SHARE = 0.25
"""Largest number of groups, over that of the scenes, for which groups save time."""
Rows = NDArray[np.intp]


class Groups(NamedTuple):
    """The first scene of each group, the group of each scene, and the factor between clear bounds.

    If two bounds of one scene differ by more than `clear`, the same one is larger in its group.
    """

    first: Rows
    group: Rows
    clear: float


def groups_of(model: Model, count: int) -> Groups | None:
    """Return groups of almost equal scenes.

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
    if not all(values.min() > 0.0 for values in varied):
        return None
    logs = [np.log(values[:, 0]) for values in varied]
    for width in WIDTHS:
        key, cells = np.zeros(count, dtype=np.int64), 1
        for values in logs:
            places = np.floor(values * (len(logs) / width))
            places -= places.min()
            number = int(places.max()) + 1
            cells *= number
            key = key * number + places.astype(np.int64)
        if cells > np.iinfo(np.int64).max:
            continue
        _, first, group = np.unique(key, return_index=True, return_inverse=True)
        if len(first) <= SHARE * count:
            return Groups(first, group, math.exp(POWER * width))
    return None
