"""Which point is meant: by order, by node, by part, the worst one; and every way to name none or several."""

import shutil

import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.point.found import find_station, meant
from tests.point.cases import cornered, result_of


@pytest.fixture(scope="module")
def corner(tmp_path_factory):
    """Result of a weld that is split at its corner."""
    folder = tmp_path_factory.mktemp("corner")
    return result_of(cornered(folder / "case"), folder / "result")


def test_a_station_by_its_order(small_result):
    """Its rows in the table of nodes are those of its two faces."""
    found = find_station(small_result, "A", order=3)
    nodes = pd.read_parquet(small_result / "nodes.parquet").iloc[list(found.rows)]
    assert nodes["surface"].tolist() == ["top", "bottom"]
    assert set(nodes["order"]) == {3}
    assert set(nodes["weld"]) == {"A"}
    assert found.max_range == tuple(nodes["max_range_MPa"])
    assert found.utilisation == tuple(nodes["utilisation"])
    assert (found.node, found.part) == (nodes["node"].iloc[0], 1)
    assert str(found) == "weld A, part 1, order 3, node 102"


def test_a_station_by_its_node(small_result):
    """Node and order lead to the same; both may be given where they agree."""
    assert find_station(small_result, "B", node=204) == find_station(small_result, "B", order=5)
    assert find_station(small_result, "B", node=204, order=5).order == 5


def test_the_worst_point_by_default(small_result):
    """As the table of welds has it, and of a part by the utilisation of its toes."""
    welds = pd.read_parquet(small_result / "welds.parquet").set_index("weld")
    for weld in ("A", "B"):
        found = find_station(small_result, weld)
        worst = welds.loc[weld]
        assert (found.part, found.order) == (worst["worst_part"], worst["worst_order"])
        assert ("top", "bottom")[found.worst_face] == worst["worst_surface"]
        of_part = find_station(small_result, weld, part=1)
        assert max(of_part.utilisation) == pytest.approx(worst["utilisation"], rel=1e-9)


def test_the_worst_point_of_a_part(corner):
    """That of its toes with the largest utilisation."""
    nodes = pd.read_parquet(corner / "nodes.parquet").query("weld == 'A' and toe")
    for part, own in nodes.groupby("part"):
        assert own["utilisation"].max() > 1.001 * own["utilisation"].min()
        assert max(find_station(corner, "A", part=part).utilisation) == own["utilisation"].max()


def test_a_face_without_a_toe_never_decides(small_result):
    """B has a toe on top only."""
    found = find_station(small_result, "B", order=2)
    assert found.toe == (True, False)
    assert found.worst_face == found.face() == found.face("top") == 0
    assert found.face("bottom") == 1
    with pytest.raises(DataError, match=r"there is no face 'middle'\. Say top or bottom, or leave it out"):
        found.face("middle")


def test_a_part_is_needed_only_where_two_share_the_order(corner):
    """At the corner both parts have their own row."""
    assert find_station(corner, "A", order=3).part == 1
    assert find_station(corner, "A", order=5).part == 2
    with pytest.raises(DataError, match=r"weld 'A': the parts 1, 2 share the order 4, at a corner .* Give the part"):
        find_station(corner, "A", order=4)
    with pytest.raises(DataError, match="share the order 4"):
        find_station(corner, "A", node=103)
    one, two = (find_station(corner, "A", order=4, part=part) for part in (1, 2))
    assert (one.node, two.node) == (103, 103)
    assert one.rows != two.rows


@pytest.mark.parametrize(
    ("place", "words"),
    [
        ({"weld": "C"}, "the result has no weld 'C'. Name one of 'A', 'B'"),
        ({"weld": "a"}, "the result has no weld 'a'. Name 'A'"),
        ({"weld": "A", "order": 9}, "weld 'A': has no order 9. Take one of its orders: 1, 2, 3, 4, 5, 6, 7"),
        ({"weld": "A", "part": 3, "order": 3}, "weld 'A': has no part 3. Take one of its parts: 1"),
        ({"weld": "A", "node": 203}, "has no node 203, which is of 'B'. Name that weld, or one of its own nodes: 100"),
        ({"weld": "A", "node": 7}, "weld 'A': has no node 7. Take one of its nodes: 100, 101"),
        ({"weld": "A", "node": 101, "order": 5}, "weld 'A', order 5: has no node 101. Take one of its nodes: 104"),
        ({"weld": "A\nB"}, r"the result has no weld 'A\\nB'"),
    ],
)
def test_what_is_not_there_is_refused_with_what_is(small_result, place, words):
    """In one line, with the way out."""
    with pytest.raises(DataError) as refused:
        find_station(small_result, **place)
    assert words.replace(r"\\n", r"\n") in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_weld_left_out_is_told_with_its_reason(small_result, tmp_path):
    """What the register has of it."""
    welds = pd.read_parquet(small_result / "welds.parquet")
    folder = shutil.copytree(small_result, tmp_path / "result")
    other = welds.iloc[[0]].assign(weld="X", status="excluded", reason="a stiffener without toe")
    pd.concat([welds, other]).to_parquet(folder / "welds.parquet")
    with pytest.raises(DataError, match=r"the weld 'X' was not assessed: a stiffener without toe\. Name a weld"):
        find_station(folder, "X", order=1)


def test_names_that_were_meant():
    """Those that hold the text come first, then those that look like it."""
    welds = ["W1_roof_neg", "W1_roof_pos", "W2_floor"]
    assert meant("w1", welds) == "Name one of 'W1_roof_neg', 'W1_roof_pos'"
    assert meant("floor", welds) == "Name 'W2_floor'"
    assert meant("W2-flor", welds) == "Name 'W2_floor'"
    assert meant("x", welds) == "Name one of 'W1_roof_neg', 'W1_roof_pos', 'W2_floor'"
