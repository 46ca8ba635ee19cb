"""Ranges in classes: their sums are those of the other tables, and every cycle is in the class it belongs to."""

import json
from functools import partial

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import CaseError
from fatigue.life.counting import count as counting
from fatigue.life.counting.block import HISTOGRAM_BINS, HISTOGRAM_EDGES, BlockStress
from fatigue.life.counting.count import count_histograms
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.record import CountedRecord
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.rule import CycleRule
from fatigue.pipeline.tables import histogram
from fatigue.results import read_provenance, read_table, strangers
from tests import naive
from tests.small_case import sine_only, small_case
from tests.test_sequences import LOOP, empty_and_laden

POINT = ["weld", "part", "order", "surface"]
STRAIGHT = damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7)
HAIBACH = damage_law(catalogue()["master-aluminium"], "mean-2sigma", "haibach", 1e7)
run = partial(assess, report=False)


def assessed(folder, case=None, **options):
    """Assess the small case, or another one; return the result folder."""
    run(load_case((case or small_case()).write(folder / "case")), folder / "result", threads=1, **options)
    return folder / "result"


def sums_of(folder):
    """Sums over the classes of every point and event, kinds side by side, beside the row of the damage table."""
    rows = read_table(folder, "damage").to_pandas().set_index([*POINT, "event"])
    bins = read_table(folder, "histogram").to_pandas()
    for kind, of_kind in bins.groupby("kind"):
        of_points = of_kind.groupby([*POINT, "event"])
        summed = of_points[["count_per_pass", "power_sum_per_pass"]].sum().assign(largest=of_points["bin"].max())
        rows = rows.join(summed.add_suffix(f"_{kind}"), how="inner")
    return rows


def paired(s, residue, by_hand):
    """The cycles counted by hand; where reversals tie, so that others pair as well, those the program says it pairs."""
    reversals = {i for pair in by_hand for i in pair[:2]}
    if len({s[i] for i in reversals}) == len(reversals):
        return by_hand
    cycles = rainflow(s, residue)
    return list(zip(cycles.start, cycles.end, cycles.count, strict=True))


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(st.integers(-40, 40), st.integers(-40, 40)), min_size=2, max_size=25),
    st.sampled_from(["repeat", "half"]),
    st.sampled_from([STRAIGHT, HAIBACH]),
    st.booleans(),
    st.sampled_from([1, 250_000]),
)
def test_every_cycle_is_in_its_class(samples, residue, law, mean_stress, longest):
    """Against a naive count of records with plateaus and ties, in whole rows and chunk by chunk."""
    m, b = np.array(samples, dtype=float).T + np.array([[0.0], [0.25]])
    rule = CycleRule(law, True, 30.0, mean_stress)
    size = 1.3
    record = CountedRecord(np.stack([m, b]), residue)
    block = BlockStress(np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]]), np.array([size]), np.zeros((1, 2)))
    before, counting.LONGEST_ROW = counting.LONGEST_ROW, longest
    try:
        found = count_histograms(block, record, rule)
    finally:
        counting.LONGEST_ROW = before
    assert found.shape == (1, 2, 2, HISTOGRAM_BINS, 2)
    for face, side in enumerate((1.0, -1.0)):
        s = m + side * b
        expected = np.zeros((2, HISTOGRAM_BINS, 2))
        k = law.slopes[0]
        by_hand = naive.cycles(s, residue)
        for kind, pairs in enumerate((by_hand, paired(s, residue, by_hand))):
            for i, j, n in pairs:
                low, high = min(s[i], s[j]), max(s[i], s[j])
                dm, db = abs(m[i] - m[j]), abs(b[i] - b[j])
                f_M = 1.0
                if mean_stress and low + high >= 30.0 and low > 0.0 and high - low <= 60.0:
                    f_M = (1.0 - low / high) ** (1.0 / 3.6)
                dS = (high - low) * size / naive.ratio_factor(db / (dm + db)) / f_M
                x = (high - low, dS)[kind]
                bin_ = int(np.searchsorted(HISTOGRAM_EDGES, x, side="right")) - 1
                expected[kind, bin_] += n, n * x**k
        np.testing.assert_allclose(found[0, face, 0], expected[0], rtol=1e-12)
        if longest > 1:  # ties of the largest stress may be paired otherwise chunk by chunk
            np.testing.assert_allclose(found[0, face, 1], expected[1], rtol=1e-12)
        np.testing.assert_allclose(found[0, face].sum(axis=1)[:, 0], expected.sum(axis=1)[:, 0], rtol=1e-12)


