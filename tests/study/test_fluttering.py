"""The fluttering example in small: from its files to verdicts and page, as a user runs it."""

import re
from pathlib import Path

import pandas as pd
import pytest

from fatigue.study.study_file import load_study
from fatigue.study.variants.story import planned_study, run_study

EXAMPLE = Path(__file__).parents[2] / "examples" / "fluttering"


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """The small study, run."""
    folder = tmp_path_factory.mktemp("small")
    return run_study(EXAMPLE / "study_small.toml", folder, threads=1), folder


def test_verdicts_of_the_small_study(found):
    """Four sentences come out on a kilometre of track, that about sound wheels does not, one has no data."""
    study, folder = found
    words = [one.verdict for one in study.verdicts]
    assert words == ["reproduced"] * 4 + ["contradicted", "not decidable"]
    claims = pd.read_parquet(folder / "claims.parquet")
    assert list(claims["verdict"]) == words
    assert claims["ratio_mean"][2] > 3.0
    assert 0.08 < claims["left_mean"][0] < 0.09  # the lower end of the stable conicities, the same under both seeds
    assert claims["left_sd"][0] == 0.0
    assert len(pd.read_parquet(folder / "claim_seeds.parquet")) == 10


def test_the_page_of_the_small_study_shows_the_hunting(found):
    """Page, claims and spectra of bogie and converter are there; lives and maps are not, as there is no case."""
    page = (found[1] / "study.html").read_text(encoding="utf-8")
    assert page.count('<article class="claim"') == 6
    assert 'id="fig-spectra-1"' in page
    assert 'id="lives"' not in page
    assert re.search(r"Of 6 claims 4 are reproduced, 1 is contradicted and 1 is not decidable", page)


def test_claims_of_the_frame_study_name_what_it_has():
    """Every side of every claim of the large study is a variant of it."""
    study = load_study(EXAMPLE / "study_frame.toml")
    _, plan, claims = planned_study(study)
    assert len(plan.variants) == 30
    assert len(claims) >= 20
