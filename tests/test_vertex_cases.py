"""``reversals = "vertex"`` as a user meets it: tables that agree with each other, screening, diagnosis, load factor."""

import json

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.diagnose import diagnose
from fatigue.pipeline.mission import events
from fatigue.results import read_provenance, upsampling_factors
from fatigue.spectra import spectra
from fatigue.synth import Size, synthesize
from tests import naive
from tests.small_case import BENDING, MEMBRANE, STEP, small_case
from tests.test_outside_band import shaken


def at_vertices(case, **counting):
    """The case, its reversals read at their vertices."""
    case.counting = {"upsample": 1, "reversals": "vertex"} | counting
    return case


def tables(folder):
    """All tables of a result by their names."""
    return {name: pd.read_parquet(folder / f"{name}.parquet") for name in ("nodes", "damage", "cycles")}


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A case with coarse samples, assessed at vertices."""
    folder = tmp_path_factory.mktemp("vertex")
    assess(at_vertices(shaken(5.0, 30.0)).write(folder / "case"), folder / "result", report=False)
    return folder


def test_cycles_are_those_of_a_slow_count(result):
    """Instants between the samples, ranges of the parabolas, membrane and bending at the same instant."""
    cycles = tables(result / "result")["cycles"]
    mine = cycles[(cycles["weld"] == "A") & (cycles["event"] == "sine")]
    q = pd.read_csv(result / "case" / "sine.csv")["q_1"].to_numpy()
    side = 1.0 if mine["surface"].iloc[0] == "top" else -1.0
    m, b, shift = (np.array(x) for x in naive.at_vertices(MEMBRANE * q, BENDING * q, side, "repeat"))
    s = m + side * b
    by_hand = naive.cycles(s, "repeat")
    found = np.array([(abs(s[i] - s[j]), STEP * (i + shift[i]), STEP * (j + shift[j]), n) for i, j, n in by_hand])
    whole = mine[mine["range_MPa"] < mine["range_MPa"].max()]  # by hand the largest one is two halves
    for place, column in enumerate(("range_MPa", "start_s", "end_s")):
        expected = np.sort(found[found[:, 3] == 1.0, place])
        np.testing.assert_allclose(np.sort(whole[column]), expected, rtol=1e-9, atol=1e-9)
    assert np.abs(mine["start_s"] / STEP - (mine["start_s"] / STEP).round()).max() > 0.1
    assert mine["membrane_range_MPa"].to_numpy() == pytest.approx((2.0 * mine["bending_range_MPa"]).to_numpy())


def test_tables_add_up(result):
    """The damage of the cycles is that of the event; per event no less than of the samples."""
    found = tables(result / "result")
    key = ["weld", "part", "order", "surface", "event"]
    by_cycles = found["cycles"].groupby(key, observed=True)["damage"].sum()
    by_event = found["damage"].set_index(key)["damage_per_pass"]
    both = pd.concat([by_cycles, by_event], axis=1, join="inner").to_numpy()
    np.testing.assert_allclose(both[:, 0], both[:, 1], rtol=1e-10)
    assess(shaken(5.0, 30.0).write(result / "sampled"), result / "of-samples", report=False)
    sampled = tables(result / "of-samples")["damage"].set_index(key)["damage_per_pass"]
    swinging = by_event.index.get_level_values("event") != "load and unload"
    assert (by_event[swinging] > 1.01 * sampled[swinging]).all()
    np.testing.assert_array_equal(by_event[~swinging], sampled[~swinging])


def test_the_diagnosis_adds_up(result):
    """Shares of modes are of the same vertices."""
    diagnose(result / "result")
    nodes = tables(result / "result")["nodes"]
    shares = pd.read_parquet(result / "result" / "attribution.parquet")
    modes = shares[shares["kind"] == "mode"]
    per_point = modes.groupby(["weld", "part", "order", "surface"], observed=True)["damage_per_km"].sum()
    stored = nodes.set_index(["weld", "part", "order", "surface"])["damage_per_km"]
    both = pd.concat([per_point, stored], axis=1, join="inner").to_numpy()
    assert len(both) > 0
    np.testing.assert_allclose(both[:, 0], both[:, 1], rtol=1e-9)


def test_load_spectra_are_of_the_same_cycles(result):
    """Their power sums are the damage of the table."""
    spectra(result / "result")
    found = pd.read_parquet(result / "result" / "spectrum.parquet")
    mine = found[(found["event"] == "sine") & (found["weld"] == "A")]
    worst = tables(result / "result")["cycles"].query("event == 'sine' and weld == 'A'")
    assert mine["max_MPa"].max() == pytest.approx(worst["range_MPa"].max(), rel=1e-12)


def test_long_records_give_the_same(result, monkeypatch):
    """On disk, in chunks: damage and cycles."""
    monkeypatch.setattr(events, "HELD_BYTES", 0.0)
    monkeypatch.setattr("fatigue.pipeline.tables.cycles._SAMPLES_AT_ONCE", 1)
    assess(result / "case" / "case.toml", result / "long", report=False)
    short, long = tables(result / "result"), tables(result / "long")
    np.testing.assert_allclose(long["damage"]["damage_per_pass"], short["damage"]["damage_per_pass"], rtol=1e-11)
    for column in ("range_MPa", "start_s", "end_s", "damage"):
        np.testing.assert_allclose(long["cycles"][column], short["cycles"][column], rtol=1e-9, atol=1e-12)


def test_the_load_factor_put_back_gives_utilisation_one(tmp_path):
    """On a curve with a knee, where cycles are counted again under factors."""
    case = at_vertices(small_case())
    case.curve |= {"name": "master-steel", "extension": "haibach"}
    assess(case.write(tmp_path / "case"), tmp_path / "result", report=False)
    worst = tables(tmp_path / "result")["nodes"].query("toe").sort_values("utilisation").iloc[-1]
    for event in case.events:
        event["stress_factor"] = float(worst["load_factor"])
    assess(case.write(tmp_path / "again"), tmp_path / "put-back", report=False)
    assert tables(tmp_path / "put-back")["nodes"].query("toe")["utilisation"].max() == pytest.approx(1.0, rel=1e-3)


def test_screened_points_are_bounded_at_vertices(tmp_path):
    """No bound is below what is counted, and the worst point is the same."""
    path = synthesize(tmp_path / "case", Size(nodes=120, modes=8, events=2, seconds=8.0, rate=250.0), seed=3)
    text = path.read_text().replace("[mission]", '[counting]\nreversals = "vertex"\nupsample = 1\n[mission]')
    path.write_text(text.replace("target_km = 1.2e7", "target_km = 20.0"))
    assess(path, tmp_path / "screened", share=1.0, report=False)
    assess(path, tmp_path / "counted", share=0.0, report=False)
    bounded, counted = tables(tmp_path / "screened"), tables(tmp_path / "counted")
    is_bound = (bounded["nodes"]["screened"] != "").to_numpy()
    assert is_bound.any()
    for table, column in (("nodes", "damage_per_km"), ("nodes", "max_range_MPa"), ("damage", "damage_per_pass")):
        assert (bounded[table][column] >= counted[table][column] * (1 - 1e-9)).all(), column
    worst = [pd.read_parquet(tmp_path / name / "welds.parquet")["life_km"] for name in ("screened", "counted")]
    np.testing.assert_allclose(*worst, rtol=1e-9)


def test_large_jobs_are_counted_in_double_precision(tmp_path, monkeypatch):
    """The counter in single precision does not read vertices; the provenance says what served."""
    monkeypatch.setattr("fatigue.pipeline.mission.precision.SINGLE_FROM", 0.0)
    assess(at_vertices(small_case()).write(tmp_path / "case"), tmp_path / "result", share=0.0, report=False)
    rules = json.loads((tmp_path / "result" / "provenance.json").read_text())["rules"]
    assert (rules["precision"], rules["reversals"]) == ("double", "vertex")


def test_fewer_samples_are_enough(tmp_path):
    """8 samples per peak at vertices lose as little as 20 of the samples: a sine of 18 Hz at 200 samples/s."""
    t = STEP * np.arange(2400)
    damage = {}
    for reversals, factor in (("samples", 2), ("vertex", 1)):
        case = small_case()
        case.histories["sine"]["q_1"] = 30.0 * np.sin(2 * np.pi * 18.0123 * t)
        case.counting = {"reversals": reversals}
        assess(case.write(tmp_path / reversals), tmp_path / f"{reversals}-result", report=False)
        assert upsampling_factors(read_provenance(tmp_path / f"{reversals}-result"))[0] == factor
        table = tables(tmp_path / f"{reversals}-result")["damage"]
        damage[reversals] = table[table["event"] == "sine"]["damage_per_pass"].max()
    assert damage["vertex"] == pytest.approx(damage["samples"], rel=0.01)


def test_the_warning_knows_of_vertices(tmp_path):
    """4.5 samples per peak: the loss is that of vertices."""
    t = STEP * np.arange(2400)
    case = at_vertices(small_case())
    case.histories["sine"]["q_1"] = 30.0 * np.sin(2 * np.pi * 44.4 * t)
    done = assess(case.write(tmp_path / "case"), tmp_path / "result", report=False)
    (told,) = [w for w in done.warnings if w.code == "sampling" and "sine" in w.where]
    assert "damage there is about 12 % low" in told.what
