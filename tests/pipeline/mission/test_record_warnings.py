"""Records that stand still, modes lost from them, one record for two events."""

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.body import read_body
from tests.small_case import small_case

NEW = {"event_at_rest", "mode_at_rest", "same_record", "unusual_speed"}


def warnings_of(tmp_path, change, suffix="csv"):
    """Tell the warnings about the records of a small case in which something is changed."""
    case = small_case(seconds=2.0)
    change(case)
    _, warnings = mission_plan(read_body(load_case(case.write(tmp_path, suffix)), strict=True), 1)
    return [warning for warning in warnings if warning.code in NEW]


def test_sound_records_are_silent(tmp_path):
    """A sine in one mode alone, an interface mode at rest and a load case of two samples are no doubt."""
    assert warnings_of(tmp_path, lambda case: None) == []


@pytest.mark.parametrize("value", [0.0, 7.5, 1e12])
@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_an_event_at_rest(tmp_path, value, suffix):
    """A record whose coordinates are all constant does no damage, whatever the constant."""

    def change(case):
        for name in ("q_1", "q_2", "q_7"):
            case.histories["noise"][name] = value

    (problem,) = warnings_of(tmp_path, change, suffix)
    assert problem.code == "event_at_rest"
    assert problem.where.startswith(f"noise.{suffix}")
    assert "event 'noise'" in problem.what


def test_rounding_is_no_movement(tmp_path):
    """The last digits of a large constant are noise of the export."""

    def change(case):
        noise = case.histories["noise"]
        for name in ("q_1", "q_2", "q_7"):
            noise[name] = 1e6 * (1.0 + 2e-16 * (np.arange(len(noise)) % 2))

    assert [problem.code for problem in warnings_of(tmp_path, change)] == ["event_at_rest"]


def test_movement_in_the_start_up_only(tmp_path):
    """What is cut off does not count as movement."""

    def change(case):
        noise = case.histories["noise"]
        noise.loc[noise.time_s > 0.9, ["q_1", "q_2", "q_7"]] = 1.0

    assert [problem.code for problem in warnings_of(tmp_path, change)] == ["event_at_rest"]


def test_a_rigid_mode_alone_is_at_rest(tmp_path):
    """A body that only drives along is not bent."""

    def change(case):
        case.modes["kind"] = ["rigid", "normal", "interface"]
        case.histories["noise"][["q_2", "q_7"]] = 0.0

    assert "event_at_rest" in [p.code for p in warnings_of(tmp_path, change) if "'noise'" in p.what]


def test_a_column_that_was_lost(tmp_path):
    """One normal mode at zero while the others move is told; an interface mode at zero is not."""

    def at_zero(name):
        def change(case):
            case.histories["noise"][name] = 0.0

        return change

    assert warnings_of(tmp_path / "a", at_zero("q_7")) == []
    (problem,) = warnings_of(tmp_path / "b", at_zero("q_1"))
    assert problem.code == "mode_at_rest"
    assert "normal mode 1 stands still in event 'noise'" in problem.what


@pytest.mark.parametrize("copied", ["file", "bytes", "single"])
def test_two_events_with_one_record(tmp_path, copied):
    """One file, a copy of it, and a copy in single precision; told with what the two events differ in."""

    def change(case):
        twin = case.histories["noise"].copy()
        if copied == "single":
            twin[["q_1", "q_2", "q_7"]] = twin[["q_1", "q_2", "q_7"]].astype(np.float32).astype(np.float64)
        case.histories["twin"] = twin
        case.events[1]["share"] = 0.15
        name = "noise" if copied == "file" else "twin"
        case.events.append({"name": "worn", "history": name, "speed_km_h": 300.0, "share": 0.1, "start_s": 1.0})

    (problem,) = warnings_of(tmp_path, change)
    assert problem.code == "same_record"
    assert "events 'noise' and 'worn' have the same record" in problem.what
    assert ("both name noise.csv" if copied == "file" else "in noise.csv and twin.csv") in problem.what
    assert "differ in share (0.15 and 0.1), speed_km_h (360 and 300)" in problem.what


def test_a_record_scaled_by_factors_is_meant(tmp_path):
    """Events that differ in their stress factor use one record on purpose."""

    def change(case):
        case.events[1]["share"] = 0.15
        case.events.append(case.events[1] | {"name": "laden", "share": 0.1, "stress_factor": 1.2})

    assert warnings_of(tmp_path, change) == []


def test_records_that_differ_in_one_mode(tmp_path):
    """A part in ten thousand in one column is another record."""

    def change(case):
        case.histories["twin"] = case.histories["noise"].assign(q_7=case.histories["noise"].q_7 * 1.0001)
        case.events[1]["share"] = 0.15
        case.events.append(case.events[1] | {"name": "worn", "history": "twin", "share": 0.1})

    assert warnings_of(tmp_path, change) == []


def test_a_length_in_m(tmp_path):
    """The speed that length and duration make is told, once for all events."""

    def change(case):
        for event in case.events[:2]:
            event["length_km"] = event.pop("speed_km_h") / 3600.0 * 2.0 * 1000.0
        case.events[1]["length_km"] /= 2.0  # 1 s is cut off

    (problem,) = warnings_of(tmp_path, change)
    assert (problem.code, problem.count) == ("unusual_speed", 2)
    assert "makes 3.6e+05 km/h, outside 1 to 600 km/h" in problem.what
