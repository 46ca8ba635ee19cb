"""Screening in the pipeline: what is counted is exact, what is not is bounded, and no weld loses its worst point."""

import json

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.synth import Size, synthesize
from fatigue.verify.recount import recount

SHARE = 0.1
KEY = ["weld", "part", "order", "surface"]
UNKNOWN = ["life_km_same_ratio", "dirlik_ratio", "equivalent_range_2e6_MPa", "R_largest_cycle", "governing_event"]


@pytest.fixture(scope="module", params=["straight", "knee", "mean stress"])
def results(request, tmp_path_factory):
    """A synthetic body with every point counted, and screened; a straight curve, one with a knee, one with f_M."""
    folder = tmp_path_factory.mktemp("screening")
    path = synthesize(folder / "case", Size(nodes=240, modes=12, events=3, seconds=8.0, rate=250.0), seed=3)
    text = path.read_text()
    if request.param == "knee":
        text = text.replace('name = "master-aluminium"', 'name = "master-aluminium"\nextension = "haibach"')
    if request.param == "mean stress":
        text = text.replace(
            'name = "master-aluminium"', 'name = "master-aluminium"\nmean_stress = "asme"\nyield_MPa = 60.0'
        )
    text = text.replace("target_km = 1.2e7", f"target_km = {target_with_spread(path, folder)}")
    path.write_text(text)
    for name, share in (("exact", 0.0), ("screened", SHARE)):
        assess(load_case(path), folder / name, share=share, report=False)
    return folder


def target_with_spread(path, folder):
    """Target at which the median point uses up a tenth of the limit, so that some points matter and some do not."""
    assess(load_case(path), folder / "trial", report=False)
    return float(SHARE * pd.read_parquet(folder / "trial" / "nodes.parquet").life_km.median() / 30.0)


def nodes_of(folder):
    """Points of both results, in the same order."""
    exact, screened = (pd.read_parquet(folder / name / "nodes.parquet") for name in ("exact", "screened"))
    assert exact[KEY].equals(screened[KEY])
    return exact, screened, (screened.screened != "").to_numpy()


def test_points_are_settled_in_every_way(results):
    """The case is one in which screening has something to do: both tiers, and points that must be counted."""
    _, screened, _ = nodes_of(results)
    assert set(screened.screened) >= {"", "weld bound"}


def test_what_is_counted_is_what_it_is_without_screening(results):
    """Every column of a counted point, to rounding; the life without end treatment may be left out."""
    exact, screened, settled = nodes_of(results)
    left_out = screened.life_km_raw_end.isna()
    exact = exact.assign(life_km_raw_end=exact.life_km_raw_end.mask(left_out))
    same_type = False  # flags beside empty ones are objects
    pd.testing.assert_frame_equal(screened[~settled], exact[~settled], rtol=1e-9, check_dtype=same_type)


def test_ends_without_treatment_are_left_out_where_they_do_not_matter(results):
    """Only at treated ends, and only where they stay below the share without treatment, too; elsewhere it is given."""
    exact, screened, settled = nodes_of(results)
    left_out = (screened.life_km_raw_end.isna() & ~settled).to_numpy()
    target_km = json.loads((results / "screened" / "provenance.json").read_text())["mission"]["target_km"]
    assert left_out.any()
    assert (exact.life_km_raw_end[left_out] > target_km / SHARE).all()
    assert (exact.life_km_raw_end[left_out] != exact.life_km[left_out]).all()
    changed = (exact.life_km_raw_end != exact.life_km).to_numpy() & ~settled
    assert (changed & ~left_out).any()


def test_what_is_not_counted_is_bounded(results):
    """Damage and ranges are never below, lives never above; the limit's share is kept."""
    exact, screened, settled = nodes_of(results)
    a, b = exact[settled], screened[settled]
    assert (b.damage_per_km >= a.damage_per_km).all()
    assert (b.max_range_MPa >= a.max_range_MPa).all()
    assert (b.life_km <= a.life_km).all()
    assert (b.utilisation < SHARE).all()
    assert b.fulfilled.all()
    assert not (b.load_factor > a.load_factor).any()  # or not said, on a curve with a knee
    of_events = [pd.read_parquet(results / name / "damage.parquet").set_index(KEY) for name in ("exact", "screened")]
    one, other = (table.loc[pd.MultiIndex.from_frame(b[KEY])] for table in of_events)
    for column in ("damage_per_pass", "damage_per_km", "max_range_MPa", "max_equivalent_range_dS"):
        assert (other[column] >= one[column]).all(), column


def test_a_point_that_some_counted_events_settle_has_bounds_of_the_others(results):
    """Its damage in the former is what was counted and a millionth, and it is more than that in some of the latter."""
    _, screened, settled = nodes_of(results)
    one, other = (pd.read_parquet(results / name / "damage.parquet").set_index(KEY) for name in ("exact", "screened"))
    of_settled = pd.MultiIndex.from_frame(screened[settled & (screened.screened == "weld bound")][KEY])
    above = (other.damage_per_pass / one.damage_per_pass)[one.damage_per_pass > 0.0].loc[of_settled] - 1.0
    counted = above < 2e-6
    assert (above[counted] > 0.5e-6).all()
    assert (counted.groupby(level=KEY).any() & ~counted.groupby(level=KEY).all()).any()


