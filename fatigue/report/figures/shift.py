"""Figure of a shift study: life of welds against the frequency or the damping of the mode that is moved."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from fatigue.report.figures.cycles import corner_note
from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.given import ResultTable, check_target, frame_of
from fatigue.report.figures.style import DASHES, SERIES, across, axis, drawn_life, figure, life_axis, upright
from fatigue.report.wording import in_figure

SCREENING = "screening without feedback"
_COLUMNS = ("weld", "frequency_hz", "damping_ratio", "life_km", "is_as_assessed", "is_worst_of_weld")


def life_against_setting(shift: ResultTable, welds: Sequence[str], target_km: float) -> Figure:
    """Life of the worst point of some welds against frequency, or against damping where that alone moves.

    Parameters
    ----------
    shift : rows of the table of this name
    welds : those to draw
    target_km : drawn as a line [km]

    Each weld has a colour, each damping ratio a dash; an upright line stands at the setting as assessed, which is
    drawn as an open circle.
    """
    shift = frame_of(shift, "shift", _COLUMNS)
    check_target(target_km)
    worst = shift[shift["is_worst_of_weld"]]
    along, across_it = "frequency_hz", "damping_ratio"
    if len(worst[along].unique()) == 1:
        along, across_it = across_it, along
    assessed = worst[worst["is_as_assessed"]]
    shown = worst[worst["weld"].isin(list(welds))]
    curves = sorted(shown[across_it].unique())
    data = [
        _curve(shown[(shown["weld"] == weld) & (shown[across_it] == value)], along, weld, colour, dash)
        for weld, colour in zip(welds, SERIES, strict=False)
        for value, dash in zip(_drawn(curves, float(assessed[across_it].iloc[0])), DASHES, strict=False)
    ]
    title = "frequency of the mode [Hz]" if along == "frequency_hz" else "damping ratio of the mode [-]"
    return figure(
        [trace for trace in data if len(trace["x"])],
        height=380,
        xaxis=axis(title),
        yaxis=life_axis("life [km]", shown["life_km"], target_km),
        shapes=[across(target_km), upright(float(assessed[along].iloc[0]))],
        annotations=[corner_note(SCREENING)],
    )


def _drawn(values: Sequence[float], assessed: float) -> list[float]:
    """As many values as there are dashes, that as assessed first: its curve is solid."""
    return [assessed, *(value for value in values if value != assessed)][: len(DASHES)]


def _curve(rows: pd.DataFrame, along: str, weld: str, colour: str, dash: str) -> Trace:
    """Life of one weld at one value of what the axis does not show."""
    rows = rows.sort_values(along)
    damping = rows["damping_ratio"].iloc[0] if len(rows) and along == "frequency_hz" else None
    is_solid = dash == DASHES[0]
    name = in_figure(weld) if is_solid or damping is None else f"{in_figure(weld)}, {100.0 * damping:.3g} %"
    return {
        "type": "scatter",
        "x": rows[along].to_numpy(dtype=np.float64),
        "y": drawn_life(rows["life_km"]),
        "mode": "lines+markers",
        "name": name,
        "line": {"color": colour, "dash": dash},
        "marker": {"size": 6, "symbol": np.where(rows["is_as_assessed"], "circle-open", "circle").tolist()},
        "hovertemplate": "%{x:.4g}: %{y:.4g} km",
    }
