"""Jobs whose shares are measured: each has what it is named for, and differs from the one without in nothing else."""

import numpy as np
import pyarrow.parquet as pq
import pytest

from benchmarks.shares import JOBS, WITHOUT, told, written
from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.results import read_provenance
from fatigue.synth import Size

SIZES = {1: Size(30, 6, 1, 8.0, 250.0), 2: Size(30, 6, 2, 4.0, 250.0)}


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Folders of results of all jobs, small."""
    folder = tmp_path_factory.mktemp("shares")
    found = {}
    for name, job in JOBS.items():
        found[name] = folder / f"result {name}"
        (_, histogram) = job.options
        assess(load_case(written(folder, name, job, SIZES)), found[name], report=False, threads=1, histogram=histogram)
    return found


def test_histograms_are_of_no_point_of_the_worst_and_of_all(results):
    """Without, there is no row of the table."""
    rows = {
        name: pq.read_table(results[name] / "histogram.parquet").num_rows
        if (results[name] / "histogram.parquet").exists()
        else 0
        for name in JOBS
    }
    assert rows["one event"] == rows["unit loads"] == rows["shear paths"] == rows["sequences"] == 0
    assert 0 < rows["histograms"] < rows["histograms of all points"]
    assert rows["all"] > 0


def test_loads_shear_and_sequences_are_there(results):
    """And change the damage, each beside the job without it."""
    damage = {
        name: np.asarray(pq.read_table(result / "nodes.parquet")["damage_per_km"]) for name, result in results.items()
    }
    for name in ("histograms", "histograms of all points", "shear paths"):
        assert (damage[name] == damage["one event"]).all()
    assert (damage["unit loads"] != damage["one event"]).any()
    assert (damage["sequences"] != damage["two events"]).any()
    for name in JOBS:
        points = read_provenance(results[name])["rules"]["multiaxial"].get("toe_points", {})
        assert bool(sum(points.values())) == (name in {"shear paths", "all"})
        events = set(pq.read_table(results[name] / "damage.parquet")["event"].to_pylist())
        assert ("(sequence 1)" in events) == (name in {"sequences", "all"})


def test_rows_of_the_table():
    """Each job over the one without that has as many events."""
    best = {name: 4.0 if JOBS[name].events == 1 else 5.0 for name in JOBS} | {"sequences": 6.0, "unit loads": 4.2}
    peak = dict.fromkeys(JOBS, 300.0) | {"histograms": 310.0}
    rows = dict(told(best, peak))
    assert rows["medium job, one event"] == "4.0 s, peak 300 MB"
    assert rows["medium job with sequences / without"] == "1.20 (+1.0 s, +0 MB)"
    assert rows["medium job with unit loads / without"] == "1.05 (+0.2 s, +0 MB)"
    assert rows["medium job with histograms / without"] == "1.00 (+0.0 s, +10 MB)"
    assert len(rows) == len(JOBS)
    assert set(WITHOUT.values()) < set(JOBS)
