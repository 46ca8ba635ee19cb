"""The page of a study."""

import json
import re
from dataclasses import replace

import pytest

from fatigue.errors import Problem
from fatigue.study.page import study_page
from fatigue.study.quantities import StudyRun, Variant
from tests.study.page.studied_example import CLAIMS, studied


def figures(page):
    """Content of every figure of a page, by its id."""
    found = re.findall(r'<script type="application/json" id="json-([^"]+)">(.*?)</script>', page, re.DOTALL)
    return {name: json.loads(text) for name, text in found}


def plain(page):
    """Words of a page without markup, scripts and styles."""
    page = re.sub(r"<(script|style)\b.*?</\1>", " ", page, flags=re.DOTALL)
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", page))


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The page of the study with records of its rides."""
    return study_page(studied(tmp_path_factory.mktemp("rides")))


def test_every_claim_stands_with_its_verdict_its_numbers_and_the_sentence_of_the_paper(page):
    """Text, sentence, statement, numbers and verdict of each claim stand together."""
    said = plain(page)
    assert "Of 4 claims 2 are reproduced, 1 is contradicted and 1 is not decidable." in said
    (first,) = re.findall(r'<article class="claim" id="claim-1">.*?</article>', page, re.DOTALL)
    told = plain(first)
    for words in (
        "worn wheels shake the converter",
        "✓ reproduced",
        "the self-excited vibration of traction converter intersects with the unstable hunting",
        "conv_y_rms[contact=worn] &gt; 3 x conv_y_rms",
        "2.369 m/s2 (2.346 to 2.392)",
        "m/s2 (0.8568 to 0.8736), which is 3 times what was found",
        "2 of 2 seeds hold the sentence",
        "Seed by seed",
    ):
        assert words in told
    assert "The paper gives no data." in said


def test_the_caution_stands_on_the_page_once(page):
    """The page says once that the vehicle is invented and that nothing is validated."""
    assert plain(page).count("The vehicle is invented") == 1


def test_claims_at_a_glance(page):
    """Each tried claim is a row with a mark for each seed; the shade is where it holds."""
    drawn = figures(page)["claims"]
    marks = {trace["name"]: len(trace["x"]) for trace in drawn["data"]}
    assert marks == {"holds": 4, "holds the reverse": 2}
    assert len(drawn["layout"]["yaxis"]["tickvals"]) == 3
    between = [shape for shape in drawn["layout"]["shapes"] if shape["type"] == "rect"][2]
    assert between["x0"] == pytest.approx((7 / 8) ** 0.5)
    assert between["x1"] == pytest.approx((8 / 7) ** 0.5)


def test_spectra_peak_where_the_rides_do(page):
    """Lines are the variants, panels bogie and converter, and the hunting of worn wheels stands at 8 Hz."""
    by_contact = next(f for f in figures(page).values() if {"contact = worn"} <= {t.get("name") for t in f["data"]})
    assert {trace["yaxis"] for trace in by_contact["data"]} == {"y", "y2"}
    assert sum(trace.get("showlegend", True) for trace in by_contact["data"]) == 2


def test_lives_have_bars_from_least_to_greatest(page):
    """A mark of each variant at each weld, with the scatter over the seeds; no name is markup."""
    lives = figures(page)["lives-1"]
    assert "roof &lt;b&gt;bracket&lt;/b&gt;" in lives["layout"]["yaxis"]["ticktext"]
    assert all("arrayminus" in trace["error_x"] for trace in lives["data"])
    assert "> 1e12" in lives["layout"]["xaxis"]["ticktext"]


def test_a_study_without_claims_vehicle_records_and_scatter():
    """Parts that a study does not have are not there, and one seed is said to have no scatter."""
    bare = studied(seeds=(3,), claims=(), vehicle=None, case="case.toml", source="files that are there")
    said = plain(study_page(bare))
    assert "The base is case.toml. The histories are files that are there; every run is assessed" in said
    assert "One seed has no scatter" in said
    assert "The vehicle is invented" not in said
    assert "Claims" not in said
    assert "Weld maps" not in said


def test_a_study_of_the_base_alone():
    """A study that varies nothing has its base, its claims and no ratio."""
    base = (Variant("base", {}),)
    claim = {"text": "x", "left": "conv_y_rms", "operator": ">", "right": 0.1}
    alone = studied(seeds=(1,), variants=base, varied=(), claims=(claim,))
    said = plain(study_page(alone))
    assert "This study varies nothing" in said
    assert "The one claim is reproduced." in said
    assert "Ratios" not in said
    assert "the one seed holds the sentence" in said


def test_runs_that_failed_and_warnings_are_told():
    """What was not run stands with its reason, warnings with their count."""
    whole = studied()
    failed = StudyRun("base", 1, whole.runs[0].folder, {}, "failed", "the vehicle left the track")
    warned = Problem("doubt", "base, seed 1", "a <doubt> of 3", "Look at it", 4)
    page = study_page(replace(whole, runs=[failed, *whole.runs[1:]], warnings=[warned]))
    said = plain(page)
    assert "8 runs in all: 7 are done, the others stand below." in said
    assert "the vehicle left the track" in said
    assert "a &lt;doubt&gt; of 3 (4 of this kind) . Look at it ." in said


def test_names_are_no_markup():
    """Titles and names of somebody else stay text."""
    page = study_page(studied(title="<script>alert(1)</script>"))
    assert "<script>alert(1)" not in page
    assert "&lt;script&gt;alert(1)" in page


def test_many_claims_and_variants_are_drawn_in_bounds():
    """A study of many variants draws few figures and folds its tables."""
    many = tuple(Variant(f"fe={fe}, v={v}", {"fe": float(fe), "v": v}) for fe in range(9) for v in range(7))
    page = study_page(studied(variants=many, claims=CLAIMS[3:] * 40, varied=()))
    assert sum(name.startswith("lives") for name in figures(page)) <= 3
    assert max(len(f["data"]) for name, f in figures(page).items() if name.startswith("lives")) <= 6
    assert "<summary>Table of 63 variants</summary>" in page
