"""A result with its inputs read again: stations solved as they were, events as they were counted, on disk or not."""

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.life.records.spool import Spool
from fatigue.point.found import find_station
from fatigue.point.history import COMPONENTS
from fatigue.point.reopened import counted_load, event_numbers, forget, reopened, sampled_load, solved_station
from fatigue.results import read_provenance


@pytest.mark.parametrize("name", ["plain", "unit loads", "corner"])
@pytest.mark.parametrize("weld", ["A", "B"])
def test_a_station_is_solved_as_it_was(results, tmp_path, name, weld):
    """All five components per unit of each coordinate are those of the table, ends treated."""
    folder = results(name)
    station = find_station(folder, weld)
    model, index = solved_station(reopened(folder, read_provenance(folder), tmp_path), station)
    stations = model.stations
    assert (stations.part[index], stations.order[index], stations.node[index]) == (
        station.part,
        station.order,
        station.node,
    )
    stress = pd.read_parquet(folder / "structural_stress.parquet")
    stress = stress[(stress["weld"] == weld) & (stress["part"] == station.part) & (stress["order"] == station.order)]
    for component in COMPONENTS:
        np.testing.assert_allclose(getattr(stations.treated, component)[index], stress[f"{component}_MPa"], rtol=1e-12)


def test_events_are_as_they_were_counted(results, tmp_path):
    """Upsampled as the record says, or not at all."""
    folder = results("upsampled")
    inputs = reopened(folder, read_provenance(folder), tmp_path)
    assert inputs.events == ["sine", "noise", "load and unload"]
    assert event_numbers(inputs, None) == [0, 1, 2]
    assert event_numbers(inputs, "noise") == [1]
    for number, factor in enumerate(inputs.factors):
        counted, sampled = counted_load(inputs, number), sampled_load(inputs, number)
        assert (counted.upsample, sampled.upsample) == (factor, 1)
        assert counted.counted.step == pytest.approx(sampled.counted.step / factor)


def test_what_is_too_long_for_memory_goes_to_disk_and_away(results, tmp_path, monkeypatch):
    """By the rule of the assessment; nothing is left of it."""
    folder = results("upsampled")
    inputs = reopened(folder, read_provenance(folder), tmp_path)
    held = counted_load(inputs, 0)
    assert not isinstance(held.counted.q, Spool)
    forget(held)
    monkeypatch.setattr("fatigue.point.reopened.HELD_BYTES", 0.0)
    kept = counted_load(inputs, 0)
    assert isinstance(kept.counted.q, Spool)
    np.testing.assert_allclose(np.asarray(kept.counted.q), held.counted.q, rtol=0, atol=1e-12)
    assert (tmp_path / "event-0000").is_dir()
    forget(kept)
    assert not (tmp_path / "event-0000").exists()


def test_points_that_the_case_does_not_have(results, tmp_path):
    """A table of nodes that does not fit the case is no table of it."""
    folder = results("plain")
    inputs = reopened(folder, read_provenance(folder), tmp_path)
    station = find_station(folder, "A", order=2)
    copy = tmp_path / "result"
    copy.mkdir()
    nodes = pd.read_parquet(folder / "nodes.parquet")
    nodes.assign(node=nodes["node"] + 1).to_parquet(copy / "nodes.parquet")
    object.__setattr__(inputs, "folder", copy)
    with pytest.raises(DataError, match=r"has other points than the case from row 1 on\. Run the assessment again"):
        solved_station(inputs, station)
