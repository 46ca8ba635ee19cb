"""The figures of one point: its cycles, its records, and what a diagnosis knows of its damage."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.report import figures, wording
from fatigue.report.figures.drawn import Figure
from fatigue.report.of_record import Record, coordinates_of, events_of, mode_names, target_of, weights_of
from fatigue.report.sections.embed import Figures, Shown
from fatigue.report.sections.point.detail import Detail
from fatigue.report.sections.why import Why, band_shares, mode_shares
from fatigue.report.stress import Envelope, Excerpt, StressSpectrum
from fatigue.report.variants import Assumptions, how_often, laws_of

SPECTRA_DRAWN, MODES_DRAWN, MODES_MARKED = 6, 8, 4


def cycle_figures(record: Record, name: str, cycles: pd.DataFrame, used: Assumptions, figs: Figures) -> list[Shown]:
    """Rainflow and damage matrix, exceedance, and the S-N curve with the spectrum of a point; none without cycles.

    ``cycles`` are its rows in the table of cycles, ``name`` is what the captions call it.
    """
    if cycles.empty or not cycles["range_MPa"].max() > 0.0:
        return []
    passes_per_km = weights_of(record)
    per_km = how_often(cycles, passes_per_km)
    of_target = f"{name}: S-N curve and the cycles of {wording.km(target_of(record))}"
    return [
        figs.add(
            "matrix",
            figures.rainflow_matrices(cycles, per_km),
            f"{name}: rainflow matrix and damage matrix",
            wide=True,
        ),
        figs.add("exceedance", figures.exceedance(cycles, passes_per_km), f"{name}: stress ranges in 1e6 km"),
        figs.add("sn", draw_sn(record, cycles, used), of_target),
    ]


def draw_sn(record: Record, cycles: pd.DataFrame, used: Assumptions) -> Figure:
    """The S-N curve of a point and the spectrum of its cycles up to the target."""
    per_target = how_often(cycles, weights_of(record)) * target_of(record)
    unit = "MPa mm<sup>−0.222</sup>" if used.curve.applies == "dS" else "MPa"
    return figures.sn_with_spectrum(cycles, per_target, laws_of(used), used.survival, unit)


def record_figures(record: Record, detail: Detail, event: str | None, figs: Figures, *, modes_too: bool) -> list[Shown]:
    """Figures of the records, none where nothing damages; with the modes' shares of the variance if asked."""
    if event is None:
        return []
    return [
        *history_figure(record, detail, event, figs),
        *(variance_figure(record, detail, event, "the worst point", figs) if modes_too else ()),
        *spectrum_figure(record, detail, event, figs),
    ]


def history_figure(record: Record, detail: Detail, event: str, figs: Figures) -> list[Shown]:
    """Stress over the whole record of an event, and close by at its most damaging cycle."""
    if detail.envelope is None:
        return []
    history = draw_history(record, detail.envelope, detail.excerpts)
    close_by = ", and close by at its most damaging cycle" if detail.excerpts else ""
    caption = f"Stress in event {wording.short(event)}{close_by}"
    return [figs.add("history", history, caption, wide=True, of_curve=False)]


def draw_history(record: Record, envelope: Envelope, excerpts: Sequence[Sequence[Excerpt]]) -> Figure:
    """Stress over a record, and close by at the first of some cycles."""
    names, _ = mode_names(record)
    first = excerpts[0] if excerpts else ()
    return figures.stress_history(envelope, first, names, _colours(record)[envelope.event])


def variance_figure(record: Record, detail: Detail, event: str, whose: str, figs: Figures) -> list[Shown]:
    """Shares of modes and unit loads in the variance of the stress; none where nothing varies."""
    if detail.variance_share is None or np.isnan(detail.variance_share).all():
        return []
    names, _ = mode_names(record)
    parts = _leading(record, detail.variance_share)
    title = f"share of the stress variance in event {wording.in_figure(event)} [%]"
    bars = figures.shares([names[mode] for mode in parts], np.array(list(parts.values())), title)
    what = "Modes and unit loads" if record.get("unit_loads") else "Modes"
    return [figs.add("modes", bars, f"{what} in the stress of {whose}", of_curve=False)]


