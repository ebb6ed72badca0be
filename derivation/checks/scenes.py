"""Simulates random realistic scenes in separate processes, each for a limited time."""

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
from derivation.engine.activity import Progress, quiet
from derivation.scene.errors import IncompleteError, SceneError
from derivation.scene.impact import simulate
from derivation.scene.scene import read

LIMIT = 60.0
"""Largest processor time of a run [s]."""
PATIENCE = 20.0
"""Elapsed time over `LIMIT` after which a process is stopped; a busy machine needs some reserve."""
START = 300.0
"""Longest time that a process may take to start [s]."""
READY = "ready"


def check_scenes(
    count: int,
    seed: int = SEED,
    progress: Progress = quiet,
    limit: float = LIMIT,
    drawn: Sequence[Scene] | None = None,
) -> tuple[Outcome, ...]:
    """Simulate realistic random scenes; return the outcomes in the order of the scenes.

    Each is simulated with `RTOL`, and again with the default tolerance if it does not finish.

    Parameters
    ----------
    count, seed
        Number of scenes, and random seed.
    progress
        Called after each scene with the outcome of its first run.
    limit
        Largest processor time of a run [s].
    drawn
        Scenes to simulate instead of random ones.
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

    solved: list[Outcome] = []
    pool = ThreadPoolExecutor(many)
    try:
        for number, outcomes in enumerate(pool.map(run, jobs), 1):
            solved.extend(outcomes)
            progress(outcomes[0].kind, number, len(jobs))
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
        for worker in workers:
            worker.stop()
    return tuple(solved)


def processors() -> int:
    """Return the number of processors that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity else os.cpu_count() or 1


class Worker:
    """A process that simulates scenes; it is replaced if it ends or takes too long."""

    def __init__(self) -> None:
        self.start()

    def start(self) -> None:
        """Start the process, which sends `READY` when it can receive scenes."""
        context = get_context("spawn")
        self.pipe, other = context.Pipe()
        self.process = context.Process(target=serve, args=(other,), daemon=True)
        self.process.start()
        other.close()
        self.ready = False

    def run(self, scene: Scene, rtol: float | None, limit: float) -> Outcome:
        """Simulate a scene in the process; return the outcome."""
        try:
            if not self.ready and self.pipe.poll(START):
                self.ready = self.pipe.recv() == READY
            self.pipe.send((scene, rtol, limit))
            if self.pipe.poll(PATIENCE * limit):
                kind, message, seconds, memory = self.pipe.recv()
                return Outcome(kind, message, rtol, scene, seconds, memory)
            ended: tuple[Kind, str] = "overrun", overrun_message(limit)
        except (EOFError, OSError):
            ended = ("traceback", "the process terminated without a result")
        self.stop()
        self.start()
        return Outcome(*ended, rtol, scene)

    def stop(self) -> None:
        """End the process."""
        self.process.terminate()
        self.process.join()
        self.pipe.close()


def serve(pipe: Connection) -> None:
    """Simulate the scenes that arrive through a pipe, until it is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the main process handles Ctrl-C
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
    """Return the peak memory of this process [bytes]; NaN if it is unknown."""
    try:
        from resource import RUSAGE_SELF, getrusage
    except ImportError:
        return math.nan
    unit = 1 if sys.platform == "darwin" else 1024
    return float(getrusage(RUSAGE_SELF).ru_maxrss * unit)


def overrun_message(limit: float) -> str:
    """Return the message for a run that took too long."""
    return f"still running after {limit:g} s of processor time"


def run(scene: Scene, rtol: float | None, limit: float = LIMIT) -> tuple[Kind, str]:
    """Simulate a scene, with history and JSON; return the kind of outcome and the message."""
    try:
        with time_limit(limit):
            return _run(scene, rtol)
    except TimeoutError:
        return "overrun", overrun_message(limit)


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise TimeoutError in the block after a processor time [s], if the system supports it."""

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
    """Simulate a scene without a limit of time; return the kind of outcome and the message."""
    try:
        result = simulate(read(scene), rtol=rtol)
        columns: Any = result.history()
        made = result.to_json()
    except IncompleteError as error:
        return "incomplete", str(error)
    except SceneError as error:
        return "rejected", str(error)
    except TimeoutError:
        raise
    except Exception:  # any exception is a failure
        return "traceback", "".join(traceback.format_exc().splitlines(keepends=True)[-3:])
    if not result.complete:
        return "incomplete", result.incomplete_note
    if not all(np.isfinite(column).all() for column in columns) or not _finite(made):
        return "NaN", "a result or the history is not finite"
    return "finished", ""


def _finite(data: Any) -> bool:
    """Return whether plain data contains no NaN and no infinity."""
    try:
        json.dumps(data, allow_nan=False)
    except ValueError:
        return False
    return all(math.isfinite(x) for x in data.values() if isinstance(x, float))
