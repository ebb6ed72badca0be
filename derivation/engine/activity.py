"""Progress of a long computation, reported to a listener; by default there is none."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

Progress = Callable[[str, int, int], None]
"""Function that receives the name of a part of the work, its number, and the number of parts."""
_listeners: list[Callable[[str], None]] = []


def quiet(*_: object) -> None:
    """Report nothing."""


def announce(text: str) -> None:
    """Report what is being computed."""
    for listener in _listeners:
        listener(text)


@contextmanager
def heard(listener: Callable[[str], None]) -> Iterator[None]:
    """Report to a listener while the block runs."""
    _listeners.append(listener)
    try:
        yield
    finally:
        _listeners.remove(listener)
