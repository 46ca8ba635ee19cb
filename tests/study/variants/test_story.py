"""A study from its file to its tables: what is run, what is not run again, and what is said of failures."""

import json
import logging
import math
import shutil
import threading
import time

import pyarrow.parquet as pq
import pytest

import fatigue.study.variants.runs.run as run_module
from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import CaseError, DataError
from fatigue.results import json_ready, read_welds
from fatigue.results.dictionary.study import STUDY
from fatigue.study.variants.runs.outcomes import quiet_threads
from fatigue.study.variants.story import listed_study, run_study
from tests.study.variants.small_study import small_study, written

RUN = "out/runs/base/seed_1"


def value(found, variant, seed, quantity, weld=""):
    """One number of a study."""
    (number,) = [n for n in found.numbers if (n.variant, n.seed, n.quantity, n.weld) == (variant, seed, quantity, weld)]
    return number.value


def contents(folder):
    """Bytes of every file of a study but its logs, by name."""
    files = (path for path in folder.rglob("*") if path.is_file() and path.suffix != ".log")
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def times(folder):
    """When each record of a run was written."""
    return {path.relative_to(folder).as_posix(): path.stat().st_mtime_ns for path in folder.rglob("*.json")}


def redone(folder, before):
    """Runs, and simulations, whose record was written since."""
    after = times(folder / "out" / "runs")
    new = {name for name in after if before.get(name) != after[name]}
    return {name.rpartition("/")[0] for name in new if name.endswith(("/run.json", "/simulation.json"))}


def test_lives_are_those_of_an_assessment_of_the_same_histories(finished, tmp_path):
    """The command line would say the same of each run: here of the case with the histories put into it by hand."""
    folder, found = finished
    case = tmp_path / "body"
    small_study(tmp_path)
    (case / "noise.csv").write_bytes((folder / "out/runs/fe-18/seed_2/simulation/noise.csv").read_bytes())
    assess(case / "case.toml", tmp_path / "result", threads=1, report=False)
    lives = read_welds(tmp_path / "result").set_index("weld")["life_km"]
    for weld in ("A", "B"):
        assert value(found, "fe=18", 2, "life_km", weld) == lives[weld]
    assert value(found, "fe=18", 2, "life_km") == lives.min()


def test_twice_the_frequency_has_half_the_stress(finished):
    """Seeds share their noise: the ratio is the same under each, and lives grow by the slope of the curve."""
    _, found = finished
    (size,) = [row for row in found.ratios if row.quantity == "size"]
    (life,) = [row for row in found.ratios if (row.quantity, row.weld) == ("life_km", "A")]
    assert (size.ratio, size.n, size.seeds_below) == (pytest.approx(0.5), 2, "1, 2")
    slope = math.log2(life.ratio)
    assert 3.0 < slope < 5.0
    assert life.min == pytest.approx(life.max, rel=1e-6)
    assert life.agree == 2


def test_tables_have_units_and_meanings(finished):
    """Columns are those of the data dictionary; texts and numbers are read as such."""
    folder, found = finished
    for name, columns in STUDY.items():
        table = pq.read_table(folder / "out" / f"{name}.parquet")
        assert table.column_names == [column.name for column in columns]
        assert [field.metadata[b"unit"].decode() for field in table.schema] == [column.unit for column in columns]
    assert pq.read_table(folder / "out" / "numbers.parquet").num_rows == len(found.numbers)
    runs = pq.read_table(folder / "out" / "runs.parquet").to_pylist()
    assert runs[0]["folder"] == "runs/base/seed_1"
    assert {run["state"] for run in runs} == {"done"}
    assert "fe=18 / base" in found.as_text()
    record = json.loads(json.dumps(json_ready(found.as_record()), allow_nan=False))
    assert [run["state"] for run in record["runs"]] == ["done"] * 4
    assert len(record["ratios"]) == len(found.ratios)
    assert json.loads((folder / "out" / "study.json").read_text())["program"] == "fatigue study run"


