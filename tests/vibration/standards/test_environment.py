"""Vibration of equipment beside a table of limits: the shipped one, closed forms, a user's own file."""

import copy
import tomllib
from pathlib import Path

import numpy as np
import pytest
from scipy import signal

from fatigue.errors import DataError
from fatigue.vibration.standards import environment_file
from fatigue.vibration.standards.environment import PEAK_OF_RMS, band_rms, density_ratios, third_octaves
from fatigue.vibration.standards.environment_file import shipped_table, vibration_table

TEXT = Path(environment_file.__file__).with_name("environment.toml").read_text("utf-8")
SHAPE = shipped_table().classes["1A"].shape


def test_the_density_of_category_1_integrates_to_33_89():
    """+6 dB per octave from 2 to 5 Hz, flat to 20 Hz, -6 dB to 150 Hz: rms^2 = 33.89 ASD."""
    assert SHAPE.integral(2.0, 150.0) == pytest.approx(33.89, abs=5e-3)
    assert SHAPE.integral(0.0, 1000.0) == SHAPE.integral(2.0, 150.0)
    assert SHAPE.integral(5.0, 20.0) == pytest.approx(15.0)
    f = np.geomspace(2.0, 150.0, 200_001)
    density = np.where(f < 5, (f / 5) ** 2, np.where(f < 20, 1.0, (20 / f) ** 2))
    assert SHAPE.integral(2.0, 150.0) == pytest.approx(np.trapezoid(density, f), rel=1e-6)


def test_densities_and_rms_of_the_shipped_table_agree():
    """Every functional rms of category 1 is that of its density within 1 %; long life is 5.66 times, 3.78 on axles."""
    for name, category in shipped_table().classes.items():
        for direction, rms in category.functional_rms.items():
            if category.shape is not None:
                density = category.functional_asd[direction]
                assert np.sqrt(density * category.shape.integral(2.0, 150.0)) == pytest.approx(rms, rel=0.0105)
            factor = 3.78 if name == "3" else 5.66
            assert category.long_life_rms[direction] / rms == pytest.approx(factor, rel=5e-3)


def test_the_peaks_of_the_source_beside_the_table():
    """1.4 g lateral and 1.7 g vertical: 37 and 22 times the functional rms of 1A, above 3 long-life rms."""
    category = shipped_table().classes["1A"]
    assert 13.7 / category.functional_rms["y"] == pytest.approx(37.0, abs=0.1)
    assert 16.7 / category.functional_rms["z"] == pytest.approx(22.3, abs=0.1)
    assert [PEAK_OF_RMS * category.long_life_rms[d] for d in "yz"] == pytest.approx([6.27, 12.75])
    assert category.shock == {"x": 50.0, "y": 30.0, "z": 30.0}


def test_the_table_says_its_edition_and_its_status():
    """The table of 2010 is superseded and recalled; categories 2 and 3 have no shape, density or shock here."""
    table = shipped_table()
    assert table.edition == "IEC 61373:2010, superseded by an edition of 2025"
    assert table.status == "recalled"
    assert [c.name for c in table.classes.values() if c.shape is None] == ["2", "3"]
    assert not any(table.classes[name].functional_asd or table.classes[name].shock for name in ("2", "3"))


def test_the_band_follows_the_mass():
    """5 to 150 Hz up to 500 kg, 2 to 60 Hz from 1250 kg on, in between 2 and 60 Hz times 1250 / m: no jump."""
    assert SHAPE.band(None) == SHAPE.band(500.0) == (5.0, 150.0)
    assert SHAPE.band(500.0001) == pytest.approx((5.0, 150.0), rel=1e-6)
    assert SHAPE.band(1000.0) == pytest.approx((2.5, 75.0))
    assert SHAPE.band(1250.0) == SHAPE.band(6600.0) == (2.0, 60.0)


def test_the_rms_of_a_band():
    """A sine counts where it is inside; the mean never does; a band beyond half the sampling rate has none."""
    t = np.arange(30 * 250) / 250
    values = 2.0 + np.sqrt(2) * (3.0 * np.cos(2 * np.pi * 9.2 * t) + 4.0 * np.cos(2 * np.pi * 80.0 * t))
    assert band_rms(values, 1 / 250, (2.0, 60.0)) == pytest.approx(3.0, rel=5e-3)
    assert band_rms(values, 1 / 250, (5.0, 100.0)) == pytest.approx(5.0, rel=5e-3)
    assert np.isnan(band_rms(values, 1 / 250, (5.0, 150.0)))


def test_the_rms_of_a_band_is_that_of_welch():
    """Stationary noise, by segments of 4 s with a Hann window."""
    values = signal.lfilter([1.0], [1.0, -0.6], np.random.default_rng(7).standard_normal(60_000))
    f, density = signal.welch(values, 250.0, nperseg=1000)
    inside = (f >= 2.0) & (f <= 60.0)
    by_segments = np.sqrt(np.trapezoid(density[inside], f[inside]))
    assert band_rms(values, 1 / 250, (2.0, 60.0)) == pytest.approx(by_segments, rel=0.01)


