"""The split of a log ratio: the numbers of its specification, and nothing left over whatever the damages are."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.decide.compare.causes import added, log_mean, log_ratio, split

# loads_oracles.json, B1_compare
A = {"e1": 2e-08, "e2": 5e-08, "e3": 1e-09}
B = {"e1": 2.5e-08, "e2": 1.2e-07, "e4": 3e-09}
PASSES_A = {"e1": 0.2, "e2": 0.05, "e3": 0.01}
PASSES_B = {"e1": 0.2, "e2": 0.08, "e4": 0.02}
LOG_MEAN = 1.0482859618383656e-07
LOG_LIFE_RATIO = -0.7345323967227997
BY_EVENT = {
    "e1": -0.047696908878103864,
    "e2": -0.6677567242934542,
    "e3": 0.009539381775620775,
    "e4": -0.028618145326862326,
}
SPLIT = {"e1": (-0.0, -0.04769690887810386), "e2": (-0.35849148059789293, -0.3092652436955612)}
MODES_OF_E2 = (
    [3e-08, 2.5e-08, -5e-09],
    [1.1e-07, 1.5e-08, -5e-09],
    [-0.763150542049662, 0.09539381775620775, -0.0],
)
TOTAL_A, TOTAL_B = math.fsum(A.values()), math.fsum(B.values())


def test_the_numbers_of_the_specification():
    """Log mean, events (one that vanishes, one that appears), mission and per pass, modes: to 1e-12."""
    assert float(log_mean(TOTAL_B, TOTAL_A)) == pytest.approx(LOG_MEAN, rel=1e-12)
    assert float(log_ratio(TOTAL_A, TOTAL_B)) == pytest.approx(LOG_LIFE_RATIO, rel=1e-12)
    for event, known in BY_EVENT.items():
        found = added(A.get(event, 0.0), B.get(event, 0.0), TOTAL_A, TOTAL_B)
        assert float(found) == pytest.approx(known, rel=1e-12)
    for event, (mission, per_pass) in SPLIT.items():
        n_a, n_b = PASSES_A[event], PASSES_B[event]
        found = split(n_a, n_b, A[event] / n_a, B[event] / n_b, TOTAL_A, TOTAL_B)
        assert float(found.mission) == pytest.approx(mission, rel=1e-12, abs=1e-15)
        assert float(found.per_pass) == pytest.approx(per_pass, rel=1e-12)
    ours, theirs, known = MODES_OF_E2
    assert added(ours, theirs, TOTAL_A, TOTAL_B) == pytest.approx(known, rel=1e-12, abs=1e-15)


DAMAGE = st.one_of(st.just(0.0), st.floats(1e-30, 1e3))
EVENTS = st.lists(st.tuples(DAMAGE, DAMAGE), min_size=1, max_size=12)


@given(EVENTS)
def test_events_leave_nothing_over(events):
    """Events of any size, in one result or in both, add up to the log ratio of the lives."""
    a, b = (np.array(side) for side in zip(*events, strict=True))
    if not (a.sum() > 0.0 and b.sum() > 0.0):
        return
    found = added(a, b, a.sum(), b.sum())
    scale = max(1.0, np.abs(found).max())
    assert found.sum() == pytest.approx(float(log_ratio(a.sum(), b.sum())), abs=1e-12 * scale)


POSITIVE = st.floats(1e-20, 1e3)


@given(POSITIVE, POSITIVE, POSITIVE, POSITIVE, st.floats(0.0, 1e-3))
def test_mission_and_per_pass_make_their_event(n_a, n_b, d_a, d_b, others):
    """Both parts add up to what the event adds, beside other damage that stays."""
    c_a, c_b = n_a * d_a, n_b * d_b
    parts = split(n_a, n_b, d_a, d_b, np.array(c_a + others), np.array(c_b + others))
    whole = float(added(c_a, c_b, c_a + others, c_b + others))
    scale = abs(float(parts.mission)) + abs(float(parts.per_pass))
    assert float(parts.mission + parts.per_pass) == pytest.approx(whole, abs=1e-11 * max(scale, 1e-3))


@given(st.lists(st.tuples(st.floats(-1e-3, 1e-3), st.floats(-1e-3, 1e-3)), min_size=1, max_size=20))
def test_signed_parts_make_their_event(modes):
    """Modes that relieve count with their sign and add up to the event."""
    a, b = (np.array(side) for side in zip(*modes, strict=True))
    total_a, total_b = 1.0 + abs(a.sum()), 2.0 + abs(b.sum())
    found = added(a, b, total_a, total_b)
    assert found.sum() == pytest.approx(float(added(a.sum(), b.sum(), total_a, total_b)), abs=1e-14)


@given(POSITIVE, st.floats(-1e-6, 1e-6))
def test_the_log_mean_of_near_numbers_lies_between_them(a, step):
    """No cancellation: it is between the numbers, and the mean of them to second order."""
    b = a * (1.0 + step)
    mean = float(log_mean(b, a))
    assert min(a, b) * (1 - 1e-15) <= mean <= max(a, b) * (1 + 1e-15)
    assert mean == pytest.approx(0.5 * (a + b), rel=1e-12)


def test_what_has_no_logarithm():
    """Numbers of two signs, zeros and infinities have none; a sequence that relieves in both has one."""
    a, b = np.array([1.0, 0.0, -1.0, np.inf, -2.0]), np.array([-1.0, 1.0, 0.0, 1.0, -1.0])
    assert np.isnan(log_ratio(b, a)).tolist() == [True, True, True, True, False]
    assert np.isnan(log_mean(b, a)).tolist() == [True, True, True, True, False]
    assert float(log_mean(-2.0, -1.0)) == pytest.approx(-float(log_mean(2.0, 1.0)), rel=1e-15)
    assert float(log_ratio(1e-320, 1e300)) == pytest.approx(math.log(1e-320) - math.log(1e300), rel=1e-12)
    parts = split(1.0, 1.0, -2e-9, -1e-9, np.array(1e-7), np.array(1e-7))
    assert float(parts.per_pass) == pytest.approx(float(added(-2e-9, -1e-9, 1e-7, 1e-7)), rel=1e-12)
    assert float(parts.mission) == 0.0


def test_the_case_by_hand_of_the_docs():
    """Every number of the table in docs/compare.md follows from its damages."""
    page = (Path(__file__).parents[3] / "docs" / "compare.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\w+) \| (\S+) \| (\S+) \| (\S*) ?\| (\S+) \| (\S+) \|$", page, re.MULTILINE)
    table = {name: (a, b, log, factor) for name, a, b, _, log, factor in rows}
    assert list(table) == ["straight", "worn", "yard", "tunnel", "all"]
    a, b = ({name: 0.0 if row[side] == "-" else float(row[side]) for name, row in table.items()} for side in (0, 1))
    for name, (_, _, log, factor) in table.items():
        found = float(added(a[name], b[name], a["all"], b["all"]))
        assert log == f"{found:.4f}"
        assert factor == f"{math.exp(found):.3g}".ljust(len(factor), "0")
    parts = split(1.0, 1.6, 50.0, 75.0, np.array(71.0), np.array(148.0))
    assert f"Of worn, {float(parts.mission):.4f} is the mission" in page
    assert f"and {float(parts.per_pass):.4f} the pass" in page
    assert f"L(148, 71) = {float(log_mean(148.0, 71.0)):.1f}" in page
