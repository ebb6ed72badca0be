"""Computation in a separate process, with limits of time and memory."""

import contextlib
import faulthandler
import os
import pickle
import select
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn, TypeVar

Value = TypeVar("Value")

SECONDS = 15
"""Processor time [s] allowed for comparing a formula."""
MEGABYTES = 1000
"""Memory [MB] allowed in addition to the memory that the program already uses."""
PATIENCE = 6
"""Elapsed time over the limit of processor time after which a process is ended."""
_CHUNK = 1 << 16


class LimitError(ValueError):
    """A computation reached a limit of time, memory or recursion; the message states a remedy."""


def bounded(
    work: Callable[[], Value], what: str, seconds: int = SECONDS, megabytes: int = MEGABYTES
) -> Value:
    """Return the result of a function that runs in a separate process; its exceptions are raised.

    If the system cannot fork, the function runs in this process without limits.

    Parameters
    ----------
    work
        Function without arguments; its result must be picklable.
    what
        Description of the work for the message, such as ``comparing the formulas``.
    seconds, megabytes
        Limits of processor time [s] and additional memory [MB].

    Raises
    ------
    LimitError
        If a limit is reached, or the recursion is too deep.
    """
    if not hasattr(os, "fork"):
        return work()
    reader, writer = os.pipe()
    sys.stdout.flush()
    sys.stderr.flush()
    child = os.fork()
    if child == 0:
        os.close(reader)
        _work(work, writer, seconds, megabytes)
    os.close(writer)
    status = None
    try:
        answer = _read(reader, seconds * PATIENCE)
        if answer is not None:
            _, status = os.waitpid(child, 0)
    finally:
        os.close(reader)
        if status is None:
            with contextlib.suppress(ProcessLookupError):
                os.kill(child, signal.SIGKILL)
            _, status = os.waitpid(child, 0)
    late = answer is None or (
        os.WIFSIGNALED(status) and os.WTERMSIG(status) in (signal.SIGXCPU, signal.SIGKILL)
    )
    if late:
        raise LimitError(f"{what} takes more than {seconds} s: simplify or shorten the formula")
    if not answer or os.WIFSIGNALED(status):
        raise LimitError(_too_large(what, megabytes))
    kind, value = pickle.loads(answer)
    if kind == "memory":
        raise LimitError(_too_large(what, megabytes))
    if kind == "depth":
        raise LimitError(f"{what} needs too deep a recursion: nest the formula less deeply")
    if kind == "error":
        raise value
    return value  # type: ignore[no-any-return]


def _too_large(what: str, megabytes: int) -> str:
    return f"{what} takes more than {megabytes} MB of memory: simplify or shorten the formula"


def _read(reader: int, seconds: float) -> bytes | None:
    """Return everything that the child writes until it closes its end; None after a timeout."""
    end = time.monotonic() + seconds
    parts: list[bytes] = []
    while True:
        ready, _, _ = select.select([reader], [], [], max(end - time.monotonic(), 0.0))
        if not ready:
            return None
        part = os.read(reader, _CHUNK)
        if not part:
            return b"".join(parts)
        parts.append(part)


def _work(work: Callable[[], Any], writer: int, seconds: int, megabytes: int) -> NoReturn:
    """Do the work in the child, write the pickled result, and exit without clean-up."""
    try:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        faulthandler.disable()  # a library that runs out of memory may abort
        _limit(seconds, megabytes)
        outcome = _outcome(work)
        with os.fdopen(writer, "wb") as stream:
            stream.write(outcome)
    finally:
        os._exit(0)


def _outcome(work: Callable[[], Any]) -> bytes:
    try:
        return pickle.dumps(("value", work()))
    except MemoryError:
        return pickle.dumps(("memory", None))
    except RecursionError:
        return pickle.dumps(("depth", None))
    except Exception as error:
        return pickle.dumps(("error", error))


def _limit(seconds: int, megabytes: int) -> None:
    """Set the limits of this process, as far as the system supports them."""
    import resource  # not available on all systems

    held = 0
    with contextlib.suppress(OSError):
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        held = pages * resource.getpagesize()
    limits = {
        resource.RLIMIT_CPU: seconds,
        resource.RLIMIT_AS: held + megabytes * 1_000_000,
        resource.RLIMIT_CORE: 0,
    }
    for kind, most in limits.items():
        with contextlib.suppress(ValueError, OSError):
            _, hard = resource.getrlimit(kind)
            within = most if hard == resource.RLIM_INFINITY else min(most, hard)
            resource.setrlimit(kind, (within, hard))
