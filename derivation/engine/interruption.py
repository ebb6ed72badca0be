"""Ctrl-C within a function of Arb, which reports it as an error of its own."""

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def interruptions() -> Iterator[None]:
    """Raise `KeyboardInterrupt` for an error that Ctrl-C caused, such as in an integrand of Arb."""
    try:
        yield
    except SystemError as error:
        cause: BaseException | None = error
        while isinstance(cause, SystemError):
            cause = cause.__cause__
        if isinstance(cause, KeyboardInterrupt):
            raise KeyboardInterrupt from None
        raise
