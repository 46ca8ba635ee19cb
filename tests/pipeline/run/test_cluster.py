"""A dask.distributed cluster as executor: same bytes, a lost worker loses nothing, clear refusals."""

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import DataError
from fatigue.pipeline.run.cluster import cluster_executor, is_open
from tests.small_case import small_case

TABLES = ("nodes", "damage", "cycles", "histogram", "structural_stress", "welds")
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


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.fixture(scope="module")
def certificates(tmp_path_factory):
    """An authority of our own and a certificate of it, made as docs/large-models.md says, with a small key."""
    if shutil.which("openssl") is None:
        pytest.skip("no openssl to make certificates with")
    folder = tmp_path_factory.mktemp("tls")
    for command in (
        "req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=my-cluster -keyout ca.key -out ca.pem",
        "req -newkey rsa:2048 -nodes -subj /CN=node -keyout node.key -out node.csr",
        "x509 -req -in node.csr -CA ca.pem -CAkey ca.key -CAcreateserial -days 2 -out node.pem",
    ):
        subprocess.run(["openssl", *command.split()], cwd=folder, check=True, capture_output=True)
    return folder


@pytest.mark.slow
def test_certificates_let_in_who_has_one_and_nobody_else(tmp_path, certificates):
    """Over TLS the same bytes, certificates by dask's configuration, no warning; without one a line says what lacks."""
    distributed = pytest.importorskip("distributed")
    path = small_case(pairs=8).write(tmp_path / "case")
    assess(load_case(path), tmp_path / "threads", threads=1, report=False)
    mine = {"cert": str(certificates / "node.pem"), "key": str(certificates / "node.key")}
    security = distributed.Security(
        tls_ca_file=str(certificates / "ca.pem"),
        require_encryption=True,
        **{f"tls_{who}_{what}": file for who in ("scheduler", "worker", "client") for what, file in mine.items()},
    )
    told = {f"DASK_DISTRIBUTED__COMM__TLS__CLIENT__{what.upper()}": file for what, file in mine.items()}
    told["DASK_DISTRIBUTED__COMM__TLS__CA_FILE"] = str(certificates / "ca.pem")

    def run(folder, address, **surroundings):
        command = [sys.executable, "-m", "fatigue", "-q", "assess", str(path), "-o", str(tmp_path / folder)]
        return subprocess.run(
            [*command, "--scheduler", address, "--no-report", "--exit-zero"],
            cwd=ROOT, capture_output=True, text=True, check=False, env=os.environ | surroundings,
        )  # fmt: skip

    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, protocol="tls://", security=security, dashboard_address=None,
        silence_logs=50, worker_dashboard_address=None,
    ) as cluster:  # fmt: skip
        assert cluster.scheduler_address.startswith("tls://")
        done = run("tls", cluster.scheduler_address, **told)
        assert done.returncode == 0, done.stderr
        assert "whoever reaches its port" not in done.stderr
        assert digests(tmp_path / "tls") == digests(tmp_path / "threads")
        refused = run("stranger", cluster.scheduler_address)
    assert refused.returncode == 3
    assert "error: tls://" in refused.stderr.splitlines()[-1]
    assert "distributed.comm.tls" in refused.stderr.splitlines()[-1]
    assert not (tmp_path / "stranger").exists()


@pytest.mark.parametrize(
    ("address", "expected"),
    [
        ("tcp://127.0.0.1:8786", False),
        ("tcp://127.8.0.1:8786", False),
        ("tcp://[::1]:8786", False),
        ("tcp://localhost:8786", False),
        ("inproc://10.0.0.5/7/1", False),
        ("tls://10.0.0.5:8786", False),
        ("tcp://10.0.0.5:8786", True),
        ("tcp://[fe80::1%eth0]:8786", True),
        ("tcp://0.0.0.0:8786", True),
        ("tcp://cluster.example:8786", True),
        ("ws://cluster.example:8786", True),
        ("", False),
    ],
)
def test_who_is_open_to_other_computers(address, expected):
    """Plain connections beyond this computer, whatever the spelling."""
    assert is_open(address) is expected


def test_an_open_scheduler_is_warned_of(caplog, cluster, monkeypatch):
    """Also where it is reached on this computer and says that it listens elsewhere."""
    with cluster_executor(cluster.scheduler_address):
        pass
    assert "whoever reaches its port" not in caplog.text
    monkeypatch.setattr("fatigue.pipeline.run.cluster.is_open", lambda address: True)
    with cluster_executor(cluster.scheduler_address):
        pass
    assert caplog.text.count("takes code from whoever reaches its port") == 1
    assert "Use tls:// with certificates" in caplog.text
