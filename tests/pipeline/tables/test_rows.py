"""Rows of the result tables: order of points, events and modes, and what is missing."""

from dataclasses import fields

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.case import load_case
from fatigue.life.mission import Pass, Plan
from fatigue.pipeline.count.event_block import EventBlock
from fatigue.pipeline.count.mission_block import MissionBlock
from fatigue.pipeline.count.piece import TIERS
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


def numbered(kind, stations, first, **codes):
    """Give every quantity of a block numbers of its own, counted up over stations and faces."""
    numbers = np.arange(2.0 * stations).reshape(stations, 2)
    return kind(**{f.name: numbers + first + 100.0 * i for i, f in enumerate(fields(kind))} | codes)


def written(folder, table, rows):
    """Write rows and read them again."""
    folder.mkdir(exist_ok=True)
    with table_writer(folder, table) as writer:
        writer.write(rows)
    return pq.read_table(folder / f"{table}.parquet").to_pandas()


def test_points_come_station_by_station_top_before_bottom(model, tmp_path):
    """Texts by their codes; event -1 and NaN are null, tier 0 is empty."""
    n = len(model.stations)
    governing, verdict = np.ones((n, 2), dtype=np.int64), np.zeros((n, 2), dtype=np.int8)
    governing[3, 1], verdict[3, 1] = -1, 4
    block = numbered(MissionBlock, n, 0.5, governing=governing, verdict=verdict)
    block.shear_ratio[2, 0] = np.nan
    tier = np.zeros(n, dtype=np.int8)
    tier[5] = 2
    nodes = written(tmp_path, "nodes", node_rows(model.stations, block, tier, PLAN))

    assert list(nodes["weld"]) == ["A"] * 14 + ["B"] * 14
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
    verdict = {"verdict": np.zeros((n, 2), dtype=np.int8)}
    events = [numbered(EventBlock, n, first, **verdict) for first in (0.25, 5000.25)]
    damage = written(tmp_path, "damage", damage_rows(model.stations, events, PLAN, slice(None)))

    assert list(damage["event"]) == ["run", "lift"] * (2 * n)
    assert list(damage["surface"][:4]) == ["top", "top", "bottom", "bottom"]
    run, lift = damage[::2], damage[1::2]
    for name, per_pass in (("damage", "damage_per_pass"), ("kurtosis", "kurtosis"), ("mean", "mean_stress_MPa")):
        assert list(run[per_pass]) == list(getattr(events[0], name).ravel())
        assert list(lift[per_pass]) == list(getattr(events[1], name).ravel())
    assert list(run["cycles_per_km"]) == list(events[0].cycles.ravel() / 2.0)
    assert lift["cycles_per_km"].isna().all()

    part = written(tmp_path / "part", "damage", damage_rows(model.stations, events, PLAN, slice(5, 9)))
    pd.testing.assert_frame_equal(part, damage[4 * 5 : 4 * 9].reset_index(drop=True))


def test_stress_lists_the_modes_of_a_station_one_after_the_other(model, tmp_path):
    """All five components as solved and with the ends treated."""
    rows = written(tmp_path, "structural_stress", stress_rows(model.stations, model.modes.mode, slice(None)))
    assert list(rows["mode"]) == [1, 2, 7] * len(model.stations)
    assert list(rows["order"]) == list(np.repeat(model.stations.order, 3))
    for component in ("membrane", "bending", "in_plane_shear", "twist_shear", "transverse_shear"):
        assert list(rows[f"{component}_MPa"]) == list(getattr(model.stations.treated, component).ravel())
        raw = getattr(model.stations.treated, component).copy()
        raw[model.stations.raw_rows] = getattr(model.stations.raw, component)
        assert list(rows[f"{component}_raw_MPa"]) == list(raw.ravel())
    part = written(tmp_path / "part", "structural_stress", stress_rows(model.stations, model.modes.mode, slice(5, 9)))
    pd.testing.assert_frame_equal(part, rows[15:27].reset_index(drop=True))
