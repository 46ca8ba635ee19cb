"""The spectral methods of the recount against a published value and the narrow band."""

import numpy as np
import pytest

from fatigue.verify.recount.anew.curve import curve_named
from fatigue.verify.recount.anew.spectral import dirlik, tovo_benasciutti


def test_spectral_methods():
    """Flat band from 10 to 40 Hz: the published Dirlik value; no stress, no damage; a sine is narrow band."""
    moments = np.array([30.0 * (40.0 ** (p + 1) - 10.0 ** (p + 1)) / (p + 1) for p in (0, 1, 2, 4)])
    own = {"slopes": [3.0], "range_at_2e6_MPa": (2**3 * 2.5e11 / 2e6) ** (1 / 3), "applies": "structural"}
    curve = curve_named("own", {"curve": {"name": "own"}, "curves": {"own": own}}, {})
    assert dirlik(moments, curve) == pytest.approx(9.88375446e-6, rel=1e-8)
    assert dirlik(np.zeros(4), curve) == tovo_benasciutti(np.zeros(4), curve) == 0.0
    narrow = dirlik(np.ones(4), curve)
    assert narrow == tovo_benasciutti(np.ones(4), curve) == curve.mean_damage(np.sqrt(8.0), 2.0)
