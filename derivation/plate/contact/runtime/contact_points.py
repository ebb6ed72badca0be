"""Points of broadcast arrays, flattened and split into blocks.

Arithmetic: none.
"""

import numpy as np

from generated.arrays import Double


def index_of(owner: np.ndarray, shape: tuple[int, ...]) -> np.ndarray | None:
    """Return the plate index of each point, or None if there is only one plate."""
    return None if owner.size == 1 else np.ravel(np.broadcast_to(owner, shape))


def cut_index(index: np.ndarray | None, part: slice) -> np.ndarray | None:
    """Return a part of the points' plate indices."""
    return None if index is None else index[part]


def flat(x: Double, shape: tuple[int, ...]) -> Double:
    """Return x, broadcast and flattened; without a copy if x is a single value."""
    if x.size == 1 and np.prod(shape) != 1:
        return np.broadcast_to(x.reshape(1), (int(np.prod(shape)),))
    return np.ravel(np.broadcast_to(x, shape))


def cut(x: Double, part: slice) -> Double:
    """Return a part of a flattened array; a repeated single value is returned as a scalar."""
    values: Double = x[0] if x.size and x.strides[0] == 0 else x[part]
    return values


def pieces(arguments: list[Double], shape: tuple[int, ...], part: slice) -> list[Double]:
    """Return parts of flattened, broadcast arguments; the arguments themselves for a single part.

    Single values stay scalars, so that no complete argument is broadcast.
    """
    if part.start == 0 and part.stop >= np.prod(shape):
        return arguments
    return [
        x.reshape(()) if x.size == 1 else np.broadcast_to(x, shape).flat[part] for x in arguments
    ]
