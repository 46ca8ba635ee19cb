"""What comes a few at a time is handed on so many at once, in its order, and none of it is lost."""

import pytest

from fatigue.pipeline.tables.batches import Batches


@pytest.mark.parametrize("pieces", [[], [2], [3], [1, 1, 1, 1], [7], [0, 10, 0, 2]])
def test_all_of_it_is_handed_on_in_its_order(pieces):
    """Three at once; what is left over comes when it is flushed, and nothing comes twice."""
    written: list[list[int]] = []
    batches = Batches(3, written.append)
    numbers = iter(range(sum(pieces)))
    for piece in pieces:
        batches.add([next(numbers) for _ in range(piece)])
        assert all(len(some) == 3 for some in written)
    batches.flush()
    batches.flush()
    assert [number for some in written for number in some] == list(range(sum(pieces)))
    assert len(written) == -(-sum(pieces) // 3)
