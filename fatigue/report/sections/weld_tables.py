"""The tables of one weld's worst point: its facts, its events, its life under other assumptions, its levers."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from fatigue.report import wording
from fatigue.report.sections.cells import Cell, Heading, PageTable, given, integer, life, num, percent, text
from fatigue.report.wording import NOT_AVAILABLE, life_km, life_years, listed


def facts(point: pd.Series, row: pd.Series, curve: str) -> list[tuple[str, str]]:
    """Where the worst point is and what it endures; ``point`` is from the table of nodes, ``row`` from the register.

    ``curve`` is its curve in words.
    """
    corner = "corner whose nodal forces are one sum of both legs" if point["summed_corner"] else "corner"
    flags = [words for words, flag in (("weld end", point["at_end"]), (corner, point["at_corner"])) if flag]
    event = NOT_AVAILABLE if pd.isna(point["governing_event"]) else str(point["governing_event"])
    place = f"{wording.given(point['arc_length_mm'])} mm along part {point['part']}"
    return [
        ("Point", f"node {point['node']}, {point['surface']} face, {place}"),
        ("Position x, y, z", ", ".join(wording.given(point[c]) for c in ("x_mm", "y_mm", "z_mm")) + " mm"),
        ("Place", listed(flags) or "along the line"),
        ("Plate", f"{wording.given(point['thickness_mm'])} mm"),
        ("Curve", f"{curve}, {row['survival']}"),
        ("Life", f"{life_km(point['life_km'])} ({life_years(point['life_years'])})"),
        ("Utilisation, damage", wording.result(point["utilisation"])),
        ("Utilisation, load", wording.result(1.0 / point["load_factor"])),
        ("Load factor to the target", wording.result(point["load_factor"])),
        ("Governing event", event),
        ("Largest range", f"{wording.result(point['max_range_MPa'])} MPa"),
        ("Equivalent range at 2e6", f"{wording.result(point['equivalent_range_2e6_MPa'])} MPa"),
        ("Bending ratio", wording.result(point["bending_ratio"])),
        ("R of the largest cycle", wording.result(point["R_largest_cycle"])),
        ("Mean stress", f"{wording.result(point['mean_stress_MPa'])} MPa"),
        ("Shear / normal stress, rms", wording.result(point["shear_ratio"])),
        ("Life by Dirlik", _dirlik_life(point["life_km_dirlik"], str(point["dirlik_verdict"]))),
        ("Dirlik / rainflow damage", wording.result(point["dirlik_ratio"])),
        ("Trust in Dirlik", str(point["dirlik_verdict"]).replace("_", " ")),
        ("Life, end not treated", _raw_life(point["life_km_raw_end"])),
    ]


def _dirlik_life(km: float, verdict: str) -> str:
    """Life by Dirlik's formula, or why there is none."""
    outside = np.isnan(km) and verdict == "outside_band"
    return "none, the spectra miss too much of the stress" if outside else life_km(km)


def _raw_life(km: float) -> str:
    """Life without the end treatment, which screening leaves out where it is proven to be long."""
    return "not counted, proven to be long enough" if np.isnan(km) else life_km(km)


def variant_table(id_: str, variants: pd.DataFrame, assessed_km: float, km_per_year: float) -> PageTable:
    """Life with one assumption changed at a time; ``variants`` as ``fatigue.report.variants.variants`` makes them."""
    rows = []
    for assumption, choice, used, factor in variants.itertuples(index=False):
        changed_km = np.inf if factor == 0.0 else assessed_km / factor
        marked = Cell(f"{choice} (used)", mark="used") if used else Cell(choice)
        rows.append((Cell(assumption), marked, life(changed_km), life(changed_km / km_per_year), num(factor)))
    headings = (
        Heading("assumption", numeric=False),
        Heading("choice", numeric=False),
        Heading("life", "km"),
        Heading("life", "years"),
        Heading("damage factor", "-"),
    )
    return PageTable(id_, headings, tuple(rows))


def event_table(id_: str, damage: pd.DataFrame, passes_per_km: Mapping[str, float], most: int) -> PageTable:
    """The events at one point, of many those that damage most; ``damage`` are rows of the table of damage."""
    weighted = damage["damage_per_pass"] * damage["event"].map(passes_per_km)
    total = weighted.sum()
    if len(damage) > most:
        weighted = weighted.sort_values(ascending=False, kind="stable").head(most)
        damage = damage.loc[weighted.index]
    ratio = damage["damage_dirlik_per_pass"] / damage["damage_same_ratio_per_pass"].replace(0.0, np.nan)
    rows = tuple(
        (
            Cell(row.event),
            percent(part / total if total > 0.0 else np.nan),
            num(row.damage_per_pass),
            num(row.max_range_MPa),
            num(row.cycles_per_pass),
            num(row.bending_ratio),
            num(quotient),
            num(row.kurtosis),
            num(row.irregularity),
            num(row.peaks_per_s),
            num(row.samples_per_peak),
            percent(row.outside_share),
        )
        for row, part, quotient in zip(damage.itertuples(), weighted, ratio, strict=True)
    )
    headings = (
        Heading("event", numeric=False),
        Heading("share of damage", "%"),
        Heading("damage of a pass", "-"),
        Heading("largest range", "MPa"),
        Heading("cycles of a pass", "-"),
        Heading("bending ratio", "-"),
        Heading("Dirlik / rainflow", "-"),
        Heading("kurtosis", "-"),
        Heading("irregularity", "-"),
        Heading("peaks", "1/s"),
        Heading("samples per peak", "-"),
        Heading("variance above the band", "%"),
    )
    return PageTable(id_, headings, rows)


def lever_table(id_: str, levers: pd.DataFrame) -> PageTable:
    """Which mode or unit load, if 10 % smaller, buys most km; ``levers`` has the columns of the table of that name."""
    with_loads = bool(levers["unit_load"].notna().any())
    rows = tuple(
        (
            integer(row.mode) if pd.isna(row.unit_load) else text(row.unit_load),
            given(row.frequency_hz),
            Cell(row.kind.replace("_", " ")),
            percent(row.share),
            num(row.life_exponent),
            life(row.life_km_estimated),
            life(row.life_km_counted),
            life(row.gain_km),
        )
        for row in levers.sort_values("rank").itertuples()
    )
    headings = (
        Heading("mode or unit load" if with_loads else "mode", numeric=not with_loads),
        Heading("frequency", "Hz"),
        Heading("kind", numeric=False),
        Heading("share of damage", "%"),
        Heading("d ln life / d ln amplitude", "-"),
        Heading("life, estimated", "km"),
        Heading("life, counted again", "km"),
        Heading("gain", "km"),
    )
    return PageTable(id_, headings, rows)