def test_the_first_class_begins_at_0_and_the_last_has_no_end():
    """Ranges beyond the grid are in the end classes, with their own powers."""
    x = np.array([1e-5, 1e6])
    block = BlockStress(x[:, None], np.zeros((2, 1)), np.ones(2), np.zeros((2, 2)))
    rule = CycleRule(STRAIGHT, False)
    found = count_histograms(block, CountedRecord(np.array([[0.0, 1.0]]), "repeat"), rule)
    for row, bin_ in ((0, 0), (1, HISTOGRAM_BINS - 1)):
        assert np.flatnonzero(found[row, 0, 0, :, 0]).tolist() == [bin_]
        assert found[row, 0, 0, bin_] == pytest.approx([1.0, x[row] ** STRAIGHT.slopes[0]], rel=1e-12)


@pytest.mark.parametrize("curve", [{}, {"extension": "haibach"}, {"extension": "cutoff", "knee_cycles": 1e6}])
def test_classes_add_up_to_the_damage_table(tmp_path, curve):
    """Counts of both kinds to cycles_per_pass; the power sum of dS to the damage on a straight curve."""
    case = small_case()
    case.curve |= curve
    case.counting["upsample"] = 1
    folder = assessed(tmp_path, case, histogram="all")
    rows = sums_of(folder)
    assert len(rows) == 14 * 2 * 3
    for kind in ("S", "dS"):
        np.testing.assert_allclose(rows[f"count_per_pass_{kind}"], rows.cycles_per_pass, rtol=1e-12)
    if not curve:
        damage = rows.power_sum_per_pass_dS / np.exp(STRAIGHT.log_constants[0])
        np.testing.assert_allclose(damage, rows.damage_per_pass, rtol=1e-12)
    bins = read_table(folder, "histogram").to_pandas()
    for kind, column in (("S", "max_range_MPa"), ("dS", "max_equivalent_range_dS")):
        assert (HISTOGRAM_EDGES[rows[f"largest_{kind}"]] <= rows[column]).all()
        assert (rows[column] < HISTOGRAM_EDGES[rows[f"largest_{kind}"] + 1]).all()
    x = (bins.power_sum_per_pass / bins.count_per_pass) ** (1.0 / STRAIGHT.slopes[0])
    assert (x >= HISTOGRAM_EDGES[bins.bin] * (1 - 1e-12)).all()
    assert (x <= HISTOGRAM_EDGES[bins.bin + 1] * (1 + 1e-12)).all()


def test_the_power_sum_of_ranges_is_that_of_the_equivalent_range(tmp_path):
    """Weighted with the mission, sum n S^k gives equivalent_range_2e6_MPa back; two curves keep their own slopes."""
    case = small_case()
    case.counting["upsample"] = 1
    case.welds["curve"] = ["mine", ""]
    case.extra = '[curves.mine]\nslopes = [5.0]\nrange_at_2e6_MPa = 40.0\napplies = "structural"\nsource = "x"'
    folder = assessed(tmp_path, case)
    per_km = {one["event"]: one["passes_per_km"] for one in read_provenance(folder)["mission"]["events"]}
    bins = read_table(folder, "histogram").to_pandas().query("kind == 'S'")
    total = (bins.power_sum_per_pass * bins.event.map(per_km)).groupby([bins[name] for name in POINT]).sum()
    nodes = read_table(folder, "nodes").to_pandas().set_index(POINT).loc[total.index]
    k = np.where(total.index.get_level_values("weld") == "A", 5.0, STRAIGHT.slopes[0])
    assert len(set(k)) == 2
    np.testing.assert_allclose((total * 1e6 / 2e6) ** (1 / k), nodes.equivalent_range_2e6_MPa, rtol=1e-12)


