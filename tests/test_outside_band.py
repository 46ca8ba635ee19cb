"""Stress above the band of the spectrum, as a user meets it: tables, warnings, show, check, screening, recount."""

import json

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.check import check_case
from fatigue.diagnose import diagnose
from fatigue.report.page import write_report
from fatigue.results.summary import result_summary
from fatigue.verify.recount.folder import recount
from tests.command_line import fatigue
from tests.small_case import STEP, small_case


def shaken(low_hz, high_hz, share=1.0, **changes):
    """The small case, whose band ends at 18 Hz, with a share of the variance of two events between two frequencies."""
    case = small_case(8.0)
    rng = np.random.default_rng(1)
    for name in ("sine", "noise"):
        table = case.histories[name]
        f = np.fft.rfftfreq(len(table), STEP)
        lines = (rng.normal(size=f.size) + 1j * rng.normal(size=f.size)) * ((f > low_hz) & (f < high_hz))
        noise = np.fft.irfft(lines, len(table))
        size = table["q_1"].std() * np.sqrt(share)
        table["q_1"] = np.sqrt(1.0 - share) * table["q_1"] + size * noise / noise.std()
        table["q_2"] = table["q_7"] = 0.0
    for name, value in changes.items():
        getattr(case, name).update(value)
    return case


def tables(folder):
    """Points and events of a result."""
    return pd.read_parquet(folder / "nodes.parquet"), pd.read_parquet(folder / "damage.parquet")


def codes(warnings):
    """Codes of warnings."""
    return [warning.code for warning in warnings]


@pytest.fixture(scope="module")
def above(tmp_path_factory):
    """A case with all of its stress above the band, and its result."""
    folder = tmp_path_factory.mktemp("above")
    case = shaken(40.0, 60.0).write(folder / "case")
    return case, assess(case, folder / "result", report=False)


def test_no_stress_in_the_band_is_no_life(above):
    """Nothing is printed as a life; the ratio, the damages and the verdict tell why."""
    nodes, damage = tables(above[1].folder)
    assert nodes["life_km_dirlik"].isna().all()
    assert nodes["life_km_tb"].isna().all()
    assert nodes["life_km_same_ratio"].notna().all()
    assert (nodes["dirlik_ratio"] < 1e-6).all()
    assert set(nodes["dirlik_verdict"]) == {"outside_band"}
    swinging = damage[damage["event"] != "load and unload"]
    assert (swinging["outside_share"] > 0.999).all()
    assert (swinging["verdict"] == "outside_band").all()
    assert swinging["peaks_per_s"].between(45.0, 55.0).all()  # of the whole record
    assert (swinging["samples_per_peak"] * swinging["peaks_per_s"] * STEP).to_numpy() == pytest.approx(1.0)
    assert damage.loc[damage["event"] == "load and unload", "outside_share"].isna().all()


def test_one_warning_names_band_share_event_and_remedy(above):
    """One line for the event that makes most of what is missed; that the count misses peaks is said as well."""
    assert codes(above[1].warnings).count("outside_band") == 1
    assert "sampling" in codes(above[1].warnings)
    told = str(next(w for w in above[1].warnings if w.code == "outside_band"))
    for words in ("event 'sine'", "upper_hz (18 Hz)", "99.9", "21 of 21 toe points", "Raise upper_hz"):
        assert words in told


def test_show_has_no_life_by_dirlik(above):
    """A dash and a line below the table; null for machines."""
    text = result_summary(above[1].folder, top=2).as_text()
    assert "no life by Dirlik: the spectra miss too much of the stress (outside_band)" in text
    assert "1e12" not in text
    points = json.loads(fatigue("show", above[1].folder, "--top", 2, "--json").stdout)["points"]
    assert [point["life_km_dirlik"] for point in points] == [None, None]


def test_page_says_why_there_is_no_comparison(above):
    """Page one has the warning; instead of a figure without points stands the reason."""
    page = write_report(above[1].folder, above[0], ()).read_text(encoding="utf-8")
    assert "none, the spectra miss too much of the stress" in page
    assert "The spectra miss too much of the stress of 28 points" in page
    assert "No event has a record long enough" not in page


def test_check_says_it_before(above):
    """The dry run looks at some welds and the beginnings of records."""
    found = [w for w in check_case(above[0]).warnings if w.code == "outside_band"]
    assert len(found) == 1
    assert "toe points looked at" in found[0].what


def test_recount_and_diagnosis_agree(above):
    """The recount finds the same by other code; a diagnosis blames the band and not the formula."""
    assert recount(above[1].folder, sample=None).passed
    finding = diagnose(above[1].folder).findings[0]
    assert finding.verdict == "outside_band"
    assert "above upper_hz (18 Hz)" in finding.reason
    assert finding.formula_error is None


def test_screened_points_have_no_life_either(tmp_path):
    """What bounds settle is estimated all the same, and left out all the same."""
    case = shaken(40.0, 60.0, mission={"target_km": 1.0})
    result = assess(case.write(tmp_path / "case"), tmp_path / "result", report=False, share=0.5, proves_worst=False)
    nodes, _ = tables(tmp_path / "result")
    assert (nodes["screened"] != "").any()
    assert nodes["life_km_dirlik"].isna().all()
    assert codes(result.warnings).count("outside_band") == 1


