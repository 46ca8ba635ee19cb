"""Pictures of pages: what the browser is asked, and what is said when it fails."""

import os
import stat

import pytest

from fatigue.errors import DataError
from fatigue.report.files.png import draw_png


def program(path, script):
    """An executable that stands for a browser."""
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


@pytest.mark.skipif(os.name == "nt", reason="a script stands for the browser")
def test_the_page_is_drawn_in_its_size(monkeypatch, tmp_path):
    """The window has the size of the page, and the picture is taken over."""
    said = tmp_path / "said"
    to_file = 'case "$a" in --screenshot=*) echo "PNG" > "${a#*=}";; file:*) cp "${a#file://}" page;; esac'
    script = f'cd {tmp_path}; printf "%s\\n" "$@" > {said}\nfor a in "$@"; do {to_file}; done'
    monkeypatch.setenv("FATIGUE_BROWSER", str(program(tmp_path / "good", script)))
    draw_png("<p>\u202e", tmp_path / "picture.png", 700)
    assert (tmp_path / "picture.png").read_text() == "PNG\n"
    assert (tmp_path / "page").read_text(encoding="utf-8") == "<p>\u202e"
    assert "--window-size=1600,700" in said.read_text().splitlines()


@pytest.mark.skipif(os.name == "nt", reason="a script stands for the browser")
def test_a_browser_that_fails_is_reported(monkeypatch, tmp_path):
    """With its last words and the way round; no picture is left."""
    monkeypatch.setenv("FATIGUE_BROWSER", str(program(tmp_path / "broken", "echo no display >&2; exit 3")))
    with pytest.raises(DataError, match=r"could not draw the page .no display.. Write the page as HTML"):
        draw_png("<p>", tmp_path / "picture.png", 700)
    assert not (tmp_path / "picture.png").exists()
