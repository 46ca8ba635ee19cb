"""Ends of a process that come from outside: Ctrl-C, the end of a session or of a batch job.

All of them go the way of an error: what is half written is removed, children are ended, finished groups of welds stay.
A second one ends the process at once.
"""

import os
import signal
import sys
from types import FrameType
from typing import NoReturn

HANDLED = ("SIGTERM", "SIGHUP")  # SIGINT has its exception; Windows has no SIGHUP


class Ended(KeyboardInterrupt):
    """The process was told to end; ``number`` is that of the signal."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.number = number


def end_orderly() -> None:
    """Have the signals raise ``Ended``, those that are not ignored, as ``nohup`` ignores one."""
    for number in (getattr(signal, name) for name in HANDLED if hasattr(signal, name)):
        if signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, _raise)


def leave(error: KeyboardInterrupt) -> NoReturn:
    """End the process with the exit code of its signal, 130 for Ctrl-C; threads under way are not waited for."""
    code = 128 + (error.number if isinstance(error, Ended) else signal.SIGINT)
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
    os._exit(code)


def _raise(number: int, _: FrameType | None) -> NoReturn:
    signal.signal(number, signal.SIG_DFL)
    raise Ended(number)
