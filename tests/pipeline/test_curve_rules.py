"""Rules of S-N curves from the case to tables, page and exit code, on a body whose answer is a closed form."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.diagnose import diagnose
from fatigue.results.summary import result_summary
from fatigue.verify.recount import recount
from tests.command_line import fatigue
from tests.small_case import SmallCase, sine_only, small_case

CLASS = """
[curves.{name}]
slopes = [3.0]
range_at_2e6_MPa = 40.0
applies = "structural"
source = "a book"
edition = "2021"
clause = "Table 3"
{keys}
"""
BENDS = 'bending_factor = "bs7608"\nbending_reference_mm = 8.0\nbending_exponent = 0.25'
CYCLES_PER_KM = 100.0  # 5 Hz at 50 m/s
RANGE, RATIO = 90.0, 1.0 / 3.0  # 30 (1 + 0.5) up and down at the top face: 60 MPa membrane, 30 MPa bending


def life(range_: float, limit: float = 1.0) -> float:
    """Life [km] of the sine on FAT 40, slope 3."""
    return limit * 2e6 * (40.0 / range_) ** 3 / CYCLES_PER_KM


def case_with(**of_welds: str) -> SmallCase:
    """The sine on weld A and weld B, each with a curve of its own name and these keys."""
    case = sine_only()
    case.welds["curve"] = list(of_welds)
    case.curve = {"name": next(iter(of_welds))}
    case.extra = "\n".join(CLASS.format(name=name, keys=keys) for name, keys in of_welds.items())
    return case


def assessed(case: SmallCase, folder: Path, **options: Any) -> pd.DataFrame:
    """The welds of an assessed case, by their names; tables are in ``folder / "result"``."""
    assess(case.write(folder), folder / "result", threads=1, report=False, **options)
    return pd.read_parquet(folder / "result" / "welds.parquet").set_index("weld")


ALL_KEYS = """
thickness_reference_mm = 4.0
thickness_exponent = 0.3
thickness_effective = "L_half"
bending_factor = "bs7608"
bending_reference_mm = 5.0
bending_exponent = 0.25
mean_stress = "iiw_low"
gamma_Ff = 1.1
gamma_Mf = 1.15
damage_limit = 0.5
"""


@pytest.fixture(scope="module")
def two_welds(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Weld A with every allowance there is and 12 mm of attachment, B with factors of a table; both assessed."""
    folder = tmp_path_factory.mktemp("rules")
    case = case_with(everything=ALL_KEYS, tabled='status = "unverified"')
    case.welds["attachment_mm"] = [12.0, None]
    case.extra = '[checks]\nstrength_factors = "factors.csv"\n' + case.extra
    rows = [("quality", "strength", 0.8, "7.2"), ("consequence", "limit", 0.9, "7.5")]
    table = pd.DataFrame(rows, columns=["factor", "role", "value", "clause"])
    table.assign(curve="tabled", edition="2025").to_csv(folder / "factors.csv", index=False)
    assess(case.write(folder), folder / "result", threads=1)
    return folder


def test_a_life_with_every_allowance(two_welds: Path) -> None:
    """gamma_Ff gamma_Mf f_t / (f_bending f(R)) on the range, each by hand; R = -1, 8 mm plate, 6 mm effective."""
    welds = pd.read_parquet(two_welds / "result" / "welds.parquet").set_index("weld")
    f_bending = (5.0 / 8.0) ** 0.25 * (1.0 + 0.18 * RATIO**1.4)
    design = 1.1 * 1.15 * (6.0 / 4.0) ** 0.3 / (f_bending * 1.6) * RANGE
    assert welds.loc["A", "life_km"] == pytest.approx(life(design, 0.5), rel=1e-9)
    assert welds.loc["A", "utilisation"] == pytest.approx(1e6 / life(design, 0.5), rel=1e-9)
    assert welds.loc["A", "load_factor"] == pytest.approx((life(design, 0.5) / 1e6) ** (1 / 3), rel=1e-9)
    assert welds.loc["A", ["damage_limit", "attachment_mm"]].tolist() == [0.5, 12.0]
    assert welds.loc["B", "life_km"] == pytest.approx(life(RANGE / 0.8, 0.9), rel=1e-9)
    assert welds["curve_status"].tolist() == ["user", "unverified"]
    assert welds["edition"].tolist() == ["2021", "2021"]


