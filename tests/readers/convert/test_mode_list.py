"""Lists of modes as they are typed."""

import pytest

from fatigue.errors import CaseError
from fatigue.readers.convert.mode_list import mode_list


def test_lists_and_ranges():
    """Numbers and ranges in any order, with or without blanks."""
    assert mode_list("1-3, 7") == (1, 2, 3, 7)
    assert mode_list("1-2,31-32") == (1, 2, 31, 32)
    assert mode_list(" 7 , 8-9") == (7, 8, 9)


@pytest.mark.parametrize("text", ["1-x", "1;2", "3,", "-4", "5-2", "1-999999", "1" * 60])
def test_what_is_no_list_is_refused(text):
    """With the place that it is written in, and what stands there."""
    with pytest.raises(CaseError, match=r"\A--ignore-modes: '.*' is no mode or range. Write 1-6,31-52.\Z"):
        mode_list(text, "--ignore-modes")
