"""Spectra of the channels of bogies and equipment: power spectral densities, mean over the seeds of a variant."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
from numpy.typing import NDArray
from scipy.signal import welch

from fatigue.case import load_case
from fatigue.errors import FatigueError
from fatigue.report.figures.drawn import Figure, Trace
from fatigue.report.figures.style import DASHES, SERIES, axis, figure, log_axis, single
from fatigue.report.wording import in_figure
from fatigue.ride.records import channel_records
from fatigue.study.page.chosen import Group
from fatigue.study.page.studied import Studied
from fatigue.study.quantities import StudyRun

Floats = NDArray[np.float64]

SEGMENT_S = 4.096  # Hann, half overlapping
UPTO_HZ = 40.0
BELOW_TOP = 5.0  # decades that are shown
MOST_PANELS = 4
PANEL_HEIGHT = 230  # px
GAP = 0.14  # between panels, of the height of one
OWN_CHANNELS = ("bog_y", "conv_y")  # of the history of a vehicle that rides without a case
CASE, HISTORY = "case.toml", "history.parquet"


@dataclass(frozen=True, slots=True, eq=False)
class Spectrum:
    """One-sided density of one channel in one event of one run; ``frequency_hz`` (k,), ``density`` (k,)."""

    channel: str
    event: str
    unit: str
    frequency_hz: Floats
    density: Floats


Spectra = dict[tuple[str, int], list[Spectrum]]


def spectra_of(of: Studied, groups: Sequence[Group]) -> Spectra:
    """Spectra of all runs of the variants of some groups, by variant and seed; none of a run that is not there."""
    wanted = {one.name for group in groups for one in group.variants}
    return {
        (run.variant, run.seed): list(_of_run(run)) for run in of.runs if run.variant in wanted and run.state == "done"
    }


def spectra_figure(group: Group, spectra: Spectra, seeds: Sequence[int]) -> Figure | None:
    """Densities of the variants of a group, a panel for each channel and event; None without any."""
    every = [one for variant in group.variants for seed in seeds for one in spectra.get((variant.name, seed), ())]
    panels = list(dict.fromkeys((one.channel, one.event, one.unit) for one in every))[:MOST_PANELS]
    if not panels:
        return None
    data: list[Trace] = []
    layout: dict[str, object] = {}
    notes = []
    height = 1.0 / len(panels)
    for place, (channel, event, unit) in enumerate(panels):
        name = "" if place == 0 else str(place + 1)
        top = 1.0 - place * height
        lines = list(_lines(group, spectra, seeds, channel, event))
        for number, (label, f, density) in lines:
            data.append(_line(label, number, f, density, name, in_legend=not any(t["name"] == label for t in data)))
        highest = max(float(np.log10(density.max())) for _, (_, _, density) in lines)
        domain = [top - height + GAP * height, top] if place < len(panels) - 1 else [top - height, top]
        title = "PSD" + (f" [({unit})²/Hz]" if unit != "-" else "")
        layout[f"yaxis{name}"] = log_axis(title, highest - BELOW_TOP, highest + 0.3, domain=domain)
        said = in_figure(channel) + (f", {in_figure(event)}" if event else "")
        notes.append({"x": 1, "xref": "paper", "xanchor": "right", "y": domain[1], "yref": "paper", "yanchor": "top",
                      "showarrow": False, "text": f"<b>{said}</b>"})  # fmt: skip
    last = "y" if len(panels) == 1 else f"y{len(panels)}"
    return figure(
        data,
        height=70 + PANEL_HEIGHT * len(panels),
        xaxis=axis("frequency [Hz]", range=[0.0, UPTO_HZ], anchor=last),
        annotations=notes,
        **layout,
    )


def _lines(
    group: Group, spectra: Spectra, seeds: Sequence[int], channel: str, event: str
) -> Iterator[tuple[int, tuple[str, Floats, Floats]]]:
    """Place of each variant in the group, with label, frequencies and mean density over the seeds."""
    for number, (variant, label) in enumerate(zip(group.variants, group.labels, strict=True)):
        same = [
            one
            for seed in seeds
            for one in spectra.get((variant.name, seed), ())
            if (one.channel, one.event) == (channel, event)
        ]
        alike = [one for one in same if np.array_equal(one.frequency_hz, same[0].frequency_hz)]
        if alike:
            f = alike[0].frequency_hz
            density = np.mean([one.density for one in alike], axis=0)
            shown = (f > 0.0) & (f <= UPTO_HZ) & (density > 0.0)
            if shown.any():
                yield number, (label, f[shown], density[shown])


def _line(label: str, number: int, f: Floats, density: Floats, panel: str, *, in_legend: bool) -> Trace:
    return {
        "type": "scatter",
        "mode": "lines",
        "name": label,
        "legendgroup": label,
        "showlegend": in_legend,
        "x": single(f),
        "y": single(density),
        "yaxis": f"y{panel}",
        "line": {"color": SERIES[number % len(SERIES)], "dash": DASHES[number // len(SERIES) % 4], "width": 1.6},
        "hovertemplate": "%{x:.3g} Hz: %{y:.3g}",
    }


def _of_run(run: StudyRun) -> Iterator[Spectrum]:
    """Spectra of the lateral channels of bogies and equipment of one run, else of all of these."""
    found = list(_of_case(run)) if (run.folder / CASE).is_file() else list(_of_ride(run))
    lateral = [one for is_lateral, one in found if is_lateral]
    yield from lateral or [one for _, one in found]


def _of_case(run: StudyRun) -> Iterator[tuple[bool, Spectrum]]:
    """Channels that the case of a run names; none where they cannot be read, which its ride says itself."""
    try:
        records, _ = channel_records(load_case(run.folder / CASE))
    except FatigueError:
        return
    several = len({record.event for record in records}) > 1
    for role in ("bogie", "equipment"):
        for record in records:
            if record.role == role and np.isfinite(record.values).all():
                unit = "m/s2" if record.is_acceleration else "-"
                made = _spectrum(record.name, record.event if several else "", unit, record.values, record.step)
                yield from ((record.direction == "y", one) for one in made)


def _of_ride(run: StudyRun) -> Iterator[tuple[bool, Spectrum]]:
    """Channels of the history of a ride without a case."""
    for channel in OWN_CHANNELS:
        for event, folder in run.sources.items():
            for time, values in _columns(Path(folder) / HISTORY, channel):
                step = float(time[-1] - time[0]) / (len(time) - 1)
                event_shown = event if len(run.sources) > 1 else ""
                yield from ((True, one) for one in _spectrum(channel, event_shown, "m/s2", values, step))


def _columns(path: Path, channel: str) -> Iterator[tuple[Floats, Floats]]:
    """Time and values of a column of a file; none where they are not there."""
    try:
        table = pq.read_table(path, columns=["time_s", channel])
    except (OSError, ValueError, KeyError):  # of pyarrow are subclasses of these
        return
    time, values = (table[name].to_numpy().astype(np.float64) for name in ("time_s", channel))
    if len(time) > 2 and np.isfinite(values).all():
        yield time, values


def _spectrum(channel: str, event: str, unit: str, values: Floats, step: float) -> Iterator[Spectrum]:
    """Density by Welch's method, segments of about four seconds."""
    length = min(len(values), 2 ** round(np.log2(max(SEGMENT_S / step, 16.0))))
    if length >= 16:
        f, density = welch(values, fs=1.0 / step, nperseg=length)
        yield Spectrum(channel, event, unit.replace("2", "²"), f, density)
