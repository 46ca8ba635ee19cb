"""Spectra whose moments and damage are known: flat bands, three published spectra, the narrow-band limit.

The literature gives damage in amplitudes, laws want ranges: a law ``N = C / a^k`` in amplitudes is ``2^k C`` in ranges.
"""

from collections.abc import Callable, Iterator
from dataclasses import astuple

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw
from fatigue.life.records.history import ModalHistory
from fatigue.spectrum.methods import (
    dirlik_damage_rate,
    dirlik_density,
    narrow_band_damage_rate,
    spectral_shape,
    tovo_benasciutti_damage_rate,
)
from fatigue.spectrum.moments import moment_matrices, point_moments, segment_spectra
from fatigue.verify.check import Check

Floats = NDArray[np.float64]
Method = tuple[str, Callable[[Floats, DamageLaw], Floats]]

DIRLIK: Method = ("Dirlik", dirlik_damage_rate)
TOVO: Method = ("Tovo-Benasciutti", tovo_benasciutti_damage_rate)
NARROW_BAND: Method = ("narrow band", narrow_band_damage_rate)
THESIS = "Dirlik 1985"
FLIFE = "FLife 2.3, in amplitudes"
NINE_DIGITS, EIGHT_DIGITS = 2e-9, 2e-8


def spectrum_checks() -> Iterator[Check]:
    """Checks of moments, bandwidth, Dirlik and Tovo-Benasciutti."""
    yield from _flat_band()
    yield from _three_spectra()
    yield from _bent_law()
    yield from _narrow_bands()
    yield from _sine()


def _straight(k: float, constant: float = 1.0) -> DamageLaw:
    """Law in ranges that is ``N = constant / a^k`` in amplitudes a."""
    return DamageLaw(np.array([k]), np.array([np.log(2**k * constant)]), np.array([]), 0.0)


def _moments(f: Floats, density: Floats) -> Floats:
    return np.array([[np.trapezoid(f**p * density, f)] for p in (0, 1, 2, 4)])


def _band(low: float, high: float, variance: float) -> Floats:
    """Exact moments of a flat band."""
    return np.array([[variance * (high ** (p + 1) - low ** (p + 1)) / ((p + 1) * (high - low))] for p in (0, 1, 2, 4)])


def _flat_band() -> Iterator[Check]:
    moments = _band(10.0, 40.0, 900.0)
    case = "flat 10 to 40 Hz, 30 MPa^2/Hz"
    shape = spectral_shape(moments)
    for quantity, unit, expected, found in (
        ("alpha_2", "-", 0.847629089, shape.alpha2),
        ("peaks", "1/s", 31.2135502, shape.peaks),
        ("crossings", "1/s", 26.4575131, shape.zero_crossings),
    ):
        yield Check("spectrum", case, quantity, unit, expected, float(found[0]), EIGHT_DIGITS, "closed form")
    values = (0.0959677952, 0.153053093, 0.750979112, 0.119959744, 0.571306063)
    for name, expected, found in zip(("D1", "D2", "D3", "Q", "R"), values, astuple(dirlik_density(shape)), strict=True):
        yield Check("spectrum", case, f"Dirlik {name}", "-", expected, float(found[0]), EIGHT_DIGITS, THESIS)
    law = _straight(3.0, 2.5e11)
    yield _rate(f"{case}, k = 3", DIRLIK, moments, law, 9.88375446e-6, EIGHT_DIGITS, THESIS)
    yield _rate(f"{case}, k = 3", NARROW_BAND, moments, law, 1.07437024e-5, EIGHT_DIGITS, "Rayleigh")


