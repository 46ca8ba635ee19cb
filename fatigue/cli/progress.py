"""What a command is doing and how far it has come, on stderr: for whoever waits at a terminal, and for log files."""

import logging
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any, TypeVar

import click

from fatigue.shown import visible
from fatigue.stages import STAGES

Given = TypeVar("Given")
Result = TypeVar("Result")
Progress = Callable[[str, int, int], None]

log = logging.getLogger(__name__)

BETWEEN_LINES_S = 10.0  # in a file or a pipe
COMPILING = "compiling the loops, once for this version on this machine: some 6 s for a small job, more for large ones"
NOT_KEPT = "; no folder to keep them can be written, so every run will: set NUMBA_CACHE_DIR to one"


def is_quiet() -> bool:
    """Whether the program was started with ``-q``."""
    return bool(click.get_current_context().obj["quiet"])


@contextmanager
def narrated(*, quiet: bool) -> Iterator[Progress]:
    """Tell the stages of a command on stderr, and give a progress callback.

    On a terminal each stage is a line when it begins, and progress is a bar with time left. Elsewhere a stage is a line
    with its duration when it is over, and a long one a line now and then; what is refused at once is not told at all.
    That code is being compiled is told when it begins. Quiet: nothing.
    """
    if quiet:
        yield lambda label, done, total: None
        return
    narrator = Narrator(on_terminal=sys.stderr.isatty())
    logger = logging.getLogger(STAGES)
    with ExitStack() as stack:
        logger.addHandler(narrator)
        stack.callback(logger.removeHandler, narrator)
        stack.callback(logger.setLevel, logger.level)
        logger.setLevel(logging.INFO)
        stack.enter_context(_told_compilations(narrator))
        stack.callback(narrator.stop)
        yield narrator.progress
        narrator.end()


def narrating(do: Callable[[Given], Result]) -> Callable[[Given], Result]:
    """Tell the stages of a function while it runs."""

    def told(given: Given) -> Result:
        with narrated(quiet=is_quiet()):
            return do(given)

    return told


class Narrator(logging.Handler):
    """Turns stages, progress and compilations into lines and bars on stderr."""

    def __init__(self, *, on_terminal: bool) -> None:
        super().__init__()
        self._on_terminal = on_terminal
        self._bars: dict[str, Any] = {}
        self._stage, self._begin = "", time.monotonic()
        self._how_far = ""
        self._compiling = 0
        self._told_compiling = False
        self._last_line = self._begin
        self._over = threading.Event()
        if not on_terminal:
            threading.Thread(target=self._now_and_then, name="fatigue-progress", daemon=True).start()

    def emit(self, record: logging.LogRecord) -> None:
        """Begin a stage."""
        self.end()
        self._stage, self._begin, self._how_far = record.getMessage(), time.monotonic(), ""
        if self._on_terminal:
            self._line(f"{self._stage} ...")

    def end(self) -> None:
        """Tell that the stage is over, where nobody saw it going on."""
        if self._stage and not self._on_terminal:
            self._line(f"{self._stage}: done in {_seconds(time.monotonic() - self._begin)}")
        self._stage = ""

    def stop(self) -> None:
        """Say nothing more, and leave no bar unfinished."""
        self._over.set()
        for bar in self._bars.values():
            bar.__exit__(None, None, None)
        self._bars.clear()

    def progress(self, label: str, done: int, total: int) -> None:
        """Show that so much of the whole is done."""
        if not self._on_terminal:
            spent = time.monotonic() - self._begin
            left = f", {_seconds(spent * (total - done) / done)} left" if 0 < done < total else ""
            self._how_far = f", {done} of {total}{left}"
            return
        if label not in self._bars:
            self._bars[label] = click.progressbar(length=total, label=label, file=sys.stderr, show_eta=True)
            self._bars[label].__enter__()
        self._bars[label].update(done - self._bars[label].pos)
        if done == total:
            self._bars.pop(label).__exit__(None, None, None)

    def compiling(self, functions: int, kept_in: str | None = None) -> None:
        """Count functions that are being compiled: one more, for the folder they are ``kept_in``, or one less."""
        self._compiling += functions
        if functions > 0 and not self._told_compiling:
            self._told_compiling = True
            said = COMPILING + (f"; kept in {kept_in}" if kept_in else NOT_KEPT)
            self._line(f"{said} ...")
            log.info("%s", said)

    def _line(self, text: str) -> None:
        self._last_line = time.monotonic()
        click.echo(visible(text), err=True)

    def _now_and_then(self) -> None:
        """Tell that something still goes on when there has been no line for a while."""
        while not self._over.wait(BETWEEN_LINES_S / 10.0):
            now = time.monotonic()
            if now - self._last_line >= BETWEEN_LINES_S:
                doing = "compiling" if self._compiling else self._stage or "working"
                how_far = "" if self._compiling else self._how_far
                self._line(f"{doing}: {_seconds(now - self._begin)} so far{how_far}")


@contextmanager
def _told_compilations(narrator: Narrator) -> Iterator[None]:
    """Have numba tell when it compiles; what it reads from disk it does not compile."""
    try:
        from numba.core import event
    except ImportError:
        yield
        return

    class Listener(event.Listener):
        """Counts begins and ends."""

        def on_start(self, what: Any) -> None:
            kept = getattr(what.data["dispatcher"], "_cache", None)
            narrator.compiling(1, getattr(kept, "cache_path", None))

        def on_end(self, _: Any) -> None:
            narrator.compiling(-1)

    with event.install_listener("numba:compile", Listener()):
        yield


def _seconds(duration: float) -> str:
    if duration < 9.95:
        return f"{duration:.1f} s"
    return f"{duration:.0f} s" if duration < 120.0 else f"{duration / 60.0:.0f} min"
