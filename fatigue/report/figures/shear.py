"""The path of a toe in the plane of normal stress and shear."""

import numpy as np
from numpy.typing import NDArray

from fatigue.report.figures.drawn import Figure
from fatigue.report.figures.style import ACCENT, MISSED, axis, figure, single

Floats = NDArray[np.float64]

LONGEST = 3000  # samples that are drawn


def shear_path(normal: Floats, shear: Floats, beta: float = 3.0, ends: tuple[int, int] | None = None) -> Figure:
    """Path of a toe: shear times sqrt(beta) over normal stress, in one scale.

    Parameters
    ----------
    normal, shear : (t,) stress at the toe [MPa], both from their means
    beta : weight of the square of the shear
    ends : samples at the ends of its largest half cycle, which are marked and, of a long record, in the middle
    """
    first = 0
    if ends is not None and len(normal) > LONGEST:
        first = int(np.clip(sum(ends) // 2 - LONGEST // 2, 0, len(normal) - LONGEST))
    part = slice(first, first + LONGEST)
    weighted = np.sqrt(beta) * shear
    data = [
        {
            "type": "scatter",
            "mode": "lines",
            "x": single(normal[part]),
            "y": single(weighted[part]),
            "line": {"color": ACCENT, "width": 1},
            "hovertemplate": "normal %{x:.2f} MPa, weighted shear %{y:.2f} MPa<extra></extra>",
            "showlegend": False,
        }
    ]
    if ends is not None:
        at = list(ends)
        data.append(
            {
                "type": "scatter",
                "mode": "lines+markers",
                "x": single(normal[at]),
                "y": single(weighted[at]),
                "line": {"color": MISSED, "width": 2, "dash": "dot"},
                "marker": {"size": 9, "symbol": "circle-open", "color": MISSED, "line": {"width": 2}},
                "name": "largest half cycle",
                "hovertemplate": "end of the largest half cycle<extra></extra>",
            }
        )
    return figure(
        data,
        height=360,
        xaxis=axis("structural stress [MPa]"),
        yaxis=axis(f"√{beta:g} × shear [MPa]", scaleanchor="x"),
    )
