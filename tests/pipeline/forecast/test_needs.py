"""Memory, disk and time of a job follow from its size; how well is measured in the benchmarks."""

from dataclasses import replace
from pathlib import Path

import pytest

from fatigue.case import load_case
from fatigue.pipeline.forecast import spare
from fatigue.pipeline.forecast.needs import IMPORTS, MB, diagnosis_memory, job_needs, size_text
from fatigue.pipeline.forecast.size import AUTOMATIC, JobSize, job_size
from fatigue.pipeline.forecast.spare import shortage_warnings, spare_disk, spare_memory
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.body import read_body
from tests.small_case import small_case

SMALL = JobSize(
    modes=20,
    stations=1000,
    welds=30,
    samples=(15_000,) * 3,
    factors=(1,) * 3,
    share=0.0,
    has_knees=False,
    threads=2,
    report=True,
)


def test_a_small_job_takes_little_more_than_its_imports():
    """Some hundred MB, and less disk."""
    needs = job_needs(SMALL)
    assert IMPORTS < needs.memory < IMPORTS + 300 * MB
    assert needs.scratch < 20 * MB
    assert 1.0 < needs.seconds < 30.0


@pytest.mark.parametrize("samples", [20_000_000, 2_000_000_000])
def test_memory_does_not_grow_with_a_record(samples):
    """A record of any length is below its inputs and 500 MB; it goes to disk."""
    long = job_needs(replace(SMALL, modes=1, stations=24, welds=1, samples=(samples,), factors=(1,), threads=1))
    assert long.memory < IMPORTS + 4.0 * samples + 500 * MB
    assert long.memory < 1000 * MB
    assert long.scratch > 8.0 * samples


def test_upsampling_is_known():
    """Samples that are interpolated take scratch files and time, and at most a bounded memory."""
    plain, fine = job_needs(SMALL), job_needs(replace(SMALL, factors=(64,) * 3))
    assert fine.scratch >= 64 * 8 * 20 * 45_000
    assert fine.seconds > 2 * plain.seconds
    assert fine.memory < plain.memory + 500 * MB


def test_screening_is_known():
    """Bounds take copies of the records and save most of the counting."""
    large = replace(SMALL, stations=100_000)
    exact, screened = job_needs(large), job_needs(replace(large, share=0.1))
    assert large.is_single
    assert screened.seconds < 0.7 * exact.seconds


def test_threads_and_report_take_memory():
    """Each thread a group of welds and a record, the page what it shows."""
    eight = job_needs(replace(SMALL, threads=8))
    assert eight.memory > job_needs(SMALL).memory
    assert "threads than 8" in eight.memory_remedy
    assert job_needs(replace(SMALL, report=False)).memory <= job_needs(SMALL).memory


def test_size_of_a_case(tmp_path):
    """Stations, kept samples and factors of a case; a factor that is not known yet is assumed."""
    case = small_case()
    case.counting["upsample"] = "auto"
    body = read_body(load_case(case.write(tmp_path)), strict=False)
    plan, _ = mission_plan(body)
    size = job_size(body, plan, threads=3, share=0.1, report=False)
    assert (size.modes, size.welds, size.threads, size.share, size.report) == (3, 2, 3, 0.1, False)
    assert size.samples == tuple(one.samples for one in plan.passes)
    assert size.factors == (AUTOMATIC,) * 3
    assert job_size(body, plan, factors=(2, 2, 2)).counted == tuple(2 * n for n in size.samples)


def test_what_the_machine_lacks_is_told(tmp_path, monkeypatch):
    """One warning for memory and one for disk, with both numbers and what to do; none where there is enough."""
    needs = job_needs(replace(SMALL, factors=(8,) * 3))
    assert list(shortage_warnings(needs, tmp_path)) == []
    monkeypatch.setattr(spare, "spare_memory", lambda: 1e8)
    monkeypatch.setattr(spare, "spare_disk", lambda folder: 1e6)
    memory, disk = shortage_warnings(needs, tmp_path / "result")
    assert memory.code == "memory_short"
    assert size_text(needs.memory) in memory.what
    assert "100 MB are available" in memory.what
    assert disk.code == "disk_short"
    assert "1 MB are free" in disk.what
    assert "upsample less" in disk.remedy
    monkeypatch.setattr(spare, "spare_memory", lambda: None)
    monkeypatch.setattr(spare, "spare_disk", lambda folder: None)
    assert list(shortage_warnings(needs, tmp_path)) == []


def test_a_diagnosis_grows_with_the_longest_record_in_memory():
    """Hundreds of bytes a sample as far as records are held in memory; those on disk take the same however long."""

    def memory(samples):
        return diagnosis_memory(replace(SMALL, modes=1, samples=(100, samples), factors=(1, 1)))

    assert 100 * MB < memory(2_000_000) - memory(1_000_000) < 200 * MB
    assert memory(200_000_000) == memory(20_000_000) < 500 * MB


def test_what_is_spare(tmp_path, monkeypatch):
    """Disk of a folder that is not there yet is that of the folder above it; a limit of a container counts."""
    assert spare_disk(tmp_path / "a" / "b") == pytest.approx(spare_disk(tmp_path), rel=0.1)
    group = tmp_path / "group"
    group.mkdir()
    (group / "memory.max").write_text("3000000\n")
    (group / "memory.current").write_text("1500000\n")
    (group / "memory.stat").write_text("anon 1000000\nfile 500000\n")
    monkeypatch.setattr(spare, "_GROUP", group)
    assert spare_memory() == 2_000_000
    (group / "memory.max").write_text("max\n")
    assert spare_memory() is None or spare_memory() > 2_000_000
    monkeypatch.setattr(spare, "_GROUP", Path("/nowhere"))
    assert spare_memory() is None or spare_memory() > 2_000_000
