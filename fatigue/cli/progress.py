"""How far a command has come, for whoever waits at a terminal."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import click


@contextmanager
def progress_bar(*, quiet: bool) -> Iterator[Callable[[str, int, int], None]]:
    """Give a progress callback: a bar with time left, on stderr and only on a terminal."""
    if quiet or not sys.stderr.isatty():
        yield lambda label, done, total: None
        return
    bars: dict[str, Any] = {}

    def progress(label: str, done: int, total: int) -> None:
        if label not in bars:
            bars[label] = click.progressbar(length=total, label=label, file=sys.stderr, show_eta=True)
            bars[label].__enter__()
        bars[label].update(done - bars[label].pos)
        if done == total:
            bars.pop(label).__exit__(None, None, None)

    try:
        yield progress
    finally:
        for bar in bars.values():
            bar.__exit__(None, None, None)
