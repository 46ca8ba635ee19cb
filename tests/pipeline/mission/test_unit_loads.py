"""Unit loads of events: their constants, what is said of loads that stand still, and how records are told apart."""

import numpy as np
import pandas as pd
import pytest

from fatigue.case import load_case
from fatigue.pipeline.mission.counted import event_counts, listed
from fatigue.pipeline.mission.events import event_load
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.mission.unit_loads import event_constants
from fatigue.pipeline.solve.body import read_body
from tests.small_case import small_case
from tests.unit_load_case import LOAD, as_unit_load, write_with_loads

STATIC = '[[mission.event]]\nname = "{name}"\nper_1000_km = 1.0\n'
GIVEN = '[[mission.event.unit_load]]\nname = "{name}"\nunit = "kN"\n{what}\n'
OF_MISSION = '[[mission.unit_load]]\nname = "dead"\nunit = "kN"\nconstant = 2.0\n'


def body_of(tmp_path, change=lambda case: None, more="", upsample=1, strict=True):
    """The small case with mode 2 as unit load ``force`` and a load ``dead``, constant in the mission."""
    case = small_case(seconds=2.0)
    case.counting = {"upsample": upsample}
    forces = as_unit_load(case, 2, "force")
    case.extra += LOAD.format(name="dead", suffix="csv") + OF_MISSION + more
    change(case)
    path = write_with_loads(case, tmp_path, pd.concat([forces, forces.assign(unit_load="dead")]))
    return read_body(load_case(path), strict=strict)


def warnings_of(body) -> dict[str, str]:
    """What is said of the records, by code."""
    _, warnings = mission_plan(body, 1)
    return {warning.code: warning.what for warning in warnings}


def test_constants_of_an_event(tmp_path):
    """Of the mission, or its own, scaled; modes and loads over time have none, and the samples nothing of them."""
    own = STATIC.format(name="lift") + GIVEN.format(name="force", what="values = [0.0, 1.0]")
    own += GIVEN.format(name="dead", what="constant = 3.0\nscale = -1.5")
    body = body_of(tmp_path, more=own)
    events = body.case.mission.event
    assert event_constants(body, events[0]).tolist() == [0.0, 0.0, 0.0, 2.0]
    assert event_constants(body, events[-1]).tolist() == [0.0, 0.0, 0.0, -4.5]
    for event in (events[0], events[-1]):
        assert not event_load(body, event, 1).counted.q[3].any()


def test_without_unit_loads_there_are_no_constants(tmp_path):
    """One zero for each mode."""
    body = read_body(load_case(small_case(2.0).write(tmp_path)), strict=True)
    assert event_constants(body, body.case.mission.event[0]).tolist() == [0.0] * 3


def test_sound_loads_are_silent(tmp_path):
    """Also one that stands still in some events, as pressure does where there is no tunnel."""

    def change(case):
        case.histories["sine"]["u_force"] = 0.0

    told = warnings_of(body_of(tmp_path, change))
    assert not {"load_at_rest", "unused_unit_load", "load_overshoot", "same_record"} & told.keys()


def test_a_load_that_changes_nowhere(tmp_path):
    """Given over time in every event, and constant in all of them."""

    def change(case):
        for table in case.histories.values():
            table["u_force"] = 4.0

    assert (
        "the unit load 'force' is given over time and changes in no event"
        in warnings_of(body_of(tmp_path, change))["load_at_rest"]
    )


def test_an_event_that_only_a_load_moves_is_not_at_rest(tmp_path):
    """Its modes stand still."""

    def change(case):
        for name in ("q_1", "q_7"):
            case.histories["noise"][name] = 0.0

    assert "event_at_rest" not in warnings_of(body_of(tmp_path, change))


def test_a_static_load_case_at_rest(tmp_path):
    """Values that are all the same."""
    same = STATIC.format(name="lift") + GIVEN.format(name="force", what="values = [1.0, 1.0]")
    assert (
        "no modal coordinate and no unit load changes in event 'lift'"
        in warnings_of(body_of(tmp_path, more=same))["event_at_rest"]
    )


