"""Figure of a what-if: the life of every weld before and after, with its band."""

import numpy as np
import pandas as pd

from fatigue.report.figures.drawn import Figure
from fatigue.report.figures.style import ACCENT, INK, MISSED, QUIET, axis, drawn_life, figure, life_axis, upright
from fatigue.shown import shortened, visible

MOST_WELDS = 60  # those that miss or are not proven first; the table has all
COLOUR = {"meets": ACCENT, "misses": MISSED, "not_proven": "#b8760b"}
WORDS = {"meets": "meets its target", "misses": "misses its target", "not_proven": "not proven"}


def lives_figure(welds: pd.DataFrame, target_km: float, target_km_before: float) -> Figure | None:
    """Lives of the welds before (hollow) and after, with the band from low to high; None where no life is known."""
    shown = welds.head(MOST_WELDS).reset_index(drop=True)
    before, after = shown["life_km_before"].to_numpy(), shown["life_km"].to_numpy(dtype=float)
    if not len(shown):
        return None
    y = np.arange(len(shown))
    data = [
        {
            "type": "scatter",
            "mode": "markers",
            "name": "as assessed",
            "x": drawn_life(before),
            "y": y,
            "marker": {"color": "#ffffff", "size": 8, "line": {"width": 1.6, "color": QUIET}},
            "hovertemplate": "%{x:.3g} km as assessed<extra></extra>",
        }
    ]
    for verdict, colour in COLOUR.items():
        here = ((shown["verdict"] == verdict) & ~np.isnan(after)).to_numpy()
        if not here.any():
            continue
        lives = drawn_life(after[here])
        low = np.fmin(drawn_life(np.nan_to_num(shown["life_km_low"].to_numpy(dtype=float)[here], nan=0.0)), lives)
        low = np.where(low > 0.0, low, lives)
        high = np.fmax(drawn_life(shown["life_km_high"].to_numpy(dtype=float)[here]), lives)
        data.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": WORDS[verdict],
                "x": lives,
                "y": y[here],
                "error_x": {"array": high - lives, "arrayminus": lives - low, "thickness": 1.4, "width": 4},
                "marker": {"color": colour, "size": 8},
                "hovertemplate": "%{x:.3g} km<extra></extra>",
            }
        )
    names = [shortened(visible(weld), 28) for weld in shown["weld"]]
    every = np.concatenate([before, after[~np.isnan(after)]])
    shapes = [upright(target_km, INK, 1.5, "solid")]
    if target_km_before != target_km:
        shapes.append(upright(target_km_before))
    return figure(
        data,
        height=150 + 22 * len(shown),
        margin={"l": 210, "r": 16, "t": 60, "b": 50},
        xaxis=life_axis("life [km]", every, target_km),
        yaxis=axis("", tickvals=y.tolist(), ticktext=names, range=[len(shown) - 0.5, -0.5]),
        shapes=shapes,
    )
