"""Tells whoever listens what a long computation is doing; by default nobody does."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

Tell = Callable[[str, int, int], None]
"""Is told of a part of the work, its number, and how many parts there are."""
_listeners: list[Callable[[str], None]] = []


def quiet(*_: object) -> None:
    """Tell nobody."""


def tell(text: str) -> None:
    """Say what is being computed."""
    for listener in _listeners:
        listener(text)


@contextmanager
def heard(listener: Callable[[str], None]) -> Iterator[None]:
    """Pass on what is told while the block runs."""
    _listeners.append(listener)
    try:
        yield
    finally:
        _listeners.remove(listener)
