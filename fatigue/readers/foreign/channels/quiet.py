"""Packages that read a format: what they log, print and warn is left out, what they raise becomes one line."""

import contextlib
import io
import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from traceback import walk_tb
from typing import Any

from fatigue.errors import DataError, Problem


@contextmanager
def quietly(path: Path, package: str, code: str) -> Iterator[None]:
    """Read a file with a package: whatever a damaged file makes of it is one refusal, and nothing else is shown.

    Raises
    ------
    DataError : of this ``code``, if the package raises
    """
    logs = [log for log in _loggers(package) if not log.disabled]
    for log in logs:
        log.disabled = True
    try:
        with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except DataError:
        raise
    except MemoryError:
        what = "it says to hold more values than memory has room for: it is damaged, or too long"
        raise DataError(Problem(code, str(path), what, "Copy the file again, or export fewer channels")) from None
    except Exception as error:
        _give_up(error)
        said = " ".join(str(error).split())[:120] or type(error).__name__
        what = f"the file is damaged or cut: the package {package} says {said!r}"
        raise DataError(Problem(code, str(path), what, "Copy the file again, or export it anew")) from None
    finally:
        for log in logs:
            log.disabled = False


def _loggers(package: str) -> list[logging.Logger]:
    """All loggers of a package, each of which may have a level and an output of its own."""
    logging.getLogger(package)
    known = logging.root.manager.loggerDict.items()
    return [log for name, log in known if f"{name}.".startswith(f"{package}.") and isinstance(log, logging.Logger)]


def _give_up(error: Exception) -> None:
    """Close what the package left half-made: it would raise again when it is collected, and nobody could catch that."""
    for frame, _ in walk_tb(error.__traceback__):
        half_made: Any = frame.f_locals.get("self")
        if hasattr(half_made, "_closed"):
            half_made._closed = True
            for name in ("_file", "_tempfile", "_mapped_file"):
                handle: Any = getattr(half_made, name, None)
                if hasattr(handle, "close"):
                    handle.close()
