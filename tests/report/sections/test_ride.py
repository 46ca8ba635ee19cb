"""What the channels of a ride say, on the page of a result where a ride was made."""

import json
import shutil
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from fatigue.case.channels import Ride
from fatigue.errors import DataError
from fatigue.report import figures
from fatigue.report.figures.ride import MOST_SLICES
from fatigue.report.page import report_page
from fatigue.report.result import read_result
from fatigue.report.sections.embed import Figures
from fatigue.report.sections.ride.hunting import MOST_COMPARED, MOST_ROWS, MOST_TRACKS, in_one_line
from fatigue.report.sections.ride.read import read_ride
from fatigue.report.sections.ride.section import ride_section
from fatigue.report.sections.ride.tables import TOLD
from fatigue.results import RIDDEN
from fatigue.ride.alarm import alarm_rows
from fatigue.ride.flutter import tracked
from fatigue.ride.hot_damage import HotDamageRow, told
from fatigue.ride.story import tables_of_channels
from fatigue.ride.tables import write_tables
from fatigue.vibration.standards.environment_file import shipped_table
from tests.report.reading import Page, values
from tests.report.tiny_result import Recipe, write_result
from tests.ride.channels import hung, hunting, record

NOWHERE = float("nan")
MARKUP = "converter <b>%{y}"
RULES = {
    "bogie_mass_t": 6.8,
    "equipment_mode": [
        {"name": MARKUP, "frequency_hz": 8.0, "damping_ratio": 0.05, "channel": "converter"},
        {"name": "fan", "frequency_hz": 48.0, "damping_ratio": 0.02},
    ],
    "equipment": [{"channel": "converter", "class": "1A", "mass_kg": 6600}],
}
BOGIE = hunting((10.3, 19.7), seconds=40.0)
CONVERTER = hung(BOGIE, 8.0, 0.05)
TOLD_IN_ORDER = ("missed", "yes", "nothing_to_tell", "no_hot_stretch")
INSIDE = {"W1 bracket": 0.9, "W2 hanger": 0.1}


def channels_of(event, km_per_s=350 / 3600, names=("bogie <i>",)):
    """Bogies, their converter and a floor in one event."""
    own = [record(BOGIE, name) for name in names]
    own.append(record(CONVERTER, "converter", "equipment"))
    own.append(record(0.1 * CONVERTER, "floor z", "floor", "z"))
    return [replace(one, event=event, km_per_s=km_per_s) for one in own]


def damage_rows(folder, of, share_inside):
    """Rows of one channel at the worst point of every weld: more damage than length in hot stretches, or less."""
    nodes = pd.read_parquet(folder / "nodes.parquet").sort_values("damage_per_km").drop_duplicates("weld", keep="last")
    length = of.hot_length_share
    return [
        HotDamageRow(
            row.weld,
            row.part,
            row.node,
            row.order,
            row.surface,
            of.record.event,
            of.record.name,
            0.5 * row.damage_per_km,
            0.5 * row.damage_per_km * inside,
            inside,
            length,
            (inside / length) / ((1.0 - inside) / (1.0 - length)) if 0.0 < length < 1.0 else NOWHERE,
        )
        for row in nodes.itertuples()
        for inside in [share_inside.get(row.weld, 0.5) if length > 0.0 else 0.0]
    ]


def write_ride(folder, channels, rules=RULES, share_inside=INSIDE):
    """Write the tables of a ride over these channels into a result, and what its provenance has of it."""
    ride = Ride(**rules)
    of_channel = [tracked(one, ride) for one in channels]
    tables = tables_of_channels(SimpleNamespace(ride=ride), channels, of_channel, shipped_table())
    tables["hot_damage"] = [row for of in of_channel for row in damage_rows(folder, of, share_inside)]
    worst = {(row.event, row.channel): row for row in tables["hot_damage"]}  # the last is the worst
    tables["alarm"] = [told(row, worst[row.event, row.channel]) for row in tables["alarm"]]
    path = folder / "provenance.json"
    provenance = json.loads(path.read_text())
    write_tables(folder, tables, provenance.get("result", ""))
    provenance["ride"] = {
        "points": "the worst point of every weld, 2",
        "rules": ride.model_dump(by_alias=True),
        "channels": [
            {"event": one.event, "name": one.name, "role": one.role, "direction": one.direction, "column": "a_<b>"}
            | {"unit": "m/s2", "scale": 1.0, "shift_s": 0.0, "file": "run.csv", "sha256": 64 * "a"}
            | {"samples": round(one.duration / one.step), "step_s": one.step}
            for one in channels
        ],
        "warnings": [
            {"code": "short_channel", "where": "<u>bogie</u>", "what": "it covers 90 % of the event", "remedy": "Look"}
        ],
    }
    path.write_text(json.dumps(provenance))
    return folder


