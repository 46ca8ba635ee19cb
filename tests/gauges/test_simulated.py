"""What gauges read in an event: rows times coordinates, at the samples of the file and at those that are counted."""

from pathlib import Path

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.gauges.gauge_file import read_gauges
from fatigue.gauges.rows import gauge_rows
from fatigue.gauges.simulated import counted, simulated
from fatigue.pipeline.mission.events import event_loads
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.weld_groups import weld_groups
from tests.gauge_case import gauge_case
from tests.gauges.test_rows import table

GAUGES = table("a,element,101,,,,,,,0,,,,top,,,,,,,,", "b,element,102,,,,,,,60,,,,bottom,,,,,0.01,,,")


def opened(case, folder):
    """Body, rows and prepared events of a case."""
    case_file, gauges = case.write(folder)
    body = read_body(load_case(case_file), strict=False)
    groups = weld_groups(body, Path(folder) / "scratch")
    rows, _ = gauge_rows(groups, read_gauges(gauges)[0])
    return body, rows, event_loads(groups, mission_plan(body)[0])


def q_of(case, event, start_s=0.0):
    """Coordinates (3, t) of a history behind its start-up, and their times."""
    history = case.case.histories[event]
    kept = history[history.time_s >= start_s - 1e-9]
    return kept[["q_1", "q_2", "q_7"]].to_numpy().T, kept.time_s.to_numpy()


def test_a_reading_is_rows_times_coordinates_in_file_time(tmp_path):
    """The start-up is cut, and times are those of the file."""
    case = gauge_case(GAUGES)
    body, rows, _ = opened(case, tmp_path)
    reading = simulated(body, rows, body.case.mission.event[1])  # starts at 1 s
    q, time = q_of(case, "noise", 1.0)
    assert reading.strain == pytest.approx(rows.strain @ q, abs=1e-9)
    assert reading.stress == pytest.approx(rows.stress @ q, abs=1e-9)
    assert reading.time == pytest.approx(time)
    assert (reading.event, reading.residue) == ("noise", "repeat")
    assert simulated(body, rows, body.case.mission.event[2]).residue == "half"


def test_an_allowance_on_stress_is_on_no_strain(tmp_path):
    """``stress_factor`` changes what is assessed and leaves the readings as they are."""
    plain, factored = gauge_case(GAUGES), gauge_case(GAUGES)
    factored.case.events[1]["stress_factor"] = 1.5
    readings = []
    for name, case in (("plain", plain), ("factored", factored)):
        body, rows, loads = opened(case, tmp_path / name)
        readings.append((simulated(body, rows, body.case.mission.event[1]).strain, counted(rows, loads[1]).strain))
    assert np.array_equal(readings[0][0], readings[1][0])
    assert np.array_equal(readings[0][1], readings[1][1])


def test_upsampled_records_pass_through_the_samples_of_the_file(tmp_path):
    """Counted at four times as many instants; every fourth is one of the file, at its own time."""
    case = gauge_case(GAUGES)
    case.case.counting = {"upsample": 4}
    body, rows, loads = opened(case, tmp_path)
    for e, event in enumerate(body.case.mission.event):
        at_samples, fine = simulated(body, rows, event), counted(rows, loads[e])
        assert fine.step == pytest.approx(at_samples.step / 4.0)
        assert fine.time[::4][: at_samples.time.size] == pytest.approx(at_samples.time)
        assert fine.strain[:, ::4] == pytest.approx(at_samples.strain, abs=1e-6)
    assert fine.strain.shape[1] == 5  # of two samples that are a single pass


def test_a_mean_of_q_that_the_case_removes_is_out_of_both(tmp_path):
    """``mean_of_q = "remove"``: readings about zero; changes are the same bit by bit in what is counted."""
    case = gauge_case(GAUGES)
    case.case.histories["noise"]["q_1"] += 50.0
    kept = gauge_case(GAUGES)
    kept.case.histories["noise"]["q_1"] += 50.0
    case.case.counting = {"upsample": 1, "mean_of_q": "remove"}
    body, rows, loads = opened(case, tmp_path / "removed")
    whole_body, whole_rows, _ = opened(kept, tmp_path / "kept")
    event = body.case.mission.event[1]
    removed, whole = simulated(body, rows, event), simulated(whole_body, whole_rows, event)
    assert removed.strain.mean(axis=1) == pytest.approx([0.0, 0.0], abs=1e-7)
    assert np.abs(whole.strain.mean(axis=1)).min() > 100.0
    assert np.diff(removed.strain) == pytest.approx(np.diff(whole.strain), abs=1e-7)
    assert counted(rows, loads[1]).strain == pytest.approx(removed.strain, abs=1e-7)
