"""Lines in a stack: company changes nothing for any of them."""

from dataclasses import fields as fields_of
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.weld.edge_type import edge_type_warnings, jumpy_lines
from fatigue.weld.line import stacked
from fatigue.weld.line_check import check_line, line_warnings, unfit_lines, warned_lines
from fatigue.weld.line_load import line_load, line_load_matrix
from fatigue.weld.structural_stress import assess_line, line_stress
from tests.weld_lines import fields, lines, ring, straight

SMOOTH = straight([10.0] * 6)
STACKS = st.lists(lines(), min_size=1, max_size=4)


@given(STACKS)
@settings(deadline=None, max_examples=20)
def test_stress_of_a_stack(some):
    """Rings and open lines, linear and parabolic ones: solved together they have the stress each has alone."""
    some = [*some, SMOOTH, replace(SMOOTH, corner_start=True), ring(9)]
    nodal = [fields(line, 3, 6, seed=i) for i, line in enumerate(some)]
    stack = stacked(some)
    found = line_stress(stack, line_load(stack, np.concatenate(nodal)))
    for line, force, a, b in zip(some, nodal, stack.begin, stack.begin[1:], strict=False):
        alone = assess_line(line, force)
        for name in ("at_end", "at_corner", "summed_corner", "unresolved"):
            np.testing.assert_array_equal(getattr(found, name)[a:b], getattr(alone, name))
        for kind in ("raw", "treated"):
            for part in fields_of(alone.raw):
                value = getattr(getattr(alone, kind), part.name)
                scale = np.abs(value).max()
                together = getattr(getattr(found, kind), part.name)[a:b]
                np.testing.assert_allclose(together, value, atol=1e-12 * scale)


def spoilt(line, name, at, value):
    """Replace a value of one node."""
    values = getattr(line, name).copy()
    values[at] = value
    return replace(line, **{name: values})


BAD = [
    spoilt(SMOOTH, "thickness", 2, 0.0),
    spoilt(SMOOTH, "node", 6, 101),
    spoilt(SMOOTH, "edge_mid", 0, True),
    spoilt(SMOOTH, "edge_mid", slice(None), True),
    spoilt(SMOOTH, "xyz", 3, SMOOTH.xyz[2]),
    spoilt(SMOOTH, "xyz", 3, np.nan),
    spoilt(SMOOTH, "xyz", 6, SMOOTH.xyz[4]),
    spoilt(SMOOTH, "normal", 1, 0.0),
    spoilt(SMOOTH, "normal", 1, [1.0, 0, 0]),
    spoilt(SMOOTH, "outward", 3, [0.0, -1.0, 0]),
    spoilt(ring(6), "normal", 5, [0.0, 0, -1]),
    replace(straight([10.0]), closed=True),
]


@pytest.mark.parametrize("bad", BAD)
def test_an_unfit_line_stands_out_of_any_company(bad):
    """What is refused alone, and nothing else, is found in a stack."""
    with pytest.raises(DataError):
        check_line(bad, "here")
    for some in ([bad], [SMOOTH, bad, ring(6)], [bad, ring(6)], [ring(6), bad]):
        assert [some[i] for i in unfit_lines(stacked(some))] == [bad]


@given(STACKS)
@settings(deadline=None, max_examples=20)
def test_doubts_about_lines_of_a_stack(some):
    """The lines that are warned about alone, and no others."""
    some = [*some, straight([10.0, 1.5, 10]), SMOOTH, straight([4.0, 6], edge_mid=[0, 1, 0])]
    assert not unfit_lines(stacked(some)).size
    assert warned_lines(stacked(some)).tolist() == [i for i, line in enumerate(some) if line_warnings(line, "here")]


def test_forces_of_parabolic_elements_stand_out():
    """Of several lines, open and closed, the one whose forces belong to parabolic elements is found."""
    some = [ring(24), SMOOTH, straight([10.0] * 8), ring(24)]
    parabolic = [replace(line, edge_mid=np.arange(line.node.size) % 2 == 1) for line in some]
    smooth = [line_load_matrix(line) @ np.ones((line.node.size, 2)) for line in some]
    rough = [line_load_matrix(line) @ np.ones((line.node.size, 2)) for line in parabolic]
    for wrong in ((), (0,), (1, 2), (3,)):
        nodal = [rough[i] if i in wrong else smooth[i] for i in range(4)]
        stack = stacked(some)
        assert jumpy_lines(stack, line_load(stack, np.concatenate(nodal))).tolist() == list(wrong)
        assert [i for i in range(4) if edge_type_warnings(some[i], nodal[i], "here")] == list(wrong)
