"""One look for all figures: typeface, inks, colours of faces and events, one colour scale per quantity."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import ArrayLike, NDArray

from fatigue.report.wording import LONGEST

# Plotly's mode bar offers by default to upload the figure to a cloud service.
CONFIG: dict[str, Any] = {
    "showSendToCloud": False,
    "displaylogo": False,
    "responsive": True,
    "modeBarButtonsToRemove": ["select2d", "lasso2d", "autoScale2d"],
}

FONT = '"Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif'
INK, QUIET, GRID, PAPER = "#1c2530", "#5c6773", "#e3e7eb", "#ffffff"
ACCENT = "#0b5c8a"
MISSED = "#b3261e"
FACE = {"top": "#00457c", "bottom": "#b8860b"}
FACE_DASH = {"top": "solid", "bottom": "dash"}
# Okabe and Ito's colours for colour-blind readers, without the yellow that paper swallows.
SERIES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#5c6773")
SEQUENTIAL = "Cividis"  # perceptually uniform; dark is the small end, which is the bad one for lives
DIVERGING = "PuOr"  # for ratios centred on 1
UNDAMAGED = "#c4cad0"

_AXIS = {
    "showline": True,
    "linecolor": QUIET,
    "linewidth": 1,
    "ticks": "outside",
    "tickcolor": QUIET,
    "ticklen": 4,
    "gridcolor": GRID,
    "zeroline": False,
    "title": {"standoff": 8},
    "exponentformat": "e",
}
TEMPLATE = go.layout.Template(
    layout={
        "font": {"family": FONT, "size": 12, "color": INK},
        "paper_bgcolor": PAPER,
        "plot_bgcolor": PAPER,
        "margin": {"l": 72, "r": 20, "t": 24, "b": 52},
        "colorway": list(SERIES),
        "hoverlabel": {"font": {"family": FONT, "size": 12}, "bgcolor": PAPER, "bordercolor": QUIET, "align": "left"},
        "hovermode": "closest",
        "legend": {"orientation": "h", "x": 0, "y": 1.02, "yanchor": "bottom", "font": {"size": 11}},
        "xaxis": _AXIS,
        "yaxis": _AXIS,
        "coloraxis": {"colorbar": {"outlinewidth": 0, "thickness": 12, "ticks": "outside"}},
    }
)


def figure(height: int, **layout: Any) -> go.Figure:
    """Begin a figure in the common look."""
    return go.Figure(layout={"template": TEMPLATE, "height": height, **layout})


def single(values: ArrayLike) -> NDArray[np.float32]:
    """Drawn data need no more than single precision; halves the page."""
    return np.asarray(values, dtype=np.float32)


def drawn_life(life_km: ArrayLike) -> NDArray[np.float64]:
    """Lives as a logarithmic axis can show them: beyond 1e12 km at 1e12 km."""
    return np.minimum(np.asarray(life_km, dtype=np.float64), LONGEST)


def life_axis(lives_km: ArrayLike, target_km: float) -> dict[str, Any]:
    """Logarithmic axis of lives [km] that shows the target, and labels its end "> 1e12"."""
    lives = np.append(np.asarray(lives_km, dtype=np.float64), target_km)
    drawn = drawn_life(lives[lives > 0.0])
    low, high = np.floor(np.log10(drawn.min()) - 0.05), np.ceil(np.log10(drawn.max()) + 0.05)
    decades = np.arange(low, high + 1, max(1, (high - low) // 8))
    top = "> 1e12" if lives.max() > LONGEST else "1e12"
    return {
        "type": "log",
        "range": [float(low), float(high)],
        "tickvals": [float(10.0**d) for d in decades],
        "ticktext": [top if d == np.log10(LONGEST) else f"1e{int(d)}" for d in decades],
        "minor": {"dtick": "D1", "ticks": "outside", "ticklen": 2, "tickcolor": QUIET},
    }


def life_scale(target_km: float) -> dict[str, Any]:
    """Build the one colour scale of lives, log10 of km from a hundredth of the target to ten thousand times it."""
    low, high = np.floor(np.log10(target_km)) - 1, np.floor(np.log10(target_km)) + 4
    decades = np.arange(low, high + 1)
    return {
        "cmin": float(low),
        "cmax": float(high),
        "colorscale": SEQUENTIAL,
        "colorbar": {
            "title": {"text": "life [km]", "side": "right"},
            "tickvals": decades.tolist(),
            "ticktext": [f"1e{int(d)}" for d in decades],
            "thickness": 12,
            "outlinewidth": 0,
            "ticks": "outside",
        },
    }


def event_colours(events: Sequence[str]) -> dict[str, str]:
    """Colour of every event, the same in all figures; events beyond the palette share its last, grey one."""
    return {event: SERIES[min(i, len(SERIES) - 1)] for i, event in enumerate(events)}
