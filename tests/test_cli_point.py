"""What the command line says of any point, and what it refuses."""

import json

import pandas as pd
import pytest

from tests.command_line import assess, fatigue
from tests.small_case import small_case


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A result of its own, without diagnosis."""
    folder = tmp_path_factory.mktemp("cli")
    done = assess(small_case(seconds=6.0).write(folder / "case"), "-o", folder / "result", "--threads", "1")
    assert done.returncode in {0, 1}, done.stderr
    return folder / "result"


def test_words_for_people(result):
    """Where it is, its numbers, its worst cycles, where the damage comes from, and whether it was met again."""
    done = fatigue("point", result, "--weld", "A", "--order", "3", "--surface", "bottom")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("small case: A, part 1, order 3, node 102, bottom face\n")
    for words in ("Utilisation, damage", "Most damaging of", "Where the damage comes from", "  event ", "  lever "):
        assert words in done.stdout
    assert "Counted again: agrees with the result" in done.stdout
    assert "counting the point and sharing out its damage" in done.stderr
    assert max(map(len, done.stdout.splitlines())) < 200


def test_json_for_machines(result):
    """The numbers are those of the tables."""
    done = fatigue("-q", "point", result, "--weld", "B", "--node", "203", "--json", "--threads", "1")
    found = json.loads(done.stdout)
    nodes = pd.read_parquet(result / "nodes.parquet").set_index(["weld", "node", "surface"])
    assert found["stored"]["life_km"] == nodes.loc[("B", 203, found["surface"]), "life_km"]
    assert found["counted"]["life_km"] == pytest.approx(found["stored"]["life_km"], rel=1e-12)
    assert found["agrees"] is True
    assert found["file"] is None
    assert done.stderr == ""


def test_a_page(result, tmp_path):
    """Its path is the last line."""
    page = tmp_path / "new" / "point.html"
    done = fatigue("point", result, "--weld", "A", "-o", page)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == str(page)
    assert page.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    again = fatigue("point", result, "--weld", "A", "-o", page)
    assert again.returncode == 3
    assert "is there already" in again.stderr
    assert "--force" in again.stderr


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        ((), 2, "Missing option '--weld'"),
        (("--weld", "A", "--surface", "left"), 2, "'left' is not one of 'top', 'bottom'"),
        (("--weld", "A", "--order", "two"), 2, "'two' is not a valid integer"),
        (("--weld", "A", "--threads", "0"), 2, "0 is not in the range"),
        (("--weld", "C"), 3, "Name one of 'A', 'B'"),
        (("--weld", "A", "--order", "8"), 3, "has no order 8. Take one of its orders: 1, 2, 3, 4, 5, 6, 7"),
        (("--weld", "A", "--node", "203"), 3, "has no node 203, which is of 'B'"),
        (
            ("--weld", "A", "-o", "point.docx"),
            2,
            "'point.docx' does not end in .html or .png; a PDF is printed from the page",
        ),
        (("--weld", "A", "--case", "nowhere.toml"), 3, "nowhere.toml"),
    ],
)
def test_mistakes_are_one_line(result, options, code, words):
    """Wrong usage is 2, what does not fit the result is 3."""
    done = fatigue("-q", "point", result, *options)
    assert done.returncode == code, done.stderr
    assert words in done.stderr
    assert "Traceback" not in done.stderr
    assert done.stdout == ""


def test_without_a_result(tmp_path):
    """The folder is named, and what makes a result."""
    done = fatigue("point", tmp_path, "--weld", "A")
    assert done.returncode == 3
    assert "no finished result" in done.stderr


def test_without_a_browser(result, tmp_path, monkeypatch):
    """One clear line that offers the page."""
    monkeypatch.setenv("FATIGUE_BROWSER", str(tmp_path / "none"))
    done = fatigue("-q", "point", result, "--weld", "A", "-o", tmp_path / "point.png")
    assert done.returncode == 3
    assert len(done.stderr.splitlines()) == 1
    assert "PNG: no Chromium, Chrome or Edge is at" in done.stderr
