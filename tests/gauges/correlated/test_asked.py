"""What a comparison takes from the case: band, event and its distance."""

import pytest

from fatigue.case import load_case
from fatigue.errors import CaseError, DataError
from fatigue.gauges.correlated.asked import Asked, band_of, event_named, km_of_pass
from tests.small_case import small_case


@pytest.mark.parametrize(
    ("rates", "top", "band"),
    [
        ([250.0, 500.0], 40.0, (0.0, 60.0)),
        ([250.0, 100.0], 40.0, (0.0, 40.0)),
        ([250.0], None, (0.0, 100.0)),
    ],
)
def test_the_band_ends_where_both_sides_and_the_modes_do(rates, top, band):
    """The lower of 0.4 of the slowest rate and 1.5 x the highest normal mode (measured_data 2.2)."""
    assert band_of(Asked(), rates, 60.0, top) == band


def test_a_band_that_is_asked_for_is_taken_up_to_half_the_slowest_rate():
    """Above it there is nothing to compare."""
    assert band_of(Asked(low_hz=0.5, high_hz=50.0), [250.0, 100.0], 60.0, 40.0) == (0.5, 50.0)
    with pytest.raises(DataError, match=r"50.1 Hz is above half the lower sampling rate, 50 Hz"):
        band_of(Asked(high_hz=50.1), [250.0, 100.0], 60.0, 40.0)
    with pytest.raises(DataError, match=r"has 7.5 lines of the shortest record, which lasts 1.5 s"):
        band_of(Asked(low_hz=1.0, high_hz=6.0), [250.0], 1.5, 40.0)
    assert band_of(Asked(low_hz=1.0, high_hz=6.0), [250.0], 1.6, 40.0) == (1.0, 6.0)


def test_the_distance_of_a_pass(tmp_path):
    """Its length, or speed times duration; both have to agree."""
    case = small_case()
    case.events[0] |= {"length_km": 0.3}
    loaded = load_case(case.write(tmp_path))
    sine, noise = (event_named(loaded, name) for name in ("sine", "noise"))
    assert km_of_pass(loaded, noise, 11.0) == pytest.approx(1.1)
    with pytest.raises(CaseError, match="is not speed_km_h"):
        km_of_pass(loaded, sine, 12.0)
