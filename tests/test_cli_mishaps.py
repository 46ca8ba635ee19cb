"""What the machine refuses while a command runs: one line, the exit code, and nothing half written."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from fatigue.cli.mishaps import mishap
from tests.small_case import small_case

resource = pytest.importorskip("resource", reason="limits of a process are a Unix thing")

ROOT = Path(__file__).parents[1]


def fatigue(*arguments, limit=None, stdout=subprocess.PIPE, **surroundings):
    """Run the program in a process of its own, with a limit of ``resource`` or another environment."""
    return subprocess.run(
        [sys.executable, "-m", "fatigue", *map(str, arguments)],
        cwd=ROOT,
        env=os.environ | {"PYTHONPATH": str(ROOT)} | surroundings,
        stdout=stdout,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
        preexec_fn=(lambda: resource.setrlimit(limit[0], (limit[1], limit[1]))) if limit else None,
    )


@pytest.mark.parametrize(
    ("error", "words", "code"),
    [
        (MemoryError(), "memory: the program got no more of it", 4),
        (np._core._exceptions._ArrayMemoryError((9, 9), np.dtype(float)), "memory: the program got no more of it", 4),
        (pa.ArrowMemoryError("malloc failed"), "memory: the program got no more of it", 4),
        (OSError(errno.ENOMEM, "x"), "memory: the program got no more of it", 4),
        (ImportError("libarrow.so: failed to map segment from shared object"), "memory: the program got no more", 4),
        (RuntimeError("can't start new thread"), "threads: the system starts no more of them", 4),
        (BlockingIOError(errno.EAGAIN, "fork"), "threads: the system starts no more of them", 4),
        (
            OSError(errno.EMFILE, "Too many open files", "welds.csv"),
            "welds.csv: cannot be read or written (Too many open files)",
            3,
        ),
        (RecursionError(), "a file: tables, lists or includes lie in one another without end", 3),
        (ValueError("Exceeds the limit (4300 digits) for integer string conversion"), "thousands of digits", 3),
        (UnicodeEncodeError("cp1252", "aЖ", 1, 2, "no"), "'Ж' cannot be written in the encoding cp1252", 3),
        (ModuleNotFoundError("No module named 'numba'", name="numba"), "numba: the package is not installed", 4),
    ],
)
def test_the_kinds_of_mishaps(error, words, code):
    """Each of them is told, with a remedy."""
    problem, exit_code = mishap(error)
    assert words in str(problem)
    assert exit_code == code


@pytest.mark.parametrize(
    "error", [ValueError("x"), KeyError("x"), RuntimeError("x"), ModuleNotFoundError(name="fatigue.x")]
)
def test_what_is_the_program_s_own_fault_is_no_mishap(error):
    """It is to be reported."""
    assert mishap(error) == (None, 4)


def test_a_limit_of_file_sizes_leaves_nothing_half_written(tmp_path):
    """In a phase early and in one late: place, reason, remedy; no half table, and the next run goes on."""
    path, result = small_case(pairs=8).write(tmp_path / "case"), tmp_path / "result"
    command = ("-q", "assess", path, "-o", result, "--threads", 1, "--no-report", "--exit-zero")
    done = fatigue(*command, limit=(resource.RLIMIT_FSIZE, 2000))
    assert done.returncode == 3
    assert "(File too large). Raise the largest size of a file (`ulimit -f`)" in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert not result.exists()
    done = fatigue(*command, limit=(resource.RLIMIT_FSIZE, 200_000))
    assert done.returncode == 3
    assert "cycles.parquet: cannot be written (File too large)" in done.stderr
    assert {file.suffix or file.name for file in result.rglob("*") if file.is_file()} == {".npz", "case", ".log"}
    assert fatigue(*command).returncode == 0
    assert "4 of 4 groups of welds were there" in (result / "fatigue.log").read_text()


def test_too_little_address_space_is_told_before_libraries_crash(tmp_path):
    """Some of them would try again without end."""
    path = small_case().write(tmp_path / "case")
    done = fatigue("assess", path, "-o", tmp_path / "result", limit=(resource.RLIMIT_AS, 400 << 20))
    assert done.returncode == 4
    assert done.stderr.startswith("error: fatigue assess: the address space is limited to 400 MB (`ulimit -v`)")
    assert not (tmp_path / "result").exists()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_a_full_disk_behind_standard_output_is_told(small_result, unbuffered):
    """By its name, however it is buffered."""
    with Path("/dev/full").open("w") as full:
        done = fatigue("show", small_result, stdout=full, PYTHONUNBUFFERED=unbuffered)
    assert done.returncode == 3
    assert done.stderr == (
        "error: standard output: cannot be written (No space left on device). "
        "Make room, and give the same command again.\n"
    )


@pytest.mark.parametrize("encoding", ["utf-8", "ascii"])
def test_a_reader_that_went_away_changes_no_exit_code(small_result, encoding):
    """As ``| head`` does."""
    read, write = os.pipe()
    os.close(read)
    with os.fdopen(write, "w") as gone:
        done = fatigue("show", small_result, stdout=gone, PYTHONIOENCODING=encoding)
    assert done.returncode == 0
    assert done.stderr == ""


def test_letters_that_a_terminal_lacks_are_written_as_escapes(tmp_path):
    """In text and JSON, which stays JSON."""
    import json  # noqa: PLC0415

    case = small_case()
    case.events[0]["name"] = "Ж <= 𝛴"
    path = case.write(tmp_path / "case")
    done = fatigue("-q", "assess", path, "-o", tmp_path / "result", "--no-report", PYTHONIOENCODING="cp1252")
    assert done.returncode == 1
    done = fatigue("show", tmp_path / "result", "--json", PYTHONIOENCODING="cp1252")
    assert {point["governing_event"] for point in json.loads(done.stdout)["points"]} <= {
        "Ж <= 𝛴",
        "noise",
        "load and unload",
    }


def test_a_traceback_is_shown_where_it_is_asked_for(tmp_path):
    """With ``-v``, and the exit code is the same."""
    for flags, shown in (((), False), (("-v",), True)):
        done = fatigue(*flags, "show", "x" * 300)
        assert done.returncode == 3
        assert ("Traceback" in done.stderr) is shown
        assert "(File name too long). Give a shorter name." in done.stderr.splitlines()[-1]
