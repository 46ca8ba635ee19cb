"""The settings of a mode that a study goes through, and which mode it is."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from fatigue.errors import CaseError, DataError, Problem, refuse
from fatigue.readers.neutral.body.modes import LOWEST_HZ, Modes
from fatigue.results import read_table
from fatigue.shown import few, visible
from fatigue.vibration.shifted import Setting

DAMPING = 0.015  # of welded aluminium bodies with floors and seats 0.01 to 0.02; assumed where the modes have none
MOST_SETTINGS = 200


@dataclass(frozen=True, slots=True)
class ShiftedMode:
    """The mode of a study.

    Attributes
    ----------
    row : its row in the modal coordinates
    mode : id
    setting : its frequency and damping as assessed
    damping_is_assumed : whether the modes of the body have no damping for it
    """

    row: int
    mode: int
    setting: Setting
    damping_is_assumed: bool


@dataclass(frozen=True, slots=True)
class LargestShare:
    """A mode and its share of the damage at the worst point of the weld where it has most."""

    mode: int
    share: float
    weld: str


def largest_shares(folder: Path, modes: Modes, events: Sequence[str]) -> tuple[LargestShare, LargestShare]:
    """The normal mode and the mode of any kind with the largest share of damage of some events at any weld.

    The worst point of a weld is the one with the most damage in these events. The share is of that damage.

    Raises
    ------
    DataError : the result has no diagnosis, or no normal mode damages
    """
    if not (folder / "attribution.parquet").exists():
        what = "there is no diagnosis that says which mode makes most damage"
        remedy = "Run `fatigue diagnose` on the folder first, or name the mode with --mode"
        raise DataError(Problem("no_diagnosis", str(folder), what, remedy))
    columns = ["weld", "part", "order", "surface", "event", "kind", "mode", "damage_per_km"]
    table = read_table(folder, "attribution", columns).to_pandas()
    table = table[table["event"].isin(list(events))]
    key = ["weld", "part", "order", "surface"]
    whole = table[table["kind"] == "event"].groupby(key, sort=False)["damage_per_km"].sum()
    worst = whole[whole.groupby("weld").idxmax()]
    worst = worst[worst > 0.0]
    of_modes = table[table["kind"] == "mode"].groupby([*key, "mode"], sort=False)["damage_per_km"].sum()
    shares = of_modes.reset_index().merge(worst.rename("whole").reset_index(), on=key)
    shares["share"] = shares["damage_per_km"] / shares["whole"]
    resonant = [int(mode) for i, mode in enumerate(modes.mode) if _resonates(modes, i)]
    of_resonant = shares[shares["mode"].isin(resonant) & (shares["share"] > 0.0)]
    if of_resonant.empty:
        what = f"no normal mode makes damage under {few([repr(visible(event)) for event in events])}"
        raise DataError(Problem("no_damage", str(folder / "attribution.parquet"), what, "Name the mode with --mode"))
    return _first(of_resonant), _first(shares)


def _first(shares: pd.DataFrame) -> LargestShare:
    found = shares.loc[shares["share"].idxmax()]
    return LargestShare(int(found["mode"]), float(found["share"]), str(found["weld"]))


def _resonates(modes: Modes, row: int) -> bool:
    return modes.kind[row] == "normal" and bool(modes.frequency[row] > LOWEST_HZ)


def chosen_mode(modes: Modes, mode: int, damping: float | None, file: str) -> ShiftedMode:
    """The mode to be moved, as it was assessed; ``damping`` stands in where the table of modes has none.

    Raises
    ------
    CaseError : no such mode, or one that has no resonance
    """
    if mode not in modes.mode:
        near = sorted(modes.mode.tolist(), key=lambda known: abs(known - mode))[:5]
        what = f"the body has no mode {mode}"
        raise CaseError(Problem("unknown_mode", "--mode", what, f"Name a mode of {file}, such as {few(sorted(near))}"))
    row = int(np.flatnonzero(modes.mode == mode)[0])
    frequency, given, kind = float(modes.frequency[row]), float(modes.damping_ratio[row]), modes.kind[row]
    if not _resonates(modes, row):
        kind = "rigid" if kind == "normal" else kind
        why = "it answers statically" if kind == "interface" else "it does not vibrate"
        what = f"mode {mode} at {frequency:g} Hz is of the kind {kind}: {why} and has no resonance to move"
        raise CaseError(Problem("no_resonance", "--mode", what, f"Name a mode of the kind normal of {file}"))
    if np.isfinite(given) and damping is not None:
        what = f"mode {mode} has the damping ratio {given:g} in {file}; it was simulated with one damping only"
        remedy = "Leave --damping out, or correct the table; --to-damping says where it moves to"
        raise CaseError(Problem("damping_is_known", "--damping", what, remedy))
    assumed = not np.isfinite(given)
    z = (DAMPING if damping is None else damping) if assumed else given
    if not 0.0 < z < 1.0:
        what = f"mode {mode} has the damping ratio {z:g} in {file}, and its resonance cannot be divided out"
        raise CaseError(Problem("no_damping", file, what, "Give the damping it was simulated with, between 0 and 1"))
    return ShiftedMode(row, mode, Setting(frequency, z), assumed)


def settings(mode: ShiftedMode, to_hz: Sequence[float], to_damping: Sequence[float]) -> tuple[Setting, ...]:
    """Settings of a study, ascending: every frequency with every damping, and the one as assessed among them.

    Raises
    ------
    CaseError : nothing to move to, numbers that are no settings, or too many
    """
    refuse(CaseError, _senseless(to_hz, to_damping))
    frequencies = sorted({float(f) for f in to_hz}) or [mode.setting.frequency_hz]
    dampings = sorted({float(z) for z in to_damping}) or [mode.setting.damping]
    found = {Setting(f, z) for z in dampings for f in frequencies} | {mode.setting}
    if len(found) > MOST_SETTINGS:
        what = f"{len(found)} settings, {MOST_SETTINGS} are possible"
        raise CaseError(Problem("too_many_settings", "--to", what, "Take a longer step"))
    return tuple(sorted(found, key=lambda one: (one.damping, one.frequency_hz)))


def _senseless(to_hz: Iterable[float], to_damping: Iterable[float]) -> Iterator[Problem]:
    frequencies, dampings = list(to_hz), list(to_damping)
    if not frequencies and not dampings:
        what = "nothing says where the mode is to be moved"
        yield Problem(
            "no_setting", "--to", what, "Give frequencies such as --to 12:15:0.5, or --to-damping 0.01:0.03:0.01"
        )
    for value in frequencies:
        if not (np.isfinite(value) and value > LOWEST_HZ):
            what = f"{value:g} Hz is no frequency of a mode that vibrates"
            yield Problem("bad_setting", "--to", what, "Give frequencies above 0, such as 12:15:0.5")
    for value in dampings:
        if not 0.0 < value < 1.0:
            what = f"{value:g} is no damping ratio of a mode that vibrates"
            yield Problem(
                "bad_setting", "--to-damping", what, "Give damping ratios between 0 and 1, such as 0.01:0.03:0.01"
            )
