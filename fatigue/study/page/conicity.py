"""Stable conicities of the vehicles of a study, as far as claims ask for their analysis graph."""

import math

from fatigue.report.figures.drawn import Figure
from fatigue.report.figures.style import ACCENT, INK, axis, figure
from fatigue.report.wording import in_figure
from fatigue.study.page.studied import Studied

ENDS = ("conicity_min", "conicity_max")
TICKS = (0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0)
LEAST, MOST = 0.008, 1.5


def conicity_figure(of: Studied) -> Figure | None:
    """A bar for each vehicle from its least to its largest stable conicity; None where no vehicle has any."""
    numbers = {
        (one.variant, one.quantity): one.value
        for one in of.numbers
        if one.quantity.startswith("conicity_m") and not one.weld
    }
    rows: list[tuple[str, float, float]] = []
    for variant in of.variants:
        low, high = (numbers.get((variant.name, end), math.nan) for end in ENDS)
        if math.isfinite(low) and math.isfinite(high):
            rows.append((variant.name, low, high))
    if not rows:
        return None
    data = [
        {
            "type": "scatter",
            "mode": "lines+markers",
            "x": [low, high],
            "y": [row, row],
            "line": {"color": ACCENT, "width": 12},
            "marker": {"size": 1, "color": ACCENT},
            "hovertemplate": f"{in_figure(name)}: %{{x:.4g}}<extra></extra>",
            "showlegend": False,
        }
        for row, (name, low, high) in enumerate(rows)
    ]
    notes = [
        {
            "x": math.log10(at),
            "y": row + 0.3,
            "xanchor": anchor,
            "showarrow": False,
            "text": f"{at:.3g}" + (f" ({hz:.1f} Hz)" if math.isfinite(hz) else ""),
            "font": {"size": 11, "color": INK},
        }
        for row, (name, low, high) in enumerate(rows)
        for at, anchor, hz in (
            (low, "left", numbers.get((name, "conicity_min_hz"), math.nan)),
            (high, "right", numbers.get((name, "conicity_max_hz"), math.nan)),
        )
    ]
    return figure(
        data,
        height=110 + 56 * len(rows),
        margin={"l": 24, "r": 16, "t": 16, "b": 50},
        xaxis=axis(
            "equivalent conicity [-]",
            type="log",
            range=[math.log10(LEAST), math.log10(MOST)],
            tickvals=list(TICKS),
            ticktext=[f"{tick:g}" for tick in TICKS],
        ),
        yaxis=axis(
            "",
            tickvals=list(range(len(rows))),
            ticktext=[in_figure(name, 22) for name, _, _ in rows],
            range=[len(rows) - 0.4, -0.6],
            automargin=True,
            showgrid=False,
        ),
        annotations=notes,
    )
