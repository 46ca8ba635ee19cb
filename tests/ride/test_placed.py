"""Parts of an event between instants: whatever the stretches are, every instant is in one part."""

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fatigue.ride.placed import edges_of, inside

INSTANTS = st.integers(0, 12)  # few, so that stretches touch and overlap
SPANS = st.lists(st.tuples(INSTANTS, INSTANTS).map(sorted).map(tuple), max_size=3)


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])  # of a busy machine
@given(st.lists(SPANS, max_size=3), st.lists(INSTANTS, min_size=1, max_size=8))
def test_an_instant_is_inside_where_its_part_is(of_channels, instants):
    """From the start of a stretch on, up to its end; also where stretches of several channels overlap."""
    edges = edges_of(of_channels)
    part = np.searchsorted(edges, np.array(instants), side="right")
    for spans in of_channels:
        expected = [any(start <= instant < end for start, end in spans) for instant in instants]
        assert inside(spans, edges)[part].tolist() == expected


def test_without_stretches_there_is_one_part():
    """And nothing is inside."""
    assert edges_of([[], []]).size == 0
    assert inside([], np.zeros(0)).tolist() == [False]
