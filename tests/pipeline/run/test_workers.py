"""Other executors than threads: same bytes, clear refusals, and what was finished is kept."""

import hashlib
import multiprocessing
from concurrent.futures import Executor, Future, ProcessPoolExecutor

import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import DataError
from tests.small_case import small_case

TABLES = ("nodes", "damage", "cycles", "histogram", "structural_stress", "welds")


def digests(folder):
    """SHA-256 of every result table."""
    return {name: hashlib.sha256((folder / f"{name}.parquet").read_bytes()).hexdigest() for name in TABLES}


@pytest.fixture(scope="module")
def many_welds(tmp_path_factory):
    """A case of three groups of welds, and the result of threads."""
    folder = tmp_path_factory.mktemp("many")
    path = small_case(pairs=8).write(folder / "case")
    done = assess(load_case(path), folder / "result", threads=1, report=False)
    assert done.groups == 4
    return path, folder / "result"


class Inline(Executor):
    """Does the work at once; refuses after so many jobs."""

    def __init__(self, jobs=1000):
        self.jobs = jobs

    def submit(self, task, /, *args, **kwargs):
        """Run the task and wrap what it gives or raises."""
        future = Future()
        self.jobs -= 1
        try:
            if self.jobs < 0:
                raise RuntimeError("worker lost")
            future.set_result(task(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


def test_processes_write_the_same_bytes(tmp_path, many_welds):
    """Two processes that are given names of files."""
    path, by_threads = many_welds
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as executor:
        assess(load_case(path), tmp_path / "result", executor=executor, report=False)
    assert digests(tmp_path / "result") == digests(by_threads)


def test_what_came_back_before_a_failure_is_kept(tmp_path, many_welds):
    """An executor that fails in the middle: the next run goes on, on threads even, with the same bytes."""
    path, by_threads = many_welds
    with pytest.raises(RuntimeError, match="worker lost"):
        assess(load_case(path), tmp_path / "result", executor=Inline(jobs=2), report=False)
    done = assess(load_case(path), tmp_path / "result", report=False)
    assert done.groups_reused == 2
    assert digests(tmp_path / "result") == digests(by_threads)


def test_a_worker_with_other_files_is_found_out(tmp_path, monkeypatch):
    """Inputs that differ where the worker is give no numbers but a refusal."""
    case = small_case(seconds=13.0).write(tmp_path / "case")  # no worker has opened it yet
    monkeypatch.setattr("fatigue.pipeline.run.orders.key_of", lambda case, inputs, options: "another")
    with pytest.raises(DataError, match=r"case\.toml: a worker sees other input files or other versions of packages"):
        assess(load_case(case), tmp_path / "result", executor=Inline(), report=False)
