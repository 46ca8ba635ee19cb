"""Hot spots of a result: extent along the line, both faces apart, rings, parts, no toe, not counted."""

import numpy as np
import pandas as pd
import pytest

from fatigue.report.hot_spots.of_result import HOT_SPOTS, NEEDED, hot_spots

STEP = 50.0


def nodes(utilisation, *, surface="top", part=1, weld="W", screened="", toe=True):
    """Rows of the table of nodes of one face of one part."""
    n = len(utilisation)
    rows = pd.DataFrame({name: np.zeros(n) for name in NEEDED})
    return rows.assign(
        weld=weld,
        surface=surface,
        part=part,
        toe=toe,
        screened=screened,
        order=np.arange(1, n + 1),
        node=np.arange(100, 100 + n),
        arc_length_mm=STEP * np.arange(n),
        utilisation=np.array(utilisation, dtype=float),
        governing_event="worn",
    )


def welds(closed=False, parts=1, length=200.0, names=("W",)):
    """The register of these welds."""
    return pd.DataFrame({"weld": names, "closed": closed, "parts": parts, "length_mm": length})


def spans(found):
    """From, to, length and number of stations of each hot spot."""
    return found.table[["from_mm", "to_mm", "length_mm", "stations"]].to_numpy().tolist()


def test_the_columns_are_those_of_the_dictionary():
    """In their order, with numbers as they are in the table of nodes."""
    found = hot_spots(nodes([1.0, 4.0, 3.0]), welds())
    assert list(found.table) == [column.name for column in HOT_SPOTS]
    assert found.table.loc[0, ["node", "utilisation", "governing_event"]].tolist() == [101, 4.0, "worn"]
    assert spans(found) == [[50.0, 100.0, 50.0, 2]]
    assert found.of_row.tolist() == [0, 1, 1]
    assert found.worst_row.tolist() == [1]


def test_faces_and_parts_have_hot_spots_of_their_own():
    """Sorted by utilisation over all welds, whatever the order of the rows."""
    rows = pd.concat(
        [
            nodes([1.0, 2.0]),
            nodes([5.0, 4.0], surface="bottom"),
            nodes([2.0, 3.0], part=2),
            nodes([9.0, 1.0], weld="V"),
        ]
    ).sample(frac=1.0, random_state=1)
    found = hot_spots(rows.reset_index(drop=True), welds(parts=2, names=("W", "V")))
    named = found.table[["hot_spot", "weld", "surface", "part", "utilisation", "stations"]].to_numpy().tolist()
    assert named == [
        [1, "V", "top", 1, 9.0, 1],
        [2, "W", "bottom", 1, 5.0, 2],
        [3, "W", "top", 2, 3.0, 2],
        [4, "W", "top", 1, 2.0, 2],
    ]
    of = rows.reset_index(drop=True)
    for rank, row in enumerate(found.worst_row, start=1):
        assert of.loc[row, "utilisation"] == found.table.loc[rank - 1, "utilisation"]
        assert found.of_row[row] == rank


@pytest.mark.parametrize(
    ("utilisation", "expected"),
    [
        ([4.0, 1.0, 0.2, 3.0], [[150.0, 0.0, 50.0, 2]]),  # through the start
        ([4.0, 4.0, 3.0, 3.0], [[0.0, 200.0, 200.0, 4]]),  # all around
    ],
)
def test_a_ring_goes_round(utilisation, expected):
    """The last station is next to the first, as far as the length of the ring says."""
    assert spans(hot_spots(nodes(utilisation), welds(closed=True))) == expected


def test_a_closed_weld_of_several_parts_is_no_ring():
    """Each part has its ends."""
    assert len(hot_spots(nodes([4.0, 1.0, 0.2, 3.0]), welds(closed=True, parts=2)).table) == 2


def test_points_without_toe_or_damage_are_in_none():
    """A table there is, without rows."""
    found = hot_spots(pd.concat([nodes([4.0], toe=False), nodes([0.0], surface="bottom")]), welds())
    assert found.table.empty
    assert found.of_row.tolist() == [0, 0]


def test_points_that_a_bound_settled_are_told():
    """They are in the stretch by their bound, and counted as such."""
    rows = nodes([4.0, 2.5, 0.1])
    rows["screened"] = ["", "modal bound", ""]
    found = hot_spots(rows, welds())
    assert found.table.loc[0, ["stations", "not_counted"]].tolist() == [2, 1]
