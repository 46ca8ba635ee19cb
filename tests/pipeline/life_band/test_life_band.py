"""Bands from the case to the table: by hand from the cycles and lives beside it, and every reason for having none."""

from functools import partial

import numpy as np
import pandas as pd
import pytest
from scipy.special import log_ndtr, ndtr, ndtri

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import CaseError
from fatigue.life.band.load import PIECES, LoadScatter, mission_scatter, record_error
from fatigue.life.band.quantiles import STRENGTHS, SURVIVALS
from fatigue.life.counting import count as counting
from fatigue.life.curves import catalogue
from fatigue.pipeline.life_band import rows as band_rows
from fatigue.pipeline.life_band import scatter as band_scatter
from fatigue.pipeline.tables import histogram
from fatigue.results import read_provenance
from tests.small_case import STEP, small_case
from tests.test_sequences import LOOP, empty_and_laden

POINT = ["weld", "part", "order", "surface"]
SIGMA = 0.3223058221131365 * np.log(10.0)
TO_MEAN = 4.41175761744262
run = partial(assess, report=False, threads=1)


def noise_case(seconds=120.0, scale=(1.0, 2.0), band=""):
    """Two events of noise, long enough to know how their damage scatters."""
    case = small_case(seconds)
    noise = case.histories["noise"]
    loud = noise.assign(**{name: scale[1] * noise[name].to_numpy()[::-1] for name in ("q_1", "q_2", "q_7")})
    case.histories = {"noise": noise, "loud": loud}
    case.events = [
        {"name": "noise", "history": "noise", "speed_km_h": 180.0, "share": 0.6},
        {"name": "loud", "history": "loud", "speed_km_h": 360.0, "share": 0.4},
    ]
    case.extra = band
    return case


def assessed(folder, case, **options):
    """Tables of a case."""
    run(load_case(case.write(folder / "case")), folder / "result", **options)
    tables = ("nodes", "damage", "cycles", "histogram", "band")
    return {t: pd.read_parquet(folder / "result" / f"{t}.parquet") for t in tables}


LINES = "[life_band]\nreference_length_mm = 25.0\ndependence = 0.0\nminer_median = 0.8\nminer_sigma_ln = 0.3\n"


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """Bands of the two events at every point."""
    return assessed(tmp_path_factory.mktemp("plain"), noise_case(), histogram="all")


@pytest.fixture(scope="module")
def lined(tmp_path_factory):
    """The same with the survival of lines and another Miner sum."""
    return assessed(tmp_path_factory.mktemp("lined"), noise_case(band=LINES), histogram="all")


def weights():
    """Passes per km."""
    return {"noise": 0.6 / (120.0 * 0.05), "loud": 0.4 / (120.0 * 0.1)}


def test_every_point_with_a_histogram_has_a_row_with_its_life(plain):
    """In the same order, with the life of the table of nodes."""
    band, bins = plain["band"], plain["histogram"].drop_duplicates(POINT)
    assert band[POINT].astype(str).to_numpy().tolist() == bins[POINT].astype(str).to_numpy().tolist()
    lives = plain["nodes"].set_index(POINT)["life_km"].loc[list(band[POINT].itertuples(index=False, name=None))]
    assert band["life_km"].to_numpy() == pytest.approx(lives.to_numpy(), rel=0)
    assert band["band_reason"].isna().all()


