"""What the operating system refuses, in words: a full disk, a file too large, a name too long, too many open files."""

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fatigue.errors import DataError, Problem

FULL = (errno.ENOSPC, errno.EDQUOT)
LONGEST_SHOWN = 400  # letters of a path; no name is longer than 255

REMEDIES = {
    errno.ENOSPC: "Make room, and give the same command again",
    errno.EDQUOT: "Make room, and give the same command again",
    errno.EFBIG: "Raise the largest size of a file (`ulimit -f`), or give a folder on a disk that takes larger ones",
    errno.EMFILE: "Raise the number of files that a program may open, as `ulimit -n 1024` does, or use fewer --threads",
    errno.ENFILE: "Close other programs: this computer has too many open files",
    errno.EROFS: "Give a folder you may write to",
    errno.ENAMETOOLONG: "Give a shorter name",
    errno.EIO: "Copy the files to another disk: this one, or the way to it, fails",
    errno.ESTALE: "Connect the network drive again, and give the same command again",
}


def refusal(error: OSError, path: Path | str | None = None) -> Problem:
    """Refusal of a file that the system does not let be read or written: place, reason and remedy.

    ``path`` is where it was met, by default the file that the error names.
    """
    place = str(path or error.filename or "a file")
    if error.errno == errno.ENOENT and error.filename and not Path(place).parent.is_dir():
        return _no_folder("system", Path(place))
    what = "cannot be written" if error.errno in FULL else "cannot be read or written"
    remedy = REMEDIES.get(error.errno or 0, "Correct the path, or give one that you may read and write")
    return Problem("system", shown(place), f"{what} ({reason(error)})", remedy)


def _no_folder(code: str, path: Path) -> Problem:
    return Problem(code, shown(str(path)), f"there is no folder {path.parent}", "Make it, or correct the path")


def reason(error: OSError) -> str:
    """What the system says, without the words of the library that it was said to."""
    said = error.strerror or str(error) or type(error).__name__
    return os.strerror(error.errno) if error.errno and "[errno" in said else said


def shown(path: str) -> str:
    """Path as a message shows it, one that no file can have without its middle."""
    half = LONGEST_SHOWN // 2
    return path if len(path) <= LONGEST_SHOWN else f"{path[:half]} ... {path[-half:]}"


def cannot_write(path: Path | str, error: OSError, when_full: str = "give the same command again") -> DataError:
    """Error of a file or folder that cannot be written; ``when_full``: what to do once there is room."""
    what, remedy = "the disk is full", f"Free some space and {when_full}"
    if error.errno == errno.ENOENT and not Path(path).parent.is_dir():
        return DataError(_no_folder("cannot_write", Path(path)))
    if error.errno not in FULL:
        what = f"cannot be written ({reason(error)})"
        remedy = REMEDIES.get(error.errno or 0, "Give a folder you may write to")
    return DataError(Problem("cannot_write", shown(str(path)), what, remedy))


@contextmanager
def refused_writing(path: Path | str, when_full: str = "give the same command again") -> Iterator[None]:
    """Tell in the words of the program why a file or folder cannot be written.

    Raises
    ------
    DataError : the system refuses to write it
    """
    try:
        yield
    except OSError as error:
        raise cannot_write(path, error, when_full) from error


def is_of_the_system(error: BaseException) -> bool:
    """Whether the system refused to read a file, for want of rights or of open files; a damaged one has no number."""
    return isinstance(error, OSError) and error.errno is not None
