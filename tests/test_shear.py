"""Shear at the toe as a user meets it: same bytes however it is run, nothing where it is off, refusals, sequences."""

from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.check import check_case
from fatigue.errors import CaseError, DataError
from fatigue.pipeline.multiaxial import counted, doubt, group
from fatigue.results import read_provenance
from fatigue.verify.recount import recount
from tests.shear_at_toe import shear_at_toe
from tests.small_case import small_case
from tests.test_sequences import LOOP, empty_and_laden

POINT = ["weld", "part", "order", "surface"]
SHEAR = ["shear_required", "multiaxial_status", "multiaxial_bound", "utilisation_path_range", "utilisation_path_length"]
SHEAR += [
    "utilisation_path_mlp",
    "utilisation_asme",
    "path_factor_largest",
    "path_moment_largest",
    "multiaxial_verdict",
]
BEYOND = 'method = "range"\n'


def sheared(pairs=1, multiaxial="alpha = 0.5", limit=100.0):
    """The small case with more shear, and by default a limit with which points fail and are left open."""
    case = small_case(seconds=6.0, pairs=pairs)
    case.nodal_forces = case.nodal_forces.assign(fx_N=4.0 * case.nodal_forces["fx_N"])
    case.mission["damage_limit"] = limit
    case.extra = f"[multiaxial]\n{multiaxial}\n"
    return case


def nodes_of(path, folder, **options):
    """Toe points of an assessment."""
    assess(path, folder, report=False, **({"threads": 1, "histogram": "none"} | options))
    nodes = pd.read_parquet(folder / "nodes.parquet")
    return nodes[nodes["toe"]].set_index(POINT)


def test_bytes_do_not_depend_on_threads_workers_or_an_interruption(tmp_path, monkeypatch):
    """Tables of one thread, of two, of processes, and of a run that goes on where another was stopped."""
    path = sheared(pairs=3).write(tmp_path / "case")
    assess(path, tmp_path / "one", threads=1, report=False)
    assess(path, tmp_path / "two", threads=2, report=False)
    with ProcessPoolExecutor(1) as workers:
        assess(path, tmp_path / "orders", executor=workers, report=False)
    real, calls = group.group_multiaxial, []

    def interrupted(*arguments):
        calls.append(arguments)
        if len(calls) > 1:
            raise KeyboardInterrupt
        return real(*arguments)

    monkeypatch.setattr("fatigue.pipeline.run.work.group_multiaxial", interrupted)
    with pytest.raises(KeyboardInterrupt):
        assess(path, tmp_path / "resumed", threads=1, report=False)
    monkeypatch.undo()
    assert assess(path, tmp_path / "resumed", threads=1, report=False).groups_reused == 1
    tables = sorted(file.name for file in (tmp_path / "one").glob("*.parquet"))
    assert "path_cycles.parquet" in tables
    for name in tables:
        bytes_of = {(tmp_path / run / name).read_bytes() for run in ("one", "two", "orders", "resumed")}
        assert len(bytes_of) == 1, name


def test_off_computes_nothing(tmp_path, monkeypatch):
    """No column is filled, no table written, no counter or bound called; the other columns are as they are."""
    report = nodes_of(sheared().write(tmp_path / "case"), tmp_path / "report")
    for name in ("path_extent", "group_multiaxial"):
        monkeypatch.setattr(f"fatigue.pipeline.run.work.{name}", None)
    off = nodes_of(sheared(multiaxial='method = "off"').write(tmp_path / "off case"), tmp_path / "off")
    assert off[SHEAR].isna().all(axis=None)
    assert not report[SHEAR].isna().all(axis=None)
    assert not (tmp_path / "off" / "path_cycles.parquet").exists()
    assert read_provenance(tmp_path / "off")["rules"]["multiaxial"] == {"method": "off"}
    pd.testing.assert_frame_equal(off.drop(columns=SHEAR), report.drop(columns=SHEAR))


@pytest.mark.parametrize("method", ["range", "length", "mlp"])
def test_a_path_method_beside_vertices_is_refused(method, tmp_path):
    """Samples and vertices cannot be compared; the report and the ASME factor stand beside them."""
    case = sheared(multiaxial=f'method = "{method}"\nalpha = 1.0')
    case.counting["reversals"] = "vertex"
    with pytest.raises(CaseError) as refused:
        assess(case.write(tmp_path / "case"), tmp_path / "out")
    (problem,) = refused.value.problems
    assert (problem.code, problem.where) == ("contradiction", "case.toml: multiaxial.method")
    assert "from sample to sample" in problem.what


