"""The figures as functions of tables: what they draw is what the tables say."""

from itertools import pairwise

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.life.curves import DamageLaw, catalogue, damage_law
from fatigue.life.rule import cycle_damage
from fatigue.report import figures
from fatigue.report.figures.cycles import cumulative
from fatigue.report.figures.lines import _end_zones, _unrolled
from fatigue.report.figures.records import _thinned
from fatigue.report.figures.style import life_axis, life_scale
from fatigue.report.stress import Envelope, Excerpt, StressSpectrum
from fatigue.spectrum.methods import dirlik_damage_rate


@pytest.fixture(scope="module")
def nodes(result_folder):
    """Table of nodes of the small result."""
    return pd.read_parquet(result_folder / "nodes.parquet")


@pytest.fixture(scope="module")
def cycles(result_folder):
    """Cycles of one point."""
    table = pd.read_parquet(result_folder / "cycles.parquet")
    return table[table["weld"] == "W1 bracket"]


def test_the_upload_button_is_off_wherever_figures_are_shown():
    """One configuration for all: nothing is sent anywhere, no advertisement."""
    assert figures.CONFIG["showSendToCloud"] is False
    assert figures.CONFIG["displaylogo"] is False


def test_all_figures_have_one_look(nodes, cycles, result_folder):
    """Every function returns a figure that carries the common template."""
    welds = pd.read_parquet(result_folder / "welds.parquet")
    stations = figures.worst_faces(nodes)
    rows = figures.line_rows(stations, frozenset())
    made = [
        figures.weld_lives(welds, 1e7),
        figures.weld_strips(nodes, 1e7),
        figures.along_weld(nodes[nodes["weld"] == "W1 bracket"], 1e7),
        figures.time_against_frequency(nodes.assign(kurtosis=3.0)),
        figures.ratio_histogram(nodes),
        figures.exceedance(cycles, {"tangent": 1.0, "curve": 2.0}),
        figures.scene(stations, rows, 1e7),
        figures.projections(stations, rows, 1e7),
    ]
    for fig in made:
        assert fig.layout["template"] is figures.TEMPLATE
        assert fig.plotly().layout.template.layout.font.family == figures.TEMPLATE["layout"]["font"]["family"]


def test_exceedance_of_the_mission_is_the_sum_of_its_events(cycles):
    """At the smallest range all cycles of 1e6 km are reached."""
    passes = {"tangent": 2.0, "curve": 3.0}
    fig = figures.exceedance(cycles, passes).plotly()
    total = 1e6 * (cycles["event"].map(passes) * cycles["count"]).sum()
    assert max(fig.data[0].x) == pytest.approx(total, rel=1e-6)
    assert sum(max(trace.x) for trace in fig.data[1:]) == pytest.approx(total, rel=1e-6)
    assert fig.data[0].y[0] == pytest.approx(cycles["range_MPa"].max(), rel=1e-6)


@settings(deadline=None, max_examples=50)
@given(st.lists(st.tuples(st.floats(0.01, 1e3), st.floats(0.5, 1e6)), min_size=1, max_size=300))
def test_exceedance_never_rises_with_the_range(pairs):
    """More cycles reach smaller ranges, and the last step holds all of them."""
    ranges, counts = (np.array(column) for column in zip(*pairs, strict=True))
    x, y = cumulative(ranges, counts)
    assert (np.diff(x) >= 0).all()
    assert (np.diff(y) <= 0).all()
    assert x[-1] == pytest.approx(counts.sum())
    assert y[0] <= ranges.max()


def test_matrices_hold_all_cycles_and_all_damage(cycles):
    """Counts sum to the cycles in 1e6 km within the decades shown, shares of the damage to 100 %."""
    per_km = cycles["count"].to_numpy()
    fig = figures.rainflow_matrices(cycles, per_km).plotly()
    counts, shares = (10.0 ** np.asarray(trace.z, dtype=float) for trace in fig.data)
    assert np.nansum(counts) == pytest.approx(1e6 * per_km.sum(), rel=1e-5)
    assert np.nansum(shares) == pytest.approx(100.0, rel=1e-2)