def test_tables_and_page_agree_on_the_design_range(two_welds: Path) -> None:
    """Cycles, histogram and nodes have the same ranges; the page recomputes the damage from them."""
    folder = two_welds / "result"
    cycles = pd.read_parquet(folder / "cycles.parquet")
    nodes = pd.read_parquet(folder / "nodes.parquet")
    worst = nodes[(nodes["weld"] == "A") & (nodes["surface"] == "top")].iloc[0]
    at_a = cycles[cycles["weld"] == "A"]
    by_hand = 40.0 * (2e6 * at_a["damage"] / at_a["count"]) ** (1.0 / 3.0)
    np.testing.assert_allclose(at_a["equivalent_range_dS"], by_hand, rtol=1e-9)
    assert worst["curve_status"] == "user"
    bins = pd.read_parquet(folder / "histogram.parquet")
    assert set(bins["weld"]) == {"A", "B"}
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "✕ differs" not in page


def test_a_diagnosis_knows_the_allowances(two_welds: Path) -> None:
    """Estimated and counted lives of 10 % less of the one mode agree, with the limit of the curve in both."""
    folder = two_welds / "result"
    diagnose(folder)
    levers = pd.read_parquet(folder / "levers.parquet")
    best = levers[levers["rank"] == 1].set_index("weld")
    welds = pd.read_parquet(folder / "welds.parquet").set_index("weld")
    np.testing.assert_allclose(best["life_km"], welds["life_km"], rtol=1e-9)
    np.testing.assert_allclose(best["life_km_counted"], welds["life_km"] / 0.9**3, rtol=1e-9)
    np.testing.assert_allclose(best["life_km_estimated"], welds["life_km"] / 0.9**3, rtol=1e-9)


def test_what_rests_on_an_unverified_curve_carries_the_word(two_welds: Path) -> None:
    """Title, first page, tables, captions, workbook and summary; the user's own values are told as such."""
    folder = two_welds / "result"
    page = (folder / "report.html").read_text(encoding="utf-8")
    words = re.sub(r"<[^>]+>", " ", page)
    assert "<title>small case: weld fatigue report on unverified curves</title>" in page
    assert "1 of 2 welds rest on unverified curves (tabled)" in words
    assert "values entered by the user: everything" in words
    assert "(1 of 2 welds: unverified curve)" in words
    of_b = page[page.index('id="weld-') :]
    captions = re.findall(r"<figcaption>(.*?)</figcaption>", of_b)
    assert any("B: life, load factor" in caption and "(unverified curve)" in caption for caption in captions)
    assert not any("A: life, load factor" in caption and "unverified" in caption for caption in captions)
    for cell in ("7.2", "7.5", "divides the range", "multiplies the damage limit", "Table 3"):
        assert cell in words
    summary = result_summary(folder, top=3)
    assert "Unverified: tabled; 1 of 2 welds have their lives from them: B" in summary.as_text()
    assert summary.as_record()["unverified_curves"] == ["tabled"]
    assert "0.5 on everything, 0.9 on tabled" in summary.assumptions
    record = json.loads((folder / "provenance.json").read_text(encoding="utf-8"))
    assert [factor["clause"] for factor in record["curves"]["tabled"]["factors"]] == ["7.2", "7.5"]
    assert [warning["code"] for warning in record["warnings"]].count("unverified_curve") == 1


def test_nothing_of_it_is_said_of_cross_checked_curves(tmp_path: Path) -> None:
    """The catalogue as it is: in the table of curves, not in the title."""
    case = sine_only()
    assess(case.write(tmp_path), tmp_path / "result", threads=1)
    page = (tmp_path / "result" / "report.html").read_text(encoding="utf-8")
    seen = re.sub(r"<script.*?</script>", "", page, flags=re.DOTALL)
    assert "unverified" not in seen.partition('<section id="method">')[0].partition("<body>")[2]
    assert "cross-checked" in page
    assert "Unverified" not in result_summary(tmp_path / "result").as_text()


@pytest.mark.parametrize(("status", "code"), [("unverified", 3), ("user", 1), ("verified", 1)])
def test_require_verified(tmp_path: Path, status: str, code: int) -> None:
    """Exit 3 names the curves; what the user has entered passes, and then the verdict of the welds counts."""
    path = case_with(mine=f'status = "{status}"', other="").write(tmp_path)
    done = fatigue("assess", path, "-o", tmp_path / "result", "--no-report", "--require-verified")
    assert done.returncode == code
    assert ("curve 'mine' is unverified" in done.stdout + done.stderr) == (code == 3)
    assert (tmp_path / "result" / "welds.parquet").exists() == (code != 3)


