"""Standard output and error that never stop a command for what they are connected to.

A reader that went away, as ``| head`` does, wants no more of it: the command goes on to its own exit code. A full disk
behind standard output is told by name. A letter that the terminal cannot show is written as its escape.
"""

import io
import os
import sys
from typing import Any, TextIO

OUTPUT = "standard output"


class _Output(io.TextIOWrapper):
    """Standard output whose errors name it."""

    def write(self, text: str, /) -> int:
        try:
            return super().write(text)
        except OSError as error:
            return self._refused(error, len(text))

    def flush(self) -> None:
        try:
            super().flush()
        except OSError as error:
            self._refused(error, 0)

    def _refused(self, error: OSError, written: int) -> int:
        if isinstance(error, BrokenPipeError):
            silence(self)
            return written
        error.filename = OUTPUT
        raise error


class _Errors(io.TextIOWrapper):
    """Standard error, of which nobody can be told that it does not work."""

    def write(self, text: str, /) -> int:
        try:
            return super().write(text)
        except OSError:
            silence(self)
            return len(text)

    def flush(self) -> None:
        try:
            super().flush()
        except OSError:
            silence(self)


def prepare_streams() -> None:
    """Replace the streams of the process, unless a caller has put others in their place."""
    if sys.stdout is sys.__stdout__ and sys.stdout is not None:
        sys.stdout = _like(_Output, sys.stdout)
    if sys.stderr is sys.__stderr__ and sys.stderr is not None:
        sys.stderr = _like(_Errors, sys.stderr)


def shows_every_letter(stream: TextIO | Any) -> bool:
    """Whether a stream can take any letter, as those in UTF-8 and those in memory can."""
    return (getattr(stream, "encoding", None) or "utf-8").lower().replace("-", "").startswith("utf")


def _like(kind: type[io.TextIOWrapper], stream: Any) -> Any:
    """A stream of another kind on the same bytes; bytes of a path that are no text stay what they are."""
    escape = "surrogateescape" if shows_every_letter(stream) else "backslashreplace"
    return kind(stream.buffer, stream.encoding, escape, line_buffering=stream.line_buffering, write_through=True)


def silence(stream: TextIO | io.TextIOWrapper) -> None:
    """Let the rest of what is written to a stream, also at the end of the process, go nowhere."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, stream.fileno())
    os.close(nowhere)
