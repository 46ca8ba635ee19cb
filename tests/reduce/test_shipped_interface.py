"""The points of the shipped car body lie where they are said to be; its variants differ in what they are named for."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.reduce.interface import read_interface
from fatigue.vehicle.equations.suspension import NEEDED

BODY = Path(__file__).parents[2] / "data" / "carbody"
PLACES = {
    "coupler_front": (12250, 0, 0),
    "coupler_rear": (-12250, 0, 0),
    "bolster_front_left": (8750, 1288, 0),
    "bolster_front_right": (8750, -1288, 0),
    "bolster_rear_left": (-8750, 1288, 0),
    "bolster_rear_right": (-8750, -1288, 0),
    "converter_1": (1500, 900, -200),
    "converter_2": (1500, -900, -200),
    "converter_3": (-1500, 900, -200),
    "converter_4": (-1500, -900, -200),
    "transformer_1": (4994, 700, -150),
    "transformer_2": (4994, -765, -150),
    "transformer_3": (3399, 700, -150),
    "transformer_4": (3399, -765, -150),
    "roof_1": (6000, 500, 2800),
    "roof_2": (-6000, 100, 2750),
    "roof_3": (-6000, -100, 2750),
    "floor_mid": (0, 0, 0),
    "floor_front": (8750, 0, 0),
    "floor_rear": (-8750, 0, 0),
    "roof_mid": (0, 0, 2600),
    "roof_base": (-6000, 0, 2600),
}


def test_points_lie_where_they_are_said_to_be():
    """Each point is the middle of its nodes, and the vehicle finds all that it needs."""
    points, warnings = read_interface(BODY / "interface.csv", strict=True)
    nodes = pd.read_parquet(BODY / "nodes.parquet").set_index("node")
    assert not warnings
    assert [point.name for point in points] == list(PLACES)
    assert set(NEEDED) <= {point.name for point in points if point.is_loaded}
    for point in points:
        place = nodes.loc[list(point.nodes)].to_numpy().mean(axis=0)
        assert place == pytest.approx(PLACES[point.name], abs=0.5), point.name
    shared = {point.name: len(point.nodes) for point in points if len(point.nodes) > 1}
    assert shared == {**{f"converter_{k}": 7 for k in range(1, 5)}, "roof_1": 17, "floor_mid": 2, "roof_mid": 2}


def test_patterns_are_whole_edges():
    """The hangers carry their load at all nodes of their lower edge, the bracket at all of its upper one."""
    points, _ = read_interface(BODY / "interface.csv", strict=True)
    nodes = pd.read_parquet(BODY / "nodes.parquet")
    for point in points:
        if len(point.nodes) > 2:
            own = nodes[nodes["node"].isin(point.nodes)]
            x, y, z = (own[f"{axis}_mm"] for axis in "xyz")
            near = (nodes["x_mm"] - x.mean()).abs().lt(250) & (nodes["y_mm"] - y.mean()).abs().lt(250)
            edge = nodes[near & np.isclose(nodes["z_mm"], z.iloc[0])]
            assert set(edge["node"]) == set(point.nodes), point.name


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("box_hangers", {"bending_thickness_mm": (9, 60.0)}),
        ("stiff", {"E_MPa": 138000.0}),
        ("stiff_box_hangers", {"bending_thickness_mm": (9, 60.0), "E_MPa": 138000.0}),
    ],
)
def test_variants_of_the_properties(name, change):
    """A variant is the table of the body with the change in its name, and nothing else."""
    expected = pd.read_csv(BODY / "properties.csv").set_index("pid")
    for column, value in change.items():
        pid, number = value if isinstance(value, tuple) else (expected.index, value)
        expected.loc[pid, column] = number
    found = pd.read_csv(BODY / f"properties_{name}.csv").set_index("pid")
    pd.testing.assert_frame_equal(found, expected)
