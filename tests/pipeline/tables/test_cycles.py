"""Every cycle of the worst points, against each point counted for itself."""

from types import SimpleNamespace

import numpy as np
import pyarrow as pa
import pytest

from fatigue.case import load_case
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.records.history import ModalHistory
from fatigue.pipeline.count.worst import WorstPoint
from fatigue.pipeline.solve.model import read_model
from fatigue.pipeline.tables import cycles
from fatigue.pipeline.tables.cycle_rows import kept_point
from tests.small_case import small_case

POINTS = (WorstPoint(0, 2, 0), WorstPoint(1, 9, 1), WorstPoint(1, 13, 0))


def kept(model):
    """What the cycles of the points need."""
    return [kept_point(model, point) for point in POINTS]


class OnlySlices:
    """Modal coordinates that are never there as a whole."""

    def __init__(self, q):
        self._q, self.shape, self.dtype = q, q.shape, q.dtype

    def __getitem__(self, part):
        """Give some samples of all modes."""
        assert part[0] == slice(None)
        return self._q[part]


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    """The solved small case."""
    return read_model(load_case(small_case().write(tmp_path_factory.mktemp("case"))), strict=False)


@pytest.fixture(scope="module")
def load():
    """Record of one event in single precision that starts at 3 s, stress factor 1.5, with constants beside it."""
    q = np.random.default_rng(4).normal(0.0, 20.0, (3, 9000)).cumsum(axis=1).astype(np.float32)
    history = ModalHistory("run", np.array([1, 2, 7]), OnlySlices(q), 0.01, 3.0)
    offset = np.array([20.0, -1.0, 3.0])
    return SimpleNamespace(counted=history, stress_factor=1.5, residue="repeat", vertex=False, offset=offset)


@pytest.mark.parametrize("samples_at_once", [1, 40_000, 4_000_000])
def test_cycles_are_those_of_each_point_alone(model, load, monkeypatch, samples_at_once):
    """In the order of the points, whatever number of them is recovered at once."""
    monkeypatch.setattr(cycles, "_SAMPLES_AT_ONCE", samples_at_once)
    treated, q = model.stations.treated, load.counted.q[:, :].astype(float)
    found = of_points(cycles.point_cycles(kept(model), load), model)
    for point, rows in zip(POINTS, found, strict=True):
        membrane, bending = (1.5 * s[point.station] @ q for s in (treated.membrane, treated.bending))
        stress = membrane + bending if point.face == 0 else membrane - bending
        expected = rainflow(stress, "repeat")
        assert rows["start_s"].to_numpy() == pytest.approx(3.0 + 0.01 * expected.start)
        assert rows["range_MPa"].to_numpy() == pytest.approx(expected.range, rel=1e-9)
        side = 1.0 - 2.0 * point.face
        constant = 1.5 * (treated.membrane + side * treated.bending)[point.station] @ load.offset
        assert rows["mean_MPa"].to_numpy() == pytest.approx(expected.mean + constant, rel=1e-9)
        across = np.abs(bending[expected.end] - bending[expected.start])
        assert rows["bending_range_MPa"].to_numpy() == pytest.approx(across, rel=1e-9)


def of_points(found, model):
    """The rows of each of ``POINTS``, however many were found at a time."""
    rows = pa.concat_tables([pa.table(dict(some)) for some in found]).to_pandas()
    assert rows["node"].drop_duplicates().tolist() == [model.stations.node[point.station] for point in POINTS]
    return [of_one.reset_index() for _, of_one in rows.groupby("node", sort=False)]


def test_rows_name_their_point(model, load):
    """Weld, node, face and event are the same in all rows of a point."""
    for point, rows in zip(POINTS, of_points(cycles.point_cycles(kept(model), load), model), strict=True):
        assert rows["weld"].unique().tolist() == ["AB"[point.weld]]
        assert rows["surface"].unique().tolist() == [("top", "bottom")[point.face]]
        assert rows["event"].unique().tolist() == ["run"]
        assert set(rows["order"]) == {model.stations.order[point.station]}


@pytest.mark.parametrize("number_of_points", [0, 1, cycles.POINTS_AT_ONCE, 2 * cycles.POINTS_AT_ONCE + 1])
def test_points_are_written_many_at_a_time_and_all(model, load, monkeypatch, number_of_points):
    """However they come in, in their order; a record is read once for as many as belong together."""
    at_once, found = [], []

    def rows_of(points, load):
        at_once.append(len(points))
        return cycles_of(points, load)

    cycles_of = cycles.point_cycles
    monkeypatch.setattr(cycles, "point_cycles", rows_of)
    points = (kept(model) * number_of_points)[:number_of_points]
    writer = cycles.cycle_writer(SimpleNamespace(write=found.append), [load])
    for point in points:
        writer.add([point])
    writer.flush()
    nodes = np.concatenate([rows["node"] for rows in found]) if found else np.empty(0)
    assert nodes[np.flatnonzero(np.diff(nodes, prepend=-1))].tolist() == [point.node for point in points]
    assert set(at_once[:-1]) <= {cycles.POINTS_AT_ONCE}
