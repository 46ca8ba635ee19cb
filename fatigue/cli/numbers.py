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
