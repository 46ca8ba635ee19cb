"""Records of events: what is refused, what is doubted, and what an event brings to every station."""

import numpy as np
import pandas as pd
import pytest

from fatigue.case import load_case
from fatigue.errors import FatigueError
from fatigue.life.history import ModalHistory
from fatigue.pipeline.body import read_body
from fatigue.pipeline.events import event_load, event_loads, mission_plan, top_mode_hz, upper_hz
from fatigue.pipeline.model import weld_groups
from tests.small_case import small_case


def body_of(case, folder):
    """Read the small files of a case."""
    return read_body(load_case(case.write(folder)), strict=False)


def test_passes_of_the_small_case(tmp_path):
    """Length = speed x kept samples x step; an event by number has none."""
    plan, _ = mission_plan(body_of(small_case(), tmp_path))
    assert [p.samples for p in plan.passes] == [2400, 2200, 2]
    assert [p.length for p in plan.passes[:2]] == pytest.approx([180 / 3600 * 12.0, 360 / 3600 * 11.0])
    assert plan.passes[2].length is None
    assert plan.passes[1].passes_per_km == pytest.approx(0.25 / 1.1)


def test_length_decides_where_speed_agrees(tmp_path):
    """Both given and within 1e-3: the length is used as it stands."""
    case = small_case()
    case.events[0]["length_km"] = 0.6005
    plan, _ = mission_plan(body_of(case, tmp_path))
    assert plan.passes[0].length == 0.6005


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda c: c.events[0].update(length_km=0.61), "length_km = 0.61 of event 'sine' is not speed_km_h = 180"),
        (
            lambda c: c.events[1].update(start_s=11.999),
            "start_s = 11.999 leaves 0 samples of noise.csv, which lasts 12 s",
        ),
        (lambda c: c.histories["noise"].__setitem__("q_2", "x"), "noise.csv: column q_2, row 1: 'x' is not a number"),
        (lambda c: c.histories["noise"].pop("q_7"), "noise.csv"),
    ],
)
def test_bad_records_are_refused(tmp_path, change, message):
    """Place, value and remedy."""
    case = small_case()
    change(case)
    with pytest.raises(FatigueError) as error:
        mission_plan(body_of(case, tmp_path))
    assert message in str(error.value)


def test_mistakes_of_several_records_are_told_together(tmp_path):
    """Two bad files, two lines."""
    case = small_case()
    case.histories["sine"].loc[3, "q_1"] = np.nan
    case.histories["noise"].loc[4, "q_1"] = np.nan
    with pytest.raises(FatigueError) as error:
        mission_plan(body_of(case, tmp_path))
    assert [p.where for p in error.value.problems] == ["sine.csv: column q_1, row 4", "noise.csv: column q_1, row 5"]


def test_few_segments_and_no_spectrum_are_doubts(tmp_path):
    """Told with the numbers."""
    case = small_case(seconds=3.0)
    _, warnings = mission_plan(body_of(case, tmp_path))
    assert {w.code for w in warnings} == {"few_segments", "no_spectrum"}
    assert any("an average of 5 segments of 1 s" in w.what for w in warnings)
    assert [w.where for w in warnings if w.code == "no_spectrum"] == ["event 'load and unload'"]


def test_upper_frequency(tmp_path):
    """As given; else the lower of 0.4 of the sampling rate and 1.5 times the highest normal mode."""
    case = small_case()
    body = body_of(case, tmp_path / "a")
    assert top_mode_hz(body) == 12.0
    assert upper_hz(body, ModalHistory("e", np.array([1]), np.zeros((1, 9)), 0.005, 0.0)) == pytest.approx(18.0)
    assert upper_hz(body, ModalHistory("e", np.array([1]), np.zeros((1, 9)), 0.04, 0.0)) == pytest.approx(10.0)
    case.spectrum["upper_hz"] = 33.0
    assert upper_hz(body_of(case, tmp_path / "b"), ModalHistory("e", np.array([1]), np.zeros((1, 9)), 0.1, 0.0)) == 33.0


def test_event_load_statistics(tmp_path):
    """Mean and covariance of the kept samples; residue by kind of event."""
    case = small_case()
    body = body_of(case, tmp_path)
    load = event_load(body, body.case.mission.event[1], 1)
    q = case.histories["noise"].iloc[200:][["q_1", "q_2", "q_7"]].to_numpy().T
    assert load.mean == pytest.approx(q.mean(axis=1))
    assert load.covariance == pytest.approx(np.cov(q, bias=True), rel=1e-9)
    assert load.residue == "repeat"
    assert event_load(body, body.case.mission.event[2], 1).residue == "half"
    assert load.duration == pytest.approx(11.0)


def test_automatic_upsampling_reaches_twenty_samples_per_peak(tmp_path):
    """A sine at 4.5 Hz sampled at 25 Hz needs a factor of 4; a record without spectrum stays as it is."""
    case = small_case()
    t = np.arange(300) * 0.04
    case.histories["sine"] = pd.DataFrame({"time_s": t, "q_1": np.sin(2 * np.pi * 4.5 * t), "q_2": 0.0, "q_7": 0.0})
    case.counting["upsample"] = "auto"
    case.spectrum["segment_s"] = 2.0
    body = body_of(case, tmp_path / "case")
    loads = event_loads(weld_groups(body, tmp_path / "scratch"), mission_plan(body)[0])
    assert loads[0].counted.step == pytest.approx(0.01)
    assert loads[2].counted.step == pytest.approx(1.0)