@pytest.fixture(scope="module")
def ridden(tmp_path_factory):
    """A result with a ride: one event of some km, one that is counted by number."""
    folder = write_result(tmp_path_factory.mktemp("ride"))
    return write_ride(folder, [*channels_of("tangent"), *channels_of("curve", NOWHERE)])


@pytest.fixture(scope="module")
def ridden_html(ridden):
    """Its page as text."""
    return report_page(ridden)


@pytest.fixture(scope="module")
def ridden_page(ridden_html):
    """Its page."""
    return Page(ridden_html)


def shown_ride(folder):
    """The ride of a result as the page reads it."""
    return read_ride(folder, read_result(folder, 5, 1000))


def section(folder):
    """What the page would say of the ride of a result, and its figures by id."""
    figs = Figures()
    ride = ride_section(shown_ride(folder), {}, figs)["ride"]
    return ride, {one.id: (one.caption, json.loads(one.json)) for one in figs.shown}


def part_of(ride, name):
    """One of its tables: headings, and texts of the rows."""
    [table] = [part["table"] for part in ride["parts"] if part["table"].id == f"ride-{name}"]
    return [heading.text for heading in table.headings], [[cell.text for cell in row] for row in table.rows]


def without(ridden, tmp_path, *tables):
    """A copy of a result without some tables."""
    folder = shutil.copytree(ridden, tmp_path / "copy")
    for name in tables:
        (folder / f"{name}.parquet").unlink()
    return folder


def test_without_a_ride_nothing_is_said_of_it(html, page, result_folder):
    """No heading, no link, no figure, not even an empty line."""
    assert shown_ride(result_folder) is None
    assert ride_section(None, {}, Figures()) == {"ride": None}
    assert "#ride" not in html
    assert 'id="ride' not in html
    assert not any("ride" in name for name in page.figures)
    assert '</li>\n    <li><a href="#welds">' in html


def test_a_ride_that_is_not_whole_is_not_shown(ridden, tmp_path):
    """Half of its tables would be read as the whole; the track alone is no need."""
    folder = without(ridden, tmp_path)
    result = read_result(folder, 5, 1000)
    for name in RIDDEN:
        path = folder / f"{name}.parquet"
        path.rename(path.with_suffix(".gone"))
        assert (read_ride(folder, result) is None) == (name != "flutter_track")
        path.with_suffix(".gone").rename(path)


def test_hunting_is_listed_with_what_it_does_to_the_welds(ridden, ridden_page):
    """Numbers of every channel are those of its tables."""
    head, *rows = ridden_page.tables["ride-hunting"]
    assert [row[:2] for row in rows] == [
        [event, channel] for event in ("tangent", "curve") for channel in ("bogie <i>", "converter", "floor z")
    ]
    bogie = dict(zip(head, rows[0], strict=True))
    track = pd.read_parquet(ridden / "flutter_track.parquet")
    hot = track[(track["event"] == "tangent") & (track["channel"] == "bogie <i>") & track["hot"]]
    assert float(bogie["dominant frequency [Hz]"]) == pytest.approx(hot["frequency_hz"].median(), rel=1e-3)
    assert bogie["hot stretches"] == "1"
    assert bogie["weld the event damages most"] == "W1 bracket"
    assert bogie["of it in hot stretches [%]"] == "90.0 %"


