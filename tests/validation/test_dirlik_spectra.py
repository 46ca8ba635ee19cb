"""Cycle damage of three reference spectra, k = 3, 3.6 and 5, against closed forms evaluated independently.

Flat 8-12 Hz (P1), two bands 1-2 and 20-24 Hz (P2), three modes (P3). Values: sum of amplitude**k per second, computed
with FLife 2.3 and by separate closed forms; a law in ranges gives 2**k times as much. Bent laws: adaptive quadrature of
the densities of Dirlik (1985) and Benasciutti and Tovo (2005).
"""

import numpy as np
import pytest

from fatigue.spectrum.methods import (
    dirlik_damage_rate,
    dirlik_density,
    narrow_band_damage_rate,
    spectral_shape,
    tovo_benasciutti_damage_rate,
)
from tests.naive_spectrum import (
    bent_law,
    modal_spectrum,
    moments_of,
    narrow_spectrum,
    straight_law,
    two_band_spectrum,
)

SLOPES = (3.0, 3.6, 5.0)


@pytest.mark.parametrize(
    ("spectrum", "moments", "alphas", "coefficients"),
    [
        (
            narrow_spectrum,
            (100.0, 1000.0, 10133.333350, 1080320.010133),
            (0.993399, 0.974936),
            (0.018457, 0.056601, 0.924941, 0.023072, 0.877258),
        ),
        (
            two_band_spectrum,
            (100.036500, 888.154000, 17623.261350, 8573840.529621),
            (0.668907, 0.601754),
            (0.059334, 0.799229, 0.141437, 0.074167, 0.571547),
        ),
    ],
)
def test_moments_and_coefficients(spectrum, moments, alphas, coefficients):
    """Moments, bandwidth parameters and Dirlik's five coefficients."""
    computed = moments_of(spectrum())
    np.testing.assert_allclose(computed[:, 0], moments, rtol=1e-9)
    shape = spectral_shape(computed)
    density = dirlik_density(shape)
    np.testing.assert_allclose((shape.alpha1[0], shape.alpha2[0]), alphas, atol=6e-7)
    found = [c[0] for c in (density.d1, density.d2, density.d3, density.q, density.r)]
    np.testing.assert_allclose(found, coefficients, atol=6e-7)


@pytest.mark.parametrize(
    ("spectrum", "method", "amplitude_sums"),
    [
        (narrow_spectrum, narrow_band_damage_rate, (3.78492570e4, 2.33954460e5, 1.89246285e7)),
        (narrow_spectrum, dirlik_damage_rate, (3.73918726e4, 2.30434273e5, 1.85250156e7)),
        (narrow_spectrum, tovo_benasciutti_damage_rate, (3.70716416e4, 2.27752811e5, 1.81662590e7)),
        (two_band_spectrum, narrow_band_damage_rate, (4.99324439e4, 3.08677049e5, 2.49753346e7)),
        (two_band_spectrum, dirlik_damage_rate, (2.41213744e4, 1.27277418e5, 7.89339425e6)),
        (two_band_spectrum, tovo_benasciutti_damage_rate, (2.60257722e4, 1.38850567e5, 8.68765185e6)),
    ],
)
def test_damage_of_the_reference_spectra(spectrum, method, amplitude_sums):
    """All digits of the table, and the 2**k between amplitude and range."""
    moments = moments_of(spectrum())
    for k, expected in zip(SLOPES, amplitude_sums, strict=True):
        assert method(moments, straight_law(k))[0] == pytest.approx(2**k * expected, rel=3e-9)


@pytest.mark.parametrize(
    ("method", "slopes", "cutoff", "expected"),
    [
        (dirlik_damage_rate, [3.0, 5.0], 0.0, 9.7165603156e4),
        (dirlik_damage_rate, [3.0], 40.0, 8.9306726205e4),
        (dirlik_damage_rate, [3.0], 0.0, 1.0186808002e5),
        (tovo_benasciutti_damage_rate, [3.0, 5.0], 0.0, 9.5216205417e4),
    ],
)
def test_bent_laws_on_the_modal_spectrum(method, slopes, cutoff, expected):
    """Knee or cut-off at an amplitude of 20, a range of 40, on three modes."""
    law = bent_law(slopes, [40.0] * (len(slopes) - 1), 8.0, cutoff)  # C in ranges is 2**3 times that in amplitudes
    assert method(moments_of(modal_spectrum()), law)[0] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    ("method", "amplitude_sums"),
    [
        (narrow_band_damage_rate, (2.17080376, 3.37050159, 10.85401882)),
        (dirlik_damage_rate, (1.73862875, 2.61415679, 8.04970285)),
        (tovo_benasciutti_damage_rate, (1.75093552, 2.58685498, 7.58837689)),
    ],
)
def test_white_noise_up_to_one_hertz(method, amplitude_sums):
    """Exact moments 1, 1/2, 1/3, 1/5: alpha1 = sqrt(3)/2, alpha2 = sqrt(5)/3."""
    moments = np.array([[1.0], [1 / 2], [1 / 3], [1 / 5]])
    shape = spectral_shape(moments)
    assert shape.alpha1[0] == pytest.approx(np.sqrt(3) / 2)
    assert shape.alpha2[0] == pytest.approx(np.sqrt(5) / 3)
    for k, expected in zip(SLOPES, amplitude_sums, strict=True):
        assert method(moments, straight_law(k))[0] == pytest.approx(2**k * expected, rel=5e-9)


@pytest.mark.parametrize(("width", "ratio"), [(0.1, 0.99892762), (0.01, 0.99998917), (0.001, 0.99999989)])
def test_dirlik_tends_to_the_narrow_band(width, ratio):
    """Flat band of relative width w at 1 Hz, k = 3.6."""
    low, high = 1 - width / 2, 1 + width / 2
    moments = np.array([[(high ** (p + 1) - low ** (p + 1)) / (p + 1) / width] for p in (0, 1, 2, 4)])
    law = straight_law(3.6)
    found = dirlik_damage_rate(moments, law)[0] / narrow_band_damage_rate(moments, law)[0]
    assert found == pytest.approx(ratio, abs=1e-8)


def test_flat_band_from_10_to_40_hz():
    """30 MPa^2/Hz over 10 to 40 Hz with exact moments; N = 2.5e11 / amplitude^3."""
    moments = np.array([[900.0], [22500.0], [630000.0], [613.8e6]])
    shape = spectral_shape(moments)
    density = dirlik_density(shape)
    found = [shape.alpha2, shape.peaks, shape.zero_crossings, density.d1, density.d2, density.d3, density.r, density.q]
    np.testing.assert_allclose(
        [value[0] for value in found],
        [
            0.847629089,
            31.2135502,
            26.4575131,
            0.0959677952,
            0.153053093,
            0.750979112,
            0.571306063,
            0.119959744,
        ],
        rtol=2e-8,
    )
    law = straight_law(3.0, 2**3 * 2.5e11)
    assert dirlik_damage_rate(moments, law)[0] == pytest.approx(9.88375446e-6, rel=1e-8)
    assert narrow_band_damage_rate(moments, law)[0] == pytest.approx(1.07437024e-5, rel=1e-8)
    assert tovo_benasciutti_damage_rate(moments, law)[0] == pytest.approx(9.6596e-6, rel=1e-4)
