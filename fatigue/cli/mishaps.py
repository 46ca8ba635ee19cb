"""What is no fault of program or case: what the machine refused, in one line, with an exit code of its own.

Whatever reaches the command line from the operating system, from memory or from a terminal that cannot show a letter
becomes a ``Problem`` here. ``fatigue -v`` shows the traceback as well.
"""

import errno
import re

from fatigue.errors import DataError, NumericalError, Problem
from fatigue.files.mishaps import refusal

BAD_DATA, FAILED = DataError.exit_code, NumericalError.exit_code
NO_ROOM = re.compile("failed to map segment|cannot allocate memory|Could not find/load shared", re.IGNORECASE)
NO_MEMORY = Problem(
    "memory",
    "memory",
    "the program got no more of it",
    "Close other programs, raise a limit (`ulimit -v`), use fewer --threads, or assess fewer welds at once",
)
NO_THREADS = Problem(
    "threads",
    "threads",
    "the system starts no more of them",
    "Raise a limit (`ulimit -u`, `ulimit -v`), or use fewer --threads",
)
NESTED = Problem(
    "nested", "a file", "tables, lists or includes lie in one another without end", "Look for one that is broken"
)
DIGITS = Problem("digits", "a file", "an integer has thousands of digits", "Look for one that is broken")


def mishap(error: BaseException) -> tuple[Problem | None, int]:
    """What the machine refused, None where the program itself is at fault; and the exit code."""
    number, text = getattr(error, "errno", None), str(error)
    found, code = None, FAILED
    match error:
        case MemoryError() | OSError(errno=errno.ENOMEM):  # numpy's and Arrow's are kinds of it
            found = NO_MEMORY
        case ImportError() | OSError() if number is None and NO_ROOM.search(text):  # for a library
            found = NO_MEMORY
        case RuntimeError() | OSError() if number == errno.EAGAIN or "can't start new thread" in text:
            found = NO_THREADS
        case OSError():
            found, code = refusal(error), BAD_DATA
        case RecursionError():
            found, code = NESTED, BAD_DATA
        case UnicodeEncodeError():
            found, code = _unwritable_letter(error), BAD_DATA
        case ValueError() if "integer string conversion" in text:
            found, code = DIGITS, BAD_DATA
        case ModuleNotFoundError() if error.name and "." not in error.name:
            found = Problem("package", error.name, "the package is not installed", "Install the program again with pip")
    return found, code


def _unwritable_letter(error: UnicodeEncodeError) -> Problem:
    letter = error.object[error.start : error.end][:10]
    what = f"{letter!r} cannot be written in the encoding {error.encoding}"
    return Problem("encoding", "a name", what, "Use other letters, or set PYTHONUTF8=1")
