"""Bands on the page and in `show`: as the table has them, with every reason in words, and what they do not say."""

import json

import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.pipeline.life_band.scatter import REASONS as CODES
from fatigue.report.page import report_page
from fatigue.report.wording import life
from fatigue.results.beside.life_band import REASONS, SHORT_REASONS, WHAT_IT_IS_NOT, read_bands
from fatigue.results.summary import result_summary
from tests.older_result import without_hashes
from tests.pipeline.life_band.test_life_band import LINES, noise_case
from tests.report.reading import Page


def made(folder, case):
    """Result of a case."""
    assess(load_case(case.write(folder / "case")), folder / "result", report=False, threads=1)
    return folder / "result"


@pytest.fixture(scope="module")
def lined(tmp_path_factory):
    """Two welds with bands and lines."""
    return made(tmp_path_factory.mktemp("lined"), noise_case(band=LINES))


@pytest.fixture(scope="module")
def short(tmp_path_factory):
    """Two welds whose records are too short."""
    return made(tmp_path_factory.mktemp("short"), noise_case(3.0))


def test_every_reason_has_words():
    """Short ones for a cell, long ones for a sentence."""
    assert set(SHORT_REASONS) == set(REASONS) == set(CODES) - {""}


def test_the_table_of_page_one_is_that_of_the_worst_points(lined):
    """Life, band, lives at survivals, lines; three digits."""
    page = Page(report_page(lined))
    band = pd.read_parquet(lined / "band.parquet")
    head, *rows = page.tables["life-bands"]
    assert head[:3] == ["weld", "life [km]", "90 % band of load [km]"]
    for row in rows:
        point = band.loc[band[band["weld"] == row[0]]["life_km"].idxmin()]
        assert row[1] == life(point["life_km"])
        assert row[2] == f"{life(point['life_km_load_low'])} – {life(point['life_km_load_high'])}"
        assert row[3:7] == [life(point[f"life_km_{p}"]) for p in ("p50", "p90", "p97_7", "p99")]
        assert row[8] == life(point["line_life_km_p50"])
    assert WHAT_IT_IS_NOT in page.words
    assert "lengths of 25 mm, correlated by 0" in page.words
    assert "half of all fail at a damage sum of 0.8, scattering by 0.3 in its logarithm" in page.words


def test_a_page_without_a_band_says_why(short):
    """In the cell, in words beneath the table, and beneath the shortest life."""
    page = Page(report_page(short))
    assert {row[2] for row in page.tables["life-bands"][1:]} == {SHORT_REASONS["short_record"]}
    assert f"No band of this life: {REASONS['short_record']}." in page.words


def test_show_prints_bands_and_reasons(lined, short):
    """And for machines every digit, or null."""
    text = result_summary(lined).as_text()
    assert "90_percent_band_of_load_km" in text
    assert WHAT_IT_IS_NOT in text
    band = pd.read_parquet(lined / "band.parquet").set_index(["weld", "part", "order", "surface"])
    for row in result_summary(lined).as_record()["welds"]:
        key = row["weld"], row["worst_part"], row["worst_order"], row["worst_surface"]
        assert row["band"]["life_km_load_low"] == band.loc[key, "life_km_load_low"]
        assert row["band"]["life_km_p50"] == band.loc[key, "life_km_p50"]
        assert row["band"]["band_reason"] is None
    told = result_summary(short)
    assert f"record too short: {REASONS['short_record']}" in told.as_text()
    assert "50_percent_km" not in told.as_text()
    assert told.as_record()["welds"][0]["band"]["life_km_p50"] is None
    json.dumps(told.as_record(), allow_nan=True, default=str)


def test_a_curve_without_scatter_says_so(tmp_path):
    """The band of load stands, and nothing beside it."""
    case = noise_case()
    case.curve = {"name": "iiw-aluminium-36"}
    folder = made(tmp_path, case)
    page = Page(report_page(folder))
    assert all(row[3:] == ["–"] * 4 for row in page.tables["life-bands"][1:])
    assert "A curve without scatter has the band of load only." in page.words
    assert "50_percent_km" not in result_summary(folder).as_text()


def test_a_result_of_an_older_version_has_no_bands(lined, tmp_path):
    """Page and text are as they were, and `read_bands` gives none."""
    import shutil  # noqa: PLC0415

    folder = without_hashes(shutil.copytree(lined, tmp_path / "older"))
    (folder / "band.parquet").unlink()
    assert read_bands(folder, pd.read_parquet(folder / "nodes.parquet")) is None
    assert "life-bands" not in Page(report_page(folder)).tables
    assert WHAT_IT_IS_NOT not in result_summary(folder).as_text()
    assert "band" not in result_summary(folder).as_record()["welds"][0]
