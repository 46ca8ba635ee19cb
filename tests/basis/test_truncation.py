"""Damage without some modes: as a real assessment without them, and what is said of the highest."""

from itertools import combinations

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.basis import counted as counting
from fatigue.basis.counted import counted, opened
from fatigue.basis.truncation import ALL, INTERFACE, NORMAL, highest, left_out, life_ratio, moves, truncation
from fatigue.case import load_case
from fatigue.pipeline.solve.body import read_body
from fatigue.readers.neutral.body.modes import Modes
from tests.small_case import small_case
from tests.unit_load_case import as_unit_load, write_with_loads

SEQUENCE = '[[mission.sequence]]\norder = ["sine", "noise"]\nper_1000_km = 1.0\n'


def modes_of(frequency, kind):
    """Modes with these frequencies and kinds, numbered from 1."""
    n = len(frequency)
    no, one = np.full(n, np.nan), np.ones(n)
    return Modes(np.arange(1, n + 1), np.array(frequency, float), no, one, tuple(kind), one)


def body_of(path):
    """Body of a case file."""
    return read_body(load_case(path), strict=True)


def utilisation_without(path, *masks):
    """Utilisation (v, n, 2) of all stations of a case without the modes of each mask."""
    with opened(body_of(path), threads=1) as case:
        return np.concatenate([group.without for group in counted(case, masks)], axis=1)


def assessed_utilisation(path, folder):
    """Utilisation (n, 2) of all stations from an assessment."""
    assess(path, folder, report=False, threads=1)
    return pd.read_parquet(folder / "nodes.parquet")["utilisation"].to_numpy().reshape(-1, 2)


@pytest.mark.parametrize("ignored", [some for n in (1, 2) for some in combinations((1, 2, 7), n)])
def test_leaving_modes_out_is_an_assessment_that_ignores_them(tmp_path, ignored):
    """Every point has the utilisation of a case with ``ignore_modes``, whichever modes they are."""
    case = small_case(seconds=3.0)
    mask = np.isin(case.modes["mode"], ignored)
    found = utilisation_without(case.write(tmp_path / "all"), mask)[0]
    case.body = {"ignore_modes": list(ignored)}
    np.testing.assert_allclose(found, assessed_utilisation(case.write(tmp_path / "some"), tmp_path / "r"), rtol=1e-12)


@pytest.mark.parametrize("what", ["knee", "repeat", "vertex", "upsampled", "sequence"])
def test_whatever_is_counted_is_counted_without_them(tmp_path, what):
    """The same on a curve with a knee, with another residue, between samples, upsampled, and across events."""
    case = small_case(seconds=3.0)
    if what == "knee":
        case.curve = {"name": "en1993-hotspot-90"}
    elif what == "repeat":
        case.counting["residue"] = "repeat"
    elif what == "vertex":
        case.counting["reversals"] = "vertex"
    elif what == "sequence":
        case.extra = SEQUENCE
    else:
        case.counting["upsample"] = 2
    found = utilisation_without(case.write(tmp_path / "all"), np.array([False, True, False]))[0]
    case.body = {"ignore_modes": [2]}
    np.testing.assert_allclose(found, assessed_utilisation(case.write(tmp_path / "some"), tmp_path / "r"), rtol=1e-12)


def test_unit_loads_stay(tmp_path):
    """A unit load is no mode: it is never left out, and the modes beside it are."""
    case = small_case(seconds=3.0)
    forces = as_unit_load(case, 2, "air")
    found = utilisation_without(write_with_loads(case, tmp_path / "all", forces), np.array([False, True]))[0]
    case.body = {"ignore_modes": [7]}
    path = write_with_loads(case, tmp_path / "some", forces)
    np.testing.assert_allclose(found, assessed_utilisation(path, tmp_path / "r"), rtol=1e-12)


def test_which_modes_are_the_highest():
    """Shares are of the elastic modes, rounded, at least one; interface modes and normal ones are told apart."""
    kinds = ["rigid", *[NORMAL] * 7, *[INTERFACE] * 3]
    modes = modes_of([0.0, *range(5, 12), 90.0, 80.0, 70.0], kinds)
    found = {(one.of, one.share): modes.mode[one.mask].tolist() for one in left_out(modes)}
    assert found == {
        (ALL, 0.1): [9],
        (ALL, 0.2): [9, 10],
        (ALL, 0.3): [9, 10, 11],
        (NORMAL, 0.1): [8],
        (NORMAL, 0.3): [7, 8],
    }  # 20 % of seven are one, too; and the highest 30 % of all are all interface modes
    assert not left_out(modes_of([0.0, 5.0], ["rigid", NORMAL]))
    assert [one.of for one in left_out(modes_of([5.0, 6.0], [NORMAL] * 2))] == [ALL]
    assert highest(modes_of([5.0, 5.0], [NORMAL] * 2), np.ones(2, bool), 0.5).tolist() == [False, True]


def test_life_ratio_and_what_moves():
    """Damage is one over life; no damage is no ratio, and life without end moves."""
    assert life_ratio(2.0, 0.5) == (4.0, "")
    assert life_ratio(1.0, 0.0)[0] == np.inf
    assert np.isnan(life_ratio(0.0, 0.0)[0])
    assert [moves(ratio) for ratio in (1.19, 1.21, 0.84, 0.83)] == [False, True, False, True]
    assert (moves(np.inf), moves(np.nan)) == (True, None)


def test_a_mode_that_carries_all_and_one_that_carries_nothing(tmp_path):
    """Mode 1 alone moves: without it nothing damages; without the interface mode no life moves."""
    case = small_case(seconds=3.0)
    for table in case.histories.values():
        table[["q_2", "q_7"]] = 0.0
    with opened(body_of(case.write(tmp_path / "c")), threads=1) as one:
        found = truncation(one, shares=(0.3, 0.9))
    of_all = [row for row in found.rows if row.left_out_of == ALL]
    assert {row.life_ratio for row in of_all if row.modes == 1} == {1.0}
    normal = [row for row in found.rows if row.left_out_of == NORMAL and row.modes == 2]
    assert {row.life_ratio for row in normal} == {np.inf}
    assert all(row.moves and "no end" in row.reason for row in normal)
    assert any("no life moves" in line for line in found.said)
    assert any("local" in note for note in found.notes)
    assert any("counted once" in note for note in found.notes)  # the highest of three modes is all interface modes


def test_a_large_case_counts_the_worst_points_only(tmp_path, monkeypatch):
    """The worst point of each weld and its ratio are those of a small case; the note says that others were not."""
    path = small_case(seconds=3.0, pairs=2).write(tmp_path / "c")
    with opened(body_of(path), threads=1) as case:
        small = truncation(case)
        monkeypatch.setattr(counting, "MOST_SAMPLES", 0)
        large = truncation(case)
        assert sum(len(group.node) for group in counted(case)) == 4
    for one, other in zip(small.rows, large.rows, strict=True):
        assert (one.weld, one.order, one.surface) == (other.weld, other.order, other.surface)
        assert one.utilisation == pytest.approx(other.utilisation, rel=1e-12)
        assert one.life_ratio == pytest.approx(other.life_ratio, rel=1e-12)
    assert any("worst point of every weld was counted" in note for note in large.notes)
    assert not any("worst point of every weld was counted" in note for note in small.notes)