def test_what_needs_cycles_is_empty_and_what_needs_none_is_there(results):
    """Cycle fields of a settled point are null; Dirlik, Tovo-Benasciutti and geometry are those of the exact run."""
    exact, screened, settled = nodes_of(results)
    assert screened.loc[settled, UNKNOWN].isna().all(axis=None)
    assert (screened.loc[settled, "dirlik_verdict"] == "not_assessed").all()
    same = ["life_km_dirlik", "life_km_tb", "thickness_mm", "arc_length_mm", "toe"]
    pd.testing.assert_frame_equal(screened.loc[settled, same], exact.loc[settled, same], rtol=1e-12)


def test_the_worst_point_of_every_weld_is_counted(results):
    """The register is that of the run that counted everything."""
    exact, screened = (pd.read_parquet(results / name / "welds.parquet") for name in ("exact", "screened"))
    pd.testing.assert_frame_equal(screened, exact, rtol=1e-9)


def test_a_likely_worst_point_is_counted_and_said_to_be_no_more(results, tmp_path):
    """In welds below the share everywhere one point is counted, its life exact; the others stay below the share."""
    assess(load_case(results / "case" / "case.toml"), tmp_path, share=SHARE, proves_worst=False, report=False)
    exact, proven, likely = (
        pd.read_parquet(f / "welds.parquet") for f in (results / "exact", results / "screened", tmp_path)
    )
    assert exact.worst_is_proven.all()
    assert proven.worst_is_proven.all()
    assert not likely.worst_is_proven.all()
    sure = likely.worst_is_proven
    pd.testing.assert_frame_equal(likely[sure], exact[sure], rtol=1e-9)
    assert (exact.utilisation[~sure] < SHARE).all()
    nodes, screened, found = (
        pd.read_parquet(f / "nodes.parquet").set_index(KEY) for f in (results / "exact", results / "screened", tmp_path)
    )
    counted = found[found.screened == ""]
    assert counted.damage_per_km.to_numpy() == pytest.approx(nodes.damage_per_km[counted.index].to_numpy(), rel=1e-9)
    assert (found.screened == "weld bound").sum() < (screened.screened == "weld bound").sum()


def test_cycles_of_every_weld_are_kept(results):
    """A job as small as this one keeps them all, each as without screening."""
    exact, screened = (pd.read_parquet(results / name / "cycles.parquet") for name in ("exact", "screened"))
    pd.testing.assert_frame_equal(screened, exact, rtol=1e-9)


def test_large_jobs_are_screened_unasked_and_keep_the_cycles_that_matter(results, tmp_path, monkeypatch):
    """Above the limit: the same register to single precision, cycles of welds from a tenth of the limit on."""
    monkeypatch.setattr("fatigue.pipeline.mission.precision.SINGLE_FROM", 0.0)
    monkeypatch.setattr("fatigue.pipeline.mission.precision.LARGE_FROM", 0.0)
    case = load_case(results / "case" / "case.toml")
    assess(case, tmp_path / "screened", report=False)
    assess(case, tmp_path / "exact", share=0.0, report=False)
    welds = pd.read_parquet(results / "exact" / "welds.parquet")
    matters = set(welds.weld[welds.utilisation >= SHARE])
    for name, screened in (("screened", True), ("exact", False)):
        found = pd.read_parquet(tmp_path / name / "welds.parquet")
        pd.testing.assert_frame_equal(found, welds, rtol=1e-5)
        assert set(pd.read_parquet(tmp_path / name / "cycles.parquet").weld) == matters
        assert (pd.read_parquet(tmp_path / name / "nodes.parquet").screened != "").any() == screened


def test_welds_may_be_bounded_in_parts(results, tmp_path, monkeypatch):
    """One weld at a time: other histories, bounds as safe, and nothing that is counted changes."""
    monkeypatch.setattr("fatigue.pipeline.count.weld_bound.WELD_BOUNDS_AT_ONCE", 1)
    assess(load_case(results / "case" / "case.toml"), tmp_path, share=SHARE, report=False)
    exact, together, parted = (
        pd.read_parquet(f / "nodes.parquet") for f in (results / "exact", results / "screened", tmp_path)
    )
    settled = (parted.screened != "").to_numpy()
    assert (parted.damage_per_km >= exact.damage_per_km * (1.0 - 1e-9)).all()
    pd.testing.assert_series_equal(parted.life_km[~settled], exact.life_km[~settled], rtol=1e-9)
    by_weld = (together.screened == "weld bound").to_numpy() & (parted.screened == "weld bound").to_numpy()
    assert by_weld.any()
    assert parted.damage_per_km[by_weld].to_numpy() == pytest.approx(
        together.damage_per_km[by_weld].to_numpy(), rel=0.1
    )


def test_the_record_says_what_was_settled_how(results):
    """Share, rule and numbers of stations are in the provenance."""
    _, screened, _ = nodes_of(results)
    rule = json.loads((results / "screened" / "provenance.json").read_text())["rules"]["screening"]
    assert rule["share_of_limit"] == SHARE
    top = screened[screened.surface == "top"].screened.value_counts()
    assert rule["stations"] == {"counted": top[""], **{k: int(top.get(k, 0)) for k in ("modal bound", "weld bound")}}


@pytest.mark.slow
def test_an_independent_recount_finds_the_bounds_safe(results):
    """`fatigue verify --results` accepts the screened result, all points; paths, which take long, of some."""
    found = recount(results / "screened", sample=len(pd.read_parquet(results / "screened" / "nodes.parquet")))
    assert found.passed, found.as_text()
    assert np.isfinite(found.points)