def test_a_gamma_is_on_the_range_and_a_limit_on_the_damage(tmp_path: Path) -> None:
    """1.2 on the range is 1.2^3 in life; the same number on the damage would be 1.2."""
    welds = assessed(case_with(plain="", gamma="gamma_Mf = 1.2"), tmp_path)
    assert welds.loc["A", "life_km"] == pytest.approx(life(RANGE), rel=1e-9)
    assert welds.loc["B", "life_km"] == pytest.approx(life(RANGE) / 1.2**3, rel=1e-9)


@pytest.mark.parametrize("share", [0.0, 0.5])
def test_bounds_are_of_the_limit_of_each_curve(tmp_path: Path, share: float) -> None:
    """Whether points are counted or settled by bounds, no life of a worst point changes."""
    welds = assessed(case_with(low='mean_stress = "iiw_low"', strict="damage_limit = 0.1"), tmp_path, share=share)
    assert welds.loc["A", "life_km"] == pytest.approx(life(RANGE / 1.6), rel=1e-9)
    assert welds.loc["B", "life_km"] == pytest.approx(life(RANGE, 0.1), rel=1e-9)


@pytest.mark.parametrize("keys", ['mean_stress = "iiw_low"', BENDS, f'mean_stress = "iiw_medium"\n{BENDS}'])
def test_bounds_with_events_in_turn_hold(tmp_path: Path, keys: str) -> None:
    """Where counted events tighten the bounds of the others, no bound falls below what counting everything gives.

    One event lies in compression, one in tension, so that cycles across them have other stress ratios than their own.
    """
    case = small_case(seconds=2.0, pairs=2)
    case.curve = {"name": "own"}
    for event, level in (("sine", -160.0), ("noise", 90.0)):
        case.histories[event]["q_1"] += level
        case.histories[event]["q_2"] *= 0.5
    case.events[1] |= {"start_s": 0.0}
    case.mission["target_km"] = 500.0
    order = '[[mission.sequence]]\norder = ["sine", "noise"]\nper_1000_km = 400.0\n'
    case.extra = CLASS.format(name="own", keys=keys) + order
    file = case.write(tmp_path)
    tables = {}
    for share in (0.0, 0.7):
        assess(file, tmp_path / f"result-{share:g}", threads=1, report=False, share=share, proves_worst=False)
        tables[share] = pd.read_parquet(tmp_path / f"result-{share:g}" / "nodes.parquet")
    exact, bounded = tables[0.0], tables[0.7]
    settled = bounded["screened"] != ""
    assert settled.any()
    assert (bounded["damage_per_km"] >= exact["damage_per_km"] * (1.0 - 1e-9)).all()
    np.testing.assert_allclose(bounded["damage_per_km"][~settled], exact["damage_per_km"][~settled], rtol=1e-9)
    assert (bounded["load_factor"] <= exact["load_factor"] * (1.0 + 1e-9)).all()


def test_a_damage_limit_of_the_curve_holds_for_shear_too(tmp_path: Path) -> None:
    """A named method leaves life and sums against the limit of the curve, and the rows of its check say which."""
    case = case_with(strict="damage_limit = 0.25", plain="")
    case.extra = '[multiaxial]\nmethod = "range"\n' + case.extra
    welds = assessed(case, tmp_path)
    nodes = pd.read_parquet(tmp_path / "result" / "nodes.parquet").query("toe")
    np.testing.assert_allclose(nodes["life_km"] * nodes["utilisation"], 1e6, rtol=1e-9)
    of_strict = nodes[nodes["weld"] == "A"]
    np.testing.assert_allclose(of_strict["life_km"] * of_strict["damage_per_km"], 0.25, rtol=1e-9)
    assert welds.loc["B", "life_km"] <= life(RANGE) * (1.0 + 1e-9)
    assert (of_strict["utilisation_path_range"].dropna() > 0.0).all()
    checks = pd.read_parquet(tmp_path / "result" / "checks.parquet")
    assert checks.groupby("weld")["damage_limit"].unique().map(list).to_dict() == {"A": [0.25], "B": [1.0]}


def test_the_recount_agrees_with_every_rule(two_welds: Path, tmp_path: Path) -> None:
    """Computed anew from the input files, also of a curve of the catalogue that the case changes."""
    assert recount(two_welds / "result", sample=None).passed
    case = sine_only()
    case.welds["curve"] = ["iiw-steel-90", "master-steel"]
    case.extra = '[curves.iiw-steel-90]\ngamma_Mf = 1.15\nmean_stress = "iiw_medium"\n'
    case.extra += "[curves.master-steel]\ngamma_Ff = 1.1\n"
    welds = assessed(case, tmp_path)
    assert welds["curve_status"].tolist() == ["user", "user"]
    assert recount(tmp_path / "result", sample=None).passed
