"""The whole path: files, the command, the tables, page and record; and what is refused."""

import json

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.errors import CaseError, DataError
from fatigue.gauges.histories.story import histories
from fatigue.results.dictionary.decided.gauges import GAUGE_TABLES
from tests.command_line import fatigue
from tests.gauge_case import FACE_STRAIN, STRAIN, gauge_case
from tests.gauges.test_rows import table

GAUGES = table(
    "front,element,102,,,,,,,0,,,,top,,,,,,,,",
    "back,element,102,,,,,,,0,,,,bottom,,,,,,,,",
    "toe,toe,,,,,,,,,,,,top,,A,3,,,,,",
)
K = 1 / 0.27712  # slope of master-aluminium, 1 / h


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A small case with its gauges, and what the command wrote and said of it."""
    folder = tmp_path_factory.mktemp("gauges")
    case = gauge_case(GAUGES, seconds=4.0)
    case_file, gauges = case.write(folder / "case")
    done = fatigue("gauges", "histories", case_file, "--gauges", gauges, "-o", folder / "out", "--csv", "--json")
    assert done.returncode == 0, done.stderr
    return case, case_file, gauges, folder / "out", json.loads(done.stdout)


def read(folder, name):
    """A table of the folder."""
    return pd.read_parquet(folder / f"{name}.parquet")


def test_histories_are_rows_times_coordinates_of_every_event(written):
    """By hand from the closed rows of element 102: mode 1 is 2 e-4, mode 2 flips from face to face."""
    case, _, _, folder, _ = written
    found = read(folder, "histories")
    assert list(found.event.unique()) == ["sine", "noise", "load and unload"]
    noise, history = found[found.event == "noise"], case.case.histories["noise"]
    kept = history[history.time_s >= 1.0 - 1e-9]
    assert noise.time_s.to_numpy() == pytest.approx(kept.time_s.to_numpy())
    q_1, q_2 = kept.q_1.to_numpy(), kept.q_2.to_numpy()
    assert noise.front_ue.to_numpy() == pytest.approx(2e6 * STRAIN * q_1 + 1e6 * FACE_STRAIN * q_2, abs=1e-6)
    assert noise.back_ue.to_numpy() == pytest.approx(2e6 * STRAIN * q_1 - 1e6 * FACE_STRAIN * q_2, abs=1e-6)
    assert noise.front_MPa.to_numpy() == pytest.approx(70000e-6 * noise.front_ue.to_numpy(), rel=1e-9)


def test_the_sine_event_in_closed_form(written):
    """30 sin 5 Hz for 4 s: 20 cycles of 2 x 30 x 200 1e-6, per km of 50 m/s, and their pseudo-damage."""
    _, _, _, folder, _ = written
    row = read(folder, "gauge_events").set_index(["gauge", "event"]).loc[("front", "sine")]
    assert row.rms_ue == pytest.approx(30.0 * 200.0 / np.sqrt(2.0))
    assert row.largest_range_ue == pytest.approx(12000.0)
    assert row.cycles_per_pass == pytest.approx(20.0)
    assert row.exponent == pytest.approx(K, rel=1e-6)
    assert row.km_per_pass == pytest.approx(0.2)
    assert row.pseudo_damage_per_pass == pytest.approx(20.0 * 12000.0**row.exponent)
    assert row.pseudo_damage_per_km == pytest.approx(row.pseudo_damage_per_pass / 0.2)
    assert row.pseudo_damage_per_mission_km == pytest.approx(0.75 * row.pseudo_damage_per_km)
    once = read(folder, "gauge_events").set_index(["gauge", "event"]).loc[("front", "load and unload")]
    assert np.isnan(once.km_per_pass)
    assert np.isnan(once.pseudo_damage_per_km)
    assert once.pseudo_damage_per_mission_km == pytest.approx(0.002 * once.pseudo_damage_per_pass)


def test_the_spectrum_of_the_mission_is_the_sum_of_its_events(written):
    """Counts and power sums add up; the latter are the pseudo-damage of the events."""
    _, _, _, folder, _ = written
    spectrum, events = read(folder, "gauge_spectrum"), read(folder, "gauge_events")
    for gauge, rows in spectrum.groupby("gauge"):
        total = rows[rows.event == "(mission)"]
        others = rows[rows.event != "(mission)"]
        assert total.count_per_km.sum() == pytest.approx(others.count_per_km.sum())
        damage = events.loc[events.gauge == gauge, "pseudo_damage_per_mission_km"].sum()
        assert total.power_sum_per_km.sum() == pytest.approx(damage)
        assert total.exceedance_per_km.iloc[0] == pytest.approx(total.count_per_km.sum())


def test_the_table_of_gauges_says_where_each_is_and_how_sure(written):
    """Place, direction, nearest weld, sensitivities; a stand-in is flagged and has none."""
    _, _, _, folder, _ = written
    rows = read(folder, "gauges").set_index("gauge")
    front, toe = rows.loc["front"], rows.loc["toe"]
    assert (front.x_mm, front.y_mm, front.z_mm) == pytest.approx((30.0, 1005.0, 0.0))
    assert (front.dir_x, front.normal_z, rows.loc["back"].normal_z) == pytest.approx((1.0, 1.0, -1.0))
    assert (front.element, front.elements, front.neighbours) == (102, 1, 2)
    assert (front.nearest_weld, front.distance_to_weld_mm) == ("B", pytest.approx(505.0))
    assert not front.stand_in
    assert toe.stand_in
    assert (toe.weld, toe.order, toe.distance_to_weld_mm) == ("A", 3, 0.0)
    assert np.isnan(toe.angle_sensitivity)
    assert 0.0 < front.angle_sensitivity < 0.2
    sine, noise = (
        read(folder, "gauge_events").set_index(["gauge", "event"]).loc[("front", name)].rms_ue
        for name in ("sine", "noise")
    )
    assert front.rms_ue == pytest.approx(np.sqrt(0.75 * sine**2 + 0.25 * noise**2))


def test_every_column_of_every_table_is_in_the_dictionary(written):
    """With unit and meaning beside the numbers; histories have two columns for each gauge."""
    _, _, _, folder, _ = written
    for name, columns in GAUGE_TABLES.items():
        schema = pq.read_schema(folder / f"{name}.parquet")
        assert schema.names[: len(columns)] == [column.name for column in columns]
        assert schema.field(columns[-1].name).metadata[b"description"]
    assert pq.read_schema(folder / "histories.parquet").names[2:4] == ["front_ue", "front_MPa"]
    assert pd.read_csv(folder / "gauges.csv").gauge.tolist() == ["front", "back", "toe"]


def test_rows_are_written_for_others(written):
    """Reading per unit of every mode, as it was used."""
    _, _, _, folder, _ = written
    rows = read(folder, "gauge_rows")
    front = rows[rows.gauge == "front"]
    assert front["mode"].tolist() == [1, 2, 7]
    assert front.strain_ue.to_numpy() == pytest.approx([200.0, 200.0, 0.0], abs=1e-6)


def test_what_is_printed_for_machines_and_people(written, tmp_path):
    """The record has rows and sentences; the text names stand-ins and sensitivity."""
    _, case_file, gauges, _, record = written
    assert [row["gauge"] for row in record["gauges"]] == ["front", "back", "toe"]
    assert record["gauges"][2]["angle_sensitivity"] is None
    assert len(record["events"]) == 9
    done = fatigue("-q", "gauges", "histories", case_file, "--gauges", gauges, "-o", tmp_path)
    assert "3 gauges of gauges.csv" in done.stdout
    assert "Stand-ins at weld toes, for planning only" in done.stdout
    assert "Most sensitive to its angle is" in done.stdout
    page = (tmp_path / "gauges.html").read_text("utf-8")
    assert "http://" not in page.split("plotly-source")[0]
    assert "Where they are" in page


def test_the_same_again_is_the_same_and_nothing_foreign_is_overwritten(written, tmp_path):
    """Byte for byte; a file that somebody wrote stays without --force; an input always."""
    _, case_file, gauges, folder, _ = written
    out = tmp_path / "out"
    histories(case_file, gauges, into=out)
    for name in GAUGE_TABLES:
        assert (out / f"{name}.parquet").read_bytes() == (folder / f"{name}.parquet").read_bytes()
    (out / "gauges.html").write_text("mine", encoding="utf-8")
    with pytest.raises(DataError, match="was not written by fatigue gauges histories, or was changed since"):
        histories(case_file, gauges, into=out)
    histories(case_file, gauges, into=out, force=True)
    with pytest.raises(DataError, match="is an input of this gauges"):
        histories(case_file, gauges, into=gauges.parent, csv=True, force=True)


def test_one_event_and_counted_instants(written, tmp_path):
    """Only that event is written, without the mission; counted instants are those of the upsampled record."""
    case, *_ = written
    case.case.counting = {"upsample": 2}
    case_file, gauges = case.write(tmp_path / "case")
    found = histories(case_file, gauges, into=tmp_path / "out", events=["noise"], counted=True)
    assert {row.event for row in found.events} == {"noise"}
    assert set(read(tmp_path / "out", "gauge_spectrum").event) == {"noise"}
    times = read(tmp_path / "out", "histories").time_s.to_numpy()
    assert np.diff(times) == pytest.approx(0.0025)
    case.case.counting = {"upsample": 1}


def test_pseudo_damage_with_an_exponent_of_ones_own(written):
    """Ratios of damage depend on k: it can be given, and stands in every row."""
    _, case_file, gauges, *_ = written
    found = histories(case_file, gauges, exponent=5.0)
    (row,) = [one for one in found.events if (one.gauge, one.event) == ("front", "sine")]
    assert row.pseudo_damage_per_pass == pytest.approx(20.0 * 12000.0**5)
    assert row.exponent == 5.0
    with pytest.raises(CaseError, match="-1 is no exponent of an S-N curve"):
        histories(case_file, gauges, exponent=-1)


def test_mistakes_end_with_their_exit_codes(written, tmp_path):
    """An unknown event, no table of gauges, a missing case; usage without --gauges."""
    _, case_file, gauges, *_ = written
    unknown = fatigue("gauges", "histories", case_file, "--gauges", gauges, "-o", tmp_path / "o", "--event", "wrong")
    assert unknown.returncode == 3
    assert "there is no event 'wrong' in case.toml. Name one of sine, noise, load and unload" in unknown.stderr
    absent = fatigue("gauges", "histories", case_file, "--gauges", tmp_path / "no.csv", "-o", tmp_path / "o")
    assert absent.returncode == 3
    assert "no.csv" in absent.stderr
    assert fatigue("gauges", "histories", tmp_path / "no.toml", "--gauges", gauges, "-o", tmp_path).returncode == 3
    assert fatigue("gauges", "histories", case_file, "-o", tmp_path / "o").returncode == 2
    assert not (tmp_path / "o").exists()


def test_names_of_gauges_are_texts_and_no_formulas(tmp_path):
    """What a spreadsheet would take for a formula is marked in CSV, in cells and headings, and kept elsewhere."""
    case = gauge_case(table("=1+1,element,101,,,,,,,0,,,,top,,,,,,,,"))
    case_file, gauges = case.write(tmp_path / "case")
    histories(case_file, gauges, into=tmp_path / "out", csv=True)
    assert read(tmp_path / "out", "gauges").gauge.tolist() == ["=1+1"]
    assert (tmp_path / "out" / "histories.csv").read_text("utf-8").startswith('"event","time_s","\'=1+1_ue"')
    assert "'=1+1" in (tmp_path / "out" / "gauges.csv").read_text("utf-8")


def test_a_case_without_mesh_has_stand_ins_alone(tmp_path):
    """No outline, no neighbours; the page draws the weld lines."""
    case = gauge_case(table("t,toe,,,,,,,,,,,,top,,A,2,,,,70000,0.3")).case
    case_file = case.write(tmp_path / "case")
    gauges = tmp_path / "gauges.csv"
    gauges.write_text(table("t,toe,,,,,,,,,,,,top,,A,2,,,,70000,0.3"), encoding="utf-8")
    found = histories(case_file, gauges, into=tmp_path / "out")
    (row,) = found.gauges
    assert (row.stand_in, row.neighbours, row.element, row.nearest_weld) == (True, 0, None, "A")
    first = next(one for one in found.events if one.event == "sine")
    assert first.rms_MPa == pytest.approx(1.5 * 30.0 / np.sqrt(2.0))  # membrane 1 and bending 0.5 per unit
    assert first.rms_ue == pytest.approx(1e6 * (1 - 0.3**2) / 70000.0 * first.rms_MPa)
