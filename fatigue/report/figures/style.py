"""One look for all figures: typeface, inks, colours of faces and events, one colour scale per quantity."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.wording import LONGEST

# Plotly's mode bar offers by default to upload the figure to a cloud service.
CONFIG: dict[str, Any] = {
    "showSendToCloud": False,
    "displaylogo": False,
    "responsive": True,
    "modeBarButtonsToRemove": ["select2d", "lasso2d", "autoScale2d"],
}

FONT = '"Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif'
INK, QUIET, GRID, PAPER, BODY = "#1c2530", "#5c6773", "#e6e9ec", "#ffffff", "#c9d0d6"
ACCENT, MISSED = "#0b5c8a", "#b3261e"
FACE = {"top": "#0b5c8a", "bottom": "#b8760b"}
FACE_DASH = {"top": "solid", "bottom": "dash"}
DASHES = ("solid", "dash", "dot", "dashdot")
# Okabe and Ito's colours for colour-blind readers, without the yellow that paper swallows.
SERIES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#5c6773")
# Viridis: perceptually uniform and safe for colour-blind readers; dark is the small end.
_VIRIDIS = (
    "#440154",
    "#482878",
    "#3e4989",
    "#31688e",
    "#26828e",
    "#1f9e89",
    "#35b779",
    "#6ece58",
    "#b5de2b",
    "#fde725",
)
SEQUENTIAL = [[i / (len(_VIRIDIS) - 1), colour] for i, colour in enumerate(_VIRIDIS)]
SHARES = [[0.0, "#ffffff"], [0.5, "#5b9bbd"], [1.0, "#083a59"]]  # of damage: white is none

_AXIS = {
    "showline": True,
    "linecolor": QUIET,
    "linewidth": 1,
    "ticks": "outside",
    "tickcolor": QUIET,
    "ticklen": 4,
    "gridcolor": GRID,
    "zeroline": False,
    "title": {"standoff": 8, "font": {"size": 12}},
    "exponentformat": "none",
}
TEMPLATE: dict[str, Any] = {
    "layout": {
        "font": {"family": FONT, "size": 12, "color": INK},
        "paper_bgcolor": PAPER,
        "plot_bgcolor": PAPER,
        "margin": {"l": 70, "r": 16, "t": 30, "b": 50},
        "colorway": list(SERIES),
        "hoverlabel": {"font": {"family": FONT, "size": 12}, "bgcolor": PAPER, "bordercolor": QUIET, "align": "left"},
        "hovermode": "closest",
        "legend": {
            "orientation": "h",
            "x": 0,
            "y": 1.0,
            "yanchor": "bottom",
            "font": {"size": 11},
            "traceorder": "normal",
        },
        "xaxis": _AXIS,
        "yaxis": _AXIS,
    }
}


def figure(data: Sequence[Trace], height: int, **layout: Any) -> Figure:
    """Figure in the common look."""
    return Figure(list(data), {"template": TEMPLATE, "height": height, **layout})


def axis(title: str, **more: Any) -> dict[str, Any]:
    """Axis with a title that names quantity and unit."""
    return {"title": {"text": title}, **more}


def log_axis(title: str, low: float, high: float, **more: Any) -> dict[str, Any]:
    """Logarithmic axis from 10**low to 10**high with a tick at every decade, or every few."""
    every = max(1, round((high - low) / 7))
    decades = np.arange(np.ceil(low), np.floor(high) + 1, every)
    return axis(
        title,
        type="log",
        range=[float(low), float(high)],
        tickvals=[float(10.0**d) for d in decades],
        ticktext=[power(int(d)) for d in decades],
        minor={"dtick": "D1" if every == 1 else 1, "ticks": "outside", "ticklen": 2, "tickcolor": QUIET},
        **more,
    )


def power(exponent: int) -> str:
    """Power of ten as figures write it."""
    return f"10<sup>{exponent}</sup>".replace("-", "−")


def across(y: float, colour: str = INK, width: float = 1.5, dash: str = "solid", x: str = "x", on: str = "y") -> Trace:
    """Line across a panel at y."""
    line = {"color": colour, "width": width, "dash": dash}
    return {"type": "line", "xref": f"{x} domain", "yref": on, "x0": 0, "x1": 1, "y0": y, "y1": y, "line": line}


def upright(
    x: float, colour: str = QUIET, width: float = 1, dash: str = "dot", on: str = "x", y: str = "paper"
) -> Trace:
    """Upright line through a panel, or all panels, at x."""
    line = {"color": colour, "width": width, "dash": dash}
    return {"type": "line", "xref": on, "yref": y, "x0": x, "x1": x, "y0": 0, "y1": 1, "line": line}


def shaded(x0: float, x1: float, on: str = "x", y: str = "paper") -> Trace:
    """Grey band behind a panel, or all panels."""
    band = {"x0": x0, "x1": x1, "y0": 0, "y1": 1, "fillcolor": GRID, "line": {"width": 0}, "layer": "below"}
    return {"type": "rect", "xref": on, "yref": y, **band}


def colour_bar(title: str, **more: Any) -> dict[str, Any]:
    """Colour bar that says what the colour means."""
    heading = {"text": title, "side": "right", "font": {"size": 12}}
    return {"title": heading, "thickness": 11, "outlinewidth": 0, "ticks": "outside", "ticklen": 3, **more}


def single(values: ArrayLike) -> NDArray[np.float32]:
    """Drawn data in single precision: it halves the page, and no eye sees more."""
    return np.asarray(values, dtype=np.float32)


def drawn_life(life_km: ArrayLike) -> NDArray[np.float64]:
    """Lives as a logarithmic axis can show them: longer ones at 1e12 km."""
    return np.minimum(np.asarray(life_km, dtype=np.float64), LONGEST)


def life_axis(title: str, lives_km: ArrayLike, target_km: float, **more: Any) -> dict[str, Any]:
    """Logarithmic axis of lives [km] that shows the target, and writes "> 1e12" at its end where lives reach it."""
    lives = np.append(np.asarray(lives_km, dtype=np.float64), target_km)
    drawn = drawn_life(lives[lives > 0.0])
    low, high = np.floor(np.log10(drawn.min()) - 0.05), np.ceil(np.log10(drawn.max()) + 0.05)
    found = log_axis(title, low, high, **more)
    if lives.max() > LONGEST:
        found["tickvals"], found["ticktext"] = [*found["tickvals"], LONGEST], [*found["ticktext"], "> 1e12"]
    return found


def life_scale(target_km: float) -> dict[str, Any]:
    """The one colour scale of lives: log10 of km, from a decade below the target to four above."""
    low = int(np.floor(np.log10(target_km))) - 1
    decades = list(range(low, low + 6))
    bar = colour_bar("life [km]", tickvals=decades, ticktext=[power(d) for d in decades])
    return {"cmin": low, "cmax": low + 5, "colorscale": SEQUENTIAL, "colorbar": bar}


def event_colours(events: Sequence[str]) -> dict[str, str]:
    """Colour of every event, the same in all figures; events beyond the palette share its last, grey one."""
    return {event: SERIES[min(i, len(SERIES) - 1)] for i, event in enumerate(events)}
