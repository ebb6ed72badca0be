"""Runs random realistic scenes in processes of their own, each for a limited time."""

import json
import math
import os
import signal
import sys
import traceback
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from multiprocessing.connection import Connection
from queue import SimpleQueue
from time import process_time
from typing import Any

import numpy as np

from derivation.checks.random_scenes import Scene
from derivation.checks.realistic_scenes import RTOL, SEED, Kind, Outcome, scenes
from derivation.engine.activity import Tell, quiet
from derivation.scene.impact import simulate
from derivation.scene.scene import IncompleteError, SceneError, read

LIMIT = 60.0
"""Seconds of processor time that a run may take."""
PATIENCE = 20.0
"""Seconds that pass for one of processor time, at most, on a machine with other work."""
START = 300.0
"""Seconds that a process may take to start."""
READY = "ready"


def check_scenes(
    count: int,
    seed: int = SEED,
    tell: Tell = quiet,
    limit: float = LIMIT,
    drawn: Sequence[Scene] | None = None,
) -> tuple[Outcome, ...]:
    """Simulate realistic random scenes in the order in which they are drawn.

    Each is run at `RTOL`, and once more without a tolerance if it does not finish.

    Parameters
    ----------
    limit
        Seconds of processor time that a run may take.
    drawn
        Scenes to run instead of random ones.
    """
    chosen = scenes(count, seed) if drawn is None else drawn
    jobs = list(chosen)
    many = min(processors(), len(jobs))
    free: SimpleQueue[Worker] = SimpleQueue()
    workers = [Worker() for _ in range(many)]
    for worker in workers:
        free.put(worker)

    def run(scene: Scene) -> list[Outcome]:
        worker = free.get()
        try:
            first = worker.run(scene, RTOL, limit)
            again = [] if first.kind == "finished" else [worker.run(scene, None, limit)]
            return [first, *again]
        finally:
            free.put(worker)

    found: list[Outcome] = []
    pool = ThreadPoolExecutor(many)
    try:
        for number, outcomes in enumerate(pool.map(run, jobs), 1):
            found.extend(outcomes)
            tell(outcomes[0].kind, number, len(jobs))
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
        for worker in workers:
            worker.stop()
    return tuple(found)


def processors() -> int:
    """How many processors this process may use."""
    may = getattr(os, "sched_getaffinity", None)
    return len(may(0)) if may else os.cpu_count() or 1


class Worker:
    """A process that simulates one scene after the other, and is replaced if one takes too long."""

    def __init__(self) -> None:
        self.start()

    def start(self) -> None:
        """Start the process, which says when it is ready."""
        context = get_context("spawn")
        self.pipe, other = context.Pipe()
        self.process = context.Process(target=serve, args=(other,), daemon=True)
        self.process.start()
        other.close()
        self.ready = False

    def run(self, scene: Scene, rtol: float | None, limit: float) -> Outcome:
        """What becomes of a scene."""
        try:
            if not self.ready and self.pipe.poll(START):
                self.ready = self.pipe.recv() == READY
            self.pipe.send((scene, rtol, limit))
            if self.pipe.poll(PATIENCE * limit):
                kind, message, seconds, memory = self.pipe.recv()
                return Outcome(kind, message, rtol, scene, seconds, memory)
            said: tuple[Kind, str] = "overrun", overrun(limit)
        except (EOFError, OSError):
            said = ("traceback", "the process ended without a result")
        self.stop()
        self.start()
        return Outcome(*said, rtol, scene)

    def stop(self) -> None:
        """End the process."""
        self.process.terminate()
        self.process.join()
        self.pipe.close()


def serve(pipe: Connection) -> None:
    """Simulate what comes through a pipe, until nobody is at its other end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the main process's, which ends this
    pipe.send(READY)
    while True:
        try:
            scene, rtol, limit = pipe.recv()
        except EOFError:
            return
        begun = process_time()
        kind, message = run(scene, rtol, limit)
        pipe.send((kind, message, process_time() - begun, peak_memory()))


def peak_memory() -> float:
    """Most memory that this process has had [bytes]; NaN where the system does not tell."""
    try:
        from resource import RUSAGE_SELF, getrusage
    except ImportError:
        return math.nan
    unit = 1 if sys.platform == "darwin" else 1024
    return float(getrusage(RUSAGE_SELF).ru_maxrss * unit)


def overrun(limit: float) -> str:
    """Says that a run took too long."""
    return f"still running after {limit:g} s of processor time"


def run(scene: Scene, rtol: float | None, limit: float = LIMIT) -> tuple[Kind, str]:
    """Simulate a scene as the command does, its history too: what became of it, and why."""
    try:
        with limited(limit):
            return _run(scene, rtol)
    except TimeoutError:
        return "overrun", overrun(limit)


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Raise TimeoutError after so many seconds of processor time, where the system can tell."""

    def stop(*_: object) -> None:
        raise TimeoutError

    if not hasattr(signal, "setitimer"):
        yield
        return
    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def _run(scene: Scene, rtol: float | None) -> tuple[Kind, str]:
    """The same without a limit."""
    try:
        result = simulate(read(scene), rtol=rtol)
        columns: Any = result.history()
        made = result.to_json()
    except IncompleteError as error:
        return "incomplete", str(error)
    except SceneError as error:
        return "refused", str(error)
    except TimeoutError:
        raise
    except Exception:  # whatever it is, it is counted
        return "traceback", "".join(traceback.format_exc().splitlines(keepends=True)[-3:])
    if not result.complete:
        return "incomplete", result.incomplete_note
    if not all(np.isfinite(column).all() for column in columns) or not _finite(made):
        return "NaN", "a result or the history is not finite"
    return "finished", ""


def _finite(data: Any) -> bool:
    """Whether plain data has no NaN and no infinity."""
    try:
        json.dumps(data, allow_nan=False)
    except ValueError:
        return False
    return all(math.isfinite(x) for x in data.values() if isinstance(x, float))
