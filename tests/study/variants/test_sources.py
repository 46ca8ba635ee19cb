"""Histories from files that are there, from the case itself, and from rides of the vehicle on two kinds of bodies."""

import shutil

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.case import load_case
from fatigue.errors import CaseError
from fatigue.reduce.bases import Recipe
from fatigue.reduce.story import reduce
from fatigue.study.car_body import car_body
from fatigue.study.variants.source.builtin import channel_table
from fatigue.study.variants.story import run_study
from fatigue.study.vehicle_file import load_vehicle
from fatigue.vehicle.equations.suspension import NEEDED
from fatigue.vehicle.run import ride
from fatigue.vehicle.run_numbers import run_numbers
from tests.reduce.small_body import write_model
from tests.small_case import small_case

TRACK = "[track]\ndistance_m = 400.0\n[run]\nspeed_km_h = 200.0\ndropped_s = 1.0\n"
EVENTS = """
[[mission.event]]
name = "sound"
history = "sound.csv"
speed_km_h = 100.0
share = 0.5
[[mission.event]]
name = "worn"
history = "worn.csv"
length_km = 3.0
share = 0.5
"""


def value(found, variant, quantity, weld="", seed=1):
    """One number of a study."""
    (number,) = [n for n in found.numbers if (n.variant, n.seed, n.quantity, n.weld) == (variant, seed, quantity, weld)]
    return number.value


@pytest.fixture(scope="module")
def two_events(tmp_path_factory):
    """The small case with two events, and the histories of a study of it, by frequency and seed."""
    folder = tmp_path_factory.mktemp("files")
    case = small_case(1.0)
    noise = case.histories["noise"]
    case.histories = {"sound": noise, "worn": noise}
    case.events = [{"name": name, "history": name, "speed_km_h": 360.0, "share": 0.5} for name in ("sound", "worn")]
    case.write(folder / "body")
    for fe in (9.2, 14):
        for seed in (1, 2):
            for event, size in (("sound", 0.1), ("worn", 1.0)):
                factor = size * (1.0 + 0.1 * seed) * 9.2 / fe
                of = noise.assign(**{f"q_{mode}": factor * noise[f"q_{mode}"] for mode in (1, 2, 7)})
                place = folder / "there" / f"{fe:g}Hz" / f"{seed:02d}"
                place.mkdir(parents=True, exist_ok=True)
                of.to_csv(place / f"{event}.csv", index=False)
    return folder


STUDY = '[base]\ncase = "body/case.toml"\n{more}[[vary]]\nkey = "own.fe"\nvalues = [9.2, 14.0]\n'


def with_files(folder, pattern, more=""):
    """What a study of the files of a pattern finds."""
    study = folder / "study.toml"
    study.write_text("seeds = [1, 2]\n" + STUDY.format(more=f'[source]\nfiles = "{pattern}"\n{more}'))
    return run_study(study, folder / "out")


def test_files_in_folders_and_by_event_are_the_same(two_events):
    """A pattern names the folder, or with {event} each file: the same histories are the same runs."""
    found = with_files(two_events, "there/{fe}Hz/{seed:02d}")
    assert not found.failures
    assert value(found, "base", "damage_per_km@worn", "A") > 1e3 * value(found, "base", "damage_per_km@sound", "A")
    assert value(found, "fe=14", "life_km", "A", 2) > value(found, "base", "life_km", "A", 2)
    history = load_case(two_events / "out/runs/fe-14/seed_2/case.toml").mission.event[1].history
    assert history == "../../../../there/14Hz/02/worn.csv"
    by_event = with_files(two_events, "there/{fe}Hz/{seed:02d}/{event}.csv")
    assert by_event.numbers == found.numbers
    assert by_event.reused == 4


def test_files_that_are_not_there(two_events):
    """Each run says what it misses; one file cannot stand for two events."""
    (two_events / "there/14Hz/02/worn.csv").rename(two_events / "worn.csv")
    found = with_files(two_events, "there/{fe}Hz/{seed:02d}")
    (two_events / "worn.csv").rename(two_events / "there/14Hz/02/worn.csv")
    (failure,) = found.failures
    assert "variant 'fe=14', seed 2" in failure.where
    assert "worn.csv" in failure.what
    found = with_files(two_events, "there/{fe}Hz/{seed:02d}/worn.csv")
    assert all("is one file, and 2 events have a history" in failure.what for failure in found.failures)
    found = with_files(two_events, "there/{fe}Hz/{seed:02d}/worn.csv", 'events = ["worn"]\n')
    assert not found.failures


def test_histories_of_the_case_itself(two_events):
    """A study of a case alone varies its rules; more seeds than one are doubtful."""
    study = two_events / "own.toml"
    text = '[base]\ncase = "body/case.toml"\n[[vary]]\nkey = "case.mission.event.worn.stress_factor"\nvalues = [2.0]\n'
    study.write_text(text)
    found = run_study(study, two_events / "own", threads=1)
    assert [v.settings for v in found.variants] == [{"stress_factor": 1.0}, {"stress_factor": 2.0}]
    assert value(found, "base", "life_km", "A") > 5.0 * value(found, "stress_factor=2", "life_km", "A")
    study.write_text("seeds = [1, 2]\n" + text)
    found = run_study(study, two_events / "own", threads=1)
    assert found.reused == 2
    assert [problem.remedy for problem in found.warnings if problem.code == "seeds_alike"] == [
        "Give one seed: the case has its histories whatever the seed"
    ]


