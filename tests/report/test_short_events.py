"""Bands of a point one of whose events is too short to have any."""

import pandas as pd
import pytest

from fatigue.report import figures
from fatigue.report.sections.why import Why, band_shares


def test_events_without_bands_stay_out_of_the_picture():
    """A two-sample event has one band without ends: it is no bar, and the others keep their shares."""
    attribution = pd.DataFrame(
        {
            "kind": ["band"] * 4,
            "event": ["noise"] * 3 + ["load"],
            "low_hz": [0.0, 5.0, 20.0, 0.0],
            "high_hz": [5.0, 20.0, None, None],
            "share": [0.2, 0.5, 0.2, 0.1],
        }
    )
    bands = band_shares(Why(**dict.fromkeys(Why.__dataclass_fields__, attribution)))
    assert bands["share"].tolist() == pytest.approx([0.2, 0.5, 0.2])
    assert len(figures.damage_by_band(bands).data[0].x) == 3
