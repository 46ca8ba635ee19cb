"""Print the report: the same page on paper, by a Chromium, Chrome or Edge that is installed."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fatigue.errors import DataError, Problem
from fatigue.files.mishaps import reason, refused_writing

BROWSERS = (
    "chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "microsoft-edge",
    "microsoft-edge-stable", "msedge",
)  # fmt: skip
_MAC = ("Google Chrome", "Chromium", "Microsoft Edge")
_WINDOWS = (r"Google\Chrome\Application\chrome.exe", r"Microsoft\Edge\Application\msedge.exe")
TIME_LIMIT_S = 300.0
INTERRUPTS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
OF_ITS_OWN: dict[str, Any] = {"start_new_session": True} if os.name == "posix" else {}  # group of processes


def print_pdf(html: Path | str, pdf: Path | str, comment: str = "") -> None:
    """Print a report to PDF: all figures and details, paginated for A4; ``comment`` goes into its last line.

    The page draws all its figures before it has finished loading when its address ends in ``#print``.

    Raises
    ------
    DataError : no browser is installed, it fails, or there is no such page
    """
    html, pdf = Path(html), Path(pdf)
    if not html.is_file():
        raise DataError(Problem("missing_file", str(html), "there is no such page", "Write the report first"))
    browser = find_browser()
    with tempfile.TemporaryDirectory(prefix="fatigue-", ignore_cleanup_errors=True) as profile:
        printed = Path(profile) / "report.pdf"
        command = [
            str(browser),
            "--headless",
            f"--user-data-dir={profile}",
            "--no-first-run",
            "--disable-gpu",
            "--disable-background-networking",
            "--no-pdf-header-footer",
            f"--print-to-pdf={printed}",
            *(["--no-sandbox"] if _is_root() else []),
            f"{html.resolve().as_uri()}#print",
        ]
        said = _run(command, profile)
        if not printed.is_file():
            raise DataError(
                Problem(
                    "no_pdf",
                    str(browser),
                    f"could not print the page ({said})",
                    f"Open {html.name} in any browser and print it there",
                )
            )
        with refused_writing(pdf):
            shutil.copyfile(printed, pdf)
            if comment:  # a comment behind the end marker is allowed (ISO 32000-1, 7.2.4 and 7.5.5)
                with pdf.open("ab") as file:
                    file.write(f"% {comment}\n".encode("ascii"))


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


def find_browser() -> Path:
    """Browser that can print a page.

    ``FATIGUE_BROWSER`` names one that is not in its usual place.

    Raises
    ------
    DataError : there is none
    """
    for candidate in _candidates():
        if candidate.is_file():
            return candidate
    if named := os.environ.get("FATIGUE_BROWSER"):
        what, remedy = f"no Chromium, Chrome or Edge is at {named}, as FATIGUE_BROWSER says", "Correct it, or unset it"
        raise DataError(Problem("no_browser", "PDF", what, remedy))
    raise DataError(
        Problem(
            "no_browser",
            "PDF",
            "no Chromium, Chrome or Edge was found to print the page",
            "Install one, name it in FATIGUE_BROWSER, or open report.html in any browser and print it there",
        )
    )


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
