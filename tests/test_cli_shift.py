"""What the command line says of a moved mode, and what it refuses."""

import json

import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.verify.recount import recount
from tests.command_line import assess, fatigue
from tests.shift.oscillating_case import oscillating

SCREENING = "screening without feedback"


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A result of its own, without diagnosis."""
    folder = tmp_path_factory.mktemp("cli")
    done = assess(oscillating(gives_damping=False).write(folder / "case"), "-o", folder / "result", "--threads", "1")
    assert done.returncode in {0, 1}, done.stderr
    return folder / "result"


def test_a_moved_mode_is_told_and_written(result):
    """Words for people, JSON for machines, a table with units that CSV follows; the folder still verifies."""
    asked = ("shift", result, "--mode", "2", "--to", "11:12:0.5", "--threads", "1")
    done = fatigue(*asked)
    assert done.returncode == 0, done.stderr
    assert SCREENING in done.stdout
    assert "damping 1.5 % assumed" in done.stdout
    assert "* as assessed" in done.stdout
    assert all(f.metadata[b"unit"] for f in pq.read_schema(result / "shift.parquet"))
    found = json.loads(fatigue(*asked, "--event", "hunting", "--to-damping", "0.015,0.03", "--json").stdout)
    assert found["method"] == SCREENING
    assert len(found["settings"]) == 3 * 2 + 1
    assert found["moved"] == ["hunting"]
    assert set(pd.read_parquet(result / "shift.parquet")["frequency_hz"]) == {10.0, 11.0, 11.5, 12.0}
    assert fatigue("report", result, "--csv").returncode == 0
    assert len(pd.read_csv(result / "shift.csv")) == len(pd.read_parquet(result / "shift.parquet"))
    assert recount(result, sample=2).passed


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        ((), 2, "Say where the mode moves"),
        (("--to", "15:12:0.5"), 2, "is no range A:B:STEP"),
        (("--to", "12:15"), 2, "is no range A:B:STEP"),
        (("--to", "1:1000:0.001"), 2, "is no range A:B:STEP"),
        (("--to", "12,nan"), 2, "is no range A:B:STEP"),
        (("--to-damping", "0.5,1.5"), 2, "damping ratios of 1 and more"),
        (("--mode", "two", "--to", "12"), 2, "is no mode id"),
        (("--to", "12"), 3, "Run `fatigue diagnose` on the folder first, or name the mode with --mode"),
        (("--mode", "3", "--to", "12"), 3, "the body has no mode 3"),
    ],
)
def test_mistakes_are_one_line(result, options, code, words):
    """Wrong usage is 2, what does not fit the case is 3."""
    done = fatigue("shift", result, *options)
    assert done.returncode == code, done.stderr
    assert words in " ".join(done.stderr.split())
    assert "Traceback" not in done.stderr


def test_a_folder_without_result(tmp_path):
    """Nothing to move."""
    done = fatigue("shift", tmp_path, "--to", "12")
    assert done.returncode == 3
    assert "no finished result in this folder" in done.stderr
