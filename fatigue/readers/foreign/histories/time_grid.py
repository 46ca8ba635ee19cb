"""Modal coordinates on a uniform time grid: kept where the file has one, else interpolated onto one."""

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory

STEP_TOLERANCE = 1e-3  # of a step: the neutral format asks for no less
GAP = 20.0  # usual steps; an interpolation over more is told


def uniform(history: ForeignHistory, resample_s: float | None) -> ForeignHistory:
    """History on a uniform time grid: its own, or one of step ``resample_s``, interpolated by cubic splines.

    Of an instant that is written twice, as solvers do at events, the later sample counts in the interpolation.

    Raises
    ------
    DataError
        time stands still, or the steps differ by more than 1e-3, and no step is given; or it is coarser than the file's
        own
    """
    if resample_s is None:
        still = np.flatnonzero(np.diff(history.time) <= 0)
        if still.size:
            row = int(still[0])
            what = f"time goes from {history.time[row]:.9g} to {history.time[row + 1]:.9g} s, it stands still"
            more = f" (and at {still.size - 1} more samples)" if still.size > 1 else ""
            remedy = "Export every instant once, or resample with --resample, which keeps the later sample"
            raise DataError(Problem("time_order", history.sample(row + 1), what + more, remedy))
        steps = np.diff(history.time)
        mean = float((history.time[-1] - history.time[0]) / steps.size)
        worst = int(np.argmax(np.abs(steps - mean)))
        if abs(steps[worst] - mean) > STEP_TOLERANCE * mean:
            raise DataError(
                Problem(
                    "uneven_step",
                    history.sample(worst + 1),
                    f"the time step is {steps[worst]:.6g} s where the mean is {mean:.6g} s",
                    f"Export at a constant step, or resample, for instance with a step of {np.median(steps):.6g} s",
                )
            )
        return history
    history, twice = _once(history)
    if history.time.size < 2:
        raise DataError(Problem("too_short", history.source, "time stands still", "Export at least two instants"))
    steps = np.diff(history.time)
    count = (history.time[-1] - history.time[0]) / resample_s if resample_s > 0 else np.inf
    if not (resample_s > 0 and 1 <= count < 1e8):
        raise DataError(
            Problem("bad_step", history.source, f"a step of {resample_s:g} s is impossible", "Give another")
        )
    time = history.time[0] + resample_s * np.arange(int(count + 1e-9) + 1)
    q = CubicSpline(history.time, history.q, axis=1)(np.minimum(time, history.time[-1]))
    warnings = [
        *twice,
        Problem(
            "resampled",
            history.source,
            f"{history.time.size} samples with steps from {steps.min():.6g} to {steps.max():.6g} s were resampled to "
            f"{resample_s:.6g} s",
            "Export at a constant step to avoid it",
        ),
    ]
    longest = int(np.argmax(steps))
    if steps[longest] > GAP * max(float(np.median(steps)), resample_s):
        what = f"a gap of {steps[longest]:.6g} s from {history.time[longest]:.9g} s was filled by interpolation"
        warnings.append(Problem("gap", history.sample(longest + 1), what, "Check that no samples were lost there"))
    if resample_s > 1.001 * float(np.median(steps)):
        warnings.append(
            Problem("coarser", history.source, "the new step is coarser than the file's usual one", "Use a finer step")
        )
    return replace(history, time=time, q=q, lines=None, warnings=(*history.warnings, *warnings))


def _once(history: ForeignHistory) -> tuple[ForeignHistory, list[Problem]]:
    """History with every instant once, the later sample where several share it."""
    keep = np.append(np.diff(history.time) > 0, True)
    if keep.all():
        return history, []
    first, count = int((~keep).argmax()), int(np.count_nonzero(~keep))
    what = f"time stands still at {history.time[first]:.9g} s; the later sample of every instant is kept"
    what += f" ({count} left out)"
    warning = Problem("instant_twice", history.sample(first + 1), what, "Export every instant once to avoid it", count)
    lines = None if history.lines is None else history.lines[keep]
    return replace(history, time=history.time[keep], q=history.q[:, keep], lines=lines), [warning]