def test_a_track_is_drawn_of_every_bogie_in_km_or_seconds(ridden, ridden_page):
    """Hot stretches are shaded, modes of equipment are lines; one out of sight is named in the caption."""
    assert [name for name in ridden_page.figures if name.startswith("ride-track")] == ["ride-track-1", "ride-track-2"]
    by_km, by_time = (ridden_page.figures[f"ride-track-{n}"]["layout"] for n in (1, 2))
    assert "[km]" in by_km["xaxis"]["title"]["text"]
    assert "[s]" in by_time["xaxis"]["title"]["text"]
    flutter = pd.read_parquet(ridden / "flutter.parquet")
    hot = flutter[flutter["hot"] & (flutter["channel"] == "bogie <i>")].set_index("event")
    for layout, event, unit in ((by_km, "tangent", "km"), (by_time, "curve", "s")):
        [band] = [shape for shape in layout["shapes"] if shape["type"] == "rect"]
        assert (band["x0"], band["x1"]) == tuple(hot.loc[event, [f"start_{unit}", f"end_{unit}"]])
        lines = [shape["y0"] for shape in layout["shapes"] if shape["type"] == "line"]
        assert lines == [8.0, 3.0]  # the mode, and the factor of a hot slice in the lower panel
    assert "not drawn: fan (48 Hz)" in ridden_page.words
    low, high = by_km["yaxis"]["range"]
    assert low < 8.0 < high < 20.0


def test_damage_inside_stands_against_the_length_inside(ridden, ridden_page):
    """Bars of the welds, the one that is damaged most on top, and a line at the share of the length."""
    drawn = ridden_page.figures["ride-damage-1"]
    np.testing.assert_allclose(values(drawn["data"][0]["x"]), [0.9, 0.1], rtol=1e-6)
    assert drawn["layout"]["yaxis"]["ticktext"] == ["W1 bracket", "W2 hanger"]
    length = pd.read_parquet(ridden / "hot_damage.parquet")["length_share_inside"].iloc[0]
    assert drawn["layout"]["shapes"][0]["x0"] == pytest.approx(length)
    denser, thinner = drawn["data"][0]["marker"]["color"]
    assert 0.1 < length < 0.9
    assert denser != thinner


def test_flags_and_alarms_are_words(ridden_page):
    """Red is a word with a sign; what the alarm tells is a sentence."""
    coincidence, alarm = ridden_page.tables["ride-coincidence"], ridden_page.tables["ride-alarm"]
    assert [row[3] for row in coincidence[1:]] == ["✕ red", "green"] * 2
    assert "chance" in coincidence[1][coincidence[0].index("coherence")]
    assert coincidence[2][-1].startswith("the mode has no channel")
    told_of = alarm[0].index("what the alarm tells of the damage")
    assert [row[told_of] for row in alarm[1:]] == [TOLD["missed"]] * 2
    assert ("td", {"class": "missed", "data-v": "2.0"}) in ridden_page.tags


def test_every_word_of_the_alarm_has_a_sentence(ridden):
    """None of those that the ride writes is shown as the bare word."""
    [of] = [tracked(one, Ride(**RULES)) for one in channels_of("tangent")[:1]]
    [alarm] = alarm_rows([of], Ride(**RULES))
    [row, _] = damage_rows(ridden, of, INSIDE)
    length = row.length_share_inside
    cases = [(0, 0.9, length), (1, 0.9, length), (1, 0.01, length), (0, 0.0, 0.0)]
    words = [
        told(replace(alarm, alarms=alarms), replace(row, share_inside=inside, length_share_inside=length)).told
        for alarms, inside, length in cases
    ]
    assert words == list(TOLD_IN_ORDER)
    assert {*words} == {*TOLD}


def test_comfort_has_form_band_and_block_in_every_row(ridden_page):
    """And no grade anywhere."""
    head, *rows = ridden_page.tables["ride-comfort"]
    at = [head.index(name) for name in ("form", "band [Hz]", "block", "edition and status")]
    assert rows
    assert all(row[i] not in ("", "–") for row in rows for i in at)
    assert {row[at[2]] for row in rows} == {"whole record", "5 s"}
    assert "short record" in next(row for row in rows if row[3].startswith("EN 12299"))[head.index("note")]
    for words in ("excellent", "complies", "comfortable"):
        assert words not in ridden_page.words


