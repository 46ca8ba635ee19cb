"""Figures of points on demand: those of the report where it has them, and of what it does not show."""

import numpy as np
import pandas as pd
import pytest

import fatigue
from fatigue.errors import DataError
from fatigue.point.drawn import FIGURES

OF_POINTS = [name for name in FIGURES if name not in {"lives", "weld"}]


@pytest.mark.parametrize("name", OF_POINTS)
@pytest.mark.parametrize("case", ["loop", "unit loads", "vertex", "corner"])
def test_figures_of_all_kinds_of_cases(results, name, case):
    """Sequences, unit loads, vertices, parts: at both faces."""
    result = fatigue.open_result(results(case))
    for surface in ("top", "bottom"):
        assert len(result.figure(name, "A", 2, surface=surface).data) > 0


@pytest.mark.parametrize("name", OF_POINTS)
def test_a_sequence_is_drawn_with_its_events_only(results, name):
    """By itself it is a difference of cycles."""
    with pytest.raises(DataError, match=r"'\(sequence 1\)' is a sequence of events"):
        fatigue.open_result(results("loop")).figure(name, "A", event="(sequence 1)")


def test_the_history_spans_what_was_counted(results):
    """Its envelope reaches from the smallest to the largest stress, constants included."""
    result = fatigue.open_result(results("unit loads"))
    drawn = result.figure("history", "A", 3, event="noise", surface="top").data[0].y
    stress = result.history("A", 3, event="noise")["structural_top_MPa"]
    assert (min(drawn), max(drawn)) == pytest.approx((stress.min(), stress.max()), rel=1e-5)


def test_the_event_is_the_one_with_the_most_damage(results):
    """Weighted with the mission, as ``governing_event`` of the point."""
    folder = results("plain")
    nodes = pd.read_parquet(folder / "nodes.parquet").query("weld == 'A' and order == 3 and surface == 'top'")
    drawn = fatigue.open_result(folder).figure("spectrum", "A", 3, surface="top")
    thick = [trace.name for trace in drawn.data if trace.line.width == 2 and trace.name]
    assert thick == [nodes["governing_event"].item()]


def test_classes_of_the_matrix_hold_every_cycle(results):
    """Counts in 1e6 km, as the logarithm is drawn."""
    result = fatigue.open_result(results("half"))
    counts = result.figure("rainflow", "A", 3, surface="top").data[0].z
    cycles = result.cycles("A", 3, surface="top")
    passes = result.events.set_index("event")["passes_per_km"]
    expected = 1e6 * (cycles["count"] * cycles["event"].map(passes)).sum()
    z = np.asarray(counts, dtype=float)
    floor = np.nanmin(z)  # decades below are drawn there
    assert 10.0 ** z[z > floor].ravel() @ np.ones((z > floor).sum()) == pytest.approx(expected, rel=1e-3)
