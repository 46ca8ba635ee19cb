"""What the command line says of a what-if, what it writes, and what it refuses."""

import json

import pandas as pd
import pyarrow.parquet as pq
import pytest

from tests.checks_case import write_checks_case
from tests.command_line import assess, fatigue
from tests.decide.whatif.reruns import base_case


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A result of which one weld misses its target, and no weld far from it."""
    folder = tmp_path_factory.mktemp("cli")
    case = base_case("straight")
    case.mission["target_km"] = 500.0
    done = assess(case.write(folder / "case"), "-o", folder / "result", "--threads", "1")
    assert done.returncode in {0, 1}, done.stderr
    return folder / "result"


def test_words_for_people_json_for_machines_and_the_exit_code(result):
    """Exit 1 where a weld misses its target under the change, whatever it did before; the knob in words."""
    done = fatigue("whatif", result, "--set", "load=1.5")
    assert done.returncode == 1, done.stderr
    assert "load: all stresses times 1.5" in done.stdout
    assert "misses" in done.stdout
    assert "28 exact" in done.stdout
    assert fatigue("whatif", result, "--set", "load=1.5", "--exit-zero").returncode == 0
    done = fatigue("whatif", result, "--set", "load=0.2", "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["fulfilled"] is True
    assert found["points_by_basis"] == {"exact": 28}
    assert {weld["weld"] for weld in found["welds"]} == {"A", "B"}
    assert all(weld["life_km_low"] == weld["life_km"] for weld in found["welds"])


def test_flips_are_told(result):
    """A weld whose verdict changes is named with both verdicts."""
    base = fatigue("show", result, "--json").returncode
    assert base == 0
    done = fatigue("whatif", result, "--set", "load=3", "--json")
    welds = json.loads(done.stdout)["welds"]
    flips = [weld for weld in welds if weld["flips"]]
    assert flips
    text = fatigue("whatif", result, "--set", "load=3").stdout
    for weld in flips:
        assert f"{weld['weld']}: {weld['verdict_before']} before, now {weld['verdict']}" in text


def test_what_the_shell_leaves_of_a_key_is_read(result):
    """With and without quotes inside, a key leads to the same event."""
    bare = ("--set", "mission.event.load and unload.per_1000_km=5", "--set", "curve.survival=mean")
    toml = ("--set", 'mission.event."load and unload".per_1000_km = 5', "--set", 'curve.survival = "mean"')
    found = [fatigue("whatif", result, *settings, "--json").stdout for settings in (bare, toml)]
    assert json.loads(found[0]) == json.loads(found[1])


def test_folder_of_a_what_if(result, tmp_path):
    """Tables with units, a page that links nothing outside, a record with hashes; run again it is replaced."""
    folder = tmp_path / "whatif"
    done = fatigue("whatif", result, "--set", "curve.extension=haibach", "-o", folder, "--csv", "--exit-zero")
    assert done.returncode == 0, done.stderr
    names = {path.name for path in folder.iterdir()}
    tables = {f"{name}.{kind}" for name in ("whatif", "whatif_welds") for kind in ("parquet", "csv")}
    assert names == tables | {"whatif.html", "whatif.json"}
    schema = pq.read_schema(folder / "whatif.parquet")
    assert all(field.metadata[b"unit"] and field.metadata[b"description"] for field in schema)
    points = pd.read_parquet(folder / "whatif.parquet")
    assert len(points) == 28
    assert (points["damage_per_km_low"] <= points["damage_per_km_high"]).all()
    welds = [pd.read_csv(folder / "whatif_welds.csv"), pd.read_parquet(folder / "whatif_welds.parquet")]
    assert welds[0]["weld"].tolist() == welds[1]["weld"].tolist()
    page = (folder / "whatif.html").read_text(encoding="utf-8")
    assert "curve.extension from none to haibach" in page
    assert "src=" not in page.split('<script type="text/plain"')[0]
    assert fatigue("whatif", result, "--set", "load=1.1", "-o", folder, "--exit-zero").returncode == 0
    assert {path.name for path in folder.iterdir()} == names - {"whatif.csv", "whatif_welds.csv"}
    (folder / "whatif.parquet").write_bytes(b"mine")
    done = fatigue("whatif", result, "--set", "load=1.1", "-o", folder)
    assert done.returncode == 3
    assert "whatif.parquet: is there already and was not written by fatigue whatif" in done.stderr


@pytest.mark.parametrize("force", [(), ("--force",)])
def test_nothing_is_written_into_the_result(result, force):
    """The folder of the result is refused as the one to write into, with force as well."""
    done = fatigue("-q", "whatif", result, "--set", "load=1.1", "-o", result, *force)
    assert done.returncode == 3
    assert "is one of the results that are read, which stay as they are. Give another folder with -o" in done.stderr
    assert not (result / "whatif.html").exists()


def test_the_result_keeps_its_bytes(result):
    """Nothing is written into the folder of the result, even where that is asked for."""
    before = {path.name: path.read_bytes() for path in result.iterdir() if path.is_file()}
    fatigue("whatif", result, "--set", "curve.extension=cutoff", "--json")
    done = fatigue("whatif", result, "--set", "load=1.1", "-o", result / ".." / result.name)
    assert done.returncode == 3
    assert "is one of the results that are read" in done.stderr
    assert before == {path.name: path.read_bytes() for path in result.iterdir() if path.is_file()}


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        ((), 2, "Say what is changed"),
        (("--set", "load=1.1", "--case", "case.toml"), 2, "--case is a whole case"),
        (("--set", "load=1.1", "--csv"), 2, "name their folder with -o"),
        (("--case", "nowhere.toml"), 3, "nowhere.toml"),
        (("--set", "spectrum.segment_s=2"), 3, "spectrum.segment_s: a change from 1 to 2 is no knob"),
        (("--set", "mission.event.sine.share=0.1"), 3, "sum to 0.35, not to 1"),
        (("--set", "mission.event.tunnel.share=0.1"), 3, "no table of the name 'tunnel'"),
        (("--drop", "tunnel"), 3, "the mission has no event 'tunnel'"),
        (("--set", "mission=1"), 3, "mission"),
        (("--set", "mission=1", "--drop", "sine"), 3, "mission"),
        (("--set", "mission.event=[1]", "--drop", "sine"), 3, "mission"),
        (("--set", "curve={}"), 3, "curve.name: the key is missing"),
        (("--set", "=5"), 3, "is no setting KEY=VALUE"),
        (("--set", "load=0"), 3, "0 is no factor on stresses"),
        (("--set", "curve.thickness_rule=thick"), 3, "thickness_rule"),
    ],
)
def test_mistakes_are_one_line(result, options, code, words):
    """Wrong usage is 2, what does not fit the case or the result is 3; the key is named."""
    done = fatigue("whatif", result, *options)
    assert done.returncode == code, done.stderr
    assert words in done.stderr


def test_a_folder_without_result(tmp_path):
    """It says what to run first."""
    done = fatigue("whatif", tmp_path, "--set", "load=1.1")
    assert done.returncode == 3
    assert "no finished result in this folder" in done.stderr


def test_checks_beside_the_toe_are_not_followed_and_said_so(tmp_path):
    """A warning names them, and a weld that a check fails is not proven to meet its target whatever its toe does."""
    path = write_checks_case(tmp_path / "case")
    text = path.read_text(encoding="utf-8")
    text = text.replace("target_km = 1000000.0", "target_km = 500.0").replace('["throat_perp"]', '["throat_root"]')
    path.write_text(text, encoding="utf-8")
    done = assess(path, "-o", tmp_path / "result", "--threads", "1")
    assert done.returncode in {0, 1}, done.stderr
    done = fatigue("whatif", tmp_path / "result", "--set", "load=0.9", "--json")
    assert "2 welds have checks beside the normal stress at the toe, which are not followed here" in done.stderr
    welds = pd.read_parquet(tmp_path / "result" / "welds.parquet").set_index("weld")
    failed = welds[~welds["fulfilled"].astype(bool) & (welds["utilisation"] <= 1.0)]
    assert len(failed)
    found = {weld["weld"]: weld for weld in json.loads(done.stdout)["welds"]}
    assert all(found[name]["verdict"] == "not_proven" for name in failed.index)
    assert all(found[name]["utilisation"] < 1.0 for name in failed.index)
