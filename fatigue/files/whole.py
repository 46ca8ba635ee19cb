"""Files that are either whole or not there: written beside their place, and moved to it once they are finished."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fatigue.files.mishaps import refused_writing

LONG = 200  # bytes of a name


@contextmanager
def replacing(final: Path, when_full: str = "give the same command again") -> Iterator[Path]:
    """A temporary path to write to; on success it is forced to disk and renamed to ``final`` in one step.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    name = final.name if len(os.fsencode(final.name)) < LONG else ""  # 255 are the most on any disk
    unfinished = final.with_name(f"{name}.{os.getpid()}.unfinished")
    try:
        with refused_writing(final, when_full):
            yield unfinished
            with unfinished.open("rb+") as file:
                os.fsync(file.fileno())
            unfinished.replace(final)
    finally:
        unfinished.unlink(missing_ok=True)


@contextmanager
def staged(folder: Path, prefix: str) -> Iterator[Path]:
    """A hidden folder in a folder, made if need be, to write to; it is gone afterwards, and so is what was made for it.

    Raises
    ------
    DataError : the folder cannot be made, or what is done in it meets a full disk
    """
    made: list[Path] = []
    try:
        with refused_writing(folder):
            made = missing_folders(folder)
            folder.mkdir(parents=True, exist_ok=True)
            stage = Path(tempfile.mkdtemp(prefix=prefix, dir=folder))
            try:
                yield stage
            finally:
                shutil.rmtree(stage, ignore_errors=True)
    finally:
        remove_empty(made)


def missing_folders(folder: Path) -> list[Path]:
    """The folder and those above it that are not there yet, the deepest first."""
    return [path for path in (folder, *folder.parents) if not path.exists()]


def remove_empty(folders: list[Path]) -> None:
    """Remove folders, the deepest first, as long as they are empty."""
    for path in folders:
        try:
            path.rmdir()
        except OSError:  # something is in it, or it was never made
            return