def test_third_octaves_of_a_band():
    """Preferred frequencies, 2 Hz and 63 Hz included where the band begins and ends with half of them."""
    assert third_octaves(2.0, 60.0).round(1).tolist() == [
        2.0, 2.5, 3.2, 4.0, 5.0, 6.3, 7.9, 10.0, 12.6, 15.8, 20.0, 25.1, 31.6, 39.8, 50.1,
    ]  # fmt: skip


def test_vibration_of_the_density_of_the_table_has_a_ratio_of_one():
    """Noise shaped like category 1 at 4 times its level: ratio 4 in every third octave, and 2 times its rms."""
    rng, n, rate = np.random.default_rng(8), 600_000, 500.0
    f = np.fft.rfftfreq(n, 1 / rate)
    density = 4 * 0.0166 * np.where(f < 5, (f / 5) ** 2, np.where(f < 20, 1.0, (20 / np.maximum(f, 1)) ** 2))
    density[(f < 2) | (f > 150)] = 0.0
    spectrum = np.sqrt(density * rate * n / 4) * (rng.standard_normal(f.size) + 1j * rng.standard_normal(f.size))
    values = np.fft.irfft(spectrum, n)
    centres, ratios, coarse = density_ratios(values, 1 / rate, SHAPE, 0.0166, (2.0, 150.0))
    assert ratios == pytest.approx(np.full(centres.size, 4.0), rel=0.2)
    assert coarse.size == 0
    assert band_rms(values, 1 / rate, (2.0, 150.0)) == pytest.approx(2 * 0.75, rel=0.02)


def test_a_short_record_does_not_resolve_low_third_octaves():
    """Five seconds: a third octave counts from 1 Hz of width on, and the others are named."""
    _, _, coarse = density_ratios(np.ones(1250), 1 / 250, SHAPE, 0.0166, (2.0, 60.0))
    assert coarse.round(1).tolist() == [2.0, 2.5, 3.2, 4.0]


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (("edition",), None, r"own.toml: edition: the key is missing\. Give the edition of the table"),
        (("status",), "  ", r"own.toml: status: '  ' is no text"),
        (("editon",), "2025", r"own.toml: editon: unknown key 'editon'\. Write 'edition'"),
        (("class",), {}, r"own.toml: class: the table has no class"),
        (("class",), 3, r"own.toml: class: it is no table of tables"),
        (("class", "1A", "rms"), 3, r"own.toml: class.1A: rms: unknown key 'rms'"),
        (("class", "1A", "what"), 3, r"own.toml: class.1A.what: 3 is no text"),
        (("class", "1A", "shape"), "category 2", r"no shape 'category 2'\. Give one of the table \('category 1'\)"),
        (("class", "1A", "functional_rms_m_s2"), None, r"class.1A.functional_rms_m_s2: the key is missing"),
        (("class", "1A", "shock_m_s2"), 30.0, r"class.1A.shock_m_s2: 30.0 is no table"),
        (("class", "1A", "shock_m_s2", "w"), 30.0, r"class.1A.shock_m_s2: w: unknown key 'w'"),
        (("class", "1A", "shock_m_s2", "x"), -1.0, r"class.1A.shock_m_s2.x: -1.0 is no number above 0"),
        (("class", "1A", "shock_m_s2", "x"), float("nan"), r"shock_m_s2.x: nan is no number above 0"),
        (("class", "1A", "shock_m_s2", "x"), True, r"shock_m_s2.x: True is no number above 0"),
        (("shape", "category 1", "light_kg"), None, r"shape.category 1.light_kg: the key is missing"),
        (("shape", "category 1", "light_kg"), "500", r"shape.category 1.light_kg: '500' is no number above 0"),
        (("shape", "category 1", "edges_hz"), [2.0, 20.0, 5.0, 150.0], r"edges_hz: .* each above the one before"),
        (("shape", "category 1", "heavy_hz"), [2.0, 60.0, 90.0], r"heavy_hz: .* no list of two frequencies"),
        (("shape", "category 1", "exponents"), [2.0, 0.0], r"exponents: .* one fewer than edges_hz"),
    ],
)  # fmt: skip
def test_mistakes_in_a_table_of_your_own(path, value, message):
    """Each is refused by its place, its value and what to do."""
    data = copy.deepcopy(tomllib.loads(TEXT))
    table = data
    for key in path[:-1]:
        table = table[key]
    table[path[-1]] = value
    if value is None:
        del table[path[-1]]
    with pytest.raises(DataError, match=message):
        vibration_table(data, "own.toml")


def test_all_mistakes_of_a_table_are_told_at_once():
    """Four of them."""
    with pytest.raises(DataError) as refused:
        vibration_table({"limits": 3, "edition": 2025}, "own.toml")
    assert len(refused.value.problems) == 5


def test_a_table_of_your_own_may_be_small():
    """One class with one functional rms: what is not in the table is empty."""
    table = vibration_table(
        {"edition": "2025", "status": "compared", "source": "x", "class": {"1A": {"functional_rms_m_s2": {"y": 0.4}}}},
        "own.toml",
    )
    assert table.classes["1A"].functional_rms == {"y": 0.4}
    assert table.classes["1A"].shape is None