@pytest.fixture(scope="module")
def body(tmp_path_factory):
    """Folder of a small reduced body with a case of two events, and the vehicle that rides on it."""
    folder = tmp_path_factory.mktemp("rides")
    model = write_model(folder / "model")
    interface = pd.read_csv(model / "interface.csv", dtype=str)
    named = set(interface["name"])
    rows = [
        {"name": name, "node": str(60 + place), "side": "internal", "components": "123"}
        for place, name in enumerate(name for name in NEEDED if name not in named)
    ]
    pd.concat([interface, pd.DataFrame(rows)]).to_csv(model / "all.csv", index=False)
    reduce(model, model / "all.csv", folder / "body", Recipe(cut_hz=300.0))
    case = folder / "body" / "case.toml"
    case.write_text(case.read_text().replace('upsample = "auto"', "upsample = 1") + EVENTS)
    (folder / "vehicle.toml").write_text(f'[car]\nbody = "body"\n{TRACK}')
    (folder / "study.toml").write_text(
        'seeds = [3]\n[base]\nvehicle = "vehicle.toml"\ncase = "body/case.toml"\n[source]\nrate_hz = 500.0\n'
        '[[source.run]]\nevent = "sound"\n[[source.run]]\nevent = "worn"\nset = { vehicle.contact.state = "worn", '
        "vehicle.contact.worn_sections_m = [[100.0, 300.0]] }\n"
    )
    return folder


def test_a_ride_of_each_event(body):
    """Histories, speeds, channels and numbers are those of the ride; the length of the case gives way to its own."""
    found = run_study(body / "study.toml", body / "out", threads=1)
    assert not found.failures
    run = body / "out/runs/base/seed_3"
    events = load_case(run / "case.toml").mission.event
    assert [(e.history, e.speed_km_h, e.length_km) for e in events] == [
        (f"simulation/{event}/history.parquet", 200.0, None) for event in ("sound", "worn")
    ]
    vehicle = load_vehicle(body / "vehicle.toml", {"run.seed": 3})
    of = ride(vehicle, car_body(vehicle))
    rms = value(found, "base", "conv_y_rms@sound", seed=3)
    assert rms == pytest.approx(run_numbers(of)["conv_y_rms"].value, rel=1e-6)  # with another number of threads of BLAS
    table = pq.read_table(run / "simulation/sound/history.parquet").to_pandas()
    assert np.allclose(np.diff(table["time_s"]), 0.002)
    assert np.sqrt((table["q_1"] ** 2).mean()) == pytest.approx(np.sqrt(1000.0 * (of.q[0] ** 2).mean()), rel=1e-2)
    assert {n.quantity for n in found.numbers} >= {"hunting_hz/bog_y@worn", "alarms/bog_y@sound", "life_km"}
    assert value(found, "base", "bogie_y_rms@worn", seed=3) != value(found, "base", "bogie_y_rms@sound", seed=3)


def test_a_case_of_another_body(body):
    """Its modes may have the same numbers: it is refused before anything rides."""
    other = body / "other"
    shutil.copytree(body / "body", other)
    modes = pd.read_csv(other / "modes.csv")
    modes.assign(frequency_hz=modes["frequency_hz"] * 1.01).to_csv(other / "modes.csv", index=False)
    study = body / "other.toml"
    study.write_text((body / "study.toml").read_text().replace("body/case", "other/case"))
    with pytest.raises(CaseError, match=r"body\.modes of case\.toml is .* and the vehicle rides on the body in"):
        run_study(study, body / "none")


def test_rides_on_the_frame_have_numbers_and_no_lives(tmp_path):
    """The case is left out; the history has channels alone."""
    (tmp_path / "vehicle.toml").write_text(TRACK)
    study = '[base]\nvehicle = "vehicle.toml"\n[[vary]]\nkey = "vehicle.converter.fe_hz"\nvalues = [14.0]\n'
    (tmp_path / "study.toml").write_text(study)
    found = run_study(tmp_path / "study.toml", tmp_path / "out", threads=2)
    assert value(found, "base", "conv_y_rms") != value(found, "fe=14", "conv_y_rms")
    columns = pq.read_schema(tmp_path / "out/runs/base/seed_1/simulation/history.parquet").names
    assert "bog_y" in columns
    assert not any(name.startswith("q_") for name in columns)
    assert found.reused == 0
    assert run_study(tmp_path / "study.toml", tmp_path / "out").reused == 2
    assert run_study(tmp_path / "study.toml", tmp_path / "again", threads=1).numbers == found.numbers


def test_channels_of_a_ride():
    """What each is of follows from its name."""
    assert channel_table("conv_z") == {
        "name": "conv_z", "column": "conv_z", "unit": "m/s2", "role": "equipment", "direction": "z", "place": "conv",
    }  # fmt: skip
    assert channel_table("roof_mid_y")["role"] == "other"
