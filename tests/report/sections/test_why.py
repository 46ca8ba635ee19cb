"""The tables of a diagnosis, where there are any, on the page."""

import shutil

import numpy as np
import pandas as pd
import pytest

from fatigue.report import figures
from fatigue.report.page import report_page
from fatigue.report.result import read_result
from fatigue.report.sections.why import Why, band_shares, exponents, mode_shares, read_why
from tests.report.reading import Page, values
from tests.report.tiny_result import MODES, write_result

SHARES = {1: 0.7, 2: 0.4, 7: -0.2}
LOAD = {"tunnel": 0.1}
BANDS = ((0.0, 5.0, 0.2), (5.0, 20.0, 0.9), (20.0, np.nan, -0.1))
REASON = "Dirlik over rainflow 1.12 lies within 0.76 to 1.32; <b>stationary</b>."


def diagnose(folder):
    """Write the four tables of a diagnosis for every point of the small result."""
    damage = pd.read_parquet(folder / "damage.parquet")
    points = damage[["weld", "part", "node", "order", "surface", "event"]].assign(chosen="all")
    half = 0.5  # each of the two events does half of the damage

    def part(kind, **columns):
        return points.assign(kind=kind, **columns)

    empty = {
        "mode": np.nan,
        "unit_load": None,
        "low_hz": np.nan,
        "high_hz": np.nan,
        "resonant_share": np.nan,
        "damage_per_km": 1e-8,
    }
    attribution = [part("event", **{**empty, "share": half, "life_exponent": -half})]
    attribution += [
        part("mode", **{**empty, "mode": float(mode), "share": half * share, "life_exponent": -3.6 * half * share})
        for mode, share in SHARES.items()
    ]
    attribution += [
        part("unit_load", **{**empty, "unit_load": load, "share": half * share, "life_exponent": -3.6 * half * share})
        for load, share in LOAD.items()
    ]
    attribution += [
        part("band", **{**empty, "low_hz": low, "high_hz": high, "share": half * share, "life_exponent": np.nan})
        for low, high, share in BANDS
    ]
    attribution += [
        part(kind, **{**empty, "share": np.nan, "life_exponent": half * exponent})
        for kind, exponent in (("load", -3.6), ("thickness", 7.2), ("thickness_rule", -0.8))
    ]
    pd.concat(attribution).to_parquet(folder / "attribution.parquet")
    track = [
        points.assign(
            start_km=0.1 * i,
            end_km=0.1 * (i + 1),
            start_s=1.0 * i,
            end_s=1.0 * (i + 1),
            damage_per_km=1e-9,
            share=0.25 * (i + 1) / 2.5,
            intensity=0.4 * (i + 1),
        )
        for i in range(4)
    ]
    pd.concat(track).to_parquet(folder / "track.parquet")
    points.assign(verdict="non_stationary", reason=REASON).to_parquet(folder / "diagnosis.parquet")
    levers = points[points["event"] == "tangent"].drop(columns="event")
    pd.concat(
        [
            levers.assign(
                rank=rank,
                mode=mode,
                unit_load=load,
                frequency_hz=8.5,
                kind="normal" if load is None else "unit_load",
                share=SHARES.get(mode, 0.1),
                life_exponent=-2.0,
                life_km=1e7,
                life_km_estimated=1.2e7,
                life_km_counted=1.25e7,
                gain_km=2.5e6,
            )
            for rank, (mode, load) in enumerate([(MODES[0], None), (np.nan, "tunnel")], start=1)
        ]
    ).to_parquet(folder / "levers.parquet")


@pytest.fixture(scope="module")
def diagnosed(tmp_path_factory):
    """A diagnosed result."""
    folder = write_result(tmp_path_factory.mktemp("why"))
    diagnose(folder)
    return folder


@pytest.fixture(scope="module")
def diagnosed_page(diagnosed):
    """Its page."""
    return Page(report_page(diagnosed))


def test_without_diagnosis_its_sections_are_left_out(page, result_folder):
    """No empty headings."""
    assert read_why(result_folder, read_result(result_folder, 1, 100)) is None
    assert "buys most kilometres" not in page.words
    assert "weld-1-damage-bands" not in page.figures


