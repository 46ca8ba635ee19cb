"""The numbers behind a verdict in closed form, and every limit of the rule on either side, for one made-up point."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fatigue.life.records.history import ModalHistory
from fatigue.spectrum.moments import segment_spectra
from fatigue.spectrum.trust import VERDICTS, judge, trust_matrices

K = 3.6
PERIOD_S, DURATION = 2.0, 400.0
EVEN = np.array([0.9, 1.1] * 4)  # variances of eight periods
COV = EVEN.std(ddof=1)  # so that the modulation index is 1
HISTORY = ModalHistory("e", np.array([1]), np.random.default_rng(0).normal(size=(1, 4096)), 1 / 128, 0.0)
BASE = trust_matrices(HISTORY, segment_spectra(HISTORY, 4.0, 50.0))
CROSSINGS, PEAKS = 8.0, 10.0
MOMENTS = np.array([[1.0], [0.9 * CROSSINGS], [CROSSINGS**2], [(CROSSINGS * PEAKS) ** 2]])


def found(variance=EVEN, cov=COV, slow=0.02, lines=0.0, k=K, period_s=PERIOD_S, top_mode_hz=36.0, **changes):
    """Judge a point whose variance takes these values, where ``cov`` is what chance makes of them."""
    forms = np.concatenate([variance, [np.mean(variance), cov * np.mean(variance)]]).astype(np.float32)[:, None]
    periods = replace(BASE.periods, rms=np.ones(1), forms=forms, periods=len(variance), period_s=period_s)
    one = np.ones((1, 1))
    record = replace(BASE.record, covariance=one, slow=slow * one, lines=lines * one)
    matrices = replace(BASE, record=record, periods=periods, duration=DURATION)
    known = {"dirlik_ratio": 1.0, "tb_ratio": 1.0, "kurtosis": 3.0, "top_cycle_share": 0.0, "samples_per_peak": 20.0}
    measured = {name: np.array([float(value)]) for name, value in (known | changes).items()}
    return judge(np.ones((1, 1)), MOMENTS, matrices, slope=k, top_mode_hz=top_mode_hz, **measured)


def verdict(**changes):
    """Name the verdict."""
    return VERDICTS[found(**changes).verdict[0]]


def test_scatter_of_variance_and_damage():
    """B_s = 1 / (period cov^2); the damage scatters by k/2 times 1 / sqrt(T B_s), less where the variance is steady."""
    of = found()
    bandwidth = 1.0 / (PERIOD_S * COV**2)
    scatter = 1.0 / math.sqrt(DURATION * bandwidth)
    assert of.modulation_index[0] == pytest.approx(1.0, rel=1e-6)
    assert of.bandwidth_hz[0] == pytest.approx(bandwidth, rel=1e-5)
    assert of.relative_bandwidth[0] == pytest.approx(bandwidth / CROSSINGS, rel=1e-5)
    assert of.damage_cov[0] == pytest.approx(0.5 * K * scatter, rel=1e-5)
    assert found(k=5.0).damage_cov[0] == pytest.approx(2.5 * scatter, rel=1e-5)
    assert found(cov=COV / 0.5).damage_cov[0] == pytest.approx(0.5 * K * scatter / 0.5, rel=1e-5)  # as by chance
    assert found(cov=COV / 0.3).damage_cov[0] == pytest.approx(0.5 * K * scatter, rel=1e-5)  # steadier than by chance
    assert 0.3 < of.modulation_low[0] < 0.5
    assert of.modulation_high[0] >= 1.4
    many = found(variance=np.tile(EVEN, 100), cov=np.tile(EVEN, 100).std(ddof=1))
    assert (many.modulation_low[0], many.modulation_high[0]) == (0.6, 1.4)


def test_kurtosis_to_be_expected():
    """A modulated Gaussian record: 3 (1 + cov^2 of its variance), over what chance makes of that; 0.5 off at least."""
    of = found()
    assert of.expected_kurtosis[0] == pytest.approx(3 * (1 + EVEN.var()) / (1 + COV**2), rel=1e-6)
    assert of.kurtosis_tolerance[0] == 0.5
    wide = found(cov=16 * COV)
    scatter = math.sqrt(PERIOD_S * (16 * COV) ** 2 / DURATION)
    assert wide.kurtosis_tolerance[0] == pytest.approx(2.6 * math.sqrt(8.0) * scatter, rel=1e-5)
    assert wide.kurtosis_tolerance[0] > 0.5


def test_factor_of_modulation():
    """Mean of v^(k/2) of the periods, over 1 + (k/2)(k/2 - 1)/2 cov^2, which chance makes."""
    v = np.array([0.25, 1.75] * 4)
    expected = np.mean(v ** (K / 2)) / (1 + 0.5 * (K / 2) * (K / 2 - 1) * COV**2)
    assert found(variance=v).modulation_factor[0] == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("k", [3.0, 3.6, 5.0])
def test_share_of_the_largest_cycle_by_chance(k):
    """(ln N + 4.6)^(k/2) / (N Gamma(1 + k/2)) of N cycles that do the damage; modulated, fewer of them do it."""
    of = found(k=k)
    assert of.top_cycle_limit[0] == 0.10  # hundreds of cycles: the least limit
    busy = found(variance=np.array([0.001] * 7 + [7.993]), k=k)
    share = np.array([0.001] * 7 + [7.993]) ** (k / 2)
    from fatigue.spectrum.methods import dirlik_over_narrow_band, spectral_shape  # noqa: PLC0415

    per_second = CROSSINGS * dirlik_over_narrow_band(spectral_shape(MOMENTS), k)[0]
    cycles = per_second * DURATION * share.mean() ** 2 / np.mean(share**2)
    by_chance = (math.log(cycles) + 4.6) ** (k / 2) / (cycles * math.gamma(1 + k / 2))
    assert busy.top_cycle_limit[0] == pytest.approx(min(max(by_chance, 0.10), 0.50), rel=1e-4)


def test_band_of_agreement():
    """The band of the slope, wider by what the scatter of the damage does to the ratio: exp(1.645 x 0.5 cov)."""
    of = found()
    chance = math.exp(1.645 * 0.5 * of.damage_cov[0])
    assert (of.ratio_low[0], of.ratio_high[0]) == pytest.approx((0.80 / chance, 1.25 * chance))
    unknown = math.exp(1.645 * 0.5 * 2 * 0.25)
    matrices = replace(BASE, periods=None)
    nothing = {name: np.array([1.0]) for name in ("dirlik_ratio", "tb_ratio", "kurtosis", "samples_per_peak")}
    short = judge(np.ones((1, 1)), MOMENTS, matrices, slope=K, top_mode_hz=None, top_cycle_share=np.zeros(1), **nothing)
    assert (short.ratio_low[0], short.ratio_high[0]) == pytest.approx((0.80 / unknown, 1.25 * unknown))
    assert short.record_too_short[0]


def test_shares_of_the_variance():
    """Slow part and tones over the whole variance; what a tone takes from the damage belongs to its share."""
    of = found(slow=0.125, lines=0.5)
    assert (of.slow_share[0], of.line_share[0]) == (0.125, 0.5)
    assert found(lines=1.5).line_share[0] == 1.0  # the taper of a whole record may make more of a tone than there is
    assert of.peaks_over_top_mode[0] == pytest.approx(PEAKS / 36.0)
    assert of.alpha2[0] == pytest.approx(CROSSINGS / PEAKS)


STEADY = {"cov": COV / 0.3}  # modulation index 0.3
INDEX = {"variance": 1.0 + 3.0 * (EVEN - 1.0)}  # ... 3, that is 0.7 and 1.3 of the mean in variance


@pytest.mark.parametrize(
    ("inside", "outside", "name"),
    [
        ({"samples_per_peak": 6.0}, {"samples_per_peak": 5.999}, "sampling"),
        ({"top_mode_hz": PEAKS / 2.99}, {"top_mode_hz": PEAKS / 3.01}, "sampling"),
        ({"slow": 0.1999}, {"slow": 0.2001}, "quasi_static"),
        ({"top_cycle_share": 0.0999}, {"top_cycle_share": 0.1001}, "single_event"),
        ({"kurtosis": 3.46}, {"kurtosis": 3.56}, "non_gaussian"),
        ({"kurtosis": 2.54}, {"kurtosis": 2.44}, "non_gaussian"),
        ({"dirlik_ratio": 1.262}, {"dirlik_ratio": 1.266}, "bandwidth"),
        ({"dirlik_ratio": 0.793}, {"dirlik_ratio": 0.789}, "bandwidth"),
        ({"cov": COV / 0.79 * 1.02, "lines": 0.299}, {"cov": COV / 0.79 * 1.02, "lines": 0.301}, "harmonic"),
        ({"cov": COV / 0.81, "lines": 0.5}, {"cov": COV / 0.79, "lines": 0.5}, "harmonic"),
    ],
)
def test_each_limit_on_either_side(inside, outside, name):
    """One number crosses its limit, all others stay sound."""
    assert verdict(**inside) == "valid"
    assert verdict(**outside) == name


def test_modulation_must_matter_and_explain_the_peaks():
    """Three times the scatter that chance makes matters where it adds 10 % of damage and a quarter of the peaks."""
    of = found(**INDEX, kurtosis=3.45)
    assert of.modulation_index[0] > of.modulation_high[0]
    assert of.modulation_factor[0] < 1.1
    assert VERDICTS[of.verdict[0]] == "valid"
    strong = {"variance": 1.0 + 8.0 * (EVEN - 1.0)}
    expected = found(**strong).expected_kurtosis[0]
    assert found(**strong).modulation_factor[0] > 1.1
    assert verdict(**strong, kurtosis=expected) == "non_stationary"
    assert verdict(**strong, kurtosis=3 + (expected - 3) / 0.26) == "non_stationary"
    assert verdict(**strong, kurtosis=3 + (expected - 3) / 0.24) == "non_gaussian"


def test_steady_is_a_tone_only_where_it_is_narrow():
    """An index of 0.3 at a bandwidth below 0.2 of the crossings; as steady, but wide, it is a lucky record."""
    below, above = (1.0 / (limit * CROSSINGS * STEADY["cov"] ** 2) for limit in (0.19, 0.21))
    assert found(**STEADY).modulation_index[0] < found(**STEADY).modulation_low[0]
    assert verdict(**STEADY, period_s=above) == "valid"
    assert verdict(**STEADY, period_s=below) == "harmonic"
    assert verdict(cov=COV / 0.5, period_s=below) == "valid"  # chance makes that, too


def test_a_number_that_could_not_be_had_accuses_nobody():
    """NaN of any input but the ratio leaves the verdict to the others; without a ratio nothing is assessed."""
    for name in ("kurtosis", "top_cycle_share", "samples_per_peak"):
        assert verdict(**{name: np.nan}) == "valid"
    assert verdict(dirlik_ratio=np.nan) == "not_assessed"
    assert verdict(dirlik_ratio=np.inf) == "not_assessed"
    assert verdict(top_mode_hz=None) == "valid"
