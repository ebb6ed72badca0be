"""Sweeps that are killed or interrupted, and sweeps on a cluster that loses a worker."""

import gc
import json
import os
import random
import signal
import socket
import subprocess
import sys
import time
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import distributed
import kills
import numpy as np
import platecontact as pc
import pytest
from studies import QUICK, begin, counts, journal, parts, scene

from derivation.cli import main
from derivation.engine.files import ROOT
from derivation.scene import read
from derivation.sweep import run

POINTS = 40
STUDY = ("--vary", f"impact.speed=0.5:2:{POINTS}")
PATIENCE = 300.0


def wait(condition: Callable[[], object]) -> None:
    """Wait until a condition is true."""
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end, "the condition is still false"
        time.sleep(0.02)


def whole(path: Path) -> bytes:
    """Return the content of the output file of an uninterrupted study."""
    pc.sweep(scene(), {"impact.speed": f"0.5:2:{POINTS}"}, out=path)
    return path.read_bytes()


def test_killed_run_is_continued(tmp_path: Path) -> None:
    out, chance = tmp_path / "rows.csv", random.Random(1)
    for _ in range(2):
        before = len(parts(out))
        process = begin(*STUDY, "--out", str(out))
        wait(lambda before=before, process=process: len(parts(out)) > before or process.poll() == 0)
        time.sleep(chance.uniform(0, 0.3))
        process.kill()
        process.communicate()
        if not out.exists():
            assert len(parts(out)) > before
    assert main(["sweep", str(QUICK), *STUDY, "--out", str(out)]) == 0
    assert (journal(out, POINTS) == 1).all()
    assert (counts(out, POINTS) == 1).all()
    assert out.read_bytes() == whole(tmp_path / "whole.csv")


@pytest.mark.parametrize("suffix", [".csv", ".nc"])
def test_run_killed_at_any_file_operation_is_continued(suffix: str, tmp_path: Path) -> None:
    command = [sys.executable, str(Path(kills.__file__)), str(tmp_path), suffix]
    paths = os.pathsep.join((str(ROOT), str(Path(kills.__file__).parent)))
    output = subprocess.run(
        command, env=os.environ | {"PYTHONPATH": paths}, cwd=ROOT, check=True, text=True,
        stdout=subprocess.PIPE, timeout=PATIENCE,
    ).stdout  # fmt: skip
    actual = json.loads(output.splitlines()[-1])
    assert actual["failures"] == []
    assert actual["kills"] > 20


@pytest.mark.parametrize("written", [0, 6])
def test_journal_is_completed_after_a_kill(written: int, tmp_path: Path) -> None:
    """The run was killed after the file of a batch, before or within its line in the journal."""
    out = tmp_path / "rows.csv"
    keys: Any = {"impact.speed": f"0.5:2:{POINTS}"}
    pc.sweep(scene(), keys, out=out)
    file = out.with_name("rows.csv.parts") / "journal.txt"
    *others, last = file.read_text().splitlines(keepends=True)
    assert others
    file.write_text("".join(others) + last[:written])
    pc.sweep(scene(), keys, out=out)
    assert (journal(out, POINTS) == 1).all()


def test_interrupted_run_states_how_to_continue(tmp_path: Path) -> None:
    out = tmp_path / "rows.csv"
    keys = "impact.speed=0.5:2:2000", "sphere.density=7000:8000:1000"
    process = begin("--vary", keys[0], "--vary", keys[1], "--out", str(out))
    wait(lambda: parts(out))
    process.send_signal(signal.SIGINT)
    _, output = process.communicate(timeout=PATIENCE)
    assert process.returncode == 2
    assert "Traceback" not in output
    assert "of 2,000,000 points" in output
    assert "run the same command again" in " ".join(output.split())
    assert not out.exists()


@contextmanager
def ended(*commands: list[str]) -> Iterator[list["subprocess.Popen[bytes]"]]:
    """Start processes and end them when the block ends."""
    made = [
        subprocess.Popen(
            [sys.executable, "-m", "distributed.cli." + command[0], *command[1:]], cwd=ROOT,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )
        for command in commands
    ]  # fmt: skip
    try:
        yield made
    finally:
        for process in made:
            process.kill()
            process.wait()


def test_loss_of_a_cluster_worker_loses_no_results(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    where, out = tmp_path / "scheduler.json", tmp_path / "rows.csv"
    scheduler = ["dask_scheduler", "--port", "0", "--no-dashboard", "--host", "127.0.0.1",
                 "--scheduler-file", str(where)]  # fmt: skip
    worker = ["dask_worker", "--scheduler-file", str(where), "--no-dashboard", "--nthreads", "1",
              "--no-nanny"]  # fmt: skip
    with ended(scheduler) as [first]:
        wait(lambda: where.exists() and where.read_text())
        address = json.loads(where.read_text())["address"]
        with ended(worker, worker) as workers:
            study = [*STUDY, "--out", str(out), "--scheduler", address]
            process = begin(*study)
            wait(lambda: len(parts(out)) >= 2)
            workers[0].kill()
            _, output = process.communicate(timeout=PATIENCE)
            assert process.returncode == 0, output
            assert (journal(out, POINTS) == 1).all()
            assert out.read_bytes() == whole(tmp_path / "whole.csv")
        first.kill()


def test_missing_scheduler_is_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run, "PATIENCE", 1.0)
    for address in ("tcp://127.0.0.1:9", "nowhere:x"):
        arguments = ["--out", str(tmp_path / "rows.csv"), "--scheduler", address]
        assert main(["sweep", str(QUICK), *STUDY, *arguments]) == 2
        output = capsys.readouterr().err
        assert "expected a Dask scheduler with a worker" in output
        assert "Traceback" not in output