def test_the_spectrum_lies_on_the_curves_of_the_catalogue(cycles):
    """The drawn curve fails after the cycles of the law, and the marks reach the number of all cycles."""
    curve = catalogue()["master-aluminium"]
    laws = {level: damage_law(curve, level, "none", 1e7) for level in ("mean", "mean-2sigma")}
    per_target = np.full(len(cycles), 1e5)
    fig = figures.sn_with_spectrum(cycles, per_target, laws, "mean-2sigma", "MPa").plotly()
    line = next(trace for trace in fig.data if trace.name == "mean-2sigma, used")
    expected = 1.0 / cycle_damage(np.asarray(line.y, dtype=float), laws["mean-2sigma"])
    np.testing.assert_allclose(line.x, expected, rtol=1e-5)
    spectrum = fig.data[-1]
    assert max(spectrum.x) <= per_target.sum()
    assert np.nansum(spectrum.marker.color) == pytest.approx(100.0, rel=1e-5)


def test_a_curve_with_cutoff_ends_there(cycles):
    """Below the cut-off nothing fails, so nothing is drawn."""
    law = damage_law(catalogue()["master-aluminium"], "mean-2sigma", "cutoff", 1e7)
    fig = figures.sn_with_spectrum(cycles, np.ones(len(cycles)), {"mean-2sigma": law}, "mean-2sigma", "MPa").plotly()
    x, y = (np.asarray(values, dtype=float) for values in (fig.data[0].x, fig.data[0].y))
    assert np.isnan(x[y < law.cutoff]).all()
    assert np.nanmax(x) <= 1e7 * 1.0001


def test_strips_show_the_shortest_life_of_each_cell(nodes):
    """The worst point of a weld is never lost between cells."""
    fig = figures.weld_strips(nodes, 1e7).plotly()
    shortest = nodes.groupby("weld")["life_km"].min().sort_values()
    np.testing.assert_allclose(10.0 ** np.min(np.asarray(fig.data[0].z, dtype=float), axis=1), shortest, rtol=1e-5)


def test_life_axes_reach_the_target_and_say_when_they_end():
    """The target is within the axis; lives beyond 1e12 km give a tick that says so."""
    plain = life_axis("life [km]", [1e5, 1e6], 1e9)
    assert plain["range"][1] >= 9
    assert "> 1e12" not in plain["ticktext"]
    assert "> 1e12" in life_axis("life [km]", [1e5, np.inf], 1e9)["ticktext"]
    assert np.isfinite(life_axis("life [km]", [np.inf], 1e7)["range"]).all()


def test_one_colour_scale_of_lives():
    """It depends on the target only, so that all figures of a report share it."""
    assert (life_scale(1.2e7)["cmin"], life_scale(1.2e7)["cmax"]) == (6, 11)


def test_parts_of_a_weld_follow_each_other():
    """Arc length goes on from part to part with a gap, and lines are not joined across it."""
    top = pd.DataFrame({"arc_length_mm": [0.0, 10.0, 20.0, 0.0, 30.0], "part": [1, 1, 1, 2, 2]})
    place, breaks = _unrolled(top)
    np.testing.assert_allclose(place, [0.0, 10.0, 20.0, 21.5, 51.5])
    np.testing.assert_array_equal(breaks, [3])


def test_end_zones_cover_the_treated_nodes():
    """Half an edge beyond the last treated node, and not beyond the end of the line."""
    zones = _end_zones(np.array([True, True, False, False, True]), np.array([0.0, 5.0, 15.0, 25.0, 30.0]))
    assert zones == [(0.0, 10.0), (27.5, 30.0)]


