"""What the command line says of a study, and its exit code."""

import json

from fatigue.cli.commands.study import failures_told
from fatigue.errors import Problem
from tests.command_line import fatigue
from tests.study.variants.small_study import written


def test_a_study_on_the_command_line(copied, with_page):
    """Text with what was there before and with verdicts; each kind of warning once; a run that fails is an error."""
    claim = '[[claim]]\ntext = "It lives longer"\nleft = "life_km:A[fe=18]"\noperator = ">"\nright = "life_km:A"\n'
    study = written(copied, claim, **{"[9.0, 18.0]": "[9.0, 18.0, -1.0]", "seeds = [1, 2]": "seeds = [1]"})
    stops = "if sys.argv[1] == '-1': sys.exit('no licence')\n"
    (copied / "stops.py").write_text(f"import sys\n{stops}{(copied / 'simulate.py').read_text()}")
    study.write_text(study.read_text().replace("simulate.py", "stops.py"))
    done = fatigue("study", "run", study, "-o", copied / "out", "--csv", "--threads", "1")
    assert done.returncode == 3, done.stderr
    assert "small study: 3 variants under 1 seed: 0 done now, 2 there from before, 1 failed" in done.stdout
    assert "reproduced: It lives longer" in done.stdout
    assert "assessing (3 runs): done in" in done.stderr
    assert "reading and checking the case" not in done.stderr
    (error,) = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    assert error.startswith(
        "error: variant 'fe=-1', seed 1: the command ended with exit code 1; its stderr ends with: no "
    )
    warnings = [line for line in done.stderr.splitlines() if line.startswith("WARNING")]
    kinds = {one["code"] for one in json.loads((copied / "out" / "study.json").read_text())["warnings"]}
    assert len(warnings) == len(kinds) > 0
    assert {path.suffix for path in (copied / "out").glob("claims.*")} == {".parquet", ".csv"}
    assert "It lives longer" in (copied / "out" / "study.html").read_text(encoding="utf-8")


def test_runs_that_fail_alike_are_one_line():
    """Thirty runs without their program are one error with a count; another reason is a line of its own."""
    same = [Problem("command_failed", f"variant 'base', seed {seed}", "no solver", "Install it") for seed in range(30)]
    lines = list(failures_told([*same, Problem("command_failed", "variant 'fe=14', seed 1", "no licence", "Get one")]))
    assert lines == [
        "variant 'base', seed 0: no solver. Install it. (and 29 more for the same reason, see study.json)",
        "variant 'fe=14', seed 1: no licence. Get one.",
    ]