def test_shares_of_modes_and_bands_sum_over_the_events(diagnosed):
    """Both events together give the share of the point, largest mode first."""
    why = read_why(diagnosed, read_result(diagnosed, 2, 100)).of_weld("W1 bracket")
    modes = mode_shares(why)
    keys = [load if pd.isna(mode) else mode for mode, load in zip(modes["mode"], modes["unit_load"], strict=True)]
    assert keys == [1, 2, 7, "tunnel"]
    assert dict(zip(keys, modes["share"], strict=True)) == pytest.approx(SHARES | LOAD)
    np.testing.assert_allclose(band_shares(why)["share"], [share for _, _, share in BANDS])
    assert np.isnan(band_shares(why)["high_hz"].iloc[-1])
    assert exponents(why) == pytest.approx({"load": -3.6, "thickness": 7.2, "thickness_rule": -0.8})


def test_the_page_shows_who_makes_the_damage(diagnosed_page):
    """Modes with their shares, bands, places, levers and the effect of one percent."""
    figures = diagnosed_page.figures
    assert figures["weld-1-damage-modes"]["data"][0]["text"] == ["70.0 %", "40.0 %", "−20.0 %", "10.0 %"]
    np.testing.assert_allclose(values(figures["weld-1-damage-bands"]["data"][0]["y"]), [0.2, 0.9, -0.1], rtol=1e-6)
    np.testing.assert_allclose(values(figures["weld-1-track"]["data"][0]["y"]), [0.4, 0.8, 1.2, 1.6], rtol=1e-6)
    assert "bands" in figures
    assert figures["weld-1-damage-modes"]["layout"]["yaxis"]["ticktext"][-1] == "unit load tunnel"
    assert diagnosed_page.tables["weld-1-levers"][0][0] == "mode or unit load"
    assert [row[0] for row in diagnosed_page.tables["weld-1-levers"][1:]] == ["1", "tunnel"]
    assert "load −3.60 %" in diagnosed_page.words


def test_the_variance_gives_way_to_the_damage(diagnosed_page, page):
    """Modes are shown by their damage where that is known, else by their variance."""
    assert "weld-1-modes" in page.figures
    assert "weld-1-modes" not in diagnosed_page.figures


def test_reasons_are_words_and_no_markup(diagnosed_page):
    """The verdict of each event with its reason, as text."""
    assert "tangent : non stationary" in diagnosed_page.words
    assert REASON in diagnosed_page.words


def test_events_without_bands_stay_out_of_the_picture():
    """A two-sample event has one band without ends: it is no bar, and the others keep their shares."""
    attribution = pd.DataFrame(
        {
            "kind": ["band"] * 4,
            "event": ["noise"] * 3 + ["load"],
            "low_hz": [0.0, 5.0, 20.0, 0.0],
            "high_hz": [5.0, 20.0, None, None],
            "share": [0.2, 0.5, 0.2, 0.1],
        }
    )
    bands = band_shares(Why(**dict.fromkeys(Why.__dataclass_fields__, attribution)))
    assert bands["share"].tolist() == pytest.approx([0.2, 0.5, 0.2])
    assert len(figures.damage_by_band(bands).plotly().data[0].x) == 3


def test_a_diagnosis_of_an_older_version_has_no_unit_loads(diagnosed, tmp_path):
    """Its tables lack the column, and are shown all the same."""
    shutil.copytree(diagnosed, tmp_path / "older")
    for name in ("attribution", "levers"):
        path = tmp_path / "older" / f"{name}.parquet"
        rows = pd.read_parquet(path)
        rows[rows["unit_load"].isna()].drop(columns="unit_load").to_parquet(path)
    page = Page(report_page(tmp_path / "older"))
    assert page.figures["weld-1-damage-modes"]["data"][0]["text"] == ["70.0 %", "40.0 %", "−20.0 %"]
    assert page.tables["weld-1-levers"][0][0] == "mode"
