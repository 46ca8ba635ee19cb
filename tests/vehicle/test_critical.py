"""Critical conicities and speeds against a second program, and crossings of margins whose zeros are known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import CaseError
from fatigue.vehicle.critical import conicity_crossings, crossings, speed_crossings, stable_ranges
from tests.vehicle_oracles import oracles, trailer

SETTINGS = ["hard", "soft", "long_wheelbase"]
NARROW = [[0.010085, 0.65706, "gains"], [0.013801, 0.90340, "loses"]]  # hard, 350 km/h; see below


def expected(setting, kind):
    """Crossings of the second program; it passed over a narrow stable window of ``hard`` at 350 km/h."""
    rows = {float(at): found for at, found in oracles("stability")["critical"]["settings"][setting][kind].items()}
    if (setting, kind) == ("hard", "conicity_crossings"):
        rows[350.0] = NARROW + rows[350.0]
    return rows


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("kind", ["conicity_crossings", "speed_crossings"])
def test_crossings_are_those_of_the_second_program(setting, kind):
    """Where stability is gained or lost, and at what frequency, within 1e-4."""
    over = conicity_crossings if kind == "conicity_crossings" else speed_crossings
    for at, rows in expected(setting, kind).items():
        found = over(trailer(setting), at)
        assert [crossing.change for crossing in found] == [change for _, _, change in rows]
        assert [crossing.at for crossing in found] == pytest.approx([value for value, _, _ in rows], rel=1e-4)
        assert [crossing.root.frequency_hz for crossing in found] == pytest.approx([hz for _, hz, _ in rows], rel=1e-4)


def test_the_window_that_a_coarse_scan_passes_over():
    """Hard at 350 km/h is stable from 0.0101 to 0.0138 too: the largest real part is -0.27 1/s at 0.012."""
    of = trailer()
    worst = {at: np.linalg.eigvals(of.state_matrix(350.0, at)).real.max() for at in (0.0100, 0.0120, 0.0140)}
    assert worst[0.0100] > 0.0
    assert worst[0.0120] == pytest.approx(-0.272, abs=0.001)
    assert worst[0.0140] > 0.0


def test_stable_ranges_between_crossings():
    """The reference: 0.0825 to 0.709, and the narrow window below."""
    found = conicity_crossings(trailer(), 350.0)
    ranges = stable_ranges(found, (0.01, 1.2), stable_at_first=False)
    assert np.array(ranges) == pytest.approx(np.array([[0.010085, 0.013801], [0.082522, 0.70876]]), rel=1e-4)
    assert stable_ranges(found[1:], (0.011, 1.2), stable_at_first=True)[0] == pytest.approx((0.011, 0.013801), rel=1e-4)
    assert stable_ranges([], (0.01, 1.2), stable_at_first=False) == []


zeros = st.lists(st.floats(0.05, 0.95), min_size=1, max_size=4, unique_by=lambda at: round(at * 12))


@given(zeros)
@settings(deadline=None, max_examples=60)
def test_zeros_of_a_polynomial_are_found(roots):
    """All zeros apart by at least a step of the grid, with what they change."""
    found = crossings(lambda x: float(np.prod(x - np.array(roots))), np.linspace(0.0, 1.0, 41))
    assert [at for at, _ in found] == pytest.approx(sorted(roots), abs=1e-6)
    sign = 1.0 if len(roots) % 2 == 0 else -1.0
    for _, change in found:
        sign = -sign
        assert change == ("loses" if sign > 0 else "gains")


@pytest.mark.parametrize("width", [0.4, 0.1, 0.01])
@pytest.mark.parametrize("middle", [0.013, 0.3, 0.4999, 0.62, 0.985])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_window_narrower_than_the_grid_is_found(width, middle, sign):
    """Two zeros within a step of the grid, wherever they lie in it."""
    step = 0.05
    half = 0.5 * width * step
    found = crossings(lambda x: sign * ((x - middle) ** 2 - half**2), np.linspace(0.0, 1.0, 21))
    assert [at for at, _ in found] == pytest.approx([middle - half, middle + half], abs=1e-6)
    assert [change for _, change in found] == (["gains", "loses"] if sign > 0 else ["loses", "gains"])


@pytest.mark.parametrize("slopes", [(1.0, 1.0), (0.1, 20.0), (20.0, 0.1)])
def test_a_window_between_two_roots_is_found(slopes):
    """One root falls slowly, another grows fast, or the reverse: the margin has a kink, not a vertex."""
    falls, grows = slopes
    found = crossings(lambda x: max(falls * (0.48 - x), grows * (x - 0.49)), np.linspace(0.0, 1.0, 21))
    assert [at for at, _ in found] == pytest.approx([0.48, 0.49], abs=1e-6)


def test_no_crossing_where_the_margin_keeps_its_sign():
    """A margin that only comes close to zero crosses nothing."""
    assert crossings(lambda x: (x - 0.5) ** 2 + 1e-6, np.linspace(0.0, 1.0, 12)) == []
    assert crossings(lambda x: -abs(x - 0.41) - 1e-6, np.linspace(0.0, 1.0, 12)) == []


def test_no_speed_has_no_crossings():
    """A vehicle at rest is refused in one line."""
    with pytest.raises(CaseError, match="0 km/h was asked for"):
        conicity_crossings(trailer(), 0.0)
