"""Points of broadcast arrays, raveled and cut into blocks.

Arithmetic: none.
"""

import numpy as np

from generated.arrays import Double


def index_of(owner: np.ndarray, shape: tuple[int, ...]) -> np.ndarray | None:
    """Each point's plate; None if there is but one."""
    return None if owner.size == 1 else np.ravel(np.broadcast_to(owner, shape))


def cut_index(index: np.ndarray | None, part: slice) -> np.ndarray | None:
    """A part of the points' plates."""
    return None if index is None else index[part]


def flat(x: Double, shape: tuple[int, ...]) -> Double:
    """x broadcast and raveled; a single value stays one, of shape (1,)."""
    if x.size == 1 and np.prod(shape) != 1:
        return np.broadcast_to(x.reshape(1), (int(np.prod(shape)),))
    return np.ravel(np.broadcast_to(x, shape))


def cut(x: Double, part: slice) -> Double:
    """A part of a raveled array; a single value repeated comes as a scalar."""
    found: Double = x[0] if x.size and x.strides[0] == 0 else x[part]
    return found


def pieces(arguments: list[Double], shape: tuple[int, ...], part: slice) -> list[Double]:
    """Parts of arguments broadcast to a shape and raveled; as they are if the part is the whole.

    Single values stay single, and no argument is broadcast as a whole.
    """
    if part.start == 0 and part.stop >= np.prod(shape):
        return arguments
    return [
        x.reshape(()) if x.size == 1 else np.broadcast_to(x, shape).flat[part] for x in arguments
    ]
