"""Stations and blocks: order of the register, one curve per block, raw values of treated stations."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.pipeline.model import read_model
from fatigue.pipeline.stations import BLOCK, cut_blocks, shapes_of, stations_of
from tests.small_case import small_case


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    """The solved small case; weld B on a curve of its own."""
    case = small_case()
    case.welds["curve"] = [None, "iiw-aluminium-40"]
    return read_model(load_case(case.write(tmp_path_factory.mktemp("case"))), strict=False)


def test_stations_follow_the_register(model):
    """Welds in the order of the table of welds, nodes along their line, whatever order the lines come in."""
    backwards = stations_of(model.lines[::-1], [weld.name for weld in model.welds])
    assert np.array_equal(backwards.node, model.stations.node)
    assert model.stations.weld.tolist() == [0] * 7 + [1] * 7
    assert model.stations.arc_length.tolist() == pytest.approx([0, 10, 20, 30, 40, 50, 60] * 2)


def test_a_block_has_one_curve_and_every_station_is_in_one(model):
    """Blocks end where the curve changes; the raw values of the treated ends come on top."""
    blocks = cut_blocks(model.stations, model.curve_of_weld)
    treated = [b for b in blocks if not b.raw]
    assert np.concatenate([b.rows for b in treated]).tolist() == list(range(14))
    assert [b.curve for b in treated] == ["master-aluminium", "iiw-aluminium-40"]
    assert [b.index for b in blocks] == list(range(len(blocks)))


def test_blocks_are_cut_by_number_of_stations_alone(model):
    """Never more than BLOCK stations."""
    many = [replace(s, line=replace(s.line, part=i + 1)) for i in range(60) for s in model.lines[:1]]
    stations = stations_of(many, ["A"])
    blocks = [b for b in cut_blocks(stations, ["master-steel"]) if not b.raw]
    assert [len(b.rows) for b in blocks] == [BLOCK] * (420 // BLOCK) + [420 % BLOCK]


def test_shapes_take_raw_values_for_raw_blocks(model):
    """A raw block counts the solution as it came, a plain one the treated, with size factor and law of its curve."""
    for block in cut_blocks(model.stations, model.curve_of_weld):
        shapes = shapes_of(model.stations, block, model.curves, "actual")
        stress = model.stations.raw if block.raw else model.stations.treated
        assert np.array_equal(shapes.bending, stress.bending[block.rows])
        assert shapes.uses_bending_ratio == (block.curve == "master-aluminium")
        assert shapes.size == pytest.approx(8.0 ** (1.6 / 7.2) if shapes.uses_bending_ratio else 1.0)
        assert shapes.law is model.curves[block.curve].law
