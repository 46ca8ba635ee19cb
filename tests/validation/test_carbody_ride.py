"""The shipped car body with a channel: the numbers that the docs tell of its worn event."""

import shutil

import pandas as pd
import pytest

from fatigue.results import RIDDEN
from fatigue.ride.story import ride
from tests.conftest import EXAMPLE


@pytest.fixture(scope="module")
def tables(example_result, tmp_path_factory):
    """Tables of the ride, on a copy of the result of ``case.toml``: some seconds, as docs quote them."""
    folder = tmp_path_factory.mktemp("ride") / "result"
    shutil.copytree(example_result, folder)
    found = ride(folder, case_file=EXAMPLE / "case_ride.toml", threads=2)
    assert not found.warnings
    return {name: pd.read_parquet(folder / f"{name}.parquet").query("event == 'worn 350'") for name in RIDDEN}


def test_hot_stretches_of_the_worn_event(tables):
    """Seven, two fifths of the length, at the frequency of the hunting; the reference is the median of sound wheels."""
    hot = tables["flutter"].query("hot")
    assert len(hot) == 7
    assert (hot["end_s"] - hot["start_s"]).sum() / 29.004 == pytest.approx(0.414, abs=0.002)
    assert hot["frequency_hz"].between(8.7, 9.4).all()


def test_coincidence_with_the_converter(tables):
    """Red at 9.2 Hz, amber at 14 Hz; the phase lacks a channel, and the row says so."""
    rows = tables["coincidence"].set_index("equipment")
    assert rows["flag"].to_dict() == {"converter": "amber", "converter as built": "red"}
    assert rows.loc["converter as built", "f_hunt_hz"] == pytest.approx(9.06, abs=0.01)
    assert rows.loc["converter as built", "amplification"] == pytest.approx(9.76, abs=0.01)
    assert rows.loc["converter", "amplification"] == pytest.approx(1.714, abs=0.001)
    assert rows["coherence"].isna().all()
    assert rows["reason"].str.contains("no channel").all()


def test_damage_of_the_hangers_lies_in_the_hot_stretches(tables):
    """That of the bracket on the roof does not."""
    rows = tables["hot_damage"].set_index("weld")
    hangers = rows[rows.index.str.contains("hanger")]
    assert len(rows) == 14
    assert hangers["share_inside"].between(0.84, 0.86).all()
    assert rows.loc["W2_hanger3_att", "share_inside"] == pytest.approx(0.852, abs=0.001)
    assert rows.loc["W2_hanger3_att", "intensity"] == pytest.approx(8.15, abs=0.01)
    assert rows.loc["W1_roof_bracket_att", "intensity"] == pytest.approx(0.88, abs=0.01)
    assert tables["alarm"]["damage_share_inside_hot"].tolist() == [rows.loc["W2_hanger3_att", "share_inside"]]
    assert tables["alarm"]["alarms"].isna().all()
    assert tables["alarm"]["reason"].str.contains("no acceleration").all()
