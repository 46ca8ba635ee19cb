"""Weld lines that lie on each other: distances, proposals, and what cannot be told apart."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.decide.compare.finished import Finished, Points
from fatigue.decide.compare.matched.lines import proposals, to_line


def body(letter: str, lines: dict[str, np.ndarray], thickness: dict[str, float] | None = None) -> Finished:
    """Welds that are nothing but lines."""
    names = tuple(lines)
    stations = np.concatenate([np.full(len(xyz), i) for i, xyz in enumerate(lines.values())])
    order = np.concatenate([np.arange(1, len(xyz) + 1) for xyz in lines.values()])
    rows = 2 * len(stations)
    points = Points(
        names=names,
        weld=np.repeat(stations, 2),
        part=np.ones(rows, np.int64),
        node=np.arange(rows),
        order=np.repeat(order, 2),
        xyz=np.concatenate(list(lines.values())),
        toe=np.ones(rows, np.bool_),
        damage=np.ones(rows),
        life=np.ones(rows),
        screened=np.zeros(rows, np.bool_),
    )
    length = [float(np.linalg.norm(np.diff(xyz, axis=0), axis=1).sum()) for xyz in lines.values()]
    thick = [(thickness or {}).get(name, 8.0) for name in names]
    columns = {
        "length_mm": length,
        "closed": False,
        "thickness_min_mm": thick,
        "thickness_max_mm": thick,
        "surface": "both",
    }
    welds = pd.DataFrame(columns, index=list(names))
    return Finished(letter, None, {}, points, welds, {}, np.ones(len(names)), {}, is_diagnosed=False)  # type: ignore[arg-type]


def straight(y: float = 0.0, length: float = 100.0, count: int = 11) -> np.ndarray:
    """A line along x."""
    return np.column_stack([np.linspace(0.0, length, count), np.full(count, y), np.zeros(count)])


def test_distance_from_a_line_is_that_from_its_edges_and_ends():
    """Beside an edge the height, beyond an end the distance from it; many points are taken some at a time."""
    line = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0]])
    assert to_line(np.array([[5.0, 0.0, 3.0]]), line) == 3.0
    assert to_line(np.array([[-3.0, 4.0, 0.0]]), line) == 5.0
    assert to_line(np.array([[5.0, 0.0, 3.0], [10.0, 5.0, 4.0]]), line) == 4.0
    assert to_line(np.array([[3.0, 0.0, 4.0]]), line[:1]) == 5.0


@given(st.integers(2, 40), st.integers(2, 40), st.floats(0.0, 4.0))
def test_the_mesh_does_not_matter(count, other, y):
    """Lines on each other are as far apart as they lie, however many nodes either has."""
    a, b = straight(count=count), straight(y, count=other)
    assert to_line(a, b) == pytest.approx(y, abs=1e-9)
    assert to_line(b, a) == pytest.approx(y, abs=1e-9)


def names(found):
    """Pairs of names."""
    return [(one.weld, one.other_weld) for one in found]


def test_lines_near_and_equally_long_are_proposed():
    """Within 5 mm and 5 %; the nearest one each way; lines further away or of another length are not."""
    a = body("A", {"near": straight(0.0), "long": straight(500.0), "far": straight(1000.0)})
    b = body(
        "B",
        {
            "one": straight(3.0, count=7),
            "two": straight(-4.0),
            "three": straight(500.0, 106.0),
            "four": straight(1006.0),
        },
    )
    found = proposals(a, b, ["near", "long", "far"], ["one", "two", "three", "four"])
    assert names(found) == [("near", "one")]
    assert found[0].distance_mm == pytest.approx(3.0)
    assert found[0].others == ()


def test_a_reversed_line_is_the_same_line():
    """Direction says nothing."""
    a, b = body("A", {"a": straight()}), body("B", {"b": straight()[::-1]})
    assert names(proposals(a, b, ["a"], ["b"])) == [("a", "b")]


def test_a_line_whose_ends_reach_far_is_not_near():
    """All of either line counts: a bow of equal length that touches in the middle is another line."""
    bow = straight()
    bow[:, 1] = 0.01 * (bow[:, 0] - 50.0) ** 2
    assert proposals(body("A", {"a": straight()}), body("B", {"b": bow}), ["a"], ["b"]) == []


def test_welds_on_one_line_are_told_apart_by_their_plates():
    """The toes of pad and bracket share their nodes; of equal plates nothing decides, and the proposal says so."""
    a = body("A", {"pad": straight(), "bracket": straight()}, {"pad": 12.0})
    b = body("B", {"p": straight(), "b": straight()}, {"p": 12.0})
    assert sorted(names(proposals(a, b, ["pad", "bracket"], ["p", "b"]))) == [("bracket", "b"), ("pad", "p")]
    equal = proposals(a, body("B", {"x": straight(), "y": straight()}), ["bracket"], ["x", "y"])
    assert [(one.weld, one.other_weld, one.others) for one in equal] == [("bracket", "x", ("y",))]


def test_nothing_to_propose():
    """No welds on a side, no proposals."""
    one = body("A", {"a": straight()})
    assert proposals(one, one, [], ["a"]) == []
