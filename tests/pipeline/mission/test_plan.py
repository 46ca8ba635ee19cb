"""The mission in numbers: passes and their lengths, what is refused, what is warned of."""

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.errors import DataError, FatigueError
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.body import read_body
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


def test_times_in_ms_are_refused_for_every_event(tmp_path):
    """Before its length is compared with the record; a load case typed in by hand may have any times."""
    case = small_case()
    for name in ("sine", "noise"):
        case.histories[name]["time_s"] *= 1000.0
    case.histories["load"]["time_s"] *= 1000.0
    case.events[0]["length_km"] = 0.6
    with pytest.raises(DataError) as error:
        mission_plan(body_of(case, tmp_path))
    assert [p.where for p in error.value.problems] == ["sine.csv: column time_s", "noise.csv: column time_s"]
    assert [p.code for p in error.value.problems] == ["long_step", "long_step"]


def test_a_step_far_too_short_is_a_warning(tmp_path):
    """Times in hours."""
    case = small_case()
    case.histories["sine"]["time_s"] /= 3600.0
    _, warnings = mission_plan(body_of(case, tmp_path))
    assert [w.where for w in warnings if w.code == "short_step"] == ["sine.csv: column time_s"]


def test_few_segments_and_no_spectrum_are_warnings(tmp_path):
    """Told with the numbers."""
    case = small_case(seconds=3.0)
    _, warnings = mission_plan(body_of(case, tmp_path))
    assert {w.code for w in warnings} == {"few_segments", "no_spectrum"}
    assert any("an average of 5 segments of 1 s" in w.what for w in warnings)
    assert [w.where for w in warnings if w.code == "no_spectrum"] == ["event 'load and unload'"]
