"""How resonances form on the page: the ranking, modes by events, a line of each weld; nothing from older diagnoses."""

import numpy as np
import pandas as pd
import pytest

from fatigue.report.page import report_page
from fatigue.report.sections.formation.section import MOST_EVENTS, MOST_NAMED, MOST_WATCHED
from fatigue.results import read_provenance, write_json
from tests.report.reading import Page
from tests.report.sections.test_why import diagnose
from tests.report.tiny_result import FREQUENCIES, MODES, Recipe, write_result
from tests.why.formation.swinging_case import swinging_case
from tests.why.formation.test_formation import run

HEADING = "How the resonance forms"
BOUNDARY = "a boundary mode: <b>nothing</b> is differentiated"
SMALL = Recipe()
STATIC_LOAD = "a static load case has no time"


def modes_of(event, resonant=1, **columns):
    """Rows of ``resonance`` of an event: one mode swings, others follow, mode 2 as a boundary mode."""
    at = pd.DataFrame({"event": event, "mode": list(MODES), "frequency_hz": list(FREQUENCIES)})
    swings = (at["mode"] == resonant).to_numpy()
    boundary = (at["mode"] == 2).to_numpy()
    found = at.assign(
        damping_ratio=0.015,
        damping_source="modes",
        **{"class": np.where(swings, "resonant", "quasi_static")},
        rms_q=1.0,
        dynamic_share=np.where(boundary, np.nan, np.where(swings, 0.87, 0.1)),
        amplification=np.where(swings, 2.0, 1.01),
        half_power_share=0.1,
        response_share=0.1,
        excitation_hz=np.where(boundary, np.nan, 5.25),
        response_hz=7.5,
        highest_hz=20.0,
        reason=np.where(boundary, BOUNDARY, None),
    )
    return found.assign(**columns)


def form(folder, swings=1, cost=1e5, events=("tangent", "curve"), reason=None, counted_from=0.01, **columns):
    """Write the tables of how resonances form, with some swings at the first weld, and what the provenance says."""
    worst = pd.read_parquet(folder / "welds.parquet")
    point = worst[["weld", "worst_part", "worst_node", "worst_order", "worst_surface"]]
    point = point.set_axis(["weld", "part", "node", "order", "surface"], axis=1)
    pd.concat([modes_of(event, **columns) for event in events]).to_parquet(folder / "resonance.parquet")
    pd.concat(
        [
            point.assign(
                event=event,
                dominant_hz=9.59 if reason is None else np.nan,
                damage_per_km=damage,
                damage_per_km_quasi_static=2e-8 if reason is None else np.nan,
                damage_per_km_dynamic=3e-9 if reason is None else np.nan,
                dynamic_share=0.3,
                reason=reason,
            )
            for event, damage in zip(events, np.linspace(9e-8, 1e-8, len(events)), strict=True)
        ]
    ).to_parquet(folder / "weld_resonance.parquet")
    first = point.iloc[np.zeros(swings, dtype=int)]
    first.assign(
        rank=np.arange(1, swings + 1),
        event=events[0],
        mode=1,
        frequency_hz=8.5,
        **{"class": "resonant"},
        start_km=0.6,
        end_km=1.8,
        start_s=7.0,
        end_s=19.0,
        damage_share=0.375,
        life_km=1e6,
        life_km_without=1e6 + cost,
        cost_km=cost,
        utilisation_cost=np.sign(cost) * np.linspace(0.5, 0.1, swings),
    ).to_parquet(folder / "watch.parquet")
    record = read_provenance(folder)
    said = {"class_thresholds": {"dynamic_share": 0.5}}
    if counted_from is not None:
        said["swing_counted_from_damage_share"] = counted_from
    write_json(folder / "provenance.json", {**record, "diagnosis": said})


def page_of(root, recipe=SMALL, **given):
    """Page of a small result with such a diagnosis."""
    folder = write_result(root, recipe)
    diagnose(folder)
    form(folder, events=recipe.events, **given)
    return Page(report_page(folder))


@pytest.fixture(scope="module")
def formed(tmp_path_factory):
    """Page with two swings at one weld."""
    return page_of(tmp_path_factory.mktemp("formed"), swings=2)


def test_without_its_tables_nothing_is_shown(page, tmp_path):
    """A result that was never diagnosed, and one by an older version, are as they were."""
    folder = write_result(tmp_path)
    diagnose(folder)
    older = Page(report_page(folder))
    for found in (page, older):
        assert HEADING not in found.words
        assert not {"watch", "resonance"} & set(found.tables)
        assert "the stress moves mostly" not in found.words
    form(folder)
    (folder / "watch.parquet").unlink()
    assert HEADING not in Page(report_page(folder)).words


def test_the_ranking_names_mode_event_place_and_cost(formed):
    """A row of each swing, the weld a link to its page."""
    head, first, second = formed.tables["watch"]
    row = dict(zip(head, first, strict=True))
    assert row["rank"] == "1"
    assert second[0] == "2"
    assert row["weld"] == "W1 bracket"
    assert (row["mode"], row["frequency [Hz]"], row["class"], row["event"]) == ("1", "8.50", "resonant", "tangent")
    assert row["half of it at"] == "km 0.6 to 1.8"
    assert row["share of damage [%]"] == "37.5 %"
    assert (row["life without [million km]"], row["cost [million km]"]) == ("1.10", "0.100")
    assert "No mode to watch at any weld" not in formed.words