def test_equipment_has_the_edition_of_its_table(ridden_page):
    """With its status, beside the class."""
    head, *rows = ridden_page.tables["ride-equipment"]
    editions = [row[head.index("edition and status")] for row in rows]
    assert len(editions) == 2
    assert all("superseded" in edition and "recalled" in edition for edition in editions)
    running = ridden_page.tables["ride-running"]
    assert "counted by number: it has no distance" in " ".join(row[-1] for row in running[1:])


def test_page_one_has_one_line(ridden, ridden_page):
    """Damage against length at the weld that the event damages most, what is met, what the alarm tells."""
    line = in_one_line(shown_ride(ridden))
    assert line.startswith("90.0 % of the damage of 'tangent' at W1 bracket lies in hot stretches of 'bogie <i>' (")
    assert f"is close to '{MARKUP}' (8 Hz); the alarm tells nothing of it" in line
    assert " ".join(line.split()) in ridden_page.words


def test_page_one_says_nothing_where_there_is_nothing_to_say(tmp_path):
    """Hot stretches that hold no more of the damage than of the length, far from any equipment."""
    folder = write_result(tmp_path)
    far = {"equipment_mode": [{"name": "fan", "frequency_hz": 48.0, "damping_ratio": 0.02}]}
    write_ride(folder, channels_of("tangent"), far, share_inside=dict.fromkeys(INSIDE, 0.05))
    page = Page(report_page(folder))
    assert ("a", {"href": "#ride"}) in page.tags
    assert "see the ride" not in page.words
    assert TOLD["nothing_to_tell"] in page.words


def test_page_one_names_equipment_that_hunting_meets(tmp_path):
    """Where hot stretches hold no more of the damage than of the length."""
    folder = write_ride(write_result(tmp_path), channels_of("tangent"), share_inside=dict.fromkeys(INSIDE, 0.05))
    line = in_one_line(shown_ride(folder))
    assert line.startswith("'bogie <i>' hunts in ")
    assert line.endswith(f"is close to '{MARKUP}' (8 Hz)")


def test_names_are_text_and_no_markup(ridden_html, ridden_page):
    """In sentences, captions, tables and figures."""
    for name in ("bogie <i>", MARKUP, "a_<b>", "<u>bogie</u>"):
        assert name not in ridden_html
        assert " ".join(name.split()) in ridden_page.words
    notes = ridden_page.figures["ride-track-1"]["layout"]["annotations"]
    assert notes[0]["text"] == "converter &lt;b&gt;%&#123;y} 8 Hz"


def test_warnings_and_files_of_the_channels_are_shown(ridden_page):
    """With those of the assessment."""
    assert "short channel : <u>bogie</u> : it covers 90 % of the event" in ridden_page.words
    head, *rows = ridden_page.tables["ride-channels"]
    assert len(rows) == 6
    assert rows[0][head.index("rate [Hz]")] == "200"
    assert rows[0][-1] == 64 * "a"


def test_of_many_channels_some_are_drawn(tmp_path):
    """The page says how many, and where the others are; the table lists them all."""
    names = tuple(f"bogie {i}" for i in range(MOST_TRACKS + 3))
    ride, drawn = section(write_ride(write_result(tmp_path), channels_of("tangent", names=names)))
    assert len(drawn) == MOST_TRACKS + MOST_COMPARED
    assert f"{MOST_TRACKS} of {len(names)} tracks of channels are drawn, the hottest" in ride["undrawn"]
    assert f"{MOST_COMPARED} of {len(names)} events and channels with hot stretches" in ride["uncompared"]
    assert len(ride["hunting"].rows) == len(names) + 2


