"""Computes the missing batches of a study in this process, in several, or on a Dask cluster."""

import gc
import logging
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from derivation.engine.activity import Progress
from derivation.scene.errors import SceneError
from derivation.scene.rows.rows import solve
from derivation.scene.scene import read
from derivation.scene.sweep import unheard_interrupts
from derivation.sweep.plan import Column
from derivation.sweep.store import PartFile, Store, to_parquet
from derivation.sweep.study import installed_version

FIRST_BATCH, TRIED = 16, 1.0
"""Number of points of the first batch; run time [s] after which the remaining time is estimated.
The first batch loads libraries, and small batches take longer for each point."""
LARGEST_BATCH = 2**16
"""Largest number of points of a batch."""
GROWTH = 16
"""Largest ratio of the sizes of successive batches."""
BATCH_SECONDS = 3.0
"""Intended run time of a batch [s], which an interrupted run loses in each process. A batch that
turns out to take longer ends before its next simulation; its other points become a new batch."""
LEAST_SECONDS = 0.3
"""Smallest intended run time of a batch [s], because a file for each batch takes time too."""
PARALLEL_FROM = 6.0
"""Remaining run time [s] above which other processes are started."""
PATIENCE = 30.0
"""Largest waiting time for a scheduler, and for its first worker [s]."""
ENVIRONMENT = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
"""Variables of the processes on this machine. Dask also sets MALLOC_TRIM_THRESHOLD_, which returns
memory early: simulations with many arrays then take 1.5 times as long."""


@dataclass(frozen=True)
class Batch:
    """Points that are computed together.

    Attributes
    ----------
    start, stop
        First point, and the point after the last one.
    renewed
        The finished batch in which some points are computed again; None for new points.
    numbers
        Indices of the points that are computed again.
    """

    start: int
    stop: int
    renewed: PartFile | None = None
    numbers: tuple[int, ...] = ()

    @property
    def count(self) -> int:
        """Number of points to compute."""
        return len(self.numbers) if self.renewed else self.stop - self.start

    def split(self, count: int) -> tuple["Batch", "Batch"]:
        """Return the first points as a batch, and the others as another one."""
        if self.renewed:
            first, others = self.numbers[:count], self.numbers[count:]
            return replace(self, numbers=first), replace(self, numbers=others)
        middle = self.start + count
        return Batch(self.start, middle), Batch(middle, self.stop)


class Queue:
    """The remaining points, in batches that take about `BATCH_SECONDS`."""

    def __init__(
        self, ranges: Iterable[tuple[int, int]], again: Iterable[tuple[PartFile, list[int]]]
    ) -> None:
        self._ranges = deque(ranges)
        self._again = deque(
            Batch(part.start, part.stop, part, tuple(numbers)) for part, numbers in again
        )
        new = sum(stop - start for start, stop in self._ranges)
        self.left = new + sum(batch.count for batch in self._again)
        self._size, self._least, self.seconds_per_point = FIRST_BATCH, 1, 0.0

    def next(self, workers: int = 1) -> Batch | None:
        """Return the next batch, so small that several workers end at about the same time."""
        if self._again:
            batch = self._again.popleft()
        elif self._ranges:
            start, stop = self._ranges.popleft()
            per_worker = self.left if workers == 1 else self.left // (2 * workers)
            size = min(self._size, max(per_worker, self._least))
            batch = Batch(start, min(stop, start + size))
            if batch.stop < stop:
                self._ranges.appendleft((batch.stop, stop))
        else:
            return None
        self.left -= batch.count
        return batch

    def put_back(self, batch: Batch) -> None:
        """Add points that a batch has left, to be computed next."""
        if batch.renewed:
            self._again.appendleft(batch)
        else:
            self._ranges.appendleft((batch.start, batch.stop))
        self.left += batch.count

    def learn(self, points: int, seconds: float) -> None:
        """Set the size of the next batches from the run time of one [s]."""
        self.seconds_per_point = max(seconds, 1e-9) / points
        self._least = max(1, int(LEAST_SECONDS / self.seconds_per_point))
        wanted = int(BATCH_SECONDS / self.seconds_per_point)
        self._size = min(max(wanted, 1), max(GROWTH * points, FIRST_BATCH), LARGEST_BATCH)


def compute(
    store: Store, workers: int, scheduler: str | None, retry: bool, progress: Progress
) -> int:
    """Compute the missing points of a study; return the number of points computed.

    Parameters
    ----------
    store
        The finished batches, to which the new ones are added.
    workers
        Number of processes, used if the study takes long.
    scheduler
        Address of a Dask scheduler, whose workers are used instead of processes.
    retry
        Whether rejected and incomplete points are computed again.
    progress
        Called first and after each batch with the index of the next point and the number of all.

    Raises
    ------
    SceneError
        If the processes, the scheduler or a worker fail, or a worker has another version.
    """
    queue = Queue(store.missing(), store.failed() if retry else ())
    todo, total, done = queue.left, store.study.plan.size, 0

    def keep(batch: Batch, content: bytes, count: int, seconds: float) -> None:
        nonlocal done
        if count < batch.count:
            batch, others = batch.split(count)
            queue.put_back(others)
        if batch.renewed:
            store.renew(batch.renewed, list(batch.numbers), content, seconds)
        else:
            store.keep(batch.start, batch.stop, content, seconds)
        done += batch.count
        queue.learn(batch.count, seconds)
        progress("points", total - todo + done + 1, total)

    progress("points", total - todo + 1, total)
    if scheduler is None:
        _here(store, queue, keep, workers)
    if queue.left:
        with _client(scheduler, workers) as client:
            _on_cluster(store, queue, keep, client)
    store.sort_batches()
    return todo


