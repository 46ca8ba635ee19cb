"""The parts of the page about the whole body: lives of all welds, where they are, what drives them, both domains."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.report import figures, wording
from fatigue.report.figures.scene import BodyOutline
from fatigue.report.result import ShownResult
from fatigue.report.sections.embed import Figures, Shown
from fatigue.report.sections.why import Why, band_shares

WELDS_DRAWN, STRIPS_DRAWN, CAUSES_DRAWN = 30, 60, 20


def lives(result: ShownResult, figs: Figures) -> Shown:
    """Draw the lives of the welds against the target."""
    fig = figures.weld_lives(result.assessed, result.target_km, WELDS_DRAWN)
    caption = "Life of the worst point of each weld against the target" + _those_drawn(result, WELDS_DRAWN)
    return figs.add("lives", fig, caption)


@dataclass(frozen=True, slots=True, eq=False)
class DrawnLines:
    """Weld lines as they are drawn: the worse toe face of each station, and rows of these, -1 between the lines.

    ``of_nodes`` are the rows of the stations in the table of nodes.
    """

    stations: pd.DataFrame
    rows: NDArray[np.int64]
    of_nodes: NDArray[np.int64]


def drawn_lines(result: ShownResult) -> DrawnLines:
    """The lines of the drawn welds."""
    stations = figures.worst_faces(result.nodes.assign(row=np.arange(len(result.nodes))))
    welds = result.assessed
    closed = frozenset(welds.loc[welds["closed"] & (welds["parts"] == 1), "weld"])
    return DrawnLines(stations, figures.line_rows(stations, closed), stations.pop("row").to_numpy())


def where(result: ShownResult, lines: DrawnLines, body: BodyOutline | None, figs: Figures) -> dict[str, Shown]:
    """Draw the weld lines in space, on paper and unrolled."""
    scene = figures.scene(lines.stations, lines.rows, result.target_km, body)
    views = figures.projections(lines.stations, lines.rows, result.target_km, body)
    strips = figures.weld_strips(result.nodes, result.target_km, STRIPS_DRAWN)
    unrolled = "Every weld line unrolled, coloured by life" + _those_drawn(result, STRIPS_DRAWN)
    worst = _those_drawn(result, len(result.drawn))
    in_space = "Weld lines" if worst else "All weld lines"
    return {
        "scene": figs.add("scene", scene, f"{in_space}, coloured by the shorter life of the toe faces{worst}"),
        "projections": figs.add("views", views, f"Side view and plan of the weld lines, coloured by life{worst}"),
        "strips": figs.add("strips", strips, unrolled),
    }


def causes(result: ShownResult, why: Why | None, figs: Figures) -> dict[str, Shown | None]:
    """Draw the events that damage the worst points and, after a diagnosis, the frequency bands."""
    shares = event_shares(result).head(CAUSES_DRAWN)
    weights = {
        event["event"]: f"{wording.number(event['per_1000_km'])} in 1000 km"
        if event["share"] is None
        else f"{wording.share(event['share'])} of km"
        for event in result.events
    } | {
        loop["name"]: f"{wording.number(1000.0 * loop['runs_per_km'])} in 1000 km"
        for loop in result.record["mission"].get("sequences", [])
    }
    fig = figures.damage_by_event(list(shares.index), shares.reset_index(drop=True), weights)
    events = (
        figs.add("events-of-welds", fig, "Share of each event in the damage of the worst points")
        if len(shares)
        else None
    )
    bands = {} if why is None else {weld: band_shares(why.of_weld(weld)) for weld in shares.index}
    if not bands or len(next(iter(bands.values()))) < 2:
        return {"events_figure": events, "bands": None}
    table = np.nan_to_num(np.stack([of_weld["share"].to_numpy() for of_weld in bands.values()]))
    fig = figures.bands_of_welds(list(bands), table, next(iter(bands.values())))
    caption = "Share of each frequency band in the damage of the worst points"
    return {"events_figure": events, "bands": figs.add("bands", fig, caption)}


def event_shares(result: ShownResult) -> pd.DataFrame:
    """Share of each event in the damage of each detailed weld's worst point, welds worst first; damaged ones only."""
    weighted = result.damage["damage_per_pass"] * result.damage["event"].map(result.passes_per_km)
    table = result.damage.assign(weighted=weighted).pivot_table(index="weld", columns="event", values="weighted")
    table = table.loc[list(result.detailed), list(result.passes_per_km)]
    total = table.sum(axis=1)
    return table[total > 0.0].div(total[total > 0.0], axis=0)


def domains(result: ShownResult, figs: Figures) -> dict[str, Any]:
    """Compare time and frequency domain at all points; nothing where no event has a spectrum."""
    ratio, drawn = result.domains.ratio, result.domains.drawn
    outside = dict(result.domains.verdicts).get("outside_band", 0)
    if not len(ratio):
        return {"scatter": None, "histogram": None, "ratio": None, "verdicts": [], "outside": outside}
    of_all = f"; {wording.whole(len(drawn))} of {wording.whole(len(ratio))} points, those that disagree first"
    caption = "Life by Dirlik against life by rainflow, both with one bending ratio"
    caption += of_all if len(drawn) < len(ratio) else ", all points with a life by both" if outside else ", all points"
    low, middle, high = np.quantile(ratio, [0.05, 0.5, 0.95])
    return {
        "scatter": figs.add("domains", figures.time_against_frequency(drawn), caption),
        "histogram": figs.add(
            "ratios",
            figures.ratio_histogram(pd.DataFrame({"dirlik_ratio": ratio})),
            "Spread of the damage ratio over all points",
        ),
        "ratio": {
            "points": len(ratio),
            "median": float(middle),
            "low": float(low),
            "high": float(high),
            "within": float(np.mean((ratio >= 0.5) & (ratio <= 2.0))),
            "spread": float(np.log10(ratio).std()),
        },
        "verdicts": [(name.replace("_", " "), points) for name, points in result.domains.verdicts],
        "outside": outside,
    }


def _those_drawn(result: ShownResult, drawn: int) -> str:
    """Words for a caption where only the worst welds are drawn."""
    total = len(result.assessed)
    return f", the {drawn} worst of {total} welds" if total > drawn else ""