def test_of_many_rows_some_are_listed(ridden):
    """The page says how many are left out, and where they are."""
    ride = shown_ride(ridden)
    many = pd.concat([ride.tables["comfort"]] * 50)
    ride = replace(ride, tables={**ride.tables, "comfort": many}, channels=ride.channels * 40)
    found = ride_section(ride, {}, Figures())["ride"]
    assert len(part_of(found, "comfort")[1]) == MOST_ROWS
    [part] = [part for part in found["parts"] if part["title"] == "Comfort"]
    assert part["left_out"] == f"{len(many) - MOST_ROWS} more rows are in comfort.parquet."
    assert found["unlisted"] == 40 * 6 - MOST_ROWS


def test_of_many_welds_the_most_damaged_are_drawn(tmp_path):
    """The caption says of how many."""
    recipe = Recipe(welds=tuple(f"W{i:02}" for i in range(25)), stations=2)
    folder = write_ride(write_result(tmp_path, recipe), channels_of("tangent"))
    caption, drawn = section(folder)[1]["ride-damage-1"]
    assert len(drawn["layout"]["yaxis"]["ticktext"]) == 20
    assert caption.endswith("20 of 25 welds")


def test_without_its_track_the_stretches_are_drawn(ridden, tmp_path):
    """One line per stretch, in seconds where there is no distance."""
    _, drawn = section(without(ridden, tmp_path, "flutter_track"))
    for number, unit in ((1, "km"), (2, "s")):
        caption, figure = drawn[f"ride-track-{number}"]
        assert [trace["name"] for trace in figure["data"]] == ["not hot", "hot stretch"]
        assert f"[{unit}]" in figure["layout"]["xaxis"]["title"]["text"]
        assert "yaxis2" not in figure["layout"]
        assert "no track is stored" in caption


def test_a_note_that_all_rows_share_is_said_once(tmp_path):
    """Below the table, which has no column for it then."""
    slow = replace(record(BOGIE[::25], "bogie", step=0.125), event="tangent")
    one = Page(report_page(write_ride(write_result(tmp_path / "one"), [slow])))
    two = Page(report_page(write_ride(write_result(tmp_path / "two"), [slow, replace(slow, name="other")])))
    assert one.tables["ride-alarm"][0][-1] == "note"
    assert "note" not in two.tables["ride-alarm"][0]
    note = one.tables["ride-alarm"][1][-1]
    assert two.words.count(note) == 1
    assert f"Of all rows: {note}." in two.words


def test_a_channel_that_cannot_be_tracked_has_its_reason(tmp_path):
    """No figure, dashes in its row, and the reason behind them."""
    slow = replace(record(BOGIE[::25], "bogie", step=0.125), event="tangent")
    page = Page(report_page(write_ride(write_result(tmp_path), [slow])))
    assert not any(name.startswith("ride-") for name in page.figures)
    row = page.tables["ride-hunting"][1]
    assert row[2:5] == ["–"] * 3
    assert row[-1].startswith("sampled at 8 Hz")
    assert page.tables["ride-coincidence"][1][3] == "–"
    assert "see the ride" not in page.words


def test_a_channel_of_no_bogie_alone_is_drawn_and_empty_tables_are_named(tmp_path):
    """No table without rows; the page says which role would give them."""
    other = replace(record(BOGIE, "wheel", "other"), event="tangent")
    ride, drawn = section(write_ride(write_result(tmp_path), [other], {}))
    assert "ride-track-1" in drawn
    assert [part["table"].id for part in ride["parts"]] == ["ride-stationarity", "ride-channels"]
    assert "comfort (role floor), vibration of equipment (role equipment)" in ride["without"]


def test_nothing_that_vibrates_is_no_figure(tmp_path):
    """A silent channel: no division by its reference, the reason instead."""
    silent = replace(record(np.zeros(12_000), "bogie"), event="tangent")
    ride, drawn = section(write_ride(write_result(tmp_path), [silent]))
    assert not drawn
    assert ride["hunting"].rows[0][-1].text == "nothing vibrates between 4 and 12 Hz"


def test_a_result_where_nothing_damages_has_its_tracks(tmp_path):
    """No share of no damage, no weld that is damaged most."""
    folder = write_ride(write_result(tmp_path, Recipe(level=0.0)), channels_of("tangent"))
    path = folder / "hot_damage.parquet"
    pd.read_parquet(path).assign(share_inside=np.nan, intensity=np.nan).to_parquet(path)
    ride, drawn = section(folder)
    assert [*drawn] == ["ride-track-1"]
    assert ride["hunting"].rows[0][5].text == "–"


