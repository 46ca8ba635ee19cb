"""FLife 2.3 (Zorman, Slavic, Boltezar, 2023), an independent implementation, on spectra and on a time history."""

import numpy as np
import pytest

from fatigue.life.records.history import ModalHistory
from fatigue.spectrum.methods import (
    dirlik_damage_rate,
    narrow_band_damage_rate,
    tovo_benasciutti_damage_rate,
)
from fatigue.spectrum.moments import moment_matrices, point_moments, segment_spectra
from tests.naive_spectrum import modal_spectrum, moments_of, narrow_spectrum, straight_law, two_band_spectrum

flife = pytest.importorskip("FLife")

CONSTANT = 1e15  # FLife's C is of amplitudes: N = C / amplitude**k


def theirs(data, k):
    """Ask FLife for damage per second: Dirlik, Tovo-Benasciutti 2, narrow band."""
    return (
        1 / flife.Dirlik(data).get_life(C=CONSTANT, k=k),
        1 / flife.TovoBenasciutti(data).get_life(C=CONSTANT, k=k, method="method 2"),
        1 / flife.Narrowband(data).get_life(C=CONSTANT, k=k),
    )


def ours(moments, k):
    """Compute damage per second on the same curve written in ranges."""
    law = straight_law(k, 2**k * CONSTANT)
    return tuple(
        method(moments, law)[0]
        for method in (dirlik_damage_rate, tovo_benasciutti_damage_rate, narrow_band_damage_rate)
    )


@pytest.mark.parametrize("k", [3.0, 3.6, 5.0, 7.3])
@pytest.mark.parametrize("spectrum", [narrow_spectrum, two_band_spectrum, modal_spectrum])
def test_same_damage_from_a_spectrum(spectrum, k):
    """Three reference spectra."""
    f, density = spectrum()
    data = flife.SpectralData(input={"PSD": density, "f": f})
    np.testing.assert_allclose(ours(moments_of((f, density)), k), theirs(data, k), rtol=1e-9)


def test_same_damage_from_a_history():
    """A stress history of three modes: our moment matrices against FLife's own Welch estimate."""
    rng = np.random.default_rng(5)
    step, segment = 1 / 256, 1024
    q = np.cumsum(rng.normal(size=(3, 20000)), axis=1)
    q -= np.linspace(0, 1, 20000) * q[:, -1:]
    shape = np.array([[0.3, -1.0, 0.7]])
    record = ModalHistory("event", np.arange(3), q, step, 0.0)
    matrices = moment_matrices(segment_spectra(record, segment * step, 0.5 / step))
    data = flife.SpectralData(input={"time_history": shape[0] @ q, "dt": step}, nperseg=segment)
    np.testing.assert_allclose(ours(point_moments(shape, matrices), 3.6), theirs(data, 3.6), rtol=1e-9)
