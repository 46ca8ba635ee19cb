"""Figure of the lives of the welds without some modes."""

from collections.abc import Sequence

import numpy as np

from fatigue.basis.truncation import ALL, INTERFACE, MOVES, TruncationRow
from fatigue.report.figures.drawn import Figure
from fatigue.report.figures.style import QUIET, SERIES, axis, figure, log_axis, upright
from fatigue.shown import shortened, visible

MOST_WELDS = 40  # those that move most; the table has all
MOST_RATIO = 1e9  # where longer lives are drawn
SYMBOL = {ALL: "circle", INTERFACE: "x-thin-open"}


def lives_without(rows: Sequence[TruncationRow], band_hz: float) -> Figure | None:
    """Life of each weld without some modes over its life with all of them; None where nothing damages any weld."""
    known = [row for row in rows if not np.isnan(row.shortest_life_ratio)]
    if not known:
        return None
    size: dict[str, float] = {}
    for row in known:
        size[row.weld] = max(size.get(row.weld, 0.0), abs(float(np.log(_drawn(row)))))
    welds = sorted(size, key=lambda weld: -size[weld])[:MOST_WELDS]
    place = {weld: i for i, weld in enumerate(welds)}
    data = []
    for i, (of, share) in enumerate(dict.fromkeys((row.left_out_of, row.share) for row in known)):
        shown = [row for row in known if (row.left_out_of, row.share) == (of, share) and row.weld in place]
        kind = "interface modes" if of == INTERFACE else f"highest {100 * share:g} %"
        kind += "" if of in (ALL, INTERFACE) else f" of the {of} modes"
        data.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": f"without {kind}",
                "x": [_drawn(row) for row in shown],
                "y": [place[row.weld] for row in shown],
                "marker": {
                    "color": SERIES[i % len(SERIES)],
                    "symbol": SYMBOL.get(of, "diamond-open"),
                    "size": 8,
                    "line": {"width": 1.6, "color": SERIES[i % len(SERIES)]},
                },
                "hovertemplate": "%{x:.3g} times as long",
            }
        )
    ratios = np.array([_drawn(row) for row in known])
    low = np.floor(np.log10(min(ratios.min(), 1.0 / MOVES)) - 0.05)
    high = np.ceil(np.log10(max(ratios.max(), MOVES)) + 0.05)
    names = [shortened(visible(weld), 28) for weld in welds]
    return figure(
        data,
        height=170 + 22 * len(welds),
        margin={"l": 210, "r": 16, "t": 60, "b": 50},
        xaxis=log_axis("life without over life with all modes [-]", low, high),
        yaxis=axis("", tickvals=list(range(len(welds))), ticktext=names, range=[len(welds) - 0.5, -0.5]),
        shapes=[upright(1.0, dash="solid"), upright(MOVES, QUIET), upright(1.0 / MOVES, QUIET)],
    )


def _drawn(row: TruncationRow) -> float:
    return min(row.shortest_life_ratio, MOST_RATIO)