def test_a_sine_is_one_class(tmp_path):
    """60 cycles at every toe point, of 90 MPa at the top and 30 MPa at the bottom, and nothing else."""
    bins = read_table(assessed(tmp_path, sine_only()), "histogram").to_pandas().query("kind == 'S'")
    assert bins.groupby([*POINT]).count_per_pass.sum().to_numpy() == pytest.approx(60.0)
    for surface, S in (("top", 90.0), ("bottom", 30.0)):
        of_face = bins[bins.surface == surface]
        assert len(of_face)
        assert set(of_face.bin) == {int(64 * (np.log10(S) + 3))}


def test_which_points(tmp_path):
    """By default the worst toes and those from a tenth of the limit on; none leaves no table, and all readers go on."""
    default = assessed(tmp_path / "default")
    bins = read_table(default, "histogram").to_pandas()
    nodes = read_table(default, "nodes").to_pandas()
    worst = read_table(default, "welds").to_pandas()
    found = set(bins[POINT].itertuples(index=False, name=None))
    above = nodes[nodes.toe & (nodes.utilisation >= 0.1)]
    expected = set(above[POINT].itertuples(index=False, name=None))
    expected |= set(worst[["weld", "worst_part", "worst_order", "worst_surface"]].itertuples(index=False, name=None))
    assert found == expected
    none = assessed(tmp_path / "none", histogram="none")
    assert not (none / "histogram.parquet").exists()
    assert not strangers(none, read_provenance(none))
    assert read_provenance(none)["result"] != read_provenance(default)["result"]
    rules = [read_provenance(folder)["rules"]["histogram"] for folder in (default, none)]
    assert rules[1] == "none"
    assert "double precision" in rules[0]


def test_a_table_that_is_not_wanted_any_more_goes(tmp_path):
    """Assessed again without it, the old one does not stay."""
    assessed(tmp_path)
    folder = assessed(tmp_path, histogram="none")
    assert not (folder / "histogram.parquet").exists()
    assert not strangers(folder, read_provenance(folder))


def test_a_table_of_another_result_is_named(tmp_path):
    """As every table of a result."""
    all_of, default = assessed(tmp_path / "a", histogram="all"), assessed(tmp_path / "b")
    (default / "histogram.parquet").write_bytes((all_of / "histogram.parquet").read_bytes())
    (problem,) = strangers(default, read_provenance(default))
    assert problem.code == "other_result"
    (default / "histogram.parquet").unlink()  # large, and needed for decisions only
    assert not strangers(default, read_provenance(default))


@pytest.mark.parametrize("points_at_once", [1, 5])
@pytest.mark.parametrize("samples", [1, 4_000])
def test_any_number_of_points_at_a_time_is_the_same(tmp_path, monkeypatch, points_at_once, samples):
    """In rows, order and values, but for the last digits of matrix products."""
    expected = read_table(assessed(tmp_path / "whole"), "histogram").to_pandas()
    monkeypatch.setattr(histogram, "POINTS_AT_ONCE", points_at_once)
    monkeypatch.setattr(histogram, "_SAMPLES", samples)
    found = read_table(assessed(tmp_path / "pieces"), "histogram").to_pandas()
    pd.testing.assert_frame_equal(found, expected, rtol=1e-12)


