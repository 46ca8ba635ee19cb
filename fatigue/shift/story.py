"""The shift study as a story: a finished result, one mode moved to other settings, and life against them.

A screening without feedback. The coordinate of the mode is filtered as its oscillator would be at the new setting under
the same modal force; all others stay. The points are solved again, from inputs that may not have changed, and their
cycles are counted again at every setting.
"""

import logging
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.errors import CaseError, Problem, given_path, refuse
from fatigue.life.mission import Plan, life_km
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.events import event_loads
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.assessed_body import assessed_body
from fatigue.pipeline.solve.weld_groups import weld_groups
from fatigue.pipeline.tables.rows import FACES
from fatigue.results import (
    ASSESSED,
    DIAGNOSED,
    SHIFTED,
    adding,
    finished_result,
    read_table,
    refuse_mixed,
    upsampling_factors,
)
from fatigue.shift.moved import FEWEST_MEMORIES, QUASI_STATIC, Moved, Movement, moved_loads, nyquist_hz
from fatigue.shift.recounted import event_damage, sequence_damage
from fatigue.shift.settings import LargestShare, ShiftedMode, chosen_mode, largest_shares, settings
from fatigue.shift.summary import LIMITS, SCREENING, ShiftStudy, WeldCurve, setting_line, weld_curve
from fatigue.shown import few, visible
from fatigue.stages import stage
from fatigue.vibration.shifted import Setting
from fatigue.why.points import Chosen, Points, choose_points, gather_points

log = logging.getLogger(__name__)

Floats = NDArray[np.float64]
Progress = Callable[[str, int, int], None]

SHARE_OF_LIMIT = 0.1  # utilisation from which a point is counted again when not all points are
_CHEAPER = 10  # at least so much quicker is counting than sharing out the damage, whose budget is taken


def shift(
    folder: Path | str,
    *,
    mode: int | None = None,
    to_hz: Sequence[float] = (),
    to_damping: Sequence[float] = (),
    damping: float | None = None,
    events: Sequence[str] = (),
    case_file: Path | str | None = None,
    threads: int | None = None,
    no_lock: bool = False,
    progress: Progress = lambda label, done, total: None,
) -> ShiftStudy:
    """Life against the frequency or damping of one mode, a screening without feedback; table ``shift`` in the folder.

    Parameters
    ----------
    folder : result of an assessment
    mode : id; by default that with the largest share of the damage, as the diagnosis in the folder has it
    to_hz, to_damping : frequencies [Hz] and damping ratios [-] that it is moved to, each with each
    damping : ratio it was simulated with where the modes have none, by default 0.015
    events : in which it is moved, by default in all
    case_file : the case it was made from; by default where the provenance of the result says
    threads : that count points, by default one per processor core; the numbers do not depend on it
    no_lock : for a file system without locks, see ``fatigue.assess``
    progress : called with a label, counts done and counts in all

    Raises
    ------
    DataError : no finished result in the folder, no diagnosis where it is needed, or inputs are gone or have changed
    CaseError : a mode without resonance, settings that make no sense, unknown events
    """
    folder = given_path(folder, "folder")
    case_file = None if case_file is None else given_path(case_file, "case_file")
    stage("reading the result and its case")
    record = finished_result(folder, ASSESSED, ("nodes",), no_lock=no_lock)
    body = assessed_body(record, folder, case_file)
    plan, _ = mission_plan(body, threads)
    moved_in = _moved_in(plan, events)
    modes_file = str(body.case.body.modes)
    shares: tuple[LargestShare, ...] = ()
    if mode is None:
        refuse_mixed(folder, record, DIAGNOSED, read=("attribution",))
        shares = largest_shares(folder, body.modes, moved_in)
    moving = chosen_mode(body.modes, shares[0].mode if mode is None else mode, damping, modes_file)
    every = settings(moving, to_hz, to_damping)
    factors = upsampling_factors(record)
    with adding(folder, record, SHIFTED, no_lock=no_lock) as addition:
        chosen = _affordable(folder, plan, factors, moved_in, len(every))
        stage("preparing the records of the events (%d)", len(plan.passes))
        groups = weld_groups(body, addition.scratch / "forces")
        points = gather_points(folder, groups, chosen)
        loads = event_loads(groups, plan, addition.scratch / "histories", threads, factors)
        static = _static_events(loads, moving, every, plan, moved_in)

        stage("counting %d points at %d settings", len(points), len(every))
        at = [one.event in moved_in for one in plan.passes]
        damage, moved = np.zeros((len(every), len(points))), []
        as_they_are: dict[int, Floats] = {}
        for number, setting in enumerate(every):
            progress("shift", number, len(every))
            events_now = moved_loads(loads, Movement(moving.row, moving.setting, setting), at, static)
            moved.append(events_now)
            damage[number] = _damage(points, [one.load for one in events_now], loads, plan, as_they_are, threads)
        progress("shift", len(every), len(every))
        warnings = list(_doubts(plan, moved_in, static, moved, every))
        for problem in warnings:
            log.warning("%s", problem)

        stage("writing tables")
        life = life_km(damage, points.damage_limit)
        with addition.table("shift") as table:
            for setting, of_setting, lives in zip(every, damage, life, strict=True):
                table.write(_rows(points, moving, setting, of_setting, lives, life[every.index(moving.setting)]))
        said = {
            "method": SCREENING,
            "limits": LIMITS,
            "mode": moving.mode,
            "frequency_hz": moving.setting.frequency_hz,
            "damping_ratio": moving.setting.damping,
            "damping_is_assumed": moving.damping_is_assumed,
            "to": [setting._asdict() for setting in every],
            "events": list(moved_in),
            "points": chosen.what,
            "warnings": [asdict(problem) for problem in warnings],
        }
        addition.publish({"shift_study": said})
    return ShiftStudy(
        title=body.case.title,
        method=SCREENING,
        limits=LIMITS,
        mode=moving.mode,
        frequency_hz=moving.setting.frequency_hz,
        damping_ratio=moving.setting.damping,
        damping_is_assumed=moving.damping_is_assumed,
        largest_shares=shares,
        events=tuple(one.event for one in plan.passes),
        moved=tuple(moved_in),
        points=chosen.what,
        is_static=_is_static(moved),
        settings=tuple(setting_line(s, moving, [m.rms_ratio for m in of]) for s, of in zip(every, moved, strict=True)),
        welds=_curves(points, life, every),
        warnings=tuple(warnings),
    )


