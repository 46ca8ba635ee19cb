"""The station and the mode of every row, in tables of every order."""

from itertools import product

import numpy as np
import pytest

from fatigue.readers.neutral.body.modes import read_modes
from fatigue.readers.neutral.body.welds import read_welds
from fatigue.readers.neutral.forces.placement import RowKeys, grid, positions, slots, stations_of
from tests.readers.neutral_tables import MODES, WELD_NODES, WELDS, read_weld_nodes, write

STATIONS = list(zip(WELD_NODES["weld"], WELD_NODES["node"], strict=True))  # seam first, as in the table of welds


@pytest.fixture
def body(tmp_path):
    """Lines and modes of the small body."""
    welds, _ = read_welds(write(tmp_path / "w.csv", WELDS), None, strict=True)
    lines, _ = read_weld_nodes(write(tmp_path / "n.csv", WELD_NODES), welds, strict=True)
    return lines, read_modes(write(tmp_path / "m.csv", MODES), (), strict=True)[0]


def keys(rows) -> RowKeys:
    """Keys of rows ((weld, node), mode)."""
    names = tuple(sorted({weld for (weld, _), _ in rows}))
    weld = np.array([names.index(weld) for (weld, _), _ in rows], np.int32)
    return RowKeys(names, weld, np.array([node for (_, node), _ in rows]), np.array([mode for _, mode in rows]))


def expected(lines, modes) -> np.ndarray:
    """1000 node + mode of every station and mode."""
    return 1000 * lines.node[:, np.newaxis] + modes.mode


@pytest.mark.parametrize("by_node", [True, False])
@pytest.mark.parametrize("first", [0, 3])
def test_a_grid_is_found(body, by_node, first):
    """Node by node or mode by mode, from any station on; every value arrives at its station and mode."""
    stations = STATIONS[first:] + STATIONS[:first]
    pairs = product(stations, MODES["mode"]) if by_node else product(MODES["mode"], stations)
    rows = list(pairs) if by_node else [(station, mode) for mode, station in pairs]
    found = keys(rows)
    regular = grid(found, *body, ())
    assert regular is not None
    assert regular.by_node == by_node
    np.testing.assert_array_equal(regular.by_station(1000 * found.node + found.mode), expected(*body))


def test_rows_in_any_order(body):
    """No grid, but every row has its slot; foreign nodes and modes have none."""
    rows = list(product(STATIONS, MODES["mode"]))
    mixed = [rows[i] for i in np.random.default_rng(0).permutation(len(rows))]
    found = keys([*mixed, (("seam", 99), 3), (("ring", 11), 3), (("seam", 11), 8)])
    assert grid(found, *body, ()) is None
    looked_up = slots(found, *body)
    assert looked_up.slot[-3:].tolist() == [-1, -1, -1]
    assert (looked_up.station[-3:].tolist(), looked_up.mode[-1]) == ([-1, -1, 0], -1)
    np.testing.assert_array_equal(looked_up.by_station(1000 * found.node + found.mode), expected(*body))


def test_ignored_modes_of_a_grid(body):
    """Left out where they are ignored; a mode that nobody knows makes the table no grid."""
    found = keys(list(product(STATIONS, [*MODES["mode"], 8])))
    assert grid(found, *body, ()) is None
    np.testing.assert_array_equal(grid(found, *body, (8,)).by_station(1000 * found.node + found.mode), expected(*body))


@pytest.mark.parametrize("spoil", [lambda rows: rows[:-1], lambda rows: [*rows[:-1], rows[0]], lambda rows: rows * 2])
def test_a_spoilt_grid_is_none(body, spoil):
    """A row that is missing, in the place of another one, or all of them twice."""
    assert grid(keys(spoil(list(product(STATIONS, MODES["mode"])))), *body, ()) is None


def test_a_node_of_two_lines_has_a_station_on_each(body):
    """The weld tells them apart."""
    lines, _ = body
    node = np.array([21, 21])
    assert stations_of(("ring", "seam"), np.array([0, 1], np.int32), node, lines).tolist() == [3, -1]


def test_positions():
    """Among ascending ids; before, between and behind them there is none."""
    assert positions(np.array([3, 7, 12]), np.array([12, 3, 1, 8, 99])).tolist() == [2, 0, -1, -1, -1]
