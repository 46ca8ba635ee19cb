"""Load spectra on the page, where there are any."""

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.life.load_spectrum import LoadCycles, from_to, range_mean, range_spectrum, uniform_edges, up_crossings
from fatigue.report import figures
from fatigue.report.page import report_page
from fatigue.report.result import read_result
from fatigue.report.sections.load_spectra import read_load_spectra, spectra_words
from tests.report.reading import Page, values
from tests.report.tiny_result import write_result

EVENTS = ("tangent", "curve", "(mission)", "(measured)")
RANGES, LEVELS = uniform_edges(0.0, 20.0, 8), uniform_edges(-10.0, 10.0, 8)


def cycles_of(scale):
    """Some cycles about zero and above it."""
    S = scale * np.array([2.0, 4.0, 8.0, 16.0, 20.0])
    mean = np.array([0.0, 1.0, -1.0, 0.5, 0.0])
    return LoadCycles(mean - 0.5 * S, mean + 0.5 * S, S, np.array([1000.0, 100.0, 10.0, 1.0, 0.5]))


def tables_of(key):
    """Rows of every table for one point."""
    found = {name: [] for name in ("spectrum", "range_mean", "from_to", "level_crossings", "equivalent")}
    for i, event in enumerate(EVENTS):
        cycles, own = cycles_of(1.0 - 0.1 * i), {**key, "event": event}
        of = range_spectrum(cycles, RANGES, 3.0)
        classes = {"lower_MPa": RANGES[:-1], "upper_MPa": RANGES[1:], "count_per_km": of.count}
        reached = {"exceedance_per_1e6_km": 1e6 * of.reached, "power_sum_per_km": of.power_sum, "max_MPa": of.largest}
        found["spectrum"].append(pd.DataFrame({**classes, **reached}).assign(**own))
        if event != "(measured)":
            for name, cells, (row, column), edges in (
                ("range_mean", range_mean(cycles, RANGES, LEVELS), ("range", "mean"), (RANGES, LEVELS)),
                ("from_to", from_to(cycles, LEVELS), ("from", "to"), (LEVELS, LEVELS)),
            ):
                sides = ((row, edges[0], cells.row), (column, edges[1], cells.column))
                place = {
                    f"{side}_{end}_MPa": e[at + (end == "upper")] for side, e, at in sides for end in ("lower", "upper")
                }
                found[name].append(pd.DataFrame({**place, "count_per_km": cells.count}).assign(**own))
            crossed = {"level_MPa": LEVELS, "up_crossings_per_km": up_crossings(cycles, LEVELS)}
            found["level_crossings"].append(pd.DataFrame(crossed).assign(**own))
        numbers = dict.fromkeys(("cycles_per_km", "passes_per_km", "max_range_MPa", "bending_ratio"), 1.0 + i)
        numbers |= {"exponent": 3.0, "equivalent_range_2e6_MPa": 30.0, "equivalent_amplitude_2e6_MPa": 15.0}
        numbers |= {"del_MPa": 5.0, "damage_per_km": 1e-9, "power_sum_per_km": 1.0}
        found["equivalent"].append(pd.DataFrame([{**own, **numbers, "del_reference": "1 Hz"}]))
    return {name: pd.concat(rows) for name, rows in found.items()}


@pytest.fixture(scope="module")
def listed(tmp_path_factory):
    """A result with load spectra of the worst point of its first weld."""
    folder = write_result(tmp_path_factory.mktemp("spectra"))
    nodes = pd.read_parquet(folder / "nodes.parquet")
    at = nodes[nodes["weld"] == "W1 bracket"].sort_values("damage_per_km").iloc[-1]
    for name, rows in tables_of(at[["weld", "part", "node", "order", "surface"]].to_dict()).items():
        rows.to_parquet(folder / f"{name}.parquet")
    return folder


@pytest.fixture(scope="module")
def listed_page(listed):
    """Its page."""
    return Page(report_page(listed))


def test_without_load_spectra_nothing_is_said_of_them(page, result_folder):
    """No empty headings."""
    assert read_load_spectra(result_folder, read_result(result_folder, 1, 100)) is None
    assert "Equivalent ranges" not in page.words
    assert spectra_words(None) == []


def test_the_page_shows_them_where_they_are(listed_page):
    """Of the weld whose worst point has them, and of no other."""
    shown = {name for name in listed_page.figures if "load-" in name or "crossings" in name}
    assert shown == {"weld-1-load-matrices", "weld-1-load-spectrum", "weld-1-crossings"}
    rows = listed_page.tables["weld-1-equivalent"]
    assert [row[0] for row in rows[1:]] == ["tangent", "curve", "mission", "measured"]
    assert "Equivalent ranges" in listed_page.words
    assert "Load spectra: chosen points" in listed_page.words


def test_exceedance_is_drawn_of_edges_and_of_the_largest_range(listed):
    """Mission first, its events, what was measured last; the line ends at the largest range."""
    spectrum = pd.read_parquet(listed / "spectrum.parquet")
    fig = figures.spectrum_exceedance(spectrum).plotly()
    assert [trace.name for trace in fig.data] == ["mission", "tangent", "curve", "measured"]
    mission = fig.data[0]
    x, y = values(mission.x), values(mission.y)
    cycles = cycles_of(0.8)
    np.testing.assert_allclose(x[:-1], [1e6 * cycles.count[cycles.range >= edge].sum() for edge in y[:-1]], rtol=1e-6)
    assert (y[0], y[-1]) == (2.5, 16.0)
    assert fig.layout.xaxis.type == fig.layout.yaxis.type == "log"


def test_matrices_hold_all_cycles(listed):
    """Both matrices of the mission, empty classes white."""
    frames = [pd.read_parquet(listed / f"{name}.parquet") for name in ("range_mean", "from_to")]
    fig = figures.class_matrices(*(frame[frame["event"] == "(mission)"] for frame in frames)).plotly()
    for trace in fig.data:
        z = np.asarray(trace.z, dtype=float)
        assert np.nansum(10.0**z) == pytest.approx(1e6 * 1111.5, rel=1e-3)
        assert np.isnan(z).any()


def test_crossings_are_drawn_where_there_are_any(listed):
    """A level that nothing crosses is none on a logarithmic axis."""
    fig = figures.crossings_by_level(pd.read_parquet(listed / "level_crossings.parquet"), ["tangent", "curve"]).plotly()
    assert [trace.name for trace in fig.data] == ["mission", "tangent", "curve"]
    assert all((values(trace.x) > 0.0).all() for trace in fig.data)
    assert fig.data[1].line.color == figures.event_colours(["tangent", "curve"])["tangent"]


def test_figures_refuse_other_tables(listed):
    """One line that names the missing columns."""
    with pytest.raises(DataError, match="lacks the columns"):
        figures.spectrum_exceedance(pd.read_parquet(listed / "level_crossings.parquet"))


def test_spectra_of_a_point_at_rest_are_drawn(listed):
    """An empty pair of axes."""
    spectrum = pd.read_parquet(listed / "spectrum.parquet").assign(
        count_per_km=0.0, exceedance_per_1e6_km=0.0, max_MPa=np.nan
    )
    assert not figures.spectrum_exceedance(spectrum).plotly().data
    crossings = pd.read_parquet(listed / "level_crossings.parquet").assign(up_crossings_per_km=0.0)
    assert not figures.crossings_by_level(crossings).plotly().data
