"""Computation in a separate process, with limits of time and memory."""

import contextlib
import faulthandler
import multiprocessing
import os
import signal
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, TypeVar

Value = TypeVar("Value")

SECONDS = 15
"""Processor time [s] allowed for comparing a formula."""
MEGABYTES = 1000
"""Memory [MB] allowed in addition to the memory that the program already uses."""
PATIENCE = 6
"""Elapsed time over the limit of processor time after which a process is ended."""


class LimitError(ValueError):
    """A computation reached a limit of time, memory or recursion; the message states a remedy."""


def run_limited(
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
    context = multiprocessing.get_context("fork")
    reader, writer = context.Pipe(duplex=False)
    child = context.Process(
        target=_run_in_child, args=(work, writer, seconds, megabytes), daemon=True
    )
    child.start()
    writer.close()
    kind = "time"
    value: Any = None
    try:
        if reader.poll(seconds * PATIENCE):
            kind, value = reader.recv()
    except EOFError:  # the system ended the process
        child.join()
        kind = "time" if child.exitcode in (-signal.SIGXCPU, -signal.SIGKILL) else "memory"
    finally:
        reader.close()
        child.kill()
        child.join()
    if kind == "time":
        raise LimitError(f"{what} takes more than {seconds} s: simplify or shorten the formula")
    if kind == "memory":
        raise LimitError(
            f"{what} takes more than {megabytes} MB of memory: simplify or shorten the formula"
        )
    if kind == "depth":
        raise LimitError(f"{what} needs too deep a recursion: nest the formula less deeply")
    if kind == "error":
        raise value
    return value  # type: ignore[no-any-return]


def _run_in_child(
    work: Callable[[], Any], writer: Connection, seconds: int, megabytes: int
) -> None:
    """Do the work in the child, and send its result or the reason why there is none."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    faulthandler.disable()  # a library that runs out of memory may abort
    _set_limits(seconds, megabytes)
    try:
        writer.send(("value", work()))
    except MemoryError:
        writer.send(("memory", None))
    except RecursionError:
        writer.send(("depth", None))
    except Exception as error:
        writer.send(("error", error))


def _set_limits(seconds: int, megabytes: int) -> None:
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
