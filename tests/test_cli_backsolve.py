"""What the command line says of what just meets the target, and what it refuses."""

import json

import pytest

from tests.command_line import fatigue


def test_answers_are_told_and_written(small_result, tmp_path):
    """Words for people, JSON for machines, table and page; exit code 1 where nothing meets the target."""
    done = fatigue("backsolve", small_result, "--for", "load")
    assert done.returncode == 0, done.stderr
    assert "1 000 000 km allow a load factor of at most" in done.stdout.replace("\u202f", " ")
    assert "|u - 1|" in done.stdout
    done = fatigue(
        "backsolve", small_result, "--for", "share:noise", "--target", "1e15", "--json", "-o", tmp_path / "out"
    )
    assert done.returncode == 1, done.stderr
    again = ("backsolve", small_result, "--for", "share:noise", "--target", "1e15", "--exit-zero")
    assert fatigue(*again).returncode == 0
    found = json.loads(done.stdout)
    assert found["solved"] is False
    assert found["rows"][0]["answer"] is None
    assert found["rows"][0]["utilisation_at_0"] > 1.0
    assert found["asked"]["event"] == "noise"
    assert str(tmp_path / "out" / "backsolve.html") in found["written"]
    page = (tmp_path / "out" / "backsolve.html").read_text(encoding="utf-8")
    assert "small case" in page


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        ((), 2, "Missing option '--for'"),
        (("--for", "load", "--csv"), 2, "name their folder with -o"),
        (("--for", "mass"), 3, "nothing is solved for 'mass'"),
        (("--for", "share:nobody"), 3, "the mission has no event 'nobody'"),
        (("--for", "share:load and unload"), 3, "is counted by number"),
        (("--for", "load", "--target", "never"), 3, "'never' is no target above 0"),
    ],
)
def test_wrong_questions(small_result, options, code, words):
    """Exit code 2 for usage, 3 for what the result does not have."""
    done = fatigue("backsolve", small_result, *options)
    assert (done.returncode, words in done.stderr) == (code, True), done.stderr


def test_no_result(tmp_path):
    """A folder without result is named."""
    done = fatigue("backsolve", tmp_path, "--for", "load")
    assert (done.returncode, "no finished result" in done.stderr) == (3, True)