def test_a_client_that_fails_is_closed_immediately(monkeypatch: pytest.MonkeyPatch) -> None:
    """Otherwise Python may close it in the thread of a new client, which then waits for itself."""
    clients = list[weakref.ref[distributed.Client]]()
    created = distributed.Client.__init__

    def noted(client: distributed.Client, *arguments: Any, **others: Any) -> None:
        clients.append(weakref.ref(client))
        created(client, *arguments, **others)

    monkeypatch.setattr(distributed.Client, "__init__", noted)
    monkeypatch.setattr(run, "PATIENCE", 0.2)
    gc.disable()
    try:
        for address in ("tcp://127.0.0.1:9", "nowhere:x"):
            with pytest.raises(pc.SceneError), run._client(address, 1):
                pass
        assert [client() for client in clients] == [None, None]
    finally:
        gc.enable()


def test_workers_of_another_version_are_rejected() -> None:
    columns = {"impact.speed": np.ones(1)}
    with pytest.raises(pc.SceneError, match=r"expected version 0\.0\.1 of platecontact"):
        run.solve_batch(scene().to_json(), columns, None, "0.0.1")


def test_batches_take_about_the_requested_time() -> None:
    queue = run.Queue([(0, 10_000), (20_000, 120_000)], [])
    done = np.zeros(120_000, dtype=int)
    while batch := queue.next(4):
        assert batch.count * 1e-3 <= run.BATCH_SECONDS
        done[batch.start : batch.stop] += 1
        queue.learn(batch.count, 1e-3 * batch.count)
    assert queue.left == 0
    assert (done[:10_000] == 1).all()
    assert not done[10_000:20_000].any()
    assert (done[20_000:] == 1).all()


@pytest.mark.parametrize(("count", "batches"), [(3, 1), (run.FIRST_BATCH, 2)])
def test_other_processes_start_after_a_slow_batch(
    count: int, batches: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A first batch that ends early is slow; a complete one may only have loaded libraries."""
    queue, kept = run.Queue([(0, 1000)], []), list[int]()

    def solved(*_: object) -> tuple[bytes, int, float]:
        return b"", count, 2.0 * run.TRIED

    def keep(batch: run.Batch, _: bytes, count: int, seconds: float) -> None:
        kept.append(count)
        if count < batch.count:
            queue.put_back(batch.split(count)[1])
        queue.learn(count, seconds)

    monkeypatch.setattr(run, "solve_batch", solved)
    monkeypatch.setattr(run, "_task", lambda *_: ())
    run._here(None, queue, keep, workers=2)  # type: ignore[arg-type]
    assert len(kept) == batches
    assert queue.left == 1000 - sum(kept)


@contextmanager
def taken_port(number: int) -> Iterator[None]:
    """Listen on a port, unless another program does."""
    with socket.socket() as held:
        with suppress(OSError):
            held.bind(("", number))
            held.listen()
        yield


def test_processes_keep_freed_memory_beside_another_study(monkeypatch: pytest.MonkeyPatch) -> None:
    """With Dask's default, freeing memory immediately takes a third of the time of simulations.

    The other study has Dask's default port, which is no reason for a warning.
    """
    monkeypatch.delenv("OPENBLAS_NUM_THREADS")
    with taken_port(8787), run._client(None, 1) as client:
        actual = client.submit(os.environ.get, "MALLOC_TRIM_THRESHOLD_").result()
        threads = client.submit(os.environ.get, "OPENBLAS_NUM_THREADS").result()
    assert (actual, threads) == (os.environ.get("MALLOC_TRIM_THRESHOLD_"), "1")


def test_slow_batches_are_divided(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # All points yield. The first ones need no viscosity and are computed in arrays, the last ones
    # one by one.
    vary = {"plate.retardation_time": "1e-12:1e-4:20:log"}
    tables = scene().to_json()
    yielding = read(tables | {"plate": tables["plate"] | {"yield_stress": 1e7}})
    pc.sweep(yielding, vary, out=tmp_path / "whole.csv")
    monkeypatch.setattr(run, "BATCH_SECONDS", 0.0)
    monkeypatch.setattr(run, "FIRST_BATCH", 20)
    monkeypatch.setattr(run.Queue, "learn", lambda *_: None)
    out = tmp_path / "divided.csv"
    study = pc.sweep(yielding, vary, out=out)
    assert (journal(out, 20) == 1).all()
    assert (counts(out, 20) == 1).all()
    effects = study["effects"].values.astype(str)
    singles = int(np.count_nonzero(np.char.find(effects, "viscosity") >= 0))
    assert 0 < singles < 20
    assert len(parts(out)) == 1 + singles
    assert out.read_bytes() == (tmp_path / "whole.csv").read_bytes()


def test_failed_points_of_a_slow_batch_are_computed_again_in_parts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    vary = {"impact.speed": "1:-1:10"}  # the last five are rejected
    out = tmp_path / "rows.csv"
    pc.sweep(scene(), vary, out=out)
    before = out.read_bytes()
    monkeypatch.setattr(run, "BATCH_SECONDS", 0.0)
    pc.sweep(scene(), vary, out=out, retry=True)
    lines = out.with_name("rows.csv.parts").joinpath("journal.txt").read_text().splitlines()
    assert sum(int(line.split()[2]) for line in lines) == 15
    assert out.read_bytes() == before