def test_the_error_is_that_of_the_cycles_laid_on_their_instants(plain):
    """Half of every row of cycles.parquet in the piece of either instant, event by event, then together."""
    of_point = plain["cycles"].groupby(POINT, observed=True)
    band = plain["band"].set_index(POINT)
    assert len(of_point) == 2
    for key, rows in of_point:
        share, se = [], []
        for event, weight in weights().items():
            of_event = rows[rows["event"] == event]
            pieces = np.zeros(PIECES)
            for name in ("start_s", "end_s"):
                sample = np.rint(of_event[name] / STEP).astype(int)
                np.add.at(pieces, PIECES * sample // 24_000, 0.5 * of_event["damage"])
            share.append(weight * pieces.sum())
            se.append(record_error(pieces))
        found = mission_scatter(np.array(share)[:, None] / sum(share), np.array(se)[:, None])
        row = band.loc[key]
        assert row["se_load"] == pytest.approx(found.se[0], rel=1e-9)
        assert row["dof"] == pytest.approx(found.dof[0], rel=1e-9)
        half = LoadScatter(found.se, found.dof).log_half_width[0]
        assert row["life_km_load_low"] == pytest.approx(row["life_km"] * np.exp(-half), rel=1e-9)
        assert row["life_km_load_high"] == pytest.approx(row["life_km"] * np.exp(half), rel=1e-9)


def test_pieces_add_up_to_the_damage_of_a_pass(tmp_path, monkeypatch):
    """Of every point and event, as the table of damage has it."""
    seen = []
    real = band_rows.lives_of_points
    monkeypatch.setattr(band_rows, "lives_of_points", lambda *a: (seen.append(a[:2]), real(*a))[1])
    tables = assessed(tmp_path, noise_case(), histogram="all")
    points, pieces = [p for some, _ in seen for p in some], np.concatenate([of for _, of in seen])
    damage = tables["damage"].set_index([*POINT, "event"])["damage_per_pass"]
    for point, of_events in zip(points, pieces.sum(axis=2), strict=True):
        key = point.weld, point.part, point.order, ("top", "bottom")[point.face]
        assert of_events == pytest.approx([damage[(*key, event)] for event in weights()], rel=1e-12)


def sigma_load(band):
    """Standard deviation of ln life by the load."""
    return LoadScatter(band["se_load"].to_numpy(), band["dof"].to_numpy()).sigma_ln


def test_lives_at_survivals_are_those_about_the_mean_curve(plain, lined):
    """The logarithm of the life is normal: load and S-N curve, then with a Miner sum that scatters as well."""
    for band, factor, miner in ((plain["band"], 1.0, 0.0), (lined["band"], 0.8, 0.3)):
        sigma = np.sqrt(sigma_load(band) ** 2 + SIGMA**2 + miner**2)
        for name, survival in SURVIVALS.items():
            expected = factor * TO_MEAN * band["life_km"] * np.exp(-ndtri(survival) * sigma)
            assert band[f"life_km_{name}"].to_numpy() == pytest.approx(expected.to_numpy(), rel=1e-9)
    assert plain["band"]["line_reason"].eq("not_asked").all()
    assert plain["band"]["line_survival_at_target"].isna().all()


def test_independent_lengths_survive_as_a_product(lined):
    """Dependence 0: every length by itself, load and Miner sum in front of all; each face is a line of its own."""
    nodes, band = lined["nodes"], lined["band"]
    arc = np.array([5.0, *[10.0] * 5, 5.0]) / 25.0
    toes = set()
    for (weld, surface), rows in band.groupby(["weld", "surface"], observed=True):
        line = nodes[(nodes["weld"] == weld) & (nodes["surface"] == surface)]
        if not line["toe"].all():
            assert rows["line_reason"].eq("no_toe").all()
            continue
        toes.add((weld, surface))
        worst = rows.loc[rows["life_km"].idxmin()]
        other = np.hypot(sigma_load(rows.loc[[rows["life_km"].idxmin()]])[0], 0.3)
        z = np.linspace(-8.0, 8.0, 4001)
        log_median = np.log(0.8 * TO_MEAN * line["life_km"].to_numpy())
        strength = (np.log(1e6) - other * z[:, None] - log_median) / SIGMA
        expected = np.trapezoid(np.exp(-0.5 * z**2) / np.sqrt(2 * np.pi) * np.exp(log_ndtr(-strength) @ arc), z)
        assert worst["line_survival_at_target"] == pytest.approx(expected, abs=1e-6)
        assert (rows["line_survival_at_target"] == worst["line_survival_at_target"]).all()
        assert 0.0 < worst["line_life_km_p50"] < worst["life_km_p50"]
    assert toes == {("A", "top"), ("A", "bottom"), ("B", "top")}


def test_a_line_that_stands_or_falls_as_one_is_its_worst_point(tmp_path):
    """Dependence 1: survival and median of the worst point, whatever its length."""
    case = noise_case(band="[life_band]\nreference_length_mm = 25.0\ndependence = 1.0\n")
    band = assessed(tmp_path, case, histogram="all")["band"]
    band = band[band["line_reason"].isna()]
    worst = band.loc[band.groupby(["weld", "surface"], observed=True)["life_km"].idxmin()]
    sigma = np.sqrt(sigma_load(worst) ** 2 + SIGMA**2)
    survival = ndtr(np.log(worst["life_km_p50"] / 1e6) / sigma)
    assert worst["line_survival_at_target"].to_numpy() == pytest.approx(survival.to_numpy(), rel=1e-9)
    assert worst["line_life_km_p50"].to_numpy() == pytest.approx(worst["life_km_p50"].to_numpy(), rel=1e-8)


def captured(folder, case, monkeypatch):
    """Lives of the points of a case as they were computed."""
    seen = []
    real = band_rows.lives_of_points
    with monkeypatch.context() as patch:
        patch.setattr(band_rows, "lives_of_points", lambda *a: (seen.append(real(*a)), seen[-1])[1])
        tables = assessed(folder, case, histogram="all")
    return [found for some in seen for found in some], tables


def test_with_a_knee_every_strength_is_a_rerun_on_its_curve(tmp_path, monkeypatch):
    """The life at mean and mean-3sigma by the histogram is that of whole assessments, to a part in a thousand."""
    case = noise_case()
    case.curve |= {"extension": "haibach", "knee_cycles": 1e7}
    found, _ = captured(tmp_path / "as_is", case, monkeypatch)
    for level, z in (("mean", 0.0), ("mean-1sigma", -1.0), ("mean-3sigma", -3.0)):
        case.curve["survival"] = level
        lives = assessed(tmp_path / level, case)["nodes"].set_index(POINT)["life_km"]
        at = int(np.argmin(np.abs(STRENGTHS - z)))
        for one in found:
            key = one.point.weld, one.point.part, one.point.order, ("top", "bottom")[one.point.face]
            assert np.exp(one.log_life[at]) == pytest.approx(lives[key], rel=2e-3)
    for one in found:
        lives = list(one.lives_km.values())
        assert lives == sorted(lives, reverse=True)
        assert one.lives_km["p97_7"] < one.point.life_km  # the load scatters, too


def test_lines_with_a_knee_need_a_histogram_everywhere(tmp_path):
    """They have a survival with all histograms, and a reason for having none with the worst ones only."""
    case = noise_case(band="[life_band]\nreference_length_mm = 25.0\ndependence = 0.5\n")
    case.curve |= {"extension": "haibach", "knee_cycles": 1e7}
    every = assessed(tmp_path / "all", case, histogram="all")["band"]
    of_toes = every[every["line_reason"].isna()]
    assert len(of_toes.groupby(["weld", "surface"], observed=True)) == 3
    assert of_toes["line_survival_at_target"].between(0.0, 1.0).all()
    case.mission["target_km"] = 1.0
    few = assessed(tmp_path / "worst", case)["band"]
    assert len(few) == 2
    assert few["line_reason"].eq("histograms").all()
    assert few["line_survival_at_target"].isna().all()


def test_a_curve_without_scatter_has_the_band_of_load_only(tmp_path):
    """No median, no survival of a line."""
    case = noise_case(band=LINES)
    case.curve = {"name": "iiw-aluminium-36"}
    band = assessed(tmp_path, case, histogram="all")["band"]
    assert (band["life_km_load_low"] < band["life_km"]).all()
    assert (band["life_km"] < band["life_km_load_high"]).all()
    assert band[[f"life_km_{name}" for name in SURVIVALS]].isna().all(axis=None)
    assert band["sigma_ln_N"].isna().all()
    assert set(band["line_reason"]) == {"no_scatter", "no_toe"}


def test_steel_and_aluminium_have_the_scatter_of_their_own_curves(tmp_path):
    """The curve of each weld, not that of the case."""
    case = noise_case()
    case.welds["curve"] = ["master-steel", None]
    band = assessed(tmp_path, case)["band"].set_index("weld")
    steel = catalogue()["master-steel"]
    ratio = (steel.reference_range["mean"] / steel.reference_range["mean-2sigma"]) ** steel.slopes[0]
    for weld, median, sigma in (("A", ratio, 0.2460982085803678 * np.log(10.0)), ("B", TO_MEAN, SIGMA)):
        rows = band.loc[[weld]]
        assert rows["sigma_ln_N"].to_numpy() == pytest.approx(sigma, rel=1e-9)
        assert (rows["life_km_p50"] / rows["life_km"]).to_numpy() == pytest.approx(median, rel=1e-9)


def reasons(tables):
    """Reasons of the bands of a case; where there is one there is nothing else."""
    band = tables["band"]
    without = band[band["band_reason"].notna() & band["band_reason"].ne("non_stationary")]
    assert without[["se_load", "life_km_load_low", "life_km_p50", "line_life_km_p50"]].isna().all(axis=None)
    return set(band["band_reason"].dropna())


def test_short_records_have_no_band(tmp_path):
    """Their damage scatters too much, or nobody knows: a record of 12 s, and one without a spectrum."""
    assert reasons(assessed(tmp_path / "short", noise_case(3.0))) == {"short_record"}
    case = noise_case(12.0)
    case.spectrum = {"segment_s": 30.0}
    assert reasons(assessed(tmp_path / "none", case)) == {"short_record"}


def test_events_counted_by_number_have_no_band(tmp_path):
    """A manoeuvre that makes the damage says nothing of the next one; one that makes little of it widens the band."""
    case = noise_case()
    case.histories["load"] = small_case().histories["load"]
    case.events.append({"name": "load", "history": "load", "per_1000_km": 2e5})
    assert reasons(assessed(tmp_path / "many", case)) == {"single_pass"}
    case.events[-1]["per_1000_km"] = 40.0
    tables = assessed(tmp_path / "few", case)
    assert reasons(tables) == set()
    damage = tables["damage"].merge(tables["band"], on=POINT)
    weight = damage["event"].map(weights() | {"load": 0.04})
    share = damage.assign(per_km=damage["damage_per_pass"] * weight).pivot_table(
        index=POINT, columns="event", values="per_km", observed=True
    )
    share = share.div(share.sum(axis=1), axis=0)["load"]
    assert (share > 1e-6).all()
    assert (share < band_scatter.MINOR).all()
    se = tables["band"].set_index(POINT)["se_load"].loc[share.index]
    assert (se > share).all()


def test_cycles_across_events_have_no_band(tmp_path):
    """Where they make more than a little of the damage no piece of a record holds it."""
    case = empty_and_laden()
    case.extra = LOOP.replace("1.5", "200")
    t = case.histories["sine"]["time_s"]
    bump = np.exp(-(((t - 6.0) / 0.3) ** 2))  # once a pass: the largest cycle is from the one in one event to the other
    case.histories["sine"] = case.histories["sine"].assign(q_1=-30.0 * bump, q_2=0.0)
    case.histories["laden"] = case.histories["laden"].assign(q_1=60.0 + 30.0 * bump, q_2=0.0, q_7=0.0)
    for event in case.events:
        if "share" not in event:
            event["per_1000_km"] = 200.0
    assert reasons(assessed(tmp_path, case)) == {"across_events"}


def test_points_that_a_bound_has_settled_have_no_band(tmp_path):
    """The worst point of a weld far below the limit need not have been counted."""
    case = noise_case()
    case.mission["target_km"] = 1.0
    tables = assessed(tmp_path, case, share=0.5, proves_worst=False, histogram="all")
    screened = tables["nodes"].merge(tables["band"], on=POINT)
    assert (screened["band_reason"].eq("screened") == screened["screened"].fillna("").ne("")).all()


def test_points_without_damage_have_no_band(tmp_path):
    """No cycle reaches the cut-off."""
    case = noise_case()
    case.curve |= {"extension": "cutoff", "knee_cycles": 10.0}
    assert reasons(assessed(tmp_path, case)) == {"no_damage"}


def test_a_method_for_shear_that_decides_has_no_band(tmp_path):
    """Pieces of time hold the cycles of the normal stress, and the larger sum is another one."""
    case = noise_case(60.0)
    case.extra = '[multiaxial]\nmethod = "range"\n'
    band = assessed(tmp_path, case)["band"]
    assert "shear" in set(band["band_reason"].dropna())


def test_what_is_not_stationary_has_a_band_at_least_so_wide(plain, tmp_path):
    """Half of the record four times as loud: the band is there, and wider."""
    case = noise_case()
    loud = np.where(np.arange(24_000) < 12_000, 2.0, 0.5)
    for name in ("noise", "loud"):
        case.histories[name] = case.histories[name].assign(
            **{q: loud * case.histories[name][q] for q in ("q_1", "q_2", "q_7")}
        )
    band = assessed(tmp_path, case)["band"]
    assert band["band_reason"].eq("non_stationary").all()
    assert (band["life_km_load_low"] > 0.0).all()
    assert band["se_load"].min() > plain["band"]["se_load"].max()


def test_reasons_are_those_of_the_diagnosis(tmp_path):
    """A record is too short for a band where the diagnosis says that it is too short."""
    from fatigue.diagnose import diagnose  # noqa: PLC0415

    case = noise_case(9.0)
    tables = assessed(tmp_path, case, histogram="all")
    diagnose(tmp_path / "result")
    told = pd.read_parquet(tmp_path / "result" / "diagnosis.parquet")
    too_short = told[told["event"] == "loud"].set_index(POINT)["record_too_short"]  # it has nearly all of the damage
    band = tables["band"].set_index(POINT)["band_reason"].loc[too_short.index]
    assert (band.eq("short_record") == too_short).all()


def test_bytes_depend_neither_on_threads_nor_on_how_many_points_wait(tmp_path, monkeypatch):
    """Nor does the counter of long records give other bands than the one of short ones, but for rounding."""
    case = noise_case(band=LINES).write(tmp_path / "case")
    run(load_case(case), tmp_path / "one", histogram="all")
    first = (tmp_path / "one" / "band.parquet").read_bytes()
    assess(load_case(case), tmp_path / "two", threads=3, report=False, histogram="all")
    assert (tmp_path / "two" / "band.parquet").read_bytes() == first
    monkeypatch.setattr(histogram, "POINTS_AT_ONCE", 3)
    run(load_case(case), tmp_path / "three", histogram="all")
    both = [pd.read_parquet(tmp_path / name / "band.parquet") for name in ("one", "three")]
    pd.testing.assert_frame_equal(*both, check_categorical=False)
    monkeypatch.setattr(counting, "LONGEST_ROW", 100)
    run(load_case(case), tmp_path / "four", histogram="all")
    ours, theirs = (pd.read_parquet(tmp_path / name / "band.parquet") for name in ("one", "four"))
    numbers = ours.select_dtypes(float).columns
    assert np.allclose(ours[numbers], theirs[numbers], rtol=1e-9, equal_nan=True)


def test_without_histograms_there_are_no_bands(tmp_path):
    """And provenance says nothing of them; with them it says what they rest on."""
    case = noise_case(12.0, band=LINES).write(tmp_path / "case")
    run(load_case(case), tmp_path / "none", histogram="none")
    assert not (tmp_path / "none" / "band.parquet").exists()
    assert read_provenance(tmp_path / "none")["rules"]["life_band"] is None
    run(load_case(case), tmp_path / "some")
    said = read_provenance(tmp_path / "some")["rules"]["life_band"]
    assert (said["miner_median"], said["miner_sigma_ln"], said["reference_length_mm"]) == (0.8, 0.3, 25.0)
    assert said["survivals"]["p97_7"] == pytest.approx(0.97725, abs=1e-5)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ("dependence = 0.5", "life_band.reference_length_mm: the key is missing although dependence = 0.5"),
        ("reference_length_mm = 20.0", "life_band.dependence: the key is missing although reference_length_mm = 20"),
        ("reference_length_mm = 0.0\ndependence = 0.5", "life_band.reference_length_mm"),
        ("reference_length_mm = 20.0\ndependence = 1.5", "life_band.dependence"),
        ("miner_sigma_ln = -0.1", "life_band.miner_sigma_ln"),
        ("miner_median = 0.0", "life_band.miner_median"),
        ("rho = 0.5", "life_band.rho"),
    ],
)
def test_wrong_keys_are_told_with_their_place(tmp_path, keys, words):
    """File, table, key and what is wrong."""
    with pytest.raises(CaseError) as error:
        load_case(noise_case(3.0, band=f"[life_band]\n{keys}\n").write(tmp_path))
    assert words in str(error.value)