@pytest.mark.parametrize("method", ["report", "asme"])
def test_vertices_beside_report_and_asme(method, tmp_path):
    """The bound holds for the range that vertices have, which is no smaller than that of the samples."""
    case = sheared(multiaxial=f'method = "{method}"')
    case.counting["reversals"] = "vertex"
    nodes = nodes_of(case.write(tmp_path / "case"), tmp_path / "out")
    assert not (nodes["utilisation_path_range"] > nodes["multiaxial_bound"]).any()
    assert nodes["multiaxial_status"].notna().all()


def test_alpha_is_required_by_the_moment(tmp_path):
    """It has no default; without it the report has no sum by moment."""
    with pytest.raises(CaseError, match="alpha"):
        assess(sheared(multiaxial='method = "mlp"').write(tmp_path / "case"), tmp_path / "out")
    nodes = nodes_of(sheared(multiaxial="").write(tmp_path / "without"), tmp_path / "report")
    assert nodes["utilisation_path_mlp"].isna().all()
    assert nodes["utilisation_path_length"].notna().any()


def test_screening_beside_a_named_method_is_refused(tmp_path):
    """Bounds of the normal stress say nothing of shear; nothing has been written then."""
    with pytest.raises(CaseError, match=r"needs every point counted.*Leave out --screen \(share\)"):
        assess(sheared(multiaxial='method = "range"').write(tmp_path / "case"), tmp_path / "out", share=0.1)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", [counted, doubt])
def test_a_record_too_long_for_the_counter(name, tmp_path, monkeypatch):
    """Named, the method is refused by check and assess; in the report the points that stay open are told."""
    for module in (counted, doubt, group):
        monkeypatch.setattr(module, "LONGEST_PATH", 900)
    if name is counted:
        path = sheared(multiaxial='method = "range"').write(tmp_path / "case")
        for refuses in (check_case, lambda case: assess(case, tmp_path / "out", report=False)):
            with pytest.raises(DataError, match="paths are counted in records of 900 samples") as refused:
                refuses(path)
            assert [problem.code for problem in refused.value.problems] == ["path_too_long"] * 2
        return
    nodes = nodes_of(sheared().write(tmp_path / "case"), tmp_path / "out")
    assert nodes["utilisation_path_range"].isna().all()
    open_ = nodes["multiaxial_status"].isna()
    assert open_.any()
    assert nodes.loc[open_, "multiaxial_verdict"].isna().all()
    assert (nodes.loc[open_, "multiaxial_bound"] > 1.0).any()
    (warning,) = [w for w in read_provenance(tmp_path / "out")["warnings"] if w["code"] == "path_too_long"]
    assert warning["count"] == int(open_.sum())
    assert "sine, noise" in warning["what"]


def test_sequences_are_in_every_sum(tmp_path):
    """Of passes the path has its own sum, of cycles across events that of the normal stress; the larger one decides."""
    case = empty_and_laden()
    case.mission["damage_limit"] = 50.0
    case.extra = LOOP + BEYOND.join(["[multiaxial]\n", ""])
    nodes = nodes_of(case.write(tmp_path / "case"), tmp_path / "range")
    report = empty_and_laden()
    report.mission["damage_limit"] = 50.0
    report.extra = LOOP
    plain = nodes_of(report.write(tmp_path / "plain case"), tmp_path / "plain")
    rows = pd.read_parquet(tmp_path / "range" / "path_cycles.parquet")
    point = tuple(rows.iloc[0][POINT])
    rows = rows[rows["weld"] == point[0]]
    per_km = {"sine": 0.75 / (12.0 * 0.05), "laden": 0.25 / (11.0 * 0.1), "load": 1.5e-3, "unload": 2e-3}
    passes = sum(per_km[event] * damage for event, damage in rows.groupby("event")["damage"].sum().items())
    across = plain.loc[point, "damage_per_km_transitions"]
    assert across * 1e6 / 50.0 > 1e-3
    assert nodes.loc[point, "utilisation_path_range"] == pytest.approx((passes + across) * 1e6 / 50.0, rel=1e-9)
    expected = np.fmax(plain["utilisation"], nodes["utilisation_path_range"])
    np.testing.assert_allclose(nodes["utilisation"], expected, rtol=1e-12)
    assert nodes["utilisation_asme"].notna().all()
    assert nodes["damage_factor_if_shear"].isna().all()
    assert (nodes["utilisation_asme"] >= plain["utilisation"] * (1.0 - 1e-12)).all()


