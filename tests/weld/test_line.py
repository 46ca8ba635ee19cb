"""A weld line and a stack of them: what is put in comes out."""

from dataclasses import fields as fields_of
from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.weld.line import stacked
from fatigue.weld.line_geometry import arc_length, length, lengths
from tests.weld_lines import lines, ring, straight

SMOOTH = straight([10.0] * 6)


def assert_same_line(found, line):
    """Compare all that a line says."""
    for name in (part.name for part in fields_of(line) if part.init):
        np.testing.assert_array_equal(getattr(found, name), getattr(line, name))


@given(st.lists(lines(), min_size=1, max_size=4))
@settings(deadline=None, max_examples=20)
def test_lines_are_cut_out_as_they_were_put_in(some):
    """One by one, and as a stack of neighbours that knows nothing of the others."""
    some = [*some, replace(SMOOTH, corner_start=True), ring(9, end_length=0.0)]
    stack = stacked(some)
    arc_length(stack)  # what is kept of the whole does not pass to a part
    for i, line in enumerate(stack):
        assert_same_line(line, some[i])
    end = stack.lines(slice(len(some) - 2, None))
    assert len(end) == 2
    for i, line in enumerate(end):
        assert_same_line(line, some[i - 2])
    np.testing.assert_allclose(arc_length(end), np.concatenate([arc_length(line) for line in some[-2:]]), atol=1e-12)
    np.testing.assert_allclose(lengths(end), [length(line) for line in some[-2:]], rtol=1e-14)
