"""The history of a point is what was counted: closed forms, largest ranges, constants, parts, disk; rainflow anew."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd
import pytest
import rainflow as peer

from fatigue.errors import DataError
from fatigue.point import history as story
from fatigue.point.found import find_station
from fatigue.point.history import COMPONENTS, event_histories, history_frame, reads_vertices
from fatigue.point.reopened import reopened
from fatigue.results import read_provenance
from tests import naive
from tests.point.cases import CASES, SEQUENCES, largest_ranges, plain, ranges_of, result_of
from tests.small_case import BENDING, MEMBRANE, STEP, THICKNESS


def history_of(folder: Path, weld: str = "A", event: str | None = None, instants="counted", **place) -> pd.DataFrame:
    """History of a station of a result."""
    station = find_station(folder, weld, **place)
    with TemporaryDirectory() as scratch:
        inputs = reopened(folder, read_provenance(folder), Path(scratch))
        histories = event_histories(inputs, station, event, instants=instants)
        found = history_frame(histories, at_vertices=reads_vertices(inputs, instants))
        assert not list(Path(scratch).glob("event-*"))
    return found


def test_a_uniform_weld_by_hand(results):
    """Membrane and bending of mode 1 are 1 and 0.5 MPa per unit, nothing else moves in the sine."""
    found = history_of(results("plain"), event="sine", order=4)
    table = pd.read_csv(results("plain").parent / "case" / "sine.csv")
    q = table["q_1"].to_numpy()
    np.testing.assert_allclose(found["time_s"], table["time_s"], rtol=0, atol=1e-9)
    np.testing.assert_allclose(found["membrane_MPa"], MEMBRANE * q, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found["bending_MPa"], BENDING * q, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found["structural_top_MPa"], (MEMBRANE + BENDING) * q, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found["structural_bottom_MPa"], (MEMBRANE - BENDING) * q, rtol=0, atol=1e-12)
    shears = found[["in_plane_shear_MPa", "twist_shear_MPa", "transverse_shear_MPa"]]
    assert np.abs(shears.to_numpy()).max() < 1e-10
    assert set(found["event"]) == {"sine"}


def test_the_start_up_is_cut_and_the_factor_included(results):
    """The random event begins at 1 s of its file, and has a factor of 1.3 on all stresses."""
    folder = results("plain")
    found = history_of(folder, event="noise", order=2)
    q = pd.read_csv(folder.parent / "case" / "noise.csv").query("time_s > 1 - 0.0025")
    stress = pd.read_parquet(folder / "structural_stress.parquet").query("weld == 'A' and order == 2")
    by_mode = stress.set_index("mode")
    assert found["time_s"].iloc[0] == pytest.approx(1.0)
    for name in COMPONENTS:
        by_hand = 1.3 * sum(by_mode.loc[mode, f"{name}_MPa"] * q[f"q_{mode}"].to_numpy() for mode in (1, 2, 7))
        np.testing.assert_allclose(found[f"{name}_MPa"], by_hand, rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("order", [1, 4, 6])
def test_ranges_are_those_of_the_assessment(results, name, order):
    """Of every event at both faces, whatever was counted: exact to what was counted."""
    folder = results(name)
    part = 1 if name != "corner" or order < 4 else 2
    history = history_of(folder, order=order, part=part)
    expected = largest_ranges(folder, ("A", part, order)).drop(index=SEQUENCES, errors="ignore")
    found = ranges_of(history).loc[expected.index]
    np.testing.assert_allclose(found, expected[["top", "bottom"]], rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("name", ["unit loads", "unit loads at vertices", "loop"])
def test_constants_are_at_the_level_of_the_cycles(results, name):
    """Largest and smallest stress are those of the largest cycle: constants, removed means and factors included."""
    folder = results(name)
    cycles = pd.read_parquet(folder / "cycles.parquet").query("weld == 'A'")
    history = history_of(folder)
    face = cycles["surface"].iloc[0]
    column = f"counted_{face}_MPa" if "counted_top_MPa" in history else f"structural_{face}_MPa"
    for event, of_event in history.groupby("event"):
        of_largest = cycles[cycles["event"] == event].sort_values("range_MPa").iloc[-1]
        middle = 0.5 * (of_event[column].max() + of_event[column].min())
        assert middle == pytest.approx(of_largest["mean_MPa"], rel=1e-10, abs=1e-10), event


def test_every_reversal_is_where_its_cycle_says(results):
    """At the file times of each cycle of the table the history has the two stresses of the cycle."""
    folder = results("upsampled")
    cycles = pd.read_parquet(folder / "cycles.parquet").query("weld == 'A' and event == 'noise'")
    face = cycles["surface"].iloc[0]
    history = history_of(folder, event="noise").set_index("time_s")[f"structural_{face}_MPa"]
    ends = np.stack([history.loc[cycles["start_s"]], history.loc[cycles["end_s"]]])
    np.testing.assert_allclose(np.abs(ends[1] - ends[0]), cycles["range_MPa"], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(ends.mean(axis=0), cycles["mean_MPa"], rtol=1e-9, atol=1e-9)


def test_samples_of_the_file_are_every_fourth_of_what_was_counted(results):
    """Where the record was upsampled four times."""
    folder = results("upsampled")
    every, few = history_of(folder, order=3), history_of(folder, order=3, instants="file")
    for event in ("sine", "noise"):
        fine, coarse = (table[table["event"] == event].drop(columns="event").to_numpy() for table in (every, few))
        assert (
            len(coarse)
            == pd.read_parquet(folder.parent / "case" / f"{event}.parquet")
            .query("time_s >= 0.9975" if event == "noise" else "time_s >= 0")
            .shape[0]
        )
        np.testing.assert_allclose(fine[::4], coarse, rtol=0, atol=1e-9)


def test_samples_of_the_file_where_a_load_is_finer(results):
    """The record was refined for the load; the samples of the file are every fourth, the load read at them."""
    folder = results("finer load")
    every, few = (history_of(folder, order=3, event="noise", instants=instants) for instants in ("counted", "file"))
    record = read_provenance(folder)
    assert [event["refined"] for event in record["mission"]["events"]][1] == 4
    q = pd.read_csv(folder.parent / "case" / "noise.csv").query("time_s > 0.9975")
    np.testing.assert_allclose(few["time_s"], q["time_s"], rtol=0, atol=1e-9)
    assert len(every) == 4 * len(few)
    np.testing.assert_allclose(every["membrane_MPa"][::4], few["membrane_MPa"], rtol=0, atol=1e-12)
    stress = pd.read_parquet(folder / "structural_stress.parquet").query("weld == 'A' and order == 3")
    push = 20.0 * np.sin(2 * np.pi * 17.0 * q["time_s"].to_numpy())
    rows = stress.set_index("mode")["membrane_MPa"]
    by_hand = rows.loc[1] * q["q_1"] + rows.loc[2] * q["q_2"] + rows[rows.index.isna()].item() * push
    np.testing.assert_allclose(few["membrane_MPa"], 1.3 * by_hand, rtol=0, atol=1e-9)


def test_a_last_piece_without_a_sample_of_the_file(results, monkeypatch):
    """Pieces may be shorter than the samples of the file are apart; none of them is empty, and none is lost."""
    folder = results("finer load")
    whole = history_of(folder, event="noise", instants="file")
    monkeypatch.setattr(story, "PIECE", 1)
    monkeypatch.setattr("fatigue.life.records.history.CACHED_NUMBERS", 1)
    monkeypatch.setattr("fatigue.life.records.history.SHORTEST_CHUNK", 3)
    pd.testing.assert_frame_equal(history_of(folder, event="noise", instants="file"), whole, rtol=1e-12, atol=1e-12)


def test_vertices_stand_beside_the_samples(results):
    """What was counted differs from the samples at reversals only, and reaches beyond them by an eighth of a step."""
    folder = results("vertex")
    found = history_of(folder, event="noise", order=3)
    for face, side in (("top", 1.0), ("bottom", -1.0)):
        sampled = found[f"structural_{face}_MPa"].to_numpy()
        membrane, bending = found["membrane_MPa"].to_numpy(), found["bending_MPa"].to_numpy()
        np.testing.assert_allclose(sampled, membrane + side * bending, rtol=0, atol=1e-12)
        m, b, _ = (np.array(x) for x in naive.at_vertices(membrane, bending, side, "repeat"))
        np.testing.assert_allclose(found[f"counted_{face}_MPa"], m + side * b, rtol=0, atol=1e-10)
        assert 0.1 < (found[f"counted_{face}_MPa"] != sampled).mean() < 0.9
    assert "counted_top_MPa" not in history_of(folder, order=3, instants="file")


def test_a_static_load_case_has_numbers_for_times(results):
    """Its values, one after the other, with the constants of the event."""
    folder = results("unit loads")
    found = history_of(folder, event="stand", order=3)
    stress = pd.read_parquet(folder / "structural_stress.parquet").query("weld == 'A' and order == 3")
    push = stress[stress["unit_load"] == "push"].iloc[0]
    assert found["time_s"].tolist() == [0.0, 1.0, 2.0, 3.0]
    np.testing.assert_allclose(found["membrane_MPa"], push["membrane_MPa"] * np.array([0.0, 40.0, -25.0, 0.0]))


@pytest.mark.parametrize("name", ["plain", "vertex, half, upsampled", "unit loads at vertices", "corner"])
def test_records_on_disk_give_the_same(results, name, monkeypatch):
    """To the last bits, in pieces that do not grow with the record; what was on disk is removed."""
    folder, place = results(name), {"order": 5, "part": 2 if name == "corner" else 1}
    in_memory = history_of(folder, **place)
    monkeypatch.setattr("fatigue.point.reopened.HELD_BYTES", 0.0)
    monkeypatch.setattr(story, "PIECE", 50)
    monkeypatch.setattr("fatigue.life.records.history.CACHED_NUMBERS", 40 * 3)
    on_disk = history_of(folder, **place)
    assert on_disk["event"].equals(in_memory["event"])
    numbers = [name for name in in_memory if name != "event"]
    np.testing.assert_allclose(on_disk[numbers], in_memory[numbers], rtol=1e-12, atol=1e-12)


def test_pieces_are_short(results, monkeypatch):
    """However long the record, a piece is a few times what is asked for."""
    monkeypatch.setattr(story, "PIECE", 100)
    monkeypatch.setattr("fatigue.life.records.history.CACHED_NUMBERS", 1)
    folder = results("upsampled")
    with TemporaryDirectory() as scratch:
        inputs = reopened(folder, read_provenance(folder), Path(scratch))
        for history in event_histories(inputs, find_station(folder, "A")):
            lengths = [len(piece.time) for piece in history.pieces()]
            assert sum(lengths) == history.samples
            assert max(lengths) <= 100 + story.PIECE


def master_damage(folder: Path, found: list[tuple[float, float, float]]) -> float:
    """Miner sum of cycles (range, bending ratio, count) by the master curve, from the numbers of the provenance."""
    used = read_provenance(folder)["curves"]["master-aluminium"]["used"]
    (slope,), (log_constant,) = used["slopes"], used["log_constants"]
    size = THICKNESS ** ((3.6 - 2.0) / (2 * 3.6))
    return sum(n * (size * s / naive.ratio_factor(r)) ** slope for s, r, n in found) / np.exp(log_constant)


@pytest.mark.parametrize("name", ["plain", "half", "unit loads", "vertex"])
@pytest.mark.parametrize("face", ["top", "bottom"])
def test_the_rainflow_package_finds_the_damage_of_the_result(results, name, face):
    """Counted by a program of somebody else, by the history alone, to 1e-9 of the damage of every pass."""
    folder, side = results(name), {"top": 1.0, "bottom": -1.0}[face]
    damage = pd.read_parquet(folder / "damage.parquet").query("weld == 'A' and order == 3").query("surface == @face")
    history, residue = history_of(folder, order=3), read_provenance(folder)["rules"]["residue"]
    for event, of_event in history.groupby("event"):
        m, b = of_event["membrane_MPa"].to_numpy(), of_event["bending_MPa"].to_numpy()
        s = of_event[f"structural_{face}_MPa"].to_numpy()
        if name == "vertex" and event != "stand":
            rule = "half" if event == "load and unload" else "repeat"
            m, b, _ = (np.array(x) for x in naive.at_vertices(m, b, side, rule))
            s = of_event[f"counted_{face}_MPa"].to_numpy()
            np.testing.assert_allclose(s, m + side * b, rtol=0, atol=1e-9)
        if residue[event].startswith("the record recurs"):
            first = int(s.argmax())
            m, b, s = (np.append(np.roll(x, -first), x[first]) for x in (m, b, s))
        if len(s) == 2:  # the package wants a sample between
            m, b, s = (np.insert(x, 1, x.mean()) for x in (m, b, s))
        cycles = []
        for size, _, count, i, j in peer.extract_cycles(s):
            dm, db = abs(m[i] - m[j]), abs(b[i] - b[j])
            cycles.append((size, db / (dm + db) if dm + db else 0.0, count))
        expected = damage.set_index("event").loc[event, "damage_per_pass"]
        assert master_damage(folder, cycles) == pytest.approx(expected, rel=1e-9), event


@pytest.mark.parametrize(
    ("event", "words"),
    [
        ("nois", "the mission has no event 'nois'. Name 'noise'"),
        ("zz", "the mission has no event 'zz'. Name one of 'sine', 'noise', 'load and unload'"),
    ],
)
def test_an_event_that_is_not_there(results, event, words):
    """With the one that was meant."""
    with pytest.raises(DataError, match=words):
        history_of(results("plain"), event=event)


def test_a_sequence_has_no_history_of_its_own(results):
    """Its events have."""
    with pytest.raises(DataError, match=r"'\(sequence 1\)' is a sequence .* Name one of its events: 'sine', 'load', "):
        history_of(results("loop"), event="(sequence 1)")


def test_inputs_that_changed_are_refused(tmp_path):
    """As every command does that needs them."""
    folder = result_of(plain().write(tmp_path / "case"), tmp_path / "result")
    path = tmp_path / "case" / "sine.csv"
    path.write_text(path.read_text().replace("0.005", "0.0050"))
    with pytest.raises(DataError, match=r"sine\.csv"):
        history_of(folder)
    path.unlink()
    with pytest.raises(DataError, match=r"sine\.csv"):
        history_of(folder)


def test_steps_are_those_of_the_file(results):
    """A time of 0.005 s between samples, and a quarter of it where they were upsampled four times."""
    for name, factor in (("plain", 1), ("upsampled", 4)):
        found = history_of(results(name), event="sine", order=1)
        np.testing.assert_allclose(np.diff(found["time_s"]), STEP / factor, rtol=1e-6)
