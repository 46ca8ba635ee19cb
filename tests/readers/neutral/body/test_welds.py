"""Welds: what the file says arrives, and what it says wrong is told."""

import pytest

from fatigue.readers.neutral.body.welds import Weld, read_welds
from tests.readers.neutral_tables import WELDS, changed, refusal_of, without, write

SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])


@SUFFIXES
def test_welds(tmp_path, suffix):
    """Welds come in the order of the file; what is empty takes its default."""
    welds, warnings = read_welds(write(tmp_path / f"w{suffix}", WELDS), {"master-steel"}, strict=True)
    assert welds == (
        Weld("seam", closed=False, surface="top", curve=None, end_length=5.0, description="a straight seam"),
        Weld("ring", closed=True, surface="both", curve="master-steel", end_length=None, description=""),
    )
    assert warnings == []


def test_welds_by_name_only(tmp_path):
    """Nothing but the name is needed."""
    welds, _ = read_welds(write(tmp_path / "w.csv", {"weld": ["b", "a"]}), (), strict=True)
    assert welds == tuple(Weld(name, False, "both", None, None, "") for name in "ba")


@SUFFIXES
@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (without(WELDS, "weld"), "column weld: the column is missing. Add it; the columns are closed, surface, curve,"),
        (changed(WELDS, "weld", 2, "seam"), "column weld, row 2: weld seam repeats row 1. Keep one of the rows."),
        (changed(WELDS, "weld", 2, None), "column weld, row 2: the text is missing. Give a text."),
        (changed(WELDS, "closed", 1, "maybe"), "column closed, row 1: maybe is not a flag. Give true or false."),
        (
            changed(WELDS, "surface", 2, "above"),
            "column surface, row 2: 'above' is not one of top, bottom, both. Give one of top, bottom, both.",
        ),
        (changed(WELDS, "end_length_mm", 2, -1.0), "column end_length_mm, row 2: -1 is below 0. Give at least 0."),
        (
            changed(WELDS, "curve", 2, "master-steal"),
            "column curve, row 2: 'master-steal' is not one of the curves. Write 'master-steel'.",
        ),
        (
            changed(WELDS, "curve", 2, "x"),
            "column curve, row 2: 'x' is not one of the curves. Add it to the curves or remove its rows.",
        ),
    ],
)
def test_bad_welds(tmp_path, suffix, columns, message):
    """Every mistake in the welds names file, column, row and value."""
    path = write(tmp_path / f"w{suffix}", columns)
    assert refusal_of(read_welds, path, {"master-steel"}).startswith(f"w{suffix}: {message}")
