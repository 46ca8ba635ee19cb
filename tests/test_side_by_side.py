"""Work on a few threads, given back in order."""

import threading
import time

import pytest

from fatigue.side_by_side import in_order, meanwhile


@pytest.mark.parametrize("threads", [1, 2, 5, None])
def test_results_are_in_the_order_of_the_items(threads):
    """Also where the first ones take longest; nothing to do is nothing done."""

    def slowly(item):
        time.sleep(0.002 * (10 - item))
        return item**2

    assert in_order(slowly, range(10), threads) == [item**2 for item in range(10)]
    assert in_order(slowly, [], threads) == []


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_no_more_at_a_time_than_threads(threads):
    """Each item holds a record, so their number is bounded."""
    at_work, most, lock = 0, 0, threading.Lock()

    def count(_):
        nonlocal at_work, most
        with lock:
            at_work += 1
            most = max(most, at_work)
        time.sleep(0.005)
        with lock:
            at_work -= 1

    in_order(count, range(9), threads)
    assert most == threads


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
def test_the_error_of_the_first_item_comes_out(threads, error):
    """Although a later one fails sooner; what has not begun by then is dropped."""
    begun = []

    def fail(item):
        begun.append(item)
        if item == 1:
            time.sleep(0.02)
        if item in (1, 2):
            raise error(item)
        time.sleep(0.02)

    with pytest.raises(error, match="1"):
        in_order(fail, range(100), threads)
    assert len(begun) < 20


def test_work_begun_meanwhile_gives_its_result_or_its_error_to_who_asks():
    """It runs beside the caller; an error nobody asks for troubles nobody."""
    begun = threading.Event()
    answer = meanwhile(lambda: begun.wait(60) and 42)
    begun.set()
    assert answer() == 42
    failed = meanwhile(lambda: 1 // 0)
    with pytest.raises(ZeroDivisionError):
        failed()
    meanwhile(lambda: 1 // 0)