@pytest.mark.usefixtures("with_page")
def test_the_same_bytes_with_another_number_of_threads(finished, tmp_path):
    """In another folder, one run after the other."""
    folder, _ = finished
    run_study(small_study(tmp_path), tmp_path / "out", threads=1)
    one, other = contents(folder / "out"), contents(tmp_path / "out")
    assert one.keys() == other.keys()
    assert not {name for name in one if one[name] != other[name]}


@pytest.mark.usefixtures("with_page")
def test_nothing_is_run_again(copied):
    """All of it is known by its hashes, although the folder has moved; the tables are the same bytes."""
    before, tables = times(copied / "out" / "runs"), contents(copied / "out")
    found = run_study(copied / "study.toml", copied / "out")
    assert found.reused == 4
    assert times(copied / "out" / "runs") == before
    assert contents(copied / "out") == tables


def test_a_folder_that_moved_without_its_inputs(copied):
    """Its cases would lead nowhere: runs are assessed again, and nothing is simulated."""
    (copied / "deep").mkdir()
    (copied / "out").rename(copied / "deep" / "out")
    before = times(copied / "deep" / "out" / "runs")
    found = run_study(copied / "study.toml", copied / "deep" / "out")
    assert found.reused == 0
    assert {name for name in before if name.endswith("simulation.json")} <= {
        name for name, when in times(copied / "deep" / "out" / "runs").items() if before.get(name) == when
    }
    case = load_case(copied / "deep" / RUN / "case.toml")
    assert case.resolve(case.body.modes).is_file()


def test_only_what_a_change_concerns_is_run_again(copied):
    """A new value and a new seed are new runs; a rule of the case assesses all, and simulates nothing."""
    before = times(copied / "out" / "runs")
    written(copied, **{"[9.0, 18.0]": "[9.0, 18.0, 27.0]"})
    run_study(copied / "study.toml", copied / "out")
    new = {f"fe-27/seed_{seed}{folder}" for seed in (1, 2) for folder in ("", "/simulation")}
    assert redone(copied, before) == new
    before = times(copied / "out" / "runs")
    case = copied / "body" / "case.toml"
    case.write_text(case.read_text().replace("[curve]", '[curve]\nsurvival = "mean"'))
    found = run_study(copied / "study.toml", copied / "out")
    assert redone(copied, before) == {f"{run}/seed_{n}" for run in ("base", "fe-18", "fe-27") for n in (1, 2)}
    assert found.reused == 0
    written(copied)
    found = run_study(copied / "study.toml", copied / "out")
    assert found.left_over == ("fe-27",)
    assert "fe-27" in found.as_text()


def test_a_change_of_the_command_runs_it_again(copied):
    """Its words that are files are inputs."""
    script = copied / "simulate.py"
    script.write_text(script.read_text().replace("0.8 * old", "0.7 * old"))
    before = times(copied / "out" / "runs")
    run_study(copied / "study.toml", copied / "out")
    assert len(redone(copied, before)) == 8


@pytest.mark.parametrize("damage", ["half", "gone", "record", "result"])
def test_what_is_not_as_it_was_left_is_made_again(copied, damage):
    """A history cut off in the middle, a missing one, a record that is no JSON, a result that was changed."""
    run = copied / RUN
    history = run / "simulation" / "noise.csv"
    match damage:
        case "half":
            history.write_bytes(history.read_bytes()[:1000])
        case "gone":
            history.unlink()
        case "record":
            (run / "run.json").write_text('{"key": ')
        case "result":
            (run / "result" / "provenance.json").write_text("{}")
    before, tables = times(copied / "out" / "runs"), contents(copied / "out")
    found = run_study(copied / "study.toml", copied / "out")
    again = redone(copied, before)
    assert "base/seed_1" in again or damage in ("half", "gone")
    assert ("base/seed_1/simulation" in again) == (damage in ("half", "gone"))
    assert not any("seed_2" in name or "fe-18" in name for name in again)
    assert not found.failures
    after = contents(copied / "out")
    assert {n for n in tables if n.endswith(".parquet") and "/" not in n and after[n] != tables[n]} == set()


