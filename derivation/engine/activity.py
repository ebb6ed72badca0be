"""Progress of a long computation, reported to listeners; by default there are none."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

Progress = Callable[[str, int, int], None]
"""Function that receives the name of a part of the work, its number, and the number of parts."""
_listeners: list[Callable[[str], None]] = []


def quiet(*_: object) -> None:
    """Ignore a progress report."""


def announce(text: str) -> None:
    """Pass a description of the current computation to all listeners."""
    for listener in _listeners:
        listener(text)


@contextmanager
def listening(listener: Callable[[str], None]) -> Iterator[None]:
    """Call a listener for each description that is announced in the block."""
    _listeners.append(listener)
    try:
        yield
    finally:
        _listeners.remove(listener)