def test_corners_and_parts_are_drawn(nodes):
    """A weld of two parts has a corner mark for each flagged station and a gap between the parts."""
    weld = nodes[nodes["weld"] == "W1 bracket"].copy()
    weld["part"] = np.where(weld["order"] <= 3, 1, 2)
    weld["at_corner"] = weld["order"].isin([3, 4])
    fig = figures.along_weld(weld, 1e7).plotly()
    uprights = [shape for shape in fig.layout.shapes if shape.type == "line" and shape.x0 == shape.x1]
    assert len(uprights) == 2
    assert np.isnan(fig.data[0].y[3])


def test_spectra_keep_their_peaks_when_thinned():
    """The largest value survives at its own frequency."""
    x = np.linspace(0.25, 500.0, 20_000)
    y = np.ones_like(x)
    y[12_345] = 7.0
    thin_x, thin_y = _thinned(x, y)
    assert len(thin_x) <= 400
    assert thin_y.max() == 7.0
    assert thin_x[thin_y.argmax()] == x[12_345]


def test_a_spectrum_that_does_not_vary_is_drawn():
    """A point without stress has a flat spectrum and no error."""
    flat = StressSpectrum("run", np.array([0.0, 1.0, 2.0]), np.zeros(3))
    fig = figures.stress_spectrum([flat], {"run": "#000000"}, {}, "run").plotly()
    assert np.isfinite(fig.layout.yaxis.range).all()


def test_history_marks_both_reversals():
    """A cycle whose instants are far apart has a close-up around each."""
    time = np.linspace(0.0, 1.0, 11)
    excerpts = [Excerpt((t,), time + t, np.sin(time + t), {1: np.cos(time)}) for t in (0.0, 5.0)]
    envelope = Envelope("run", np.array([0.0, 1.0]), np.array([-1.0, -2.0]), np.array([1.0, 2.0]))
    fig = figures.stress_history(envelope, excerpts, {1: "mode 1"}, "#000000").plotly()
    marks = [trace for trace in fig.data if trace.name == "reversals of the cycle"]
    assert [len(trace.x) for trace in marks] == [1, 1]
    assert sum(shape.type == "rect" for shape in fig.layout.shapes) == 2


def test_cycles_close_by_have_a_panel_each():
    """One excerpt, or two side by side where the reversals are far apart; no panel overlaps the next."""
    time = np.linspace(0.0, 1.0, 11)
    excerpts = [Excerpt((t,), time + t, np.sin(time + t), {1: np.cos(time)}) for t in (0.0, 5.0)]
    near = Excerpt((0.2, 0.4), time, np.sin(time), {1: np.cos(time)})
    fig = figures.cycles_close_by([excerpts, [near]], ["first: 2 MPa", "second: 1 MPa"], {1: "mode 1"}).plotly()
    domains = [fig.layout[name].domain for name in ("xaxis", "xaxis2", "xaxis3")]
    assert domains[0][0] == 0.0
    assert domains[-1][1] == pytest.approx(1.0)
    assert all(a[1] < b[0] for a, b in pairwise(domains))
    assert [note.text for note in fig.layout.annotations] == ["first: 2 MPa", "second: 1 MPa"]
    marks = [trace for trace in fig.data if trace.name == "reversals of the cycle"]
    assert [len(trace.x) for trace in marks] == [1, 1, 2]
    assert sum(bool(trace.showlegend) for trace in fig.data) == 3


def test_a_point_is_marked_on_its_line(result_folder):
    """At its arc length and life, and by an upright line through all panels."""
    nodes = pd.read_parquet(result_folder / "nodes.parquet")
    points = nodes[nodes["weld"] == nodes["weld"].iloc[0]]
    row = points[points["surface"] == "bottom"].iloc[1]
    fig = figures.along_weld(points, 1e7, marked=(row["part"], row["order"], "bottom")).plotly()
    (mark,) = [trace for trace in fig.data if trace.name == "this point, bottom face"]
    assert mark.x[0] == row["arc_length_mm"]
    assert mark.y[0] == min(row["life_km"], 1e12)
    assert any(shape.type == "line" and shape.x0 == shape.x1 == row["arc_length_mm"] for shape in fig.layout.shapes)


