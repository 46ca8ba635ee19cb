"""What the command line says of a study, and its exit codes."""

import json

from tests.study.variants.small_study import written
from tests.test_cli import fatigue


def test_a_study_on_the_command_line(copied):
    """Text for people with what was there before; a claim with its verdict; a warning of each kind once."""
    claim = '[[claim]]\ntext = "It lives longer"\nleft = "life_km:A[fe=18]"\noperator = ">"\nright = "life_km:A"\n'
    study = written(copied, claim)
    done = fatigue("study", "run", study, "-o", copied / "out", "--csv", "--threads", "1")
    assert done.returncode == 0, done.stderr
    assert "small study: 2 variants under 2 seeds: 0 done now, 4 there from before" in done.stdout
    assert "reproduced: It lives longer" in done.stdout
    assert "assessing (4 runs): done in" in done.stderr
    assert "reading and checking the case" not in done.stderr
    warnings = [line for line in done.stderr.splitlines() if line.startswith("WARNING")]
    assert len(warnings) == len({line.partition(":")[2].partition(":")[0] for line in warnings}) or len(warnings) < 8
    assert {path.suffix for path in (copied / "out").glob("claims.*")} == {".parquet", ".csv"}
    page = (copied / "out" / "study.html").read_text(encoding="utf-8")
    assert "It lives longer" in page


def test_a_run_that_fails_on_the_command_line(copied):
    """Tables and JSON are there all the same; the failure is a line of stderr, and the exit code is 3."""
    script = copied / "simulate.py"
    script.write_text(script.read_text().replace("draw =", 'sys.exit("no licence") if seed == 2 else 0\ndraw ='))
    done = fatigue("study", "run", copied / "study.toml", "-o", copied / "out", "--json")
    assert done.returncode == 3
    found = json.loads(done.stdout)
    assert [run["state"] for run in found["runs"]] == ["done", "failed", "done", "failed"]
    errors = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    assert len(errors) == 2
    assert all("no licence" in line for line in errors)
    assert (copied / "out" / "numbers.parquet").is_file()