@pytest.mark.parametrize(("constant", "same"), [(2.0, True), (3.0, False)])
def test_constants_tell_records_apart(tmp_path, constant, same):
    """Empty and loaded runs may share one record; the same load twice may not."""

    def change(case):
        case.events.append(case.events[2] | {"name": "again", "per_1000_km": 3.0})
        case.extra = case.extra.replace(OF_MISSION, "")
        case.events = [event | {"history": event["history"]} for event in case.events]

    def written(case):
        change(case)
        text = ""
        for event in case.events:
            keys = {**event, "history": f"{event['history']}.csv"}
            value = constant if event["name"] == "again" else 2.0
            text += "[[mission.event]]\n" + "".join(f"{k} = {v!r}\n" for k, v in keys.items())
            text += GIVEN.format(name="dead", what=f"constant = {value}")
        case.events = []
        case.extra += text

    assert ("same_record" in warnings_of(body_of(tmp_path, written))) == same


@pytest.mark.parametrize("upsample", [1, 2, 8, "auto"])
def test_static_load_cases_are_never_upsampled(tmp_path, upsample):
    """Their plan says so, too."""
    static = STATIC.format(name="lift") + GIVEN.format(name="force", what="values = [0.0, 1.0, 0.2]")
    body = body_of(tmp_path, more=static, upsample=upsample)
    plan, _ = mission_plan(body, 1)
    assert (plan.passes[-1].samples, plan.passes[-1].factor(8)) == (3, 1)
    load = event_load(body, body.case.mission.event[-1], 8)
    assert np.asarray(load.counted.q)[2].tolist() == [0.0, 1.0, 0.2]
    assert (load.moments, load.is_upsampled, load.residue) == (None, False, "half")


def test_a_finer_load_upsamples_its_event_alone(tmp_path):
    """By a power of 2; the larger of this and ``upsample`` counts, and the duration stays."""
    t = np.arange(0.0, 2.1, 0.0015)
    own = STATIC.format(name="pulse") + 'history = "noise.csv"\nresidue = "half"\n'
    own += GIVEN.format(name="force", what='history = "p.csv"')
    pd.DataFrame({"time_s": t, "u_force": np.sin(9.0 * t)}).to_csv(tmp_path / "p.csv", index=False)
    body = body_of(tmp_path, more=own, strict=False)
    plan, _ = mission_plan(body, 1)
    assert [one.refined for one in plan.passes] == [1, 1, 1, 4]
    event = body.case.mission.event[-1]
    loads = {factor: event_load(body, event, factor) for factor in (1, 4, 8)}
    assert [load.counted.q.shape[1] for load in loads.values()] == [4 * 399 + 1, 4 * 399 + 1, 8 * 399 + 1]
    assert {round(load.duration, 9) for load in loads.values()} == {2.0}
    assert [load.upsample for load in loads.values()] == [4, 4, 8]


def test_what_events_count(tmp_path):
    """Half a cycle, one, at most so many, or all of a record."""
    static = ""
    for name, values, residue in (
        ("a", "[0, 1]", "repeat"),
        ("b", "[0, 1, 0, 2]", "half"),
        ("c", "[0, 1, 0]", "repeat"),
    ):
        static += STATIC.format(name=name) + f'residue = "{residue}"\n'
        static += GIVEN.format(name="force", what=f"values = {values}")
    body = body_of(tmp_path, more=static)
    plan, _ = mission_plan(body, 1)
    counts = {one.event: (one.cycles, one.counts) for one in event_counts(body.case, plan)}
    assert counts == {
        "sine": (None, "every cycle of the record, repeated"),
        "noise": (None, "every cycle of the record, repeated"),
        "load and unload": (0.5, "half a cycle (load or unload)"),
        "a": (1.0, "one cycle (load and unload)"),
        "b": (1.5, "at most 1.5 cycles"),
        "c": (1.0, "at most 1 cycle"),
    }
    many = event_counts(body.case, plan) * 4
    assert listed(many)[-1] == "and 8 more"
    assert all("every cycle" not in line for line in listed(many))
