"""Printing: which browser is taken, and what is said when there is none."""

import os
import signal
import stat
import subprocess
import sys
import time
from pathlib import Path

import pytest

from fatigue.errors import DataError
from fatigue.report.files.browser import find_browser
from fatigue.report.files.pdf import print_pdf


def program(path, script):
    """An executable that stands for a browser."""
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


def test_without_any_browser_the_message_says_what_to_do(monkeypatch, tmp_path):
    """Names what was looked for and the way round."""
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("FATIGUE_BROWSER", raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    with pytest.raises(DataError, match=r"no Chromium, Chrome or Edge was found.*print it there"):
        find_browser()


def test_a_named_browser_is_taken_and_no_other(monkeypatch, tmp_path):
    """FATIGUE_BROWSER decides; a wrong one is not silently replaced."""
    monkeypatch.setenv("FATIGUE_BROWSER", str(program(tmp_path / "mine", "true")))
    assert find_browser() == tmp_path / "mine"
    monkeypatch.setenv("FATIGUE_BROWSER", str(tmp_path / "none"))
    with pytest.raises(DataError, match=r"no Chromium.* is at .*none, as FATIGUE_BROWSER says\. Correct it"):
        find_browser()


def test_usual_places_on_other_systems(monkeypatch, tmp_path):
    """Edge is found where Windows keeps it."""
    edge = tmp_path / r"Microsoft\Edge\Application\msedge.exe"
    edge.parent.mkdir(parents=True, exist_ok=True)
    edge.write_text("")
    monkeypatch.delenv("FATIGUE_BROWSER", raising=False)
    monkeypatch.setenv("PATH", "")
    monkeypatch.setenv("PROGRAMFILES", str(tmp_path))
    monkeypatch.setattr("sys.platform", "win32")
    assert find_browser() == edge


def test_a_browser_that_fails_is_reported_with_its_last_words(monkeypatch, tmp_path):
    """No half-written file is left behind."""
    page = tmp_path / "report.html"
    page.write_text("<p>")
    monkeypatch.setenv("FATIGUE_BROWSER", str(program(tmp_path / "broken", "echo no display >&2; exit 3")))
    with pytest.raises(DataError, match=r"could not print the page .no display.. Open report.html in any browser"):
        print_pdf(page, tmp_path / "report.pdf")
    assert not (tmp_path / "report.pdf").exists()


def test_a_browser_that_hangs_is_stopped(monkeypatch, tmp_path):
    """The time limit ends it, and the message says so."""
    page = tmp_path / "report.html"
    page.write_text("<p>")
    monkeypatch.setenv("FATIGUE_BROWSER", str(program(tmp_path / "slow", "exec sleep 30")))
    monkeypatch.setattr("fatigue.report.files.browser.TIME_LIMIT_S", 0.2)
    with pytest.raises(DataError, match="not done after"):
        print_pdf(page, tmp_path / "report.pdf")


def test_without_page_there_is_nothing_to_print(tmp_path):
    """The message names the page."""
    with pytest.raises(DataError, match=r"report\.html: there is no such page"):
        print_pdf(tmp_path / "report.html", tmp_path / "report.pdf")


def test_the_page_is_printed_whole(monkeypatch, tmp_path):
    """The browser gets the address that makes the page draw everything, and its file is taken over."""
    page = tmp_path / "my report.html"
    page.write_text("<p>")
    said = tmp_path / "said"
    to_file = 'case "$a" in --print-to-pdf=*) echo "%PDF" > "${a#*=}";; esac'
    script = f'printf "%s\\n" "$@" > {said}\nfor a in "$@"; do {to_file}; done'
    monkeypatch.setenv("FATIGUE_BROWSER", str(program(tmp_path / "good", script)))
    print_pdf(page, tmp_path / "report.pdf")
    assert (tmp_path / "report.pdf").read_text() == "%PDF\n"
    arguments = said.read_text().splitlines()
    assert arguments[-1].endswith("my%20report.html#print")
    assert ("--no-sandbox" in arguments) == (os.geteuid() == 0)


@pytest.mark.skipif(os.name == "nt", reason="Windows has other signals")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_ends_the_browser_with_its_helpers(tmp_path, number):
    """Neither a process nor a profile of it is left, and no half page."""
    (tmp_path / "tmp").mkdir()
    (tmp_path / "report.html").write_text("<p>")
    mine = program(tmp_path / "mine", f'sleep 100 & echo $! > {tmp_path}/helper.part; mv {tmp_path}/helper.part '
                   f"{tmp_path}/helper; wait")  # fmt: skip
    code = (
        "from fatigue.cli.ends import end_orderly; from fatigue.report.files.pdf import print_pdf; end_orderly(); "
        f"print_pdf({str(tmp_path / 'report.html')!r}, {str(tmp_path / 'report.pdf')!r})"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        env=os.environ | {"FATIGUE_BROWSER": str(mine), "TMPDIR": str(tmp_path / "tmp")},
        stderr=subprocess.DEVNULL,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # noqa: PLW1509 (no threads here)
    )
    while process.poll() is None and not (tmp_path / "helper").exists():
        time.sleep(0.01)
    process.send_signal(number)
    process.wait(30)
    helper = int((tmp_path / "helper").read_text())
    for _ in range(500):
        if not _runs(helper):
            break
        time.sleep(0.01)
    assert not _runs(helper)
    assert not list((tmp_path / "tmp").iterdir())
    assert not (tmp_path / "report.pdf").exists()


def _runs(process):
    """Whether a process is there that has not ended."""
    try:
        return Path(f"/proc/{process}/stat").read_text().split()[2] != "Z"
    except OSError:
        return False
