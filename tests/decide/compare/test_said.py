"""Sentences about two results: who gains and loses, flips, the common cause, and what is to be doubted."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.decide.compare.finished import Finished, read_results
from fatigue.decide.compare.matched.lines import Proposal
from fatigue.decide.compare.matched.welds import WeldMap, match_welds
from fatigue.decide.compare.pairs import Pair, pair_of
from fatigue.decide.compare.said import gains, notes, sentences
from fatigue.decide.compare.summary import match_rows


@pytest.fixture(scope="module")
def result(small_result) -> Finished:
    """The small result as it is read."""
    return read_results([small_result], no_lock=False)[0]


def beside(result: Finished, **other) -> Pair:
    """The result and a second one that differs in some of its fields."""
    b = replace(result, letter="B", **other)
    return pair_of(result, b, match_welds(result, b, WeldMap(), accept_proposed=False))


def test_losers_and_gainers_are_ranked(result):
    """One weld twice as long, one a tenth: each named with its factor; the order is from loss to gain."""
    factor = np.where(result.points.weld == 0, 2.0, 0.1)
    points = replace(result.points, life=result.points.life * factor, damage=result.points.damage / factor)
    welds = result.welds.assign(
        life_km=result.welds["life_km"] * [2.0 if w == "A" else 0.1 for w in result.welds.index]
    )
    pair = beside(result, points=points, welds=welds)
    losing, gaining, same = gains(pair)
    assert [losing["weld"].tolist(), gaining["weld"].tolist(), len(same)] == [["B"], ["A"], 0]
    said = list(sentences(pair))
    assert said[0] == "Of 2 welds 1 lasts longer in B than in A, 1 less long and none as long to 5 %."
    assert any(one.startswith("The largest loss is that of B, which lasts 0.1 times as long in B (") for one in said)
    assert any(one.startswith("The largest gain is that of A, which lasts 2 times as long in B (") for one in said)


def test_a_flip_by_a_check_is_no_flip_of_a_life(result):
    """The toes say the same in both: the check that decides is named."""
    welds = result.welds.assign(fulfilled=~result.welds["fulfilled"], worst_check="throat")
    pair = beside(result, welds=welds)
    assert (pair.welds["flip"] != "").all()
    said = " ".join(notes(pair))
    assert "The verdict of A flips by a check beside its toes (throat), by no life here." in said
    assert "flips by a check" not in " ".join(notes(beside(result)))


def test_welds_without_a_toe_have_no_life(result):
    """A weld whose worst point is not there takes no part, and the rest is compared."""
    welds = result.welds.astype({"worst_part": float}).assign(worst_part=np.nan)
    pair = beside(result, welds=welds)
    assert pair.welds.empty
    assert list(sentences(pair)) == ["No matched weld has a toe, so that no life is compared."]
    assert len(pair.points) == len(result.points)


def test_a_worst_point_elsewhere_is_said(result):
    """The worst point of B is made to be another: the causes are of two places, and the sentence says so."""
    welds = result.welds.copy()
    welds.loc["A", "worst_order"] = 1 + welds.loc["A", "worst_order"] % 7
    points = replace(result.points, life=0.5 * result.points.life)
    pair = beside(result, welds=welds, points=points)
    moved = pair.welds.set_index("weld")["worst_moved"]
    assert moved.to_dict() == {"A": True, "B": False}
    assert "Another point is the worst in B at 1 weld: A." in list(notes(pair))


def test_proposals_are_told_with_what_to_do(result):
    """One that is certain, one of welds on one line that nothing tells apart; both stand in the table of matches."""
    pair = beside(result)
    some = (Proposal("C", "left", 0.25), Proposal("D", "right", 0.0, ("other",)))
    matched = replace(pair.matched, proposed=some, only_first=("C", "D"), only_other=("left", "right", "other"))
    said = list(notes(replace(pair, matched=matched)))
    assert (
        "Lines that lie on each other, proposed and not used: C = left (0.25 mm). Take them with --accept-proposed."
        in said
    )
    assert (
        "Lines on one place that cannot be told apart: D may be right and other. Name them in a table with --map."
        in said
    )
    table = match_rows(replace(pair, matched=matched))
    proposed = table[table["matched_by"] == "proposed"]
    assert proposed["note"].tolist() == ["take it with --accept-proposed", "as well: other"]
    assert table["other_weld"].tolist()[2:] == ["left", "right", "other"]


def test_renamed_events_are_hinted_at(result):
    """Events of either result without a partner: one of them may be the other under another name."""
    passes = {name.replace("noise", "rough"): often for name, often in result.passes.items()}
    said = " ".join(notes(replace(beside(result), other=replace(result, letter="B", passes=passes))))
    assert "Events are matched by name: noise of A and rough of B have no partner." in said
    assert "matched by name" not in " ".join(notes(beside(result)))
