"""Figures of a gauge: what is drawn is what is in the tables, aligned sides on each other, others apart."""

from types import SimpleNamespace

import numpy as np
import pytest

from fatigue.gauges.correlated.excerpts import Excerpt, aligned_excerpt, largest_excerpt
from fatigue.gauges.correlated.flag_rows import SpikeShown
from fatigue.gauges.correlated.numbers import side
from fatigue.gauges.correlated.page.figures import densities, exceedances, histories, spike_samples
from fatigue.gauges.correlated.sides import Strain
from fatigue.gauges.measured.alignment import Alignment

RATE = 100.0


def bumped(at, samples=3000):
    """A wave that is largest at one sample, and dies away within seconds of it."""
    t = (np.arange(samples) - at) / RATE
    return 5.0 * np.cos(2 * np.pi * 4.0 * t) * np.exp(-(t**2) / 0.5)


def one_side(x, segments=None):
    """A side of one record over 1 km."""
    return side([Strain(x, segments or ((0, len(x) - 1),))], "half", 1.0)


def test_an_excerpt_is_around_the_largest_cycle():
    """Its middle is time 0, the bump is in it, and it is no longer than ten seconds."""
    time, strain = largest_excerpt(one_side(bumped(1500)), RATE)
    assert strain.max() == pytest.approx(5.0)
    assert abs(time[strain.argmax()]) < 0.5
    assert 3.0 <= np.ptp(time) <= 10.0
    np.testing.assert_allclose(np.diff(time), 1 / RATE)


def test_an_excerpt_at_an_end_stays_in_the_record():
    """Nothing is drawn before the first or behind the last sample."""
    for at in (30, 2970):
        time, strain = largest_excerpt(one_side(bumped(at)), RATE)
        assert len(time) == len(strain) < 200
        assert strain.max() == pytest.approx(5.0)


def test_what_is_cut_is_not_drawn():
    """NaN breaks the line."""
    found = one_side(bumped(1500), ((0, 1600), (1620, 2999)))
    _, strain = largest_excerpt(found, RATE)
    assert np.isnan(strain).sum() == 19
    assert largest_excerpt(one_side(np.zeros(100)), RATE) is None


@pytest.mark.parametrize("shift", [-30, 0, 30])
def test_aligned_sides_lie_on_each_other(shift):
    """The measured one is moved back by its lag, to the time of the simulation."""
    measured, simulated = one_side(bumped(1500 + shift)), one_side(bumped(1500))
    at = Alignment(shift / RATE, shift, 1.0, 0.0, at_end=False)
    first, second = aligned_excerpt(measured, simulated, at, RATE)
    assert first.time[first.strain.argmax()] == pytest.approx(15.0)
    assert second.time[second.strain.argmax()] == pytest.approx(15.0)


def compared(alignment, excerpts):
    """What a figure needs of a comparison."""
    drawn = SimpleNamespace(
        excerpts=excerpts,
        frequency=np.array([0.0, 1.0, 2.0]),
        measured_density=np.array([0.0, 10.0, 0.0]),
        simulated_density=np.array([0.0, 1.0, 0.1]),
        level=np.array([1.0, 2.0]),
        measured_reached=np.array([100.0, 0.0]),
        simulated_reached=np.array([50.0, 5.0]),
    )
    return SimpleNamespace(alignment=alignment, drawn=drawn)


def test_sides_that_are_not_aligned_have_a_panel_each_on_one_scale():
    """Two places of two records are never drawn as one history."""
    both = [
        Excerpt(name, np.arange(3.0), np.array([0.0, size, -1.0])) for name, size in (("measured", 4), ("simulated", 2))
    ]
    apart = histories(compared(None, tuple(both))).plotly()
    assert [trace.yaxis for trace in apart.data] == ["y", "y2"]
    assert apart.layout.yaxis.range == apart.layout.yaxis2.range
    assert apart.layout.yaxis.range[1] > 4.0
    together = histories(compared("aligned", tuple(both))).plotly()
    assert {trace.yaxis for trace in together.data} <= {None, "y"}
    assert histories(compared(None, ())) is None


def test_density_and_exceedance_show_both_sides():
    """Nothing above 0 breaks the line of a logarithmic axis."""
    one = compared(None, ())
    power, cycles = densities(one).plotly(), exceedances(one).plotly()
    assert [trace.name for trace in power.data] == ["measured", "simulated"]
    assert power.data[0].x.tolist() == [1.0, 2.0]
    assert np.isnan(power.data[0].y[1])
    assert power.data[1].y.tolist() == pytest.approx([1.0, 0.1])
    assert cycles.data[1].x.tolist() == [50.0, 5.0]
    assert np.isnan(cycles.data[0].x[1])
    assert cycles.data[0].y.tolist() == [1.0, 2.0]


def test_every_spike_has_a_panel_with_its_samples():
    """The flagged sample stands out; a record may be called anything."""
    time = 10.0 + np.arange(5) / RATE
    marked = np.array([False, False, True, False, False])
    spike = SpikeShown("<b>r</b>.csv", time, np.array([0.0, 1, 9, 1, 0]), marked, 8.0)
    found = spike_samples([spike, spike, spike, spike]).plotly()
    assert len(found.data) == 8
    assert found.data[1].x == (10.02,)
    assert list(found.data[1].y) == [9.0]
    assert "<b>" not in found.data[0].hovertemplate
    assert found.layout.annotations[0].text == "10.020 s"
    assert spike_samples([]) is None