def _moved_in(plan: Plan, events: Sequence[str]) -> tuple[str, ...]:
    """Events in which the mode is moved, in their order.

    Raises
    ------
    CaseError : an event that the mission does not have
    """
    names = [one.event for one in plan.passes]
    unknown = [name for name in events if name not in names]
    known = few([f"{visible(name)!r}" for name in names], 10)
    refuse(
        CaseError,
        [
            Problem("unknown_event", "--event", f"the mission has no event {visible(str(name))!r}", f"It has {known}")
            for name in unknown
        ],
    )
    return tuple(name for name in names if not events or name in events)


def _affordable(folder: Path, plan: Plan, factors: Sequence[int], moved_in: Sequence[str], settings: int) -> Chosen:
    """Points with a weld toe: all if that is affordable, else as for a diagnosis; a face without toe never governs."""
    counts = [settings if one.event in moved_in else 1 for one in plan.passes]
    samples = sum(n * f * one.samples for n, f, one in zip(counts, factors, plan.passes, strict=True))
    chosen = choose_points(folder, max(1, samples // _CHEAPER), SHARE_OF_LIMIT, settings)
    toe = read_table(folder, "nodes", ["toe"])["toe"].to_numpy()
    kept = np.asarray(toe, dtype=np.bool_)[chosen.rows]
    rows = chosen.rows[kept]
    worst = np.searchsorted(rows, chosen.rows[chosen.worst][kept[chosen.worst]])
    everywhere = f"all {len(rows)} points with a weld toe"
    return Chosen(rows, chosen.why[kept], worst, everywhere if (chosen.why == "all").all() else chosen.what)


def _static_events(
    loads: Sequence[EventLoad], moving: ShiftedMode, to: Sequence[Setting], plan: Plan, moved_in: Sequence[str]
) -> list[bool]:
    """Whether the record of each event cannot hold the resonance, at one of the settings: only what is static moves.

    Raises
    ------
    CaseError : no record can hold it
    """
    highest = max(setting.frequency_hz for setting in (*to, moving.setting))
    static = [highest >= nyquist_hz(load) for load in loads]
    limits = [nyquist_hz(load) for load, one in zip(loads, plan.passes, strict=True) if one.event in moved_in]
    if highest < max(limits):
        return static
    what = f"{highest:g} Hz is not below half the sampling rate of any event, {max(limits):.5g} Hz"
    if moving.setting.frequency_hz >= max(limits):
        what = f"mode {moving.mode} is at {what}: it answers quasi-statically, and no resonance can be moved"
        raise CaseError(Problem("above_nyquist", "--mode", what, "Name a mode that the records can hold"))
    raise CaseError(Problem("above_nyquist", "--to", what, "Stay below, or sample the records more finely"))


def _damage(
    points: Points,
    moved: Sequence[EventLoad],
    loads: Sequence[EventLoad],
    plan: Plan,
    as_they_are: dict[int, Floats],
    threads: int | None,
) -> Floats:
    """Miner sum of every point per km (p,) [1/km]; ``as_they_are`` keeps those of events that are not moved."""
    damage = sequence_damage(points, moved, plan)
    for number, (load, before, one_pass) in enumerate(zip(moved, loads, plan.passes, strict=True)):
        if load is not before:
            of_event = event_damage(points, load, threads)
        else:
            if number not in as_they_are:
                as_they_are[number] = event_damage(points, load, threads)
            of_event = as_they_are[number]
        damage += one_pass.passes_per_km * of_event
    return damage


def _rows(
    points: Points, moving: ShiftedMode, setting: Setting, damage: Floats, life: Floats, assessed: Floats
) -> dict[str, object]:
    """Rows of the table ``shift``: every point at one setting."""
    n = len(points)
    with np.errstate(invalid="ignore"):
        ratio = np.where(np.isinf(life) & np.isinf(assessed), 1.0, life / assessed)
    shortest = pd.Series(life).groupby(points.weld).idxmin().to_numpy()
    return {
        "weld": points.weld,
        "part": points.part,
        "node": points.node,
        "order": points.order,
        "surface": [FACES[face] for face in points.face],
        "mode": np.full(n, moving.mode),
        "frequency_hz": np.full(n, setting.frequency_hz),
        "damping_ratio": np.full(n, setting.damping),
        "is_as_assessed": np.full(n, setting == moving.setting),
        "damage_per_km": damage,
        "life_km": life,
        "life_ratio": ratio,
        "is_worst_of_weld": np.isin(np.arange(n), shortest),
    }


def _curves(points: Points, life: Floats, every: tuple[Setting, ...]) -> tuple[WeldCurve, ...]:
    """Curve of every weld, that with the shortest life at any setting first."""
    curves = []
    for weld in dict.fromkeys(points.weld.tolist()):
        own = np.flatnonzero(points.weld == weld)
        worst = own[life[:, own].argmin(axis=1)]
        lives = life[np.arange(len(every)), worst]
        nodes, faces = points.node[worst].tolist(), [FACES[face] for face in points.face[worst]]
        curves.append((float(lives.min()), weld_curve(str(weld), lives, nodes, faces, every)))
    return tuple(curve for _, curve in sorted(curves, key=lambda one: one[0]))


def _is_static(moved: Sequence[Sequence[Moved]]) -> bool:
    """Whether moving the mode does no more than scale its coordinate, in all events and at all settings."""
    beside = [one.beside_static for events in moved for one in events if np.isfinite(one.beside_static)]
    return bool(beside) and max(beside) < QUASI_STATIC


def _doubts(
    plan: Plan, moved_in: Sequence[str], static: Sequence[bool], moved: Sequence[Sequence[Moved]], to: Sequence[Setting]
) -> Iterator[Problem]:
    """Doubts about a study, each once."""
    names = [one.event for one in plan.passes]
    slow = [name for name, is_static in zip(names, static, strict=True) if is_static and name in moved_in]
    if slow:
        highest = max(setting.frequency_hz for setting in to)
        what = f"{few([visible(name) for name in slow])}: sampled too coarsely to hold {highest:g} Hz, so the mode is "
        what += "scaled by (f / f')^2 there and nothing resonates"
        yield Problem("shift_static", "--to", what, "Sample the record at more than twice the frequency")
    memories = {
        name: min(events[i].memories for events in moved)
        for i, name in enumerate(names)
        if name in moved_in and not static[i]
    }
    short = [name for name, lasts in memories.items() if lasts < FEWEST_MEMORIES]
    if short:
        least = min(memories.values())
        what = (
            f"{few([visible(name) for name in short])}: the record lasts {least:.2g} times as long as the moved mode "
        )
        what += f"remembers, 1 / (2 pi z f), below {FEWEST_MEMORIES:g}: how it comes in and goes out decides"
        yield Problem("shift_short", "--to", what, "Record longer, or take the lives for an order of magnitude")