Keep = Callable[[Batch, bytes, int, float], None]


def _here(store: Store, queue: Queue, keep: Keep, workers: int) -> None:
    """Compute batches in this process, until the remaining time justifies other processes."""
    spent, batches = 0.0, 0
    while batch := queue.next():
        content, count, seconds = solve_batch(*_task(store, batch))
        keep(batch, content, count, seconds)
        spent, batches = spent + seconds, batches + 1
        # A batch that ends early is slow even without the libraries that the first one loads.
        known = batches > 1 or count < batch.count
        long = queue.left * queue.seconds_per_point > PARALLEL_FROM
        if workers > 1 and known and spent > TRIED and long:
            return


def _on_cluster(store: Store, queue: Queue, keep: Keep, client: Any) -> None:
    """Compute batches on the workers of a cluster, two at a time for each worker."""
    from distributed import KilledWorker, as_completed

    running: dict[str, Batch] = {}
    finished = as_completed(loop=client.loop)

    def fill() -> None:
        workers = max(1, sum(client.nthreads().values()))
        while len(running) < 2 * workers and (batch := queue.next(workers)):
            future = client.submit(solve_batch, *_task(store, batch), pure=False)
            running[future.key] = batch
            finished.add(future)

    fill()
    for future in finished:
        batch = running.pop(future.key)
        try:
            content, count, seconds = future.result()
        except KilledWorker:
            raise SceneError(
                f"sweep: expected workers that finish the points {batch.start} to "
                f"{batch.stop - 1}, but several were terminated while they computed them, possibly "
                "for lack of memory; run it again, other points are kept"
            ) from None
        except (CancelledError, OSError) as error:
            raise SceneError(
                f"sweep: lost the connection to the scheduler ({type(error).__name__}); run it "
                "again, finished points are kept"
            ) from None
        except ImportError as error:
            raise SceneError(
                f"sweep: expected platecontact on every worker, got: {error}; install it there"
            ) from None
        future.release()
        keep(batch, content, count, seconds)
        fill()


Task = tuple[dict[str, Any], dict[str, Column], float | None, str]


def _task(store: Store, batch: Batch) -> Task:
    """Return the arguments of `solve_batch`, which can be sent to another machine."""
    study = store.study
    columns = study.plan.points(batch.start, batch.stop)
    if batch.renewed:
        indices = np.array(batch.numbers) - batch.start
        columns = {key: values[indices] for key, values in columns.items()}
    return study.base["scene"], columns, study.rtol, study.base["version"]


def solve_batch(
    scene: dict[str, Any], columns: dict[str, Column], rtol: float | None, wanted: str
) -> tuple[bytes, int, float]:
    """Simulate some points: all of them, or the first ones if they take long.

    Return the content of their file, their number and the run time [s].

    Raises
    ------
    SceneError
        If this machine has another version of the program.
    """
    installed = installed_version()
    if installed != wanted:
        raise SceneError(
            f"sweep: expected version {wanted} of platecontact on every worker, got "
            f"{installed}; install the same version everywhere"
        )
    start = time.perf_counter()
    rows = solve(read(scene), columns, rtol, BATCH_SECONDS)
    content = to_parquet(rows)
    return content, len(rows), time.perf_counter() - start


@contextmanager
def _client(scheduler: str | None, workers: int) -> Iterator[Any]:
    """Yield a client of a scheduler, or of processes on this machine, which end with the block.

    Raises
    ------
    SceneError
        If the processes do not start, or the scheduler or its first worker does not respond.
    """
    import dask.config
    from distributed import Client, LocalCluster

    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    if scheduler is None:
        # Ctrl-C is for this process, which ends the others.
        spawn = dask.config.set({"distributed.nanny.pre-spawn-environ": ENVIRONMENT})
        with unheard_interrupts(), spawn:
            try:
                cluster = LocalCluster(
                    n_workers=workers,
                    threads_per_worker=1,
                    dashboard_address=":0",  # any free port: several studies may run at once
                    scheduler_kwargs={"dashboard": False},
                    silence_logs=logging.CRITICAL,
                )
            except (RuntimeError, OSError) as error:
                raise SceneError(
                    f"sweep: expected {workers} processes to start, got: {error}; a script of your "
                    'own has to call pc.sweep below `if __name__ == "__main__":`, or with '
                    "workers=1; finished points are kept"
                ) from None
        with cluster, Client(cluster, set_as_default=False) as client:
            yield client
        return
    client = _connected(scheduler)
    if client is None:
        # The failed client is part of a reference cycle. Python would close it at any time, perhaps
        # in a thread that is needed to start another client, which then waits forever.
        gc.collect()
        raise SceneError(
            f"scheduler: expected a Dask scheduler with a worker, got none at {scheduler}; "
            "start them with `dask scheduler` and `dask worker ADDRESS`, and give the address as "
            "tcp://HOST:PORT"
        )
    with client:
        yield client


def _connected(scheduler: str) -> Any:
    """Return a client of a scheduler that has a worker; None if one of them does not respond."""
    from distributed import Client

    client = None
    with suppress(OSError, ValueError):  # ValueError: invalid address
        client = Client(scheduler, timeout=PATIENCE, set_as_default=False)
        client.wait_for_workers(1, timeout=PATIENCE)
        return client
    if client is not None:
        client.close()
    return None