@pytest.mark.parametrize("limit", [4e3, 2e4])
def test_screened_points_are_bounded_from_their_bounds(limit, tmp_path):
    """What is settled there is settled when every point is counted, and no bound is below the count."""
    exact = nodes_of(sheared(limit=limit).write(tmp_path / "case"), tmp_path / "exact", share=0.0)
    screened = nodes_of(tmp_path / "case" / "case.toml", tmp_path / "screened", share=1.0, proves_worst=False)
    named = sheared(limit=limit, multiaxial='method = "mlp"\nalpha = 0.5').write(tmp_path / "named case")
    every = nodes_of(named, tmp_path / "every")
    bounded = screened["screened"] != ""
    assert bounded.any()
    assert (screened["multiaxial_bound"] >= every["utilisation_path_range"] * (1.0 - 1e-9)).all()
    assert (screened["utilisation_asme"] >= exact["utilisation_asme"] * (1.0 - 1e-9)).all()
    passed = screened["multiaxial_status"] == "settled_passes"
    assert (every.loc[passed, "utilisation_path_range"] <= 1.0).all()
    assert {"settled_passes", "counted"} >= set(screened["multiaxial_status"]) - {"settled_fails"}
    left = bounded & screened["utilisation_path_range"].notna()
    np.testing.assert_allclose(screened.loc[left, "utilisation_asme"], exact.loc[left, "utilisation_asme"], rtol=1e-9)
    known = screened["shear_required"].notna()
    assert (screened.loc[known, "shear_required"] == exact.loc[known, "shear_required"]).all()


@pytest.mark.parametrize("extension", ["none", "haibach"])
def test_a_large_job_settles_points_by_the_closer_bound(extension, tmp_path, monkeypatch):
    """What the bound by length leaves open may be settled by powers along the path: proven, and recounted."""
    job = sheared(limit=4e3)
    job.curve["extension"] = extension
    case = job.write(tmp_path / "case")
    small = nodes_of(case, tmp_path / "small", share=0.0)
    monkeypatch.setattr("fatigue.pipeline.run.work.is_large", lambda *_: True)
    large = nodes_of(case, tmp_path / "large", share=0.0)
    closer = (small["multiaxial_status"] == "counted") & (large["multiaxial_status"] == "settled_passes")
    assert closer.any()
    assert (small.loc[closer, "multiaxial_bound"] > 1.0).all()
    assert (large.loc[closer, "multiaxial_bound"] <= 1.0).all()
    assert (large.loc[closer, "multiaxial_bound"] >= small.loc[closer, "utilisation_path_range"]).all()
    assert large.loc[~closer, "multiaxial_bound"].equals(small.loc[~closer, "multiaxial_bound"])
    for verdict in (small["multiaxial_verdict"], large["multiaxial_verdict"]):
        assert verdict[closer].str.endswith("passes").all()
    found = recount(tmp_path / "large", sample=None)
    assert found.passed, found.as_text()
    table = pd.read_parquet(tmp_path / "large" / "nodes.parquet")
    table.loc[table["multiaxial_status"] == "settled_passes", "multiaxial_bound"] *= 0.1
    table.to_parquet(tmp_path / "large" / "nodes.parquet")
    wrong = recount(tmp_path / "large", sample=None)
    assert "multiaxial_bound" in {check.column for check in wrong.columns if not check.passed}


def test_load_factor_of_a_named_method_on_a_curve_with_a_knee_is_empty(tmp_path):
    """Sums by paths do not scale with one power there; the life is that of the larger sum all the same."""
    nodes = nodes_of(shear_at_toe(BEYOND, extension="haibach").write(tmp_path / "case"), tmp_path / "out")
    assert nodes["load_factor"].isna().all()
    assert (nodes["utilisation"] == nodes["utilisation_path_range"]).all()
    checks = pd.read_parquet(tmp_path / "out" / "checks.parquet")
    assert checks["utilisation_stress"].isna().all()
    welds = pd.read_parquet(tmp_path / "out" / "welds.parquet")
    assert welds["load_factor"].isna().all()
    assert welds["utilisation"].iloc[0] == pytest.approx(nodes["utilisation"].max(), rel=1e-12)


def test_records_on_disk_give_the_same(tmp_path, monkeypatch):
    """Shear of a record that is read in chunks."""
    path = sheared().write(tmp_path / "case")
    one = nodes_of(path, tmp_path / "memory")
    monkeypatch.setattr("fatigue.pipeline.mission.events.HELD_BYTES", 0.0)
    other = nodes_of(path, tmp_path / "disk")
    pd.testing.assert_frame_equal(other[SHEAR], one[SHEAR], rtol=1e-9)


def test_the_page_of_the_docs_has_every_status_and_verdict():
    """What stands in the tables is explained."""
    page = (Path(__file__).parents[1] / "docs" / "shear.md").read_text(encoding="utf-8")
    for name in (*group.STATUSES, *doubt.VERDICTS, "report", "range", "length", "mlp", "asme", "off"):
        assert f"`{name}`" in page, name
    assert f"{counted.LONGEST_PATH:,}".replace(",", " ") in page