def _three_spectra() -> Iterator[Check]:
    f = np.linspace(8.0, 12.0, 4001)
    band = _moments(f, np.full_like(f, 25.0))
    f = np.arange(1000, 24001) / 1000
    two_bands = _moments(f, np.where(f <= 2, 64.0, np.where(f >= 20, 9.0, 0.0)))
    for case, moments, k, dirlik, tovo in (
        ("flat 8 to 12 Hz", band, 3.6, 2.30434273e5, 2.27752811e5),
        ("1 to 2 and 20 to 24 Hz", two_bands, 3.0, 2.41213744e4, 2.60257722e4),
        ("1 to 2 and 20 to 24 Hz", two_bands, 3.6, 1.27277418e5, 1.38850567e5),
        ("1 to 2 and 20 to 24 Hz", two_bands, 5.0, 7.89339425e6, 8.68765185e6),
    ):
        yield _rate(f"{case}, k = {k:g}", DIRLIK, moments, _straight(k), dirlik, EIGHT_DIGITS, FLIFE)
        yield _rate(f"{case}, k = {k:g}", TOVO, moments, _straight(k), tovo, EIGHT_DIGITS, FLIFE)


def _bent_law() -> Iterator[Check]:
    """Checks of three resonances on a law with a knee at an amplitude of 20 MPa, a range of 40 MPa."""
    f = np.arange(100, 40001) / 500
    density = sum(
        a / ((1 - (f / f0) ** 2) ** 2 + (2 * zeta * f / f0) ** 2)
        for f0, zeta, a in ((1.2, 0.20, 20.0), (9.3, 0.02, 0.40), (36.0, 0.015, 0.004))
    )
    moments = _moments(f, np.asarray(density))
    first = np.log(2.0**3)
    knee = np.array([40.0])
    bent = DamageLaw(np.array([3.0, 5.0]), np.array([first, first + 2 * np.log(40.0)]), knee, 0.0)
    cut = DamageLaw(np.array([3.0]), np.array([first]), np.array([]), 40.0)
    source = "adaptive quadrature of the density"
    for case, law, method, expected in (
        ("three resonances, slopes 3 and 5", bent, DIRLIK, 9.7165603156e4),
        ("three resonances, slope 3 and cut-off", cut, DIRLIK, 8.9306726205e4),
        ("three resonances, slope 3", _straight(3.0), DIRLIK, 1.0186808002e5),
        ("three resonances, slopes 3 and 5", bent, TOVO, 9.5216205417e4),
    ):
        yield _rate(case, method, moments, law, expected, NINE_DIGITS, source)


def _narrow_bands() -> Iterator[Check]:
    for width, expected in ((0.1, 0.99892762), (0.01, 0.99998917), (0.001, 0.99999989)):
        moments, law = _band(1 - width / 2, 1 + width / 2, 1.0), _straight(3.6)
        found = float(dirlik_damage_rate(moments, law)[0] / narrow_band_damage_rate(moments, law)[0])
        yield Check(
            "spectrum",
            f"flat band of width {width:g}",
            "Dirlik / narrow band",
            "-",
            expected,
            found,
            EIGHT_DIGITS,
            "closed form",
        )
    one = np.ones((4, 1))
    found = float(dirlik_damage_rate(one, _straight(2.0))[0])
    yield Check("spectrum", "all moments 1, k = 2", "Dirlik, E of a^2", "1/s", 2.0, found, 1e-9, "Rayleigh")


def _sine() -> Iterator[Check]:
    """Checks on a sine at 5 Hz in segments of 2 s: Hann spreads it over three bins, 1/6, 2/3, 1/6."""
    t = np.arange(4000) / 200
    history = ModalHistory("sine", np.array([1]), (3 * np.sin(2 * np.pi * 5 * t))[None], 1 / 200, 0.0)
    moments = point_moments(np.array([[2.0]]), moment_matrices(segment_spectra(history, 2.0, 80.0)))[:, 0]
    case, source = "6 sin(10 pi t), segments of 2 s", "closed form; Welch 1967"
    yield Check("spectrum", case, "m0", "MPa^2", 18.0, float(moments[0]), 1e-9, source)
    yield Check("spectrum", case, "m2 / m0", "Hz^2", 25 + 0.25 / 3, float(moments[2] / moments[0]), 1e-9, source)


def _rate(
    case: str, method: Method, moments: Floats, law: DamageLaw, expected: float, tolerance: float, source: str
) -> Check:
    name, damage_rate = method
    found = float(damage_rate(moments, law)[0])
    return Check("spectrum", case, f"{name}, damage", "1/s", expected, found, tolerance, source)
