"""Rows of the table of answers: every weld, the one that decides first, and before them the whole body."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.decide.backsolve.by_mission import Mileage, Shares, weights_of
from fatigue.decide.backsolve.by_strength import SCAN, Strengths
from fatigue.decide.backsolve.forward import Base
from fatigue.decide.backsolve.question import Question
from fatigue.shown import few, visible

Floats = NDArray[np.float64]

JUMP = "the target is passed in a jump, at a cut-off or where a mean-stress rule begins: this side of it meets it"
RISES = "not monotonic: a thicker plate may do worse; from here on all thicker ones that were looked at meet the target"
AT_END = "at a weld end, treated over the plate thickness as it was: treated over the new one the damage is another"
ENOUGH = 1e-9  # relative, of passes that a loop needs


@dataclass(frozen=True, slots=True)
class AnswerRow:
    """Columns of ``backsolve``."""

    question: str
    weld: str
    part: int | None
    node: int | None
    order: int | None
    surface: str
    state: str
    unit: str
    now: float
    answer: float
    sense: str
    low: float
    high: float
    factor: float
    share_at_least: float
    share_at_most: float
    utilisation_now: float
    utilisation_at_answer: float
    deviation: float
    utilisation_at_0: float
    utilisation_at_1: float
    basis: str
    not_monotonic: bool
    note: str


def strength_rows(base: Base, asked: Question, found: Strengths) -> tuple[AnswerRow, ...]:
    """Answers for load, curve and thickness: the body first, then the welds, the one that asks for most first."""
    order = np.argsort(-found.x, kind="stable").tolist()
    welds = [_of_strength(base, asked, found, weld) for weld in order]
    first = welds[0]
    factor, rises = _body_factor(asked, found, first), bool(found.not_monotonic.any())
    body = replace(first, weld="", factor=factor, not_monotonic=rises)
    if asked.of == "thickness":  # plates differ: one factor on all of them
        note = f"one factor on all thicknesses; {first.note}".removesuffix("; ")
        body = replace(body, note=note, now=np.nan, answer=np.nan, low=np.nan, high=np.nan)
    elif first.state == "solved":
        body = replace(body, **_body_bounds(asked, found))
    return (body, *welds)


def _body_factor(asked: Question, found: Strengths, first: AnswerRow) -> float:
    x = float(found.x.max())
    if first.state != "solved":
        return np.nan
    return 1.0 / x if asked.of == "load" else x


def _body_bounds(asked: Question, found: Strengths) -> dict[str, Any]:
    """Bounds of the strength of the body: of all welds the largest lower one, and the largest upper one."""
    low, high = float(found.low.max()), float(found.high.max())
    return {"low": 1.0 / high, "high": 1.0 / low} if asked.of == "load" else {"low": low, "high": high}


def _of_strength(base: Base, asked: Question, found: Strengths, weld: int) -> AnswerRow:
    x, row = float(found.x[weld]), int(found.row[weld])
    state = "none" if np.isinf(x) else "any" if x == 0.0 else "solved"
    thickness = float(base.stored.thickness[row])
    now, unit = (thickness, "mm") if asked.of == "thickness" else (1.0, "-")
    ends = [float(found.low[weld]), x, float(found.high[weld])]
    values = [now / v if asked.of == "load" else now * v for v in ends] if state == "solved" else [np.nan] * 3
    notes = [JUMP] if found.jumps[weld] and state == "solved" else []
    if asked.of == "thickness":
        notes += [RISES] if found.not_monotonic[weld] else []
        notes += [AT_END] if state == "solved" and base.is_treated_over_thickness(weld, row) else []
        if state == "any":
            notes.append(f"met from {SCAN[0]:g} to {SCAN[-1]:g} times the thickness: thinner was not looked at")
        elif state == "none":
            notes.append(f"not met at {SCAN[-1]:g} times the thickness: thicker was not looked at")
    return AnswerRow(
        question=asked.name,
        **_point(base, weld, row),
        state=state,
        unit=unit,
        now=now,
        answer=values[1],
        sense="at_most" if asked.of == "load" else "at_least",
        low=min(values),
        high=max(values),
        factor=values[1] / now,
        share_at_least=np.nan,
        share_at_most=np.nan,
        **_utilisations(base, asked, weld, row, float(found.utilisation[weld])),
        utilisation_at_0=np.nan,
        utilisation_at_1=np.nan,
        basis=str(found.basis[weld]) or "exact",
        not_monotonic=bool(found.not_monotonic[weld]),
        note="; ".join(notes),
    )


def mileage_rows(base: Base, asked: Question, found: Mileage) -> tuple[AnswerRow, ...]:
    """Answers for the mileage: the body first, then the welds, that which bears least first."""
    now = float(base.stored.record["mission"]["km_per_year"])
    welds = []
    for weld in np.argsort(found.km_per_year, kind="stable").tolist():
        km, row = float(found.km_per_year[weld]), int(found.row[weld])
        solved = np.isfinite(km)
        answer = km if solved else np.nan
        welds.append(
            AnswerRow(
                question=asked.name,
                **_point(base, weld, row),
                state="solved" if solved else "any",
                unit="km/a",
                now=now,
                answer=answer,
                sense="at_most",
                low=answer,
                high=answer,
                factor=answer / now,
                share_at_least=np.nan,
                share_at_most=np.nan,
                **_utilisations(base, asked, weld, row, float(found.utilisation[weld])),
                utilisation_at_0=np.nan,
                utilisation_at_1=np.nan,
                basis="recount" if found.counted[weld] else "exact",
                not_monotonic=False,
                note="",
            )
        )
    return (replace(welds[0], weld=""), *welds)


def share_rows(base: Base, asked: Question, found: Shares) -> tuple[AnswerRow, ...]:
    """Answers for the share of an event: the body first, then the welds, that with the narrowest span first."""
    width = found.span.high - found.span.low
    order = np.argsort(width, kind="stable").tolist()
    welds = [_of_share(base, asked, found, weld) for weld in order]
    low, high = float(found.span.low.max()), float(found.span.high.min())
    now = welds[0].now
    at_0, at_1 = float(found.at_0.max()), float(found.at_1.max())
    above, below = high < 1.0, low > 0.0
    if low > high:
        state, deciding, answer = "none", int(width.argmin()), np.nan
    elif not (above or below):
        state, deciding, answer = "any", int(width.argmin()), np.nan
    else:
        is_upper = above and (not below or abs(high - now) <= abs(low - now))
        deciding = int(found.span.high.argmin() if is_upper else found.span.low.argmax())
        state, answer = "solved", high if is_upper else low
    row = next(one for one in welds if one.weld == base.stored.welds[deciding])
    body = replace(
        row,
        weld="",
        state=state,
        answer=answer,
        low=answer,
        high=answer,
        factor=answer / now if now > 0.0 else np.nan,
        share_at_least=low if low <= high else np.nan,
        share_at_most=high if low <= high else np.nan,
        utilisation_at_0=at_0,
        utilisation_at_1=at_1,
    )
    if state != "solved" or row.answer != answer:
        body = replace(body, utilisation_at_answer=np.nan, deviation=np.nan)
    return (body, *welds)


def _of_share(base: Base, asked: Question, found: Shares, weld: int) -> AnswerRow:
    low, high, at = float(found.span.low[weld]), float(found.span.high[weld]), float(found.answer[weld])
    row = int(found.row[weld])
    state = "none" if low > high else "any" if np.isnan(at) else "solved"
    events = base.stored.record["mission"]["events"]
    now = float(next(one["share"] for one in events if one["event"] == asked.event))
    return AnswerRow(
        question=asked.name,
        **_point(base, weld, row),
        state=state,
        unit="-",
        now=now,
        answer=at,
        sense="" if state != "solved" else "at_most" if found.is_upper[weld] else "at_least",
        low=at,
        high=at,
        factor=at / now if now > 0.0 else np.nan,
        share_at_least=low if low <= high else np.nan,
        share_at_most=high if low <= high else np.nan,
        **_utilisations(base, asked, weld, row, float(found.utilisation[weld])),
        utilisation_at_0=float(found.at_0[weld]),
        utilisation_at_1=float(found.at_1[weld]),
        basis="recount" if found.counted[weld] else "exact",
        not_monotonic=False,
        note="; ".join(_short_loops(base, asked, at)),
    )


def _short_loops(base: Base, asked: Question, share: float) -> Iterator[str]:
    """Loops of events that need more passes than there are at a share."""
    if np.isnan(share):
        return
    weights, events = weights_of(base, asked.event, share), base.change.events
    for number, loop in enumerate(base.change.loops):
        runs = weights[events + number]
        short = [e for e in dict.fromkeys(loop) if weights[e] < loop.count(e) * runs * (1.0 - ENOUGH)]
        if short:
            names = few([visible(base.change.names[e]) for e in short])
            yield f"{base.change.names[events + number]} needs more passes of {names} than there are then"


def _point(base: Base, weld: int, row: int) -> dict[str, Any]:
    key: pd.Series = base.keys.iloc[row]
    return {
        "weld": base.stored.welds[weld],
        "part": int(key["part"]),
        "node": int(key["node"]),
        "order": int(key["order"]),
        "surface": str(key["surface"]),
    }


def _utilisations(base: Base, asked: Question, weld: int, row: int, at_answer: float) -> dict[str, Any]:
    """Utilisation of the point now, and at the answer; the deviation is that of what was solved."""
    now = float(base.stored.damage_per_km[row] * asked.target_km / base.limit[weld])
    return {
        "utilisation_now": now,
        "utilisation_at_answer": at_answer,
        "deviation": abs(at_answer - 1.0),
    }
