"""In which precision cycles are counted, by size alone."""

import json

import pytest

from fatigue.assess import assess
from fatigue.errors import CaseError
from fatigue.pipeline.mission.precision import LARGE_FROM, SINGLE_FROM, counts_single, is_large, stress_samples
from tests.small_case import small_case


def test_both_faces_and_all_events_count():
    """100 stations over events of 3000 and 2000 samples."""
    assert stress_samples(100, (3000, 2000)) == 1e6


@pytest.mark.parametrize(("precision", "more", "single"), [("auto", 0, False), ("auto", 1, True), ("double", 1, False)])
def test_single_precision_begins_above_its_limit(precision, more, single):
    """Exactly at the limit it is double, and whatever the size where it is asked for."""
    samples = int(SINGLE_FROM / 200) + more
    assert counts_single(100, (samples,), precision) is single
    assert not is_large(100, (samples,))


def test_large_jobs_are_far_larger():
    """A car with five events is not screened."""
    assert is_large(50_000, (int(LARGE_FROM / 1e5) + 1,))
    assert not is_large(8200, (40_000,) * 5)


def test_double_precision_is_had_for_the_asking(tmp_path, monkeypatch):
    """Whatever the size; it is another job, and the record says which."""
    monkeypatch.setattr("fatigue.pipeline.mission.precision.SINGLE_FROM", 0.0)
    case = small_case().write(tmp_path / "case")
    for precision, said in (("auto", "single, doubtful points in double"), ("double", "double")):
        assess(case, tmp_path / precision, precision=precision, report=False)
        record = json.loads((tmp_path / precision / "provenance.json").read_text())
        assert record["rules"]["precision"] == said
        assert record["rules"]["screening"]["share_of_limit"] == 0.0


def test_another_word_is_refused(tmp_path):
    """With the words there are."""
    with pytest.raises(CaseError, match="is no precision of counting"):
        assess(small_case().write(tmp_path / "case"), tmp_path / "result", precision="half")