def test_damage_by_method_is_a_share_of_what_was_counted():
    """Bars add up to the last group; an event without a spectrum is left out."""
    columns = ("damage_per_pass", "damage_same_ratio_per_pass", "damage_dirlik_per_pass", "damage_tb_per_pass")
    rows = [("fast", 1e-6, 2e-6, 1e-6, 3e-6), ("slow", 3e-6, 2e-6, 5e-6, 1e-6), ("load", 9e-6, np.nan, np.nan, np.nan)]
    table, passes_per_km = pd.DataFrame(rows, columns=["event", *columns]), {"fast": 2.0, "slow": 1.0, "load": 1.0}
    with pytest.raises(DataError, match="passes_per_km: there is none for event 'load'"):
        figures.damage_by_method(table, {"fast": 2.0, "slow": 1.0})
    fig = figures.damage_by_method(table, passes_per_km).plotly()
    bars = {trace.name: trace.y for trace in fig.data}
    assert list(fig.data[0].x) == ["fast", "slow", "together"]
    assert bars["rainflow"].tolist() == pytest.approx([0.4, 0.6, 1.0])
    assert bars["Dirlik"].tolist() == pytest.approx([0.4, 1.0, 1.4])
    assert list(figures.damage_by_method(table, passes_per_km, most=1).plotly().data[0].x) == ["slow"]


@pytest.mark.parametrize("bandwidth", [(9.0, 11.0), (2.0, 40.0)])
def test_ranges_that_a_spectrum_expects(bandwidth):
    """They are as many as Dirlik's damage has on a slope: the k-th moment of the ranges that are drawn."""
    low, high = bandwidth
    moments = np.array([30 * (high**n - low**n) / n for n in (1, 2, 3, 5)])
    cycles = pd.DataFrame({"range_MPa": [12.0 * np.sqrt(moments[0])], "count": [1.0]})
    fig = figures.ranges_by_method(cycles, moments, 1e4).plotly()
    line = next(trace for trace in fig.data if trace.name == "Dirlik")
    ranges, reached = np.asarray(line.y, dtype=float), np.asarray(line.x, dtype=float)
    power_sum = np.trapezoid(3.0 * ranges**2 * reached, ranges)  # sum n S^3 = integral of 3 S^2 N(> S)
    law = DamageLaw(np.array([3.0]), np.array([0.0]), np.array([]), 0.0)
    assert power_sum == pytest.approx(1e4 * dirlik_damage_rate(moments[:, None], law)[0], rel=1e-3)
    narrow = next(trace for trace in fig.data if trace.name == "narrow band")
    assert max(narrow.x) == pytest.approx(1e4 * np.sqrt(moments[2] / moments[0]), rel=1e-6)


def test_of_many_points_those_that_disagree_are_drawn():
    """All that are off by more than a factor of 2, or not to be trusted, before any that agree."""
    n = 5000
    ratio = np.ones(n)
    ratio[::50] = 3.0
    verdict = np.full(n, "valid", dtype=object)
    verdict[7::100] = "harmonic"
    table = pd.DataFrame(
        {"life_km_same_ratio": 1e7, "life_km_dirlik": 1e7, "dirlik_ratio": ratio, "dirlik_verdict": verdict}
    )
    drawn = figures.drawn_points(table, most=400)
    assert drawn.sum() == 400
    assert drawn[::50].all()
    assert drawn[7::100].all()
    assert figures.drawn_points(table, most=n).all()


def test_events_beyond_the_palette_are_one_bar():
    """Leading events keep their colour, the rest is summed; every row sums to 1."""
    events = [f"event {i}" for i in range(12)]
    shares = pd.DataFrame(np.random.default_rng(3).dirichlet(np.ones(12), size=4), columns=events)
    fig = figures.damage_by_event(["a", "b", "c", "d"], shares, dict.fromkeys(events, "8 % of km")).plotly()
    assert fig.data[-1].name == "6 other events"
    np.testing.assert_allclose(np.sum([trace.x for trace in fig.data], axis=0), 1.0, rtol=1e-6)


