"""A browser without a window, for what only a browser can do: where one is, and how it is run to its end."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fatigue.errors import DataError, Problem
from fatigue.files.mishaps import reason

BROWSERS = (
    "chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "microsoft-edge",
    "microsoft-edge-stable", "msedge",
)  # fmt: skip
_MAC = ("Google Chrome", "Chromium", "Microsoft Edge")
_WINDOWS = (r"Google\Chrome\Application\chrome.exe", r"Microsoft\Edge\Application\msedge.exe")
TIME_LIMIT_S = 300.0
INTERRUPTS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
OF_ITS_OWN: dict[str, Any] = {"start_new_session": True} if os.name == "posix" else {}  # group of processes


def run_browser(browser: Path, options: Sequence[str], address: str, scratch: str) -> str:
    """Open an address in a browser without a window, and return the last words of the browser.

    ``options`` say what it makes of the page; ``scratch`` is an empty folder for its profile.
    """
    command = [
        str(browser),
        "--headless",
        f"--user-data-dir={scratch}",
        "--no-first-run",
        "--disable-gpu",
        "--disable-background-networking",
        *options,
        *(["--no-sandbox"] if _is_root() else []),
        address,
    ]
    return _run(command, scratch)


def _run(command: list[str], scratch: str) -> str:
    """Run a browser to its end, and return its last words; whatever stops this one ends it with all its helpers."""
    surroundings = os.environ | {"TMPDIR": scratch}  # else it leaves a folder there when it is ended
    with tempfile.TemporaryFile() as words:
        process = None
        try:
            with _held_back():
                process = subprocess.Popen(
                    command, stdout=words, stderr=words, stdin=subprocess.DEVNULL, env=surroundings, **OF_ITS_OWN
                )
            process.wait(TIME_LIMIT_S)
        except OSError as error:
            return reason(error)
        except subprocess.TimeoutExpired:
            return f"not done after {TIME_LIMIT_S:g} s"
        finally:
            if process is not None:
                _end(process)
        words.seek(0)
        lines = words.read().decode(errors="replace").strip().splitlines()
    return lines[-1] if lines else f"exit code {process.returncode}"


@contextmanager
def _held_back() -> Iterator[None]:
    """Let an interrupt wait: of a process that is being started nobody knows the number yet, so none could end it."""
    if threading.current_thread() is not threading.main_thread():  # others are not interrupted
        yield
        return
    waiting: list[int] = []
    handlers = {one: signal.signal(one, lambda number, _: waiting.append(number)) for one in INTERRUPTS}
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        for number in waiting:
            signal.raise_signal(number)


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a process and the group it leads; helpers that outlive it would write to a profile that is removed."""
    try:
        if OF_ITS_OWN:
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
    except (ProcessLookupError, PermissionError):  # all of them are gone
        pass
    process.wait()


def find_browser(wanted: str = "PDF", instead: str = "open report.html in any browser and print it there") -> Path:
    """Browser that can draw a page.

    ``FATIGUE_BROWSER`` names one that is not in its usual place. ``wanted`` is what it is needed for, ``instead`` what
    to do without one.

    Raises
    ------
    DataError : there is none
    """
    for candidate in _candidates():
        if candidate.is_file():
            return candidate
    if named := os.environ.get("FATIGUE_BROWSER"):
        what, remedy = f"no Chromium, Chrome or Edge is at {named}, as FATIGUE_BROWSER says", "Correct it, or unset it"
        raise DataError(Problem("no_browser", wanted, what, remedy))
    what = "no Chromium, Chrome or Edge was found to draw the page"
    raise DataError(Problem("no_browser", wanted, what, f"Install one, name it in FATIGUE_BROWSER, or {instead}"))


def _candidates() -> Iterator[Path]:
    if named := os.environ.get("FATIGUE_BROWSER"):
        yield Path(named)
        return  # who names a browser wants that one
    yield from (Path(found) for name in BROWSERS if (found := shutil.which(name)))
    if sys.platform == "darwin":
        yield from (Path(f"/Applications/{name}.app/Contents/MacOS/{name}") for name in _MAC)
    if sys.platform == "win32":
        roots = [os.environ.get(name) for name in ("PROGRAMFILES", "PROGRAMFILES(X86)", "LOCALAPPDATA")]
        yield from (Path(root) / name for root in roots if root for name in _WINDOWS)


def _is_root() -> bool:
    """Chromium refuses its sandbox to root, as in a container."""
    return hasattr(os, "geteuid") and os.geteuid() == 0