def spectrum_figure(record: Record, detail: Detail, event: str, figs: Figures) -> list[Shown]:
    """Spectra of the stress, with the normal modes marked that lead in its variance; none where nothing varies."""
    if detail.variance_share is None or not detail.spectra or np.isnan(detail.variance_share).all():
        return []
    spectrum = draw_spectrum(record, detail.spectra, detail.variance_share, event)
    caption = "Stress spectrum, the leading normal modes, and where the variance lies"
    return [figs.add("psd", spectrum, caption, of_curve=False)]


def draw_spectrum(
    record: Record, spectra: Sequence[StressSpectrum], variance_share: NDArray[np.float64], event: str
) -> Figure:
    """Spectra of the stress, that of an event first, with the normal modes marked that lead in its variance there."""
    _, natural = mode_names(record)
    parts = _leading(record, variance_share)
    drawn = sorted(spectra, key=lambda s: s.event != event)[:SPECTRA_DRAWN]
    marked = {f"mode {m}, {natural[m]:.4g} Hz": (natural[m], part) for m, part in parts.items() if m in natural}
    return figures.stress_spectrum(drawn, _colours(record), dict(list(marked.items())[:MODES_MARKED]), event)


def _colours(record: Record) -> dict[str, str]:
    return figures.event_colours([event["event"] for event in events_of(record)])


def _leading(record: Record, variance_share: NDArray[np.float64]) -> dict[int, float]:
    """The largest shares of the variance by mode or unit load."""
    leading = np.argsort(-np.abs(variance_share), kind="stable")[:MODES_DRAWN]
    numbers = list(coordinates_of(record))
    return {numbers[k]: float(variance_share[k]) for k in leading}


def shear_figure(record: Record, detail: Detail, event: str | None, figs: Figures) -> list[Shown]:
    """Path of normal stress and shear where the model of shear decides; else nothing."""
    if detail.path is None:
        return []
    beta = float(record["rules"]["multiaxial"]["beta"])
    normal, of_shear = detail.path
    path = figures.shear_path(normal, of_shear, beta, _largest_half_cycle(detail.path, beta))
    caption = f"Path of normal stress and shear in event {wording.short(event or '')}: the model of shear decides"
    return [figs.add("path", path, caption)]


def _largest_half_cycle(path: NDArray[np.float64], beta: float) -> tuple[int, int]:
    """Samples of the most distant pair of a path (2, t), to 1e-4 of their distance: by their extents in directions."""
    angles = np.radians(np.arange(0.0, 180.0, 1.0))
    along = np.stack([np.cos(angles), np.sqrt(beta) * np.sin(angles)], axis=1) @ path
    widest = int(np.ptp(along, axis=1).argmax())
    first, last = sorted((int(along[widest].argmin()), int(along[widest].argmax())))
    return first, last


def why_figures(record: Record, why: Why, event: str, figs: Figures) -> list[Shown]:
    """Figures of the modes, frequency bands and places that make the damage of a point."""
    names, natural = mode_names(record)
    shown = []
    modes = mode_shares(why).head(MODES_DRAWN)
    title = "share of the damage, all events [%]"
    pairs = zip(modes["mode"], modes["unit_load"], strict=True)
    called = [f"unit load {load}" if pd.isna(mode) else names[mode] for mode, load in pairs]
    bars = figures.shares(called, modes["share"].to_numpy(), title)
    what = "mode and unit load" if record.get("unit_loads") else "mode"
    shown.append(figs.add("damage-modes", bars, f"Damage by {what}; a negative share relieves"))
    bands = band_shares(why)
    if len(bands) > 1:
        leading = modes["mode"].dropna()[:MODES_MARKED]
        marked = [natural[mode] for mode in leading if mode in natural]
        caption = "Damage by frequency band; dotted: the leading normal modes"
        shown.append(figs.add("damage-bands", figures.damage_by_band(bands, marked), caption))
    track = why.track[why.track["event"] == event]
    if len(track) > 1:
        caption = f"Where in event {wording.short(event)} the damage is made"
        shown.append(figs.add("track", figures.damage_on_track(track), caption))
    return shown
