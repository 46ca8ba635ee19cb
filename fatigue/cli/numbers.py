"""Numbers that options take; nan and inf are none, which is said before anything is asked of the files."""

import math
from typing import Any

import click


class FiniteRange(click.FloatRange):
    """A finite number within bounds; ``click.FloatRange`` lets nan through, which is neither above nor below any."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Turn the text of an option into a number, or fail as wrong usage."""
        number = float(super().convert(value, param, ctx))
        if not math.isfinite(number):
            self.fail(f"{value!r} is not a finite number.", param, ctx)
        return number


ABOVE_ZERO = FiniteRange(0.0, min_open=True)
FROM_ZERO = FiniteRange(0.0)
SHARE = FiniteRange(0.0, 1.0, min_open=True)
DAMPING = FiniteRange(0.0, 1.0, max_open=True)
DAMPED = FiniteRange(0.0, 1.0, min_open=True, max_open=True)
MOST_STEPS = 1000  # of a range


def numbers_of(text: str | None, option: str) -> tuple[float, ...]:
    """Numbers above 0 of a list, or of a range from A to B, B included where the step leads there."""
    if text is None:
        return ()
    try:
        values = _of_range(text) if ":" in text else tuple(float(number) for number in text.split(","))
    except ValueError:
        values = ()
    if not values or not all(0.0 < value < float("inf") for value in values):
        what = f"{text!r} is no range A:B:STEP with A up to B, nor a list, of numbers above 0"
        raise click.BadParameter(f"{what}, of {MOST_STEPS} at most.", param_hint=option)
    return values


def _of_range(text: str) -> tuple[float, ...]:
    first, last, step = (float(number) for number in text.split(":"))
    if not (step > 0.0 and last >= first and (last - first) / step < MOST_STEPS):
        raise ValueError(text)
    steps = int((last - first) / step + 1e-9)
    return tuple(round(first + i * step, 12) for i in range(steps + 1))
