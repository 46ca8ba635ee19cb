"""The cycles of any point: those of the table at the worst points, and everywhere those of its damage."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.point.cycles import cycle_frame, recorded_plan
from fatigue.point.found import FACES, find_station
from fatigue.point.reopened import reopened
from fatigue.results import read_provenance
from tests.point.cases import CASES, SEQUENCES


def cycles_of(folder: Path, weld: str, surface: str | None = None, event: str | None = None, **place) -> pd.DataFrame:
    """Cycles of a point of a result."""
    station = find_station(folder, weld, **place)
    with TemporaryDirectory() as scratch:
        inputs = reopened(folder, read_provenance(folder), Path(scratch))
        return cycle_frame(inputs, station, station.face(surface), event)


@pytest.mark.parametrize("name", CASES)
def test_the_table_of_cycles_at_the_worst_points(results, name):
    """Every number and text of it, sequences included; to rounding, as points are multiplied out one at a time here."""
    table = pd.read_parquet(results(name) / "cycles.parquet")
    for weld in ("A", "B"):
        expected = table[table["weld"] == weld].reset_index(drop=True)
        found = cycles_of(results(name), weld)
        pd.testing.assert_frame_equal(found, expected, rtol=1e-11, atol=1e-12)


@pytest.mark.parametrize("name", CASES)
def test_the_damage_of_every_event_at_other_points(results, name):
    """Summed over the cycles it is that of the table of damage; so is the number of cycles."""
    folder = results(name)
    damage = pd.read_parquet(folder / "damage.parquet")
    for place in ({"order": 2}, {"order": 6}):
        for face in FACES:
            found = cycles_of(folder, "A", face, **place).groupby("event")
            here = damage[(damage["weld"] == "A") & (damage["order"] == place["order"]) & (damage["surface"] == face)]
            expected = here.set_index("event")
            for mine, its in (("damage", "damage_per_pass"), ("count", "cycles_per_pass")):
                summed = found[mine].sum().reindex(expected.index, fill_value=0.0)  # no row where nothing changes
                np.testing.assert_allclose(summed, expected[its], rtol=1e-9)


def test_of_one_event(results):
    """Only its cycles, a sequence being one as well."""
    every = cycles_of(results("loop"), "A", order=3)
    for event in ("laden", *SEQUENCES):
        own = cycles_of(results("loop"), "A", event=event, order=3)
        pd.testing.assert_frame_equal(own, every[every["event"] == event].reset_index(drop=True))
    assert (every[every["event"] == "(sequence 1)"]["count"] < 0.0).any()


def test_of_records_on_disk(results, monkeypatch):
    """The same cycles to rounding, where no record fits in memory."""
    folder = results("vertex, half, upsampled")
    in_memory = cycles_of(folder, "A", order=5)
    monkeypatch.setattr("fatigue.point.reopened.HELD_BYTES", 0.0)
    monkeypatch.setattr("fatigue.pipeline.tables.cycles._SAMPLES_AT_ONCE", 10)
    on_disk = cycles_of(folder, "A", order=5)
    assert len(on_disk) == len(in_memory)
    for name in ("range_MPa", "mean_MPa", "start_s", "end_s", "damage"):
        np.testing.assert_allclose(on_disk[name], in_memory[name], rtol=1e-9, atol=1e-12)


def test_an_event_that_is_not_there(results):
    """With the sequences among those there are."""
    with pytest.raises(DataError, match=r"the mission has no event 'x'. Name one of .* '\(sequence 1\)'"):
        cycles_of(results("loop"), "A", event="x")


@pytest.mark.parametrize("name", ["loop", "unit loads"])
def test_the_mission_of_the_record_is_that_of_the_case(results, name, tmp_path):
    """Passes, runs and orders, without reading a record."""
    folder = results(name)
    record = read_provenance(folder)
    plan, expected = recorded_plan(record), mission_plan(reopened(folder, record, tmp_path).body)[0]
    assert plan.names == expected.names
    np.testing.assert_allclose(plan.weights, expected.weights, rtol=1e-15)
    assert [loop.order for loop in plan.loops] == [loop.order for loop in expected.loops]
    assert (plan.target_km, plan.km_per_year, plan.damage_limit) == (1e6, 2e5, 1.0)
