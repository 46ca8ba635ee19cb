"""The upper frequency of the spectra on the page: by the rule of the assessment."""

from types import SimpleNamespace

import pytest

from fatigue.report.sections.point.detail import upper_hz


@pytest.mark.parametrize(
    ("hertz", "kinds", "given", "expected"),
    [
        ([5.0, 12.0, 60.0], ["normal", "normal", "interface"], None, 18.0),
        ([1e-4, 5e-4], ["normal", "normal"], None, 80.0),  # rigid-body modes under the name of normal ones
        ([60.0], ["interface"], None, 80.0),
        ([12.0], ["normal"], 33.0, 33.0),
    ],
)
def test_upper_frequency(hertz, kinds, given, expected):
    """As given; else the lower of 0.4 of the sampling rate and 1.5 times the highest mode that vibrates."""
    record = {"modes": {"frequency_hz": hertz, "kind": kinds}}
    inputs = SimpleNamespace(case=SimpleNamespace(spectrum=SimpleNamespace(upper_hz=given)))
    assert upper_hz(record, inputs, 0.005) == pytest.approx(expected)
