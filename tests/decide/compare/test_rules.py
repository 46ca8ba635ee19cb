"""What two results have differently, from their records: every kind once, in words, with where it shows."""

import copy
from dataclasses import replace

import pytest

from fatigue.decide.compare.finished import Finished, read_results
from fatigue.decide.compare.matched.welds import WeldMap, match_welds
from fatigue.decide.compare.rules import differences


@pytest.fixture(scope="module")
def result(small_result) -> Finished:
    """The small result as it is read."""
    return read_results([small_result], no_lock=False)[0]


MODES_MOVED = ("mode 2: 12 Hz", "mode 2: 11 Hz", "per_pass and modes")


def changed(result: Finished, change) -> dict[str, tuple[str, str, str]]:
    """Differences from the same result with another record."""
    record = copy.deepcopy(result.record)
    change(record)
    other = replace(result, letter="B", record=record)
    found = differences(result, other, match_welds(result, other, WeldMap(), accept_proposed=False))
    assert len({one.what for one in found}) == len(found)
    assert {one.result for one in found} <= {"B"}
    return {one.what: (one.value, one.other_value, one.sits_in) for one in found}


def test_the_same_differs_in_nothing(result):
    """Two records that are equal, and what was only counted or kept."""
    assert changed(result, lambda record: None) == {}

    def counted(record):
        record["rules"]["screening"]["stations"] = {"counted": 1}
        record["rules"]["knee_cycles"] = 1e8  # no knee without an extension

    assert changed(result, counted) == {}


@pytest.mark.parametrize(
    ("path", "value", "known"),
    [
        ("rules.thickness_rule", "asme", {"thickness_rule": ("actual", "asme", "per_pass")}),
        ("rules.mean_stress", "asme", {"mean_stress": ("none", "asme", "per_pass")}),
        ("rules.weld_ends", "none", None),
        ("rules.residue.noise", "half", None),
        ("rules.precision", "single", {"precision": ("double", "single", "per_pass")}),
        ("rules.spectrum.segment_s", 2.0, None),
        ("mission.target_km", 3e6, {"target_km": ("1000000", "3000000", "the verdict only")}),
        ("mission.km_per_year", 1e5, {"km_per_year": ("200000", "100000", "years only")}),
        ("force_convention", "on_node", {"force_convention": ("on_element", "on_node", "per_pass")}),
        ("software.fatigue", "9.9", None),
        ("modes.frequency_hz", [5.0, 11.0, 60.0], {"modes, matched by their numbers": MODES_MOVED}),
    ],
)  # fmt: skip
def test_each_kind_is_told(result, path, value, known):
    """One entry changed, one difference told."""

    def change(record):
        *tables, key = path.split(".")
        for name in tables:
            record = record[name]
        assert record[key] != value
        record[key] = value

    found = changed(result, change)
    assert len(found) == 1
    assert known is None or found == known


@pytest.mark.parametrize(("rule", "value"), [("spectrum", {"segment_s": 2.0}), ("life_band", {"miner_sigma_ln": 0.3})])
def test_what_lies_beside_the_life_is_told_as_such(result, rule, value):
    """The rules of the estimate, of bands and of what is kept say nothing of the life."""
    found = changed(result, lambda record: record["rules"][rule].update(value))
    ((_, _, sits_in),) = found.values()
    assert sits_in.startswith("nothing of the life")


def test_events_and_sequences(result):
    """Shares, lengths, factors; a sequence with its order; nothing of a rule that only one record has."""

    def change(record):
        event = record["mission"]["events"][0]
        event.update(share=0.5, length=0.7, stress_factor=1.1)
        record["mission"]["sequences"] = [{"name": "(sequence 1)", "order": ["sine", "noise"], "runs_per_km": 1e-3}]
        del record["rules"]["reversals"]

    found = changed(result, change)
    assert found["share, sine"] == ("0.75", "0.5", "mission")
    assert found["length of a pass [km], sine"][2] == "mission"
    assert found["stress_factor, sine"] == ("1", "1.1", "per_pass")
    assert found["(sequence 1)"] == ("–", "sine > noise", "sequence")
    assert len(found) == 4


def test_a_curve_of_the_same_name_with_other_numbers(result):
    """Told with its key; survival, which moves its constants, only once."""

    def other(record):
        record["curves"]["master-aluminium"]["reference_range"]["mean"] = 3000.0

    assert list(changed(result, other)) == ["curve master-aluminium: reference_range.mean"]
    welds = result.welds.assign(survival="mean-3sigma", curve=["master-aluminium", "my-class"])
    b = replace(result, letter="B", welds=welds)
    found = {one.what: one for one in differences(result, b, match_welds(result, b, WeldMap(), accept_proposed=False))}
    assert set(found) == {"survival", f"curve of {welds.index[1]}"}
    assert found["survival"].sits_in == "per_pass"


def test_a_limit_of_some_welds(result):
    """Older tables of welds have no limit: that of the mission counts."""
    limit = result.limit.copy()
    limit[0] = 0.3
    b = replace(result, letter="B", limit=limit)
    (found,) = differences(result, b, match_welds(result, b, WeldMap(), accept_proposed=False))
    assert found.what == f"damage limit of {result.points.names[0]}"
    assert (found.value, found.other_value, found.sits_in) == ("1", "0.3", "limit")
