"""Rows of the result tables: order of points, events and modes, and what is missing."""

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.case import load_case
from fatigue.life.mission import Pass, Plan
from fatigue.pipeline.count.block import TIERS
from fatigue.pipeline.count.result import OF_EVENT, GroupResult
from fatigue.pipeline.solve.model import read_model
from fatigue.pipeline.tables.rows import damage_rows, node_rows, stress_rows
from fatigue.results import table_writer
from fatigue.spectrum.trust import VERDICTS
from tests.small_case import small_case

PLAN = Plan((Pass("run", 100, 2.0, 1.0, None), Pass("lift", 2, None, None, 3.0)), 1e6, 2e5, 1.0)


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    """The solved small case: 14 stations."""
    return read_model(load_case(small_case().write(tmp_path_factory.mktemp("case"))), strict=False)


def numbered(stations, events):
    """A result in which every quantity has numbers of its own, counted up over stations and faces."""
    result = GroupResult.empty(events, stations)
    for array in (result.event_columns, result.of_mission):
        array[...] = 0.25 + np.arange(array.size).reshape(array.shape)
    result.verdicts[...], result.verdict[...], result.governing[...], result.tier[...] = 0, 0, 1, 0
    return result


def written(folder, table, rows):
    """Write rows and read them again."""
    folder.mkdir(exist_ok=True)
    with table_writer(folder, table) as writer:
        writer.write(rows)
    return pq.read_table(folder / f"{table}.parquet").to_pandas()


def test_points_come_station_by_station_top_before_bottom(model, tmp_path):
    """Texts by their codes; event -1 and NaN are null, tier 0 is empty."""
    n = len(model.stations)
    result = numbered(n, len(PLAN.passes))
    block = result.mission
    block.governing[3, 1], block.verdict[3, 1], block.shear_ratio[2, 0], result.tier[5] = -1, 4, np.nan, 2
    nodes = written(tmp_path, "nodes", node_rows(model.stations, result, PLAN, ["user"] * len(model.welds)))

    assert list(nodes["weld"]) == ["A"] * 14 + ["B"] * 14
    assert nodes["toe"].tolist() == model.stations.toe.ravel().tolist()
    assert list(nodes["surface"]) == ["top", "bottom"] * n
    assert list(nodes["node"]) == list(np.repeat(model.stations.node, 2))
    assert list(nodes["life_km"]) == list(block.life_km.ravel())
    assert list(nodes["x_mm"]) == list(np.repeat(model.stations.xyz[:, 0], 2))
    assert np.flatnonzero(nodes["governing_event"].isna()).tolist() == [7]
    assert set(nodes["governing_event"].dropna()) == {"lift"}
    assert nodes["dirlik_verdict"][7] == VERDICTS[4]
    assert np.flatnonzero(nodes["shear_ratio"].isna()).tolist() == [4]
    assert nodes["screened"].tolist() == [TIERS[2] if i in (10, 11) else "" for i in range(2 * n)]


def test_damage_lists_the_events_of_a_point_one_after_the_other(model, tmp_path):
    """Per km where a pass has a length, null where it has none."""
    n = len(model.stations)
    result = numbered(n, len(PLAN.passes))
    damage = written(tmp_path, "damage", damage_rows(model.stations, result, PLAN, slice(None)))

    assert list(damage["event"]) == ["run", "lift"] * (2 * n)
    assert list(damage["surface"][:4]) == ["top", "top", "bottom", "bottom"]
    run, lift = damage[::2], damage[1::2]
    for name in OF_EVENT:
        of_run, of_lift = result.of_events(name)
        assert list(run[name]) == list(of_run.ravel())
        assert list(lift[name]) == list(of_lift.ravel())
    assert list(run["cycles_per_km"]) == list(result.of_events("cycles_per_pass")[0].ravel() / 2.0)
    assert lift["cycles_per_km"].isna().all()

    part = written(tmp_path / "part", "damage", damage_rows(model.stations, result, PLAN, slice(5, 9)))
    pd.testing.assert_frame_equal(part, damage[4 * 5 : 4 * 9].reset_index(drop=True))


def test_stress_lists_the_modes_of_a_station_one_after_the_other(model, tmp_path):
    """All five components as solved and with the ends treated."""
    rows = written(tmp_path, "structural_stress", stress_rows(model.stations, model.body.coordinates, slice(None)))
    assert list(rows["mode"]) == [1, 2, 7] * len(model.stations)
    assert list(rows["order"]) == list(np.repeat(model.stations.order, 3))
    for component in ("membrane", "bending", "in_plane_shear", "twist_shear", "transverse_shear"):
        assert list(rows[f"{component}_MPa"]) == list(getattr(model.stations.treated, component).ravel())
        raw = getattr(model.stations.treated, component).copy()
        raw[model.stations.raw_ends.rows] = getattr(model.stations.raw_ends.stress, component)
        assert list(rows[f"{component}_raw_MPa"]) == list(raw.ravel())
    part = written(
        tmp_path / "part", "structural_stress", stress_rows(model.stations, model.body.coordinates, slice(5, 9))
    )
    pd.testing.assert_frame_equal(part, rows[15:27].reset_index(drop=True))
