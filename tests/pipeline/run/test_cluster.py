"""A dask.distributed cluster as executor: same bytes, a lost worker loses nothing, clear refusals."""

import hashlib
import subprocess
import sys
from pathlib import Path

import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import DataError
from fatigue.pipeline.run.cluster import cluster_executor
from tests.small_case import small_case

TABLES = ("nodes", "damage", "cycles", "structural_stress", "welds")
ROOT = Path(__file__).parents[3]


def digests(folder):
    """SHA-256 of every result table."""
    return {name: hashlib.sha256((folder / f"{name}.parquet").read_bytes()).hexdigest() for name in TABLES}


@pytest.fixture
def cluster():
    """Two worker processes on this machine."""
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50, worker_dashboard_address=None
    ) as cluster:
        yield cluster


def test_two_workers_write_the_same_bytes(tmp_path, cluster):
    """From the command line, on an existing scheduler."""
    path = small_case(pairs=8).write(tmp_path / "case")
    assess(load_case(path), tmp_path / "threads", threads=1, report=False)
    command = ["assess", path, "-o", tmp_path / "cluster", "--scheduler", cluster.scheduler_address, "--no-report"]
    done = subprocess.run(
        [sys.executable, "-m", "fatigue", *map(str, command), "--exit-zero"],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert digests(tmp_path / "cluster") == digests(tmp_path / "threads")


def test_a_worker_killed_in_the_middle_loses_nothing(tmp_path, cluster):
    """The other one takes over, and the bytes are the same."""
    path = small_case(seconds=60.0, pairs=16).write(tmp_path / "case")
    assess(load_case(path), tmp_path / "threads", threads=2, report=False)
    victims = [worker.pid for worker in cluster.workers.values()][:1]
    killed = []

    def kill(label, done, total):
        if not killed:
            import os  # noqa: PLC0415
            import signal  # noqa: PLC0415

            killed.append(os.kill(victims[0], signal.SIGKILL))

    with cluster_executor(cluster.scheduler_address) as executor:
        assess(load_case(path), tmp_path / "cluster", executor=executor, report=False, progress=kill)
    assert killed
    assert digests(tmp_path / "cluster") == digests(tmp_path / "threads")


def test_a_scheduler_that_does_not_answer_is_named(monkeypatch):
    """One line with the address and what to start."""
    pytest.importorskip("distributed")
    monkeypatch.setattr("fatigue.pipeline.run.cluster.TIMEOUT_S", 0.5)
    with pytest.raises(DataError, match=r"tcp://127\.0\.0\.1:9: no scheduler answers .* `dask scheduler`"):
        cluster_executor("tcp://127.0.0.1:9").__enter__()


@pytest.mark.parametrize("address", ["nonsense", "host:8786", "tcp://host"])
def test_what_is_no_address_is_refused_at_once(address):
    """One line with an example, before anything is tried."""
    pytest.importorskip("distributed")
    with pytest.raises(DataError, match=rf"{address}: is not the address of a scheduler\. Give one such as tcp://"):
        cluster_executor(address).__enter__()
