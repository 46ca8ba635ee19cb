"""What the command line says of reducing a body, and what it refuses."""

import json

import pandas as pd
import pytest

from tests.command_line import fatigue
from tests.reduce.small_body import write_model


def test_reduce_is_told_and_written(tmp_path):
    """Words for people with progress on stderr, JSON for machines; a doubt is told once; files of others stay."""
    model, out = write_model(tmp_path / "model"), tmp_path / "body"
    given = ("reduce", model, "--interface", model / "interface.csv", "--cut-hz", "300")
    done = fatigue(*given, "-o", out)
    assert done.returncode == 0, done.stderr
    assert "residual basis: " in done.stdout
    assert "forces of 1 weld line at 3 nodes" in done.stdout
    assert "is a rule and no property of the body" in done.stdout
    assert "normal modes up to 300 Hz and 15 residual attachment modes: done in" in done.stderr
    assert "WARNING" not in done.stderr
    weak = fatigue(*given, "-o", out, "--basis", "weak", "--damping", "none", "--json")
    assert weak.returncode == 0, weak.stderr
    found = json.loads(weak.stdout)
    assert found["basis"]["name"] == "weak"
    assert found["flexibility"]["least_at"].startswith("converter_1")
    assert [problem["code"] for problem in found["warnings"]] == ["stiff_points"]
    assert weak.stderr.count("WARNING") == 1
    assert "damping_ratio" not in pd.read_csv(out / "modes.csv")
    (out / "modes.csv").write_text("mine", encoding="utf-8")
    done = fatigue(*given, "-o", out)
    assert done.returncode == 3
    assert "modes.csv: is there already and was not written by fatigue reduce, or was changed since" in done.stderr


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (("-o", "out"), 2, "Missing option '--interface'"),
        (("--interface", "interface.csv"), 2, "Missing option '-o'"),
        (("--interface", "nothing.csv", "-o", "out"), 3, "nothing.csv: there is no such file"),
        (("--interface", "interface.csv", "-o", "out", "--basis", "rubin"), 2, "'rubin' is not one of"),
        (("--interface", "interface.csv", "-o", "out", "--cut-hz", "nan"), 2, "not a finite number"),
        (("--interface", "interface.csv", "-o", "out", "--units", "cm"), 3, "unknown unit system 'cm'"),
        (("--interface", "interface.csv", "-o", "out", "--basis", "kuhar"), 3, "exact at one frequency"),
    ],
)
def test_mistakes_in_options(tmp_path, options, code, words):
    """Wrong usage ends with 2, bad data with 3, each with one line."""
    model = write_model(tmp_path / "model")
    places = {"interface.csv": model / "interface.csv", "out": tmp_path / "out"}
    done = fatigue("reduce", model, *(places.get(option, option) for option in options))
    assert done.returncode == code
    assert words in done.stderr
    assert "Traceback" not in done.stderr