def test_variants_that_differ_in_their_case_share_histories(copied, finished):
    """The command is not told what is of the case alone; lives are those of the other curve."""
    more = '[[vary]]\nkey = "case.curve.survival"\nvalues = ["mean"]\n'
    written(copied, more)
    before = times(copied / "out" / "runs")
    found = run_study(copied / "study.toml", copied / "out")
    assert redone(copied, before) == {"survival-mean/seed_1", "survival-mean/seed_2"}
    assert not (copied / "out/runs/survival-mean/seed_1/simulation").exists()
    case = load_case(copied / "out/runs/survival-mean/seed_1/case.toml")
    assert case.mission.event[0].history == "../../base/seed_1/simulation/noise.csv"
    assert value(found, "survival=mean", 1, "life_km") > 2.0 * value(finished[1], "base", 1, "life_km")


def test_only_some_variants(copied):
    """Of the others what is finished is used, and the rest is said not to be run."""
    written(copied, **{"[9.0, 18.0]": "[9.0, 18.0, 27.0, 36.0]"})
    found = run_study(copied / "study.toml", copied / "out", only="fe=2*")
    states = {run.variant: run.state for run in found.runs}
    assert states == {"base": "done", "fe=18": "done", "fe=27": "done", "fe=36": "not run"}
    assert math.isnan(value(found, "fe=36", 1, "size"))
    (reason,) = {n.reason for n in found.numbers if n.variant == "fe=36"}
    assert "not run" in reason
    assert found.exit_code == 0
    with pytest.raises(CaseError, match=r"the study has no variant 'fe=28'. Write 'fe=27'"):
        run_study(copied / "study.toml", copied / "out", only="fe=28")


def test_a_run_that_fails_is_told_and_the_others_go_on(copied):
    """With its settings, the last lines of its stderr, and an exit code; its numbers are empty with the reason."""
    script = copied / "simulate.py"
    script.write_text(
        script.read_text().replace("draw =", 'if size < 6 and seed == 2: sys.exit("no wheel left")\ndraw =')
    )
    found = run_study(copied / "study.toml", copied / "out")
    (failure,) = found.failures
    assert failure.where == "variant 'fe=18', seed 2"
    assert "ended with exit code 1; its stderr ends with: no wheel left" in failure.what
    assert found.exit_code == 3
    assert [run.state for run in found.runs] == ["done", "done", "done", "failed"]
    empty = [number for number in found.numbers if (number.variant, number.seed) == ("fe=18", 2)]
    assert {number.quantity for number in empty} >= {"life_km", "size", "drawn"}
    assert all(math.isnan(number.value) and "no wheel left" in number.reason for number in empty)
    (size,) = [row for row in found.ratios if row.quantity == "size"]
    assert (size.n, size.ratio) == (1, pytest.approx(0.5))
    assert "1 failed" in found.as_text()


def test_a_history_that_no_assessment_reads(copied):
    """What the assessment says of it stands behind the run."""
    script = copied / "simulate.py"
    script.write_text(script.read_text().replace("time_s,q_1", "time_s,q_9"))
    found = run_study(copied / "study.toml", copied / "out")
    assert len(found.failures) >= 4
    assert all(problem.where.startswith("variant ") for problem in found.failures)
    assert found.exit_code == 3


def test_a_fault_of_the_program_costs_one_run(copied, monkeypatch):
    """It is told with exit code 4, and the others are there."""

    def assess_one(case_file, *arguments, **options):
        if "fe-18/seed_2" in case_file.as_posix():
            raise ZeroDivisionError("a bug")
        return assess(case_file, *arguments, **options)

    monkeypatch.setattr(run_module, "assess", assess_one)
    shutil.rmtree(copied / "out" / "runs" / "fe-18")
    found = run_study(copied / "study.toml", copied / "out")
    (failure,) = found.failures
    assert failure.where.startswith("variant 'fe=18', seed 2")
    assert "this should not have happened (ZeroDivisionError: a bug)" in failure.what
    assert (found.exit_code, [run.state for run in found.runs]) == (4, ["done", "done", "done", "failed"])


