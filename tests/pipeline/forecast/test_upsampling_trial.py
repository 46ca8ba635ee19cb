"""What ``fatigue check`` says of the upsampling of an assessment."""

import pytest

from fatigue.assess import assess
from fatigue.check import check_case
from fatigue.pipeline.forecast import band_trial
from fatigue.results import read_provenance, upsampling_factors
from tests.small_case import small_case


@pytest.mark.parametrize(("read_at_most", "expected"), [(5e6, (1, 8, 1)), (0.0, (1, 1, 1))])
def test_factors_are_those_of_the_assessment(tmp_path, monkeypatch, read_at_most, expected):
    """Of all welds and events; events that are too long to be looked at are taken for ones like the longest."""
    monkeypatch.setattr(band_trial, "READ_AT_MOST", read_at_most)
    case = small_case(pairs=8)
    case.counting["upsample"] = "auto"
    path = case.write(tmp_path / "case")
    checked = check_case(path)
    assert checked.estimate.upsample == expected
    if read_at_most > 0.0:
        assert "upsampling       8 times 1 of 3 events" in checked.as_text()
        assess(path, tmp_path / "result", report=False)
        assert tuple(upsampling_factors(read_provenance(tmp_path / "result"))) == expected


def test_what_is_asked_for_is_foretold(tmp_path):
    """Without reading a record for it."""
    checked = check_case(small_case().write(tmp_path))
    assert checked.estimate.upsample == (1, 1, 1)
    assert "upsampling       none" in checked.as_text()