def test_a_little_is_no_verdict(tmp_path):
    """A thousandth of the variance is worth 3 % of damage: a share in the table, no verdict, no warning, a life."""
    result = assess(shaken(40.0, 45.0, 1e-3).write(tmp_path / "case"), tmp_path / "result", report=False)
    nodes, damage = tables(tmp_path / "result")
    sine = damage[damage["event"] == "sine"]
    assert sine["outside_share"].to_numpy() == pytest.approx(1e-3, rel=0.1)
    assert (nodes["dirlik_verdict"] != "outside_band").all()
    assert np.isfinite(nodes["life_km_dirlik"]).all()
    assert "outside_band" not in codes(result.warnings)


def test_one_small_event_outside_does_not_take_the_life_away(tmp_path):
    """The event carries the verdict, the mission has the sum: the other event does nearly all of the damage."""
    case, calm = shaken(40.0, 60.0), small_case(20.0)
    case.histories["sine"] = calm.histories["sine"]
    assess(case.write(tmp_path / "case"), tmp_path / "result", report=False)
    nodes, damage = tables(tmp_path / "result")
    verdicts = damage.set_index("event")["verdict"]
    assert set(verdicts["noise"]) == {"outside_band"}
    assert "outside_band" not in set(verdicts["sine"])
    assert "outside_band" not in set(nodes["dirlik_verdict"])
    assert np.isfinite(nodes["life_km_dirlik"]).all()


@pytest.mark.parametrize(("upper_hz", "lines"), [(0.1, 0), (1.2, 1), (7.5, 7)])
def test_few_lines_in_the_band(tmp_path, upper_hz, lines):
    """Segments of 1 s have lines 1 Hz apart."""
    case = small_case()
    case.spectrum["upper_hz"] = upper_hz
    found = [w for w in check_case(case.write(tmp_path)).warnings if w.code == "few_lines"]
    assert len(found) == 2
    assert f"({upper_hz:g} Hz) leaves {lines} lines" in found[0].what


def test_a_band_beyond_half_the_sampling_rate_is_all_of_the_record(tmp_path):
    """Nothing lies above it, and nothing is said."""
    case = shaken(40.0, 60.0, spectrum={"upper_hz": 500.0})
    result = assess(case.write(tmp_path / "case"), tmp_path / "result", report=False)
    nodes, damage = tables(tmp_path / "result")
    assert (damage["outside_share"].dropna() == 0.0).all()
    assert nodes["dirlik_ratio"].between(0.5, 2.0).all()
    assert not {"outside_band", "few_lines"} & set(codes(result.warnings))


def test_automatic_upsampling_sees_the_whole_record(tmp_path):
    """4 samples per peak above the band ask for 8 times as many; white noise for no more than that."""
    for name, (low, high) in {"band": (40.0, 60.0), "white": (0.0, 101.0)}.items():
        case = shaken(low, high, counting={"upsample": "auto"})
        assess(case.write(tmp_path / name), tmp_path / f"{name}-result", report=False)
        _, damage = tables(tmp_path / f"{name}-result")
        swinging = damage[damage["event"] == "sine"]
        factor = swinging["samples_per_peak"] * swinging["peaks_per_s"] * STEP
        assert factor.to_numpy() == pytest.approx(8.0)
        assert (swinging["samples_per_peak"] >= 20.0).all()


def test_rigid_modes_by_the_name_of_normal_ones_set_no_band(tmp_path):
    """Without a mode that vibrates the band ends at 0.4 of the sampling rate, in the recount as in the assessment."""
    case = small_case()
    case.modes["frequency_hz"], case.modes["kind"] = 1e-4, "normal"
    assess(case.write(tmp_path / "case"), tmp_path / "result", report=False)
    _, damage = tables(tmp_path / "result")
    assert (damage["damage_dirlik_per_pass"].dropna() > 0.0).all()
    assert recount(tmp_path / "result", sample=2).passed


def test_likely_worst_point_is_sought_in_the_whole_spectrum(tmp_path):
    """The point that vibrates above the band does the damage, the one with the larger stress in the band does not."""
    case = shaken(40.0, 60.0, mission={"target_km": 1.0})
    for name in ("sine", "noise"):
        t = case.histories[name]["time_s"].to_numpy()
        case.histories[name]["q_2"] = 3.0 * np.sin(2 * np.pi * 10.0 * t)
    first = case.nodal_forces["node"] < 103  # of weld A: half the mode 1 of the others, and twice their mode 2
    forces = [column for column in case.nodal_forces if column.endswith(("_N", "_Nmm"))]
    case.nodal_forces.loc[first & (case.nodal_forces["mode"] == 1), forces] *= 0.5
    case.nodal_forces.loc[first & (case.nodal_forces["mode"] == 2), forces] *= 2.0
    assess(case.write(tmp_path / "case"), tmp_path / "fast", report=False, share=1.0, proves_worst=False)
    assess(tmp_path / "case" / "case.toml", tmp_path / "exact", report=False, share=0.0)
    worst = [pd.read_parquet(tmp_path / name / "welds.parquet") for name in ("fast", "exact")]
    assert [table["worst_node"][0] for table in worst] == [103, 103]  # all points of weld B are alike
    assert worst[0]["life_km"].to_numpy() == pytest.approx(worst[1]["life_km"].to_numpy(), rel=1e-6)