def test_modes_stand_by_events(formed):
    """Class, dynamic share, both frequencies in one cell; a boundary mode has dashes and its reason, as text."""
    head, *rows = formed.tables["resonance"]
    assert head[-2:] == ["tangent", "curve"]
    assert [row[0] for row in rows] == ["1", "2"]
    assert rows[0][4:] == ["resonant; 0.87; 5.250 → 7.500 Hz"] * 2
    assert rows[1][4] == "quasi-static; – → 7.500 Hz"
    assert rows[0][3] == "70.0 %"
    assert f"Mode 2 in all these events: {BOUNDARY}." in formed.words
    assert "Left out: 1 other mode, which swings in no event; see resonance.parquet." in formed.words
    assert "(0.5 of its rms or more)" in formed.words
    assert "Damping:" not in formed.words


def test_each_weld_has_its_line(formed):
    """Of the event that damages it most; the weld without a swing says so."""
    assert (
        "In tangent the stress moves mostly at 9.590 Hz; damage 9.000e−8 per km, of its quasi-static part alone "
        "2.000e−8, of its dynamic part alone 3.000e−9 (they do not add up). Watch mode 1 (8.500 Hz, resonant) in "
        "tangent, half of its swing's damage at km 0.6 to 1.8: costs 100 000 km, 1 100 000 km if it "
        "followed its load."
    ) in formed.words
    assert formed.words.count("No mode to watch: none owes 1 % of the damage to its swing") == 1


@pytest.mark.parametrize(("counted_from", "said"), [(0.01, "1 %"), (None, "much")])
def test_where_nothing_owes_to_a_swing_the_page_says_so(tmp_path, counted_from, said):
    """A sentence in place of the table, with the share on record if it is there; relieving swings are counted."""
    page = page_of(tmp_path, swings=2, cost=-1e5, counted_from=counted_from)
    assert "watch" not in page.tables
    assert f"No mode to watch at any weld: none owes {said} of the damage to its swing" in page.words
    assert "2 that relieve are in watch.parquet" in page.words
    assert "resonance" in page.tables


def test_what_could_not_be_split_has_its_reason(tmp_path):
    """Neither the ranking nor the line of the weld claims that modes follow."""
    page = page_of(tmp_path, swings=0, reason=STATIC_LOAD)
    assert "could not be told" in page.words
    assert f"Not split: tangent and curve: {STATIC_LOAD}" in page.words
    assert (
        "the stress has no dominant frequency; damage 9.000e−8 per km, of its quasi-static part alone –" in page.words
    )
    assert f"Not available: {STATIC_LOAD}." in page.words
    assert "No mode to watch" not in page.words


def test_an_assumed_damping_is_said_where_it_is_read(tmp_path):
    """Below the modes and in the line of every weld."""
    page = page_of(tmp_path, damping_source="assumed")
    assert page.words.count("a damping ratio of 0.015 was assumed for 3 of 3 modes") == 3


def test_no_damping_is_said_too(tmp_path):
    """The split takes 0 then; why numbers are empty that the page does not show is left to the table."""
    page = page_of(tmp_path, damping_source=None, damping_ratio=np.nan, excitation_hz=5.0, dynamic_share=0.2)
    assert BOUNDARY not in page.words
    assert page.words.count("3 of 3 modes have no damping ratio and are split as if it were 0") == 3


def test_many_swings_and_events_are_cut_and_named(tmp_path):
    """The page says how many are left out; events that damage most stay, in the order of the mission."""
    events = tuple(f"<i>event</i> {i}" for i in range(MOST_EVENTS + 20))
    page = page_of(tmp_path, Recipe(events=events), swings=MOST_WATCHED + 3)
    assert len(page.tables["watch"]) == 1 + MOST_WATCHED
    assert "3 more that cost less are in watch.parquet" in page.words
    assert page.tables["resonance"][0][4:] == list(events[:MOST_EVENTS])
    assert f"and {20 - MOST_NAMED} more, which damage less; see resonance.parquet" in page.words


def test_endless_life_without_a_swing_is_no_number(tmp_path):
    """Where nothing else damages, the life without is beyond all numbers."""
    page = page_of(tmp_path, cost=np.inf)
    assert page.tables["watch"][1][-3:-1] == ["> 1e12", "> 1e12"]
    assert "nothing would damage the point if it followed its load" in page.words


def test_a_diagnosis_shows_what_it_says(tmp_path):
    """From a whole case with a static load: the page names the swing of the tables and text, and the load's reason."""
    case = swinging_case()
    case.modes["damping_ratio"] = np.nan
    found = run(case, tmp_path, damping=0.015)
    page = Page(report_page(found.folder))
    worst = found.watch.iloc[0]
    row = page.tables["watch"][1]
    assert row[1] == worst["weld"]
    assert row[2] == str(worst["mode"]) == "1"
    assert row[5] == worst["event"] == "worn"
    assert "a damping ratio of 0.015 was assumed for 3 of 3 modes" in page.words
    assert "Not split: load and unload: " in page.words
    assert len(page.tables["watch"]) == 1 + int((found.watch["utilisation_cost"] > 0.0).sum())
