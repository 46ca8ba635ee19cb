"""Figures of an analysis graph show what its numbers say."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest

from fatigue.study.graph.asked import Asked
from fatigue.study.graph.asks import ASKS, asks_table
from fatigue.study.graph.figures.along import along_figure
from fatigue.study.graph.figures.colours import moved, palette
from fatigue.study.graph.figures.energy import energy_figure, that_cross
from fatigue.study.graph.figures.maps import APART, boundaries_figure, stability_figure
from fatigue.study.graph.figures.plane import plane_figure
from fatigue.study.graph.numbers import graph_numbers
from fatigue.study.graph.summary import Graph, ranges_of
from fatigue.study.graph.vehicle_graph import vehicle_graph
from fatigue.vehicle.definition import Vehicle
from tests.vehicle_bodies import rigid_body

ASKED = Asked(np.linspace(100.0, 600.0, 6), np.geomspace(0.02, 1.1, 12), (), ())


@pytest.fixture(scope="module")
def found():
    """Graph of the reference trailer with a rigid car body."""
    return vehicle_graph("hard", Vehicle(), rigid_body(), ASKED)


def traces(figure, **wanted):
    """Traces that have these properties."""
    return [t for t in figure.data if all(getattr(t, key) == value for key, value in wanted.items())]


def test_the_map_marks_every_crossing_and_names_what_hunts(found):
    """Crossings of all lines are circles, the run is a star, each unstable region has a name with its frequencies."""
    figure = stability_figure(found).plotly()
    points = traces(figure, type="scatter")
    circles = [x for trace in points if trace.marker.size == 7 for x in trace.x]
    assert len(circles) == sum(len(line.crossings) for line in found.lines) > 2
    (star,) = [trace for trace in points if trace.marker.symbol == "star"]
    assert (star.x[0], star.y[0]) == (350.0, 0.1)
    said = [note.text for note in figure.layout.annotations]
    assert any("car body hunts" in text for text in said)
    assert any("bogie hunting" in text for text in said)
    labels = [note for note in figure.layout.annotations if note.text.endswith(" Hz") and "<b>" not in note.text]
    wide, high = np.ptp(ASKED.speeds), np.ptp(np.log10(ASKED.conicities))
    places = [(note.x / wide, note.y / high) for note in labels]
    for i, (x, y) in enumerate(places):
        assert all(abs(x - a) > APART[0] or abs(y - b) > APART[1] for a, b in places[:i])


def test_red_bands_are_what_is_not_stable(found):
    """Bands and stable ranges together cover the line, once."""
    line = found.over_conicity[0]
    figure = along_figure(line, 0.1, palette(found.lines)).plotly()
    bands = [(shape.x0, shape.x1) for shape in figure.layout.shapes if shape.type == "rect"]
    pieces = sorted([*bands, *line.stable])
    assert pieces[0][0] == line.ends[0]
    assert pieces[-1][1] == line.ends[1]
    assert all(a[1] == b[0] for a, b in itertools.pairwise(pieces))


def test_coloured_are_the_roots_that_the_line_moves(found):
    """Hunting and sway have colours, pitch and bounce of the car body and equipment are grey; every root is drawn."""
    line = found.over_conicity[0]
    names = {locus.name for locus in moved(line)}
    assert any("hunting" in name for name in names)
    assert not any(word in name for name in names for word in ("pitch", "bounce", "converter", "transformer"))
    figure = plane_figure((line,), palette(found.lines)).plotly()
    (grey,) = traces(figure, name="roots that it leaves alone")
    drawn = np.isfinite(np.array(grey.x, dtype=float)).sum()
    coloured = sum(np.isfinite(np.array(t.x, dtype=float)).sum() for t in figure.data if t is not grey)
    assert drawn + coloured == sum(np.isfinite(locus.damping).sum() for locus in line.loci)


def test_energy_of_a_root_that_crosses_is_whole(found):
    """Shares of all bodies sum to one along the line; shown are the roots that pass zero damping."""
    line = found.over_conicity[0]
    loci = that_cross(line)
    assert {crossing.root.of.name for crossing in line.crossings} & {
        root.of.name for locus in loci for root in locus.roots if root is not None
    }
    figure = energy_figure(line, loci).plotly()
    for row in range(len(loci)):
        of = [t.y for t in figure.data if t.yaxis == f"y{'' if row == 0 else row + 1}"]
        assert np.nansum(of, axis=0) == pytest.approx(1.0, abs=1e-6)


def test_several_vehicles_are_one_figure_of_boundaries(found):
    """Each has its name in the legend, once."""
    figure = boundaries_figure([found, found]).plotly()
    assert [t.name for t in figure.data if t.showlegend] == ["hard", "hard"]


def test_what_the_paper_asks_has_a_cell_for_every_vehicle(found):
    """A sentence that the graph has no number for gets a dash."""
    table = asks_table(Graph((found,), {"hard": graph_numbers(found.vehicle, rigid_body())}))
    assert len(table.rows) == len(ASKS)
    assert all(row[-1].text for row in table.rows)
    assert table.rows[3][-1].text == "–"  # no line at a conicity of 0.06 was asked for


@pytest.mark.parametrize(
    ("stable", "said"),
    [
        ((), "nothing that was looked at"),
        (((0.01, 1.2),), "conicities 0.01 to 1.2, all that were looked at"),
        (((0.01, 0.0193), (0.0296, 0.566)), "conicities up to 0.0193 and 0.0296 to 0.566"),
        (((0.0825, 1.2),), "conicities from 0.0825 on"),
    ],
)
def test_ranges_are_said_in_words(stable, said):
    """An end of what was looked at is none of the vehicle."""
    line = SimpleNamespace(stable=stable, ends=(0.01, 1.2), along="conicity", crossings=())
    assert ranges_of(line) == said
    speeds = SimpleNamespace(stable=((60.0, 108.7),), ends=(60.0, 700.0), along="speed", crossings=())
    assert ranges_of(speeds) == "speeds up to 109 km/h"
