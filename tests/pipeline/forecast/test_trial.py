"""What a job will take: parts that add up and grow as the job does; seconds are measured in the benchmarks."""

from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from fatigue.case import load_case
from fatigue.pipeline.forecast.trial import CELL, CYCLE, DETAIL, PAGE, START, job_time
from fatigue.pipeline.forecast.upsampling_trial import foretold
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.model import solve_group
from fatigue.pipeline.solve.weld_groups import weld_groups
from fatigue.results.columns import DAMAGE, NODES, STRUCTURAL_STRESS
from tests.small_case import sine_only, small_case


def needed(case, folder, stations=None):
    """Estimate a case."""
    body = read_body(load_case(case.write(folder)), strict=False)
    plan, _ = mission_plan(body)
    with TemporaryDirectory() as scratch:
        model = solve_group(weld_groups(body, Path(scratch)), 0)
        upsampled = foretold(body, plan, Path(scratch))
        upsampled.add(model.stations.treated)
        factors = upsampled.factors(body.case.counting.upsample, plan)
        return job_time(plan, model, stations or len(model.stations), factors, 0.5, Path(scratch))


def test_the_parts_add_up(tmp_path):
    """All of them are above 0; every point is counted in a small job, so both totals are one."""
    time = needed(small_case(), tmp_path)
    parts = (time.start, time.events, time.counting, time.tables, time.report)
    assert min(parts) > 0.0
    assert time.total == pytest.approx(sum(parts))
    assert time.start == START + 0.5
    assert not time.screened
    assert time.total_exact == time.total


def test_tables_by_hand(tmp_path):
    """One sine: 60 cycles at the worst point of each of two welds, 14 stations, three modes, one event."""
    time = needed(sine_only(), tmp_path)
    cells = 2 * 14 * (len(NODES) + len(DAMAGE)) + 14 * 3 * len(STRUCTURAL_STRESS)
    assert time.tables == pytest.approx(CELL * cells + CYCLE * 2 * 60)
    assert time.report == pytest.approx(PAGE + 2 * DETAIL, rel=1e-2)


def test_more_stations_take_as_much_more(tmp_path):
    """Tables grow in proportion; the start does not."""
    one = needed(sine_only(), tmp_path)
    ten = needed(sine_only(), tmp_path, stations=140)
    assert ten.tables == pytest.approx(10 * one.tables)
    assert ten.start == one.start


def test_large_jobs_are_screened_and_both_are_foretold(tmp_path, monkeypatch):
    """Above the limit bounds settle what they can; all points counted is another number."""
    monkeypatch.setattr("fatigue.pipeline.mission.precision.LARGE_FROM", 0.0)
    time = needed(small_case(), tmp_path)
    assert time.screened
    assert time.counting > 0.0
    assert time.counting_exact > 0.0
    assert time.total_exact - time.total == pytest.approx(time.counting_exact - time.counting)


@pytest.mark.parametrize("factor", ["auto", 4])
def test_upsampled_records_are_foretold(tmp_path, factor):
    """Also where the factor is found by the program; what is written stays as much."""
    case = small_case()
    plain = needed(case, tmp_path / "plain")
    case.counting["upsample"] = factor
    fine = needed(case, tmp_path / "fine")
    assert fine.tables == pytest.approx(plain.tables, rel=0.2)  # as many cycles, on more samples