def test_a_diagnosis_of_every_run(copied):
    """If it is asked for: what makes the damage, as numbers of each weld."""
    written(copied, **{"seeds = [1, 2]": "seeds = [1]\ndiagnose = true", "values = [9.0, 18.0]": "values = [9.0]"})
    found = run_study(copied / "study.toml", copied / "out")
    assert 0.0 < value(found, "base", 1, "largest_mode_share", "A") <= 1.5
    assert value(found, "base", 1, "event_share", "B") == 1.0


def test_seeds_and_variants_that_change_nothing(tmp_path):
    """One warning each: what is varied does not reach the source."""
    path = small_study(tmp_path, **{"{fe} {seed}": "9.0 7"})
    found = run_study(path, tmp_path / "out")
    mine = {problem.code: problem for problem in found.warnings if problem.code.endswith("_alike")}
    assert mine["seeds_alike"].count == 2
    assert "seeds 1 and 2 of variant 'base' have the same histories" in mine["seeds_alike"].what
    assert "all numbers of variant 'fe=18' are those of variant 'base'" in mine["variants_alike"].what


def test_a_sound_study_is_silent(finished):
    """No warning of the study itself."""
    assert not [problem for problem in finished[1].warnings if problem.code.endswith("_alike")]


def test_files_of_somebody_else_stay(copied):
    """Each in the way is told; with force files are replaced, folders and inputs never."""
    (copied / "out" / "numbers.parquet").write_text("mine")
    with pytest.raises(DataError, match=r"numbers\.parquet: is there already"):
        run_study(copied / "study.toml", copied / "out")
    assert run_study(copied / "study.toml", copied / "out", force=True).reused == 4
    (copied / "new" / "runs" / "mine").mkdir(parents=True)
    with pytest.raises(DataError, match="runs: is there already and is not of a study"):
        run_study(copied / "study.toml", copied / "new")
    (copied / "study.toml").rename(copied / "study.json")
    with pytest.raises(DataError, match="is an input of this study"):
        run_study(copied / "study.json", copied, force=True)


def test_two_studies_at_once(copied):
    """The second one is refused: the folder is locked."""
    script = copied / "simulate.py"
    script.write_text("import time\ntime.sleep(1.0)\n" + script.read_text())
    first = threading.Thread(target=run_study, args=(copied / "study.toml", copied / "out"))
    first.start()
    time.sleep(0.6)
    try:
        with pytest.raises(DataError, match="another run is writing to this folder"):
            run_study(copied / "study.toml", copied / "out")
    finally:
        first.join()


def test_the_list_of_runs(finished):
    """What each sets, and whether it is there; nothing is written."""
    folder, _ = finished
    listed = listed_study(folder / "study.toml", folder / "out")
    assert [run["there"] for run in listed.runs] == [True] * 4
    assert listed.runs[2]["sets"] == {"own.fe": 18.0}
    assert "fe=18: own.fe = 18" in listed.as_text()
    other = listed_study(folder / "study.toml", folder / "none", only="base")
    assert [run["there"] for run in other.runs] == [False] * 2
    assert not (folder / "none").exists()


def test_logs_of_runs_do_not_mix(finished):
    """Each result has the log of its own assessment."""
    folder, _ = finished
    for log in folder.rglob("fatigue.log"):
        assert log.read_text().count("the result is complete") == 1


def test_the_log_is_quiet_only_meanwhile(caplog):
    """What threads of single runs say is not told while a study runs; what the study says is, and both are later."""
    log = logging.getLogger("fatigue")
    log.addHandler(caplog.handler)
    try:
        with quiet_threads():
            log.info("of the study")
            said_by_another("of a run")
        said_by_another("later")
    finally:
        log.removeHandler(caplog.handler)
    texts = [record.getMessage() for record in caplog.records]
    assert "of a run" not in texts
    assert {"of the study", "later"} <= set(texts)


def said_by_another(text):
    """Log a line from a thread of its own."""
    thread = threading.Thread(target=logging.getLogger("fatigue").warning, args=(text,))
    thread.start()
    thread.join()