def test_screened_points_have_none_and_single_precision_is_counted_in_double(tmp_path, monkeypatch):
    """Only counted points; sums agree with the damage counted in single precision to 1e-6."""
    monkeypatch.setattr("fatigue.pipeline.mission.precision.SINGLE_FROM", 0.0)
    case = small_case(pairs=2)
    case.mission["target_km"] = 1.0
    folder = assessed(tmp_path, case, share=0.5, proves_worst=False, histogram="all")
    assert read_provenance(folder)["rules"]["precision"].startswith("single")
    nodes = read_table(folder, "nodes").to_pandas()
    counted = nodes[nodes.screened == ""]
    assert 0 < len(counted) < len(nodes)
    rows = sums_of(folder)
    assert len(rows) == 3 * len(counted)
    damage = rows.power_sum_per_pass_dS / np.exp(STRAIGHT.log_constants[0])
    np.testing.assert_allclose(damage, rows.damage_per_pass, rtol=2e-6)
    np.testing.assert_allclose(rows.count_per_pass_S, rows.cycles_per_pass, rtol=1e-12)


@pytest.mark.parametrize("mean_of_q", ["keep", "remove"])
def test_mean_stress_is_in_the_equivalent_ranges(tmp_path, mean_of_q):
    """With mean_stress asme dS is the one of the damage, constants beside the samples included."""
    case = small_case()
    case.histories["noise"]["q_1"] += 150.0
    case.histories["load"]["q_1"] += np.array([0.0, 150.0])
    case.curve |= {"mean_stress": "asme", "yield_MPa": 60.0}
    case.counting |= {"upsample": 1, "mean_of_q": mean_of_q}
    case.events[2]["mean_of_q"] = "keep"
    rows = sums_of(assessed(tmp_path, case))
    damage = rows.power_sum_per_pass_dS / np.exp(STRAIGHT.log_constants[0])
    np.testing.assert_allclose(damage, rows.damage_per_pass, rtol=1e-12)
    of_noise = rows.xs("noise", level="event")
    tenser = of_noise.power_sum_per_pass_dS / of_noise.power_sum_per_pass_S
    assert (tenser.max() > 5.0) == (
        mean_of_q == "keep"
    )  # the factor of the thickness over I(r) is 1.3, to the power 3.6


def test_cycles_across_events_are_in_classes_too(tmp_path, monkeypatch):
    """The classes of a loop add up to its row in the damage table: net cycles, net damage, some classes below 0."""
    case = empty_and_laden(mean_stress="asme", yield_MPa=150.0)
    case.extra = LOOP
    monkeypatch.setattr(histogram, "_POINTS_OF_LOOPS", 3)
    folder = assessed(tmp_path, case)
    rows = sums_of(folder)
    assert sorted(set(rows.index.get_level_values("event"))) == ["(sequence 1)", "laden", "load", "sine", "unload"]
    np.testing.assert_allclose(rows.count_per_pass_dS, rows.cycles_per_pass, rtol=1e-9, atol=1e-9)
    damage = rows.power_sum_per_pass_dS / np.exp(STRAIGHT.log_constants[0])
    np.testing.assert_allclose(damage, rows.damage_per_pass, rtol=1e-9)
    bins = read_table(folder, "histogram").to_pandas()
    assert (bins.count_per_pass[bins.event == "(sequence 1)"] < 0.0).any()
    assert (bins.count_per_pass[bins.event != "(sequence 1)"] > 0.0).all()
    assert (rows.count_per_pass_S > 0.0).sum() > 4 * 2


def test_other_points_are_refused(tmp_path):
    """In the words of the argument."""
    with pytest.raises(
        CaseError, match=r"histogram: 'some' are no points to keep\. Give one of 'worst', 'all', 'none'"
    ):
        assessed(tmp_path, histogram="some")


def test_the_table_says_what_it_is(small_result):
    """Rows are in the order of points, events, kinds and classes; the record of the run says which points."""
    bins = read_table(small_result, "histogram").to_pandas()
    order = {name: i for i, name in enumerate(["sine", "noise", "load and unload"])}
    keys = list(
        zip(
            bins.weld,
            bins.part,
            bins.order,
            bins.surface != "top",
            bins.event.map(order),
            bins.kind != "S",
            bins.bin,
            strict=True,
        )
    )
    assert keys == sorted(keys)
    assert (bins.count_per_pass > 0.0).all()
    record = json.loads((small_result / "provenance.json").read_text())
    assert "histogram.parquet" in [entry["file"] for entry in record["outputs"]]