def test_the_worst_weld_is_that_by_what_it_may_bear(tmp_path):
    """A weld with less damage and a smaller limit; older results have one limit for all."""
    folder = write_ride(write_result(tmp_path), channels_of("tangent"))
    result = read_result(folder, 5, 1000)
    damage = pd.read_parquet(folder / "hot_damage.parquet").groupby("weld")["damage_per_km"].first()
    least = 0.5 * damage["W2 hanger"] / damage["W1 bracket"]
    for limits, worst in (((1.0, least), "W2 hanger"), ((None, None), "W1 bracket")):
        by_weld = result.assessed["weld"].map(dict(zip(("W1 bracket", "W2 hanger"), limits, strict=True)))
        ride = read_ride(folder, replace(result, assessed=result.assessed.assign(damage_limit=by_weld)))
        assert ride.channels[0].worst["weld"] == worst


def test_a_long_track_is_thinned_and_keeps_what_is_clear():
    """Of equal parts the clearest slice each; many short stretches are no thousand shapes."""
    n = 40 * MOST_SLICES
    time = 0.25 * np.arange(n)
    share = np.where(np.arange(n) % 40 == 7, 0.9, 0.2)
    track = pd.DataFrame(
        {"time_s": time, "km": 0.1 * time, "frequency_hz": 8.0, "share": share, "rms": 1.0, "reference_rms": 1.0}
    ).assign(hot=share > 0.5)
    edges = np.linspace(0.0, time[-1], 20_001)
    stretches = pd.DataFrame(
        {"start_km": 0.1 * edges[:-1], "end_km": 0.1 * edges[1:], "start_s": edges[:-1], "end_s": edges[1:]}
    ).assign(frequency_hz=8.0, hot=np.arange(20_000) % 2 == 0)
    fig = figures.hunting_along_event(stretches, track).plotly()
    [hot] = [trace for trace in fig.data if trace.name == "hot stretch"]
    assert len(hot.x) == MOST_SLICES
    assert len(fig.layout.shapes) < 10


def test_names_of_modes_keep_clear_of_the_track():
    """Above or below their line, at its end or its start; lines close together share one text."""
    time = np.arange(100) * 0.25
    stretches = pd.DataFrame({"start_km": [0.0], "end_km": [2.5], "start_s": [0.0], "end_s": [25.0]})
    stretches = stretches.assign(frequency_hz=8.3, hot=False)
    track = pd.DataFrame(
        {"time_s": time, "km": 0.1 * time, "share": 0.5, "rms": 1.0, "reference_rms": 1.0, "hot": False}
    )
    modes = pd.DataFrame({"equipment": ["fan", "pump", "converter"], "frequency_hz": [8.0, 8.05, 14.0]})

    def placed(frequency):
        fig = figures.hunting_along_event(stretches, track.assign(frequency_hz=frequency), modes).plotly()
        shared, alone = fig.layout.annotations
        assert (shared.text, alone.text) == ("fan 8 Hz, pump 8.05 Hz", "converter 14 Hz")
        assert (alone.xanchor, alone.yanchor) == ("right", "bottom")
        return shared.xanchor, shared.yanchor

    assert placed(7.8) == ("right", "bottom")
    assert placed(8.3) == ("right", "top")
    at_end = np.where(time > 15.0, np.where(np.arange(100) % 2, 7.8, 8.3), 10.5)
    assert placed(at_end) == ("left", "bottom")


def test_figures_refuse_other_tables(ridden):
    """One line that names the missing columns."""
    with pytest.raises(DataError, match="flutter: the table lacks the columns"):
        figures.hunting_along_event(pd.read_parquet(ridden / "alarm.parquet"))
    with pytest.raises(DataError, match="hot_damage: the table lacks the columns"):
        figures.damage_in_hot_stretches(pd.read_parquet(ridden / "flutter.parquet"))
