"""Things that come a few at a time and are written so many at once."""

from collections.abc import Callable, Sequence
from typing import Generic, TypeVar

T = TypeVar("T")


class Batches(Generic[T]):
    """Hands on what comes a few at a time, in its order, always ``at_once`` of them; the rest when it is flushed."""

    def __init__(self, at_once: int, write: Callable[[Sequence[T]], None]) -> None:
        self._at_once, self._write = at_once, write
        self._waiting: list[T] = []

    def add(self, some: Sequence[T]) -> None:
        """Have some more written, sooner or later."""
        self._waiting += some
        while len(self._waiting) >= self._at_once:
            self._write(self._waiting[: self._at_once])
            self._waiting = self._waiting[self._at_once :]

    def flush(self) -> None:
        """Write what is waiting."""
        if self._waiting:
            self._write(self._waiting)
        self._waiting = []