def test_outline_of_a_box_is_its_edges():
    """Twelve sharp edges of a cube of flat faces are kept, the diagonals of its subdivision are not."""
    grid = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    faces = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    split = [face for a, b, c, d in faces for face in ((a, b, c, -1), (a, c, d, -1))]
    body = figures.body_outline(np.arange(1, 9), grid, np.array(split) + 1)
    assert len(body.edge) == 12
    assert len(body.triangle) == 12
    np.testing.assert_allclose(np.linalg.norm(np.diff(body.xyz[body.edge], axis=1), axis=2), 1.0)
    quads = figures.body_outline(np.arange(1, 9), grid, np.array(faces) + 1)
    assert (len(quads.edge), len(quads.triangle)) == (12, 12)


def test_a_flat_scene_stays_in_view(nodes):
    """Weld lines in one plane give axes of a positive length in every direction, true to scale."""
    stations = figures.worst_faces(nodes)
    space = figures.scene(stations, figures.line_rows(stations, frozenset()), 1e7).plotly().layout.scene
    extent = np.array([np.ptp(space[axis].range) for axis in ("xaxis", "yaxis", "zaxis")])
    ratio = np.array([space.aspectratio[axis] for axis in "xyz"])
    assert (extent > 0.0).all()
    np.testing.assert_allclose(extent / ratio, extent[0] / ratio[0])


def test_a_closed_line_is_drawn_closed(nodes):
    """The first station comes again at the end of its line, then a gap."""
    stations = figures.worst_faces(nodes)
    rows = figures.line_rows(stations, frozenset({"W1 bracket"}))
    np.testing.assert_array_equal(rows[:8], [0, 1, 2, 3, 4, 5, 0, -1])
    assert len(stations) == 12


def test_the_worse_toe_face_stands_for_its_station(nodes):
    """A face without a toe does not count, however short its life."""
    one_toe = nodes.assign(toe=nodes["surface"] == "bottom")
    assert set(figures.worst_faces(one_toe)["surface"]) == {"bottom"}
    assert set(figures.worst_faces(nodes)["surface"]) == {"top"}


def test_negative_shares_are_shown_as_such():
    """A mode that relieves has a bar to the left and room for its number."""
    fig = figures.shares(["a", "b"], np.array([1.02, -0.02]), "share [%]").plotly()
    assert fig.layout.xaxis.range[0] < -0.02
    assert list(fig.data[0].text) == ["102.0 %", "−2.00 %"]


def test_bands_without_end_are_drawn():
    """The open band above the last edge and the one from 0 Hz have a place on a logarithmic axis."""
    bands = pd.DataFrame({"low_hz": [0.0, 1.0, 10.0], "high_hz": [1.0, 10.0, np.nan], "share": [0.1, 1.0, -0.1]})
    fig = figures.damage_by_band(bands, modes=[8.5]).plotly()
    assert (np.asarray(fig.data[0].x) > 0.0).all()
    assert fig.data[0].customdata[2] == "above 10 Hz"
    assert figures.bands_of_welds(["W1"], np.array([[0.1, 1.0, -0.1]]), bands).plotly().data[0].z.shape == (1, 3)


@pytest.mark.parametrize(("start", "unit"), [([0.0, 0.1], "km"), ([np.nan, np.nan], "s")])
def test_places_on_the_track(start, unit):
    """Distance where the event has one, else time."""
    track = pd.DataFrame(
        {
            "start_km": start,
            "end_km": np.array(start) + 0.1,
            "start_s": [0.0, 1.0],
            "end_s": [1.0, 2.0],
            "share": [0.2, 0.8],
            "intensity": [0.4, 1.6],
        }
    )
    fig = figures.damage_on_track(track).plotly()
    assert f"[{unit}]" in fig.layout.xaxis.title.text
    np.testing.assert_allclose(fig.data[0].y, [0.4, 1.6], rtol=1e-6)
