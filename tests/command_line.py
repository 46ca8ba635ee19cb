"""The command line called in the process of the tests, as one of its own takes a second to begin; and in its own."""

import contextlib
import io
import logging
import os
import signal
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from unittest.mock import patch

from fatigue.cli.ends import HANDLED
from fatigue.stages import STAGES

ROOT = Path(__file__).parents[1]


def fatigue(*arguments, cwd=None):
    """Exit code, stdout and stderr of the program; log, signals and working directory are left as they were."""
    words = ["fatigue", *map(str, arguments)]
    streams = [io.TextIOWrapper(io.BytesIO(), encoding="utf-8", write_through=True) for _ in range(2)]
    program = import_module("fatigue.cli.main")
    code = 0
    with (
        _log_and_signals_kept(),
        contextlib.chdir(cwd or ROOT),
        contextlib.redirect_stdout(streams[0]),
        contextlib.redirect_stderr(streams[1]),
        patch.object(sys, "argv", words),
        patch.object(program, "hold_little"),  # it is about the heap of the whole process
        patch.object(program, "leave", side_effect=KeyboardInterrupt),  # Ctrl-C ends all tests, and orderly
    ):
        try:
            program.main()
        except SystemExit as end:
            code = end.code or 0
    return subprocess.CompletedProcess(words, code, *(stream.buffer.getvalue().decode() for stream in streams))


def assess(*arguments):
    """Assess without the report, which has tests of its own."""
    return fatigue("assess", *arguments, "--no-report")


def fatigue_alone(*arguments):
    """Run the program in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "fatigue", *map(str, arguments)],
        cwd=ROOT,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )


@contextlib.contextmanager
def _log_and_signals_kept():
    logs = [logging.getLogger(name) for name in ("fatigue", STAGES)]
    before = [(log, log.handlers[:], log.level) for log in logs]
    signals = {number: signal.getsignal(number) for name in HANDLED if (number := getattr(signal, name, None))}
    try:
        yield
    finally:
        for log, handlers, level in before:
            log.handlers[:] = handlers
            log.setLevel(level)
        for number, handler in signals.items():
            signal.signal(number, handler)
