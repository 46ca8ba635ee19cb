"""An overflow while an event meets a block of stations, told as an error that names both."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from fatigue.errors import NumericalError, Problem


@contextmanager
def no_overflow(event: str, welds: str) -> Iterator[None]:
    """Turn an overflow while an event is counted at some welds into an error that names both.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    try:
        with np.errstate(over="raise", invalid="raise"):  # invalid: the infinities of a matrix product meet
            yield
    except FloatingPointError:
        raise NumericalError(
            Problem(
                "overflow",
                f"event '{event}', {welds}",
                "stresses or damage exceed what double precision can hold",
                "Check the units of forces and modal coordinates, and look for a value that is far too large",
            )
        ) from None
