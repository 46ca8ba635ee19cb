"""Printing: which browser is taken, and what is said when there is none."""

import os
import stat

import pytest

from fatigue.errors import DataError
from fatigue.report.files.pdf import find_browser, print_pdf


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
    monkeypatch.setattr("fatigue.report.files.pdf.TIME_LIMIT_S", 0.2)
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
