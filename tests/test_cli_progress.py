"""What is told while somebody waits: on a terminal, in a log file, and not at all."""

import logging
import os
import subprocess
import sys
import time

import pytest

from fatigue.cli import progress
from fatigue.cli.progress import COMPILING, Narrator, narrated
from fatigue.stages import STAGES, stage
from tests.command_line import ROOT


@pytest.fixture
def lines(monkeypatch):
    """Collect the lines that go to stderr, which is no terminal."""
    said = []
    monkeypatch.setattr(progress.click, "echo", lambda text, err: said.append(text))
    monkeypatch.setattr(progress.sys.stderr, "isatty", lambda: False, raising=False)
    return said


def wait_for(condition):
    """Wait until it holds, at most some seconds."""
    end = time.monotonic() + 20.0
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    assert condition()


def test_in_a_pipe_a_stage_is_told_when_it_is_over(lines):
    """With its duration, in order; the last one, too."""
    with narrated(quiet=False):
        stage("reading %d files", 3)
        assert lines == []
        stage("counting")
        assert [line.partition(":")[0] for line in lines] == ["reading 3 files"]
    assert [line.partition(": done in ")[0] for line in lines] == ["reading 3 files", "counting"]
    stage("nobody listens any more")
    assert len(lines) == 2


def test_what_is_refused_leaves_no_line_about_stages(lines):
    """The error is the only line."""
    with pytest.raises(ValueError, match="bad"), narrated(quiet=False):
        stage("reading")
        raise ValueError("bad")
    assert lines == []


def test_a_long_stage_tells_now_and_then_how_far_it_is(lines, monkeypatch):
    """A line each time so many seconds have passed, never more; with progress and time left."""
    monkeypatch.setattr(progress, "BETWEEN_LINES_S", 0.3)
    with narrated(quiet=False) as told:
        stage("counting")
        for done in range(1000):
            told("assessing", done, 4000)
        begin = time.monotonic()
        wait_for(lambda: len(lines) >= 2)
        spent = time.monotonic() - begin
    assert spent >= 0.3
    assert all(line.startswith("counting: ") for line in lines)
    assert "so far, 999 of 4000, " in lines[0]
    assert lines[0].endswith(" left")
    assert "%" not in lines[0]


def test_quiet_says_nothing(lines):
    """Neither stages nor progress."""
    with narrated(quiet=True) as told:
        stage("counting")
        told("assessing", 1, 2)
    assert lines == []


def test_compilation_is_told_when_it_begins_and_once():
    """Said before the first loop is compiled, also in a pipe, and not for each of them."""
    script = (
        "import sys, numpy, numba\n"
        "from fatigue.cli.progress import narrated\n"
        "from fatigue.stages import stage\n"
        "@numba.njit(cache=False)\n"
        "def one(x): return x + 1\n"
        "@numba.njit(cache=False)\n"
        "def two(x): return x + 2\n"
        "with narrated(quiet=False):\n"
        "    stage('counting'); one(1); two(1); one(2)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, env=os.environ | {"PYTHONPATH": str(ROOT)}, capture_output=True,
        text=True, check=True,
    )  # fmt: skip
    first, second = done.stderr.splitlines()
    assert first.startswith("compiling the loops, once for this version on this machine")
    assert "no folder to keep them can be written, so every run will: set NUMBA_CACHE_DIR" in first
    assert second.startswith("counting: done in")


def test_where_compiled_loops_are_kept_is_told_and_logged(lines, caplog):
    """The folder of the first loop that is compiled, on stderr and in the log."""
    with narrated(quiet=False), caplog.at_level("INFO", "fatigue.cli.progress"):
        stage("counting")
        narrator = next(h for h in logging.getLogger(STAGES).handlers if isinstance(h, Narrator))
        narrator.compiling(1, "/some/folder")
        narrator.compiling(-1)
        narrator.compiling(1, "/another")
    assert [line for line in lines if "compiling" in line] == [f"{COMPILING}; kept in /some/folder ..."]
    logged = [record.getMessage() for record in caplog.records if record.name == progress.__name__]
    assert logged == [f"{COMPILING}; kept in /some/folder"]
