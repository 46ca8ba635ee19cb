"""What is said of a result beside the reference: who gains, who loses, why, which verdicts flip, and what to doubt."""

import math
from collections.abc import Iterator, Sequence

import pandas as pd

from fatigue.decide.compare.pairs import GAINED, LOST, POINT, Pair
from fatigue.decide.compare.ratios import EXACT
from fatigue.decide.compare.split import MODE, UNIT_LOAD, WHOLE
from fatigue.decide.compare.words import SAME, is_same, times
from fatigue.report.wording import life_km, listed
from fatigue.shown import few, shortened

MOST = {"loses": "The largest loss is that of", "gains": "The largest gain is that of"}


def gains(pair: Pair) -> tuple[pd.DataFrame, pd.DataFrame, pd.DataFrame]:
    """Welds that lose life, those that gain some, the largest change first, and those that last as long."""
    ratio = pair.welds["log_life_ratio"]
    same = ratio.map(is_same) | ratio.isna()
    return pair.welds[~same & (ratio < 0.0)], pair.welds[~same & (ratio > 0.0)][::-1], pair.welds[same]


def sentences(pair: Pair) -> Iterator[str]:
    """Who gains and loses, why, and which welds flip, in a few sentences."""
    b, (losing, gaining, same) = pair.other.letter, gains(pair)
    if pair.welds.empty:
        yield "No matched weld has a toe, so that no life is compared."
        return
    welds = f"{len(pair.welds)} weld{'s' * (len(pair.welds) > 1)}"
    yield (
        f"Of {welds} {_count(len(gaining))} longer in {b} than in A, {len(losing) or 'none'} less long and "
        f"{len(same) or 'none'} as long to {100.0 * (SAME - 1.0):.0f} %."
    )
    yield from _flips(pair)
    for some, verb in ((losing, "loses"), (gaining, "gains")):
        if len(some):
            row = some.iloc[0]
            reason = f": {row['why']}" if row["why"] else ""
            yield f"{MOST[verb]} {lasts(row, b)}{reason}."
        if len(some) > 1:
            yield from _common_cause(some, verb)
    first, other = (side.sort_values("life_km").iloc[0] for side in (_shortest(pair, ""), _shortest(pair, "other_")))
    again = "the same weld" if first["weld"] == other["weld"] else shortened(str(other["name"]))
    yield (
        f"The shortest life of all is {life_km(first['life_km'])} in A ({shortened(str(first['name']))}) and "
        f"{life_km(other['life_km'])} in {b} ({again})."
    )


def lasts(row: pd.Series, letter: str) -> str:
    """A weld and its lives in words."""
    said = f"{shortened(str(row['weld']))}, which lasts {times(float(row['life_ratio']))} as long in {letter}"
    return f"{said} ({life_km(row['life_km'])}, then {life_km(row['other_life_km'])})"


def _count(welds: int) -> str:
    return "none lasts" if welds == 0 else "1 lasts" if welds == 1 else f"{welds} last"


def _shortest(pair: Pair, side: str) -> pd.DataFrame:
    names = {"name": pair.welds[f"{side}weld"], "life_km": pair.welds[f"{side}life_km"]}
    return pd.DataFrame({"weld": pair.welds["weld"], **names})


def _flips(pair: Pair) -> Iterator[str]:
    b = pair.other.letter
    for flip, said in ((LOST, f"in A and miss it in {b}"), (GAINED, f"in {b} and miss it in A")):
        some = pair.welds.loc[pair.welds["flip"] == flip, "weld"].tolist()
        if some:
            who = "1 weld meets" if len(some) == 1 else f"{len(some)} welds meet"
            yield f"{who} the target {_missing(said, some)}."
    met = pair.welds["fulfilled"] & pair.welds["other_fulfilled"]
    missed = pair.welds.loc[~pair.welds["fulfilled"] & ~pair.welds["other_fulfilled"], "weld"].tolist()
    if not pair.welds["flip"].any():
        both = f"{few(missed)} miss{'es' * (len(missed) == 1)} the target in both"
        yield f"No verdict flips: {'all meet their targets in both' if met.all() else both}."
    elif missed:
        yield f"In both {few(missed)} miss{'es' * (len(missed) == 1)} the target."


def _missing(said: str, some: list[str]) -> str:
    said = said.replace("and miss", "and misses") if len(some) == 1 else said
    return f"{said}: {few(some, 8)}"


def _common_cause(some: pd.DataFrame, verb: str) -> Iterator[str]:
    """The event that is the largest cause at most of some welds, and what makes it there."""
    causes = some.loc[some["cause_event"].fillna("") != "", "cause_event"]
    if causes.empty:
        return
    event, welds = causes.value_counts().index[0], int(causes.value_counts().iloc[0])
    by = some.loc[some["cause_event"].eq(event) & some["cause_by"].ne(""), "cause_by"].str.split(", ").explode()
    modes = by.value_counts().head(2).index.tolist()
    most = f", through {listed(modes)} most often" if modes else ""
    every = "all" if welds == len(some) else str(welds)
    yield f"Of the {len(some)} welds that {verb.removesuffix('s')} life, {every} owe most of it to {event}{most}."


def notes(pair: Pair) -> Iterator[str]:
    """What is not compared, or with less certainty."""
    a, b, welds, points = pair.first, pair.other, pair.matched, pair.points
    if a.record.get("result") and a.record.get("result") == b.record.get("result"):
        yield f"{b.letter} is the same result as A."
    usable = [one for one in welds.proposed if not one.others]
    if usable:
        pairs = few([f"{one.weld} = {one.other_weld} ({one.distance_mm:.2g} mm)" for one in usable])
        yield f"Lines that lie on each other, proposed and not used: {pairs}. Take them with --accept-proposed."
    if unclear := [one for one in welds.proposed if one.others]:
        pairs = few([f"{one.weld} may be {listed([one.other_weld, *one.others])}" for one in unclear])
        yield f"Lines on one place that cannot be told apart: {pairs}. Name them in a table with --map."
    for letter, some, left_out in (("A", welds.only_first, b.left_out), (b.letter, welds.only_other, a.left_out)):
        if some:
            listed_there = [weld for weld in some if weld in left_out]
            there = f" (listed in the other, not assessed: {few(listed_there)})" if listed_there else ""
            yield f"Only {letter} has {len(some)} weld{'s' * (len(some) > 1)}: {few(some)}{there}."
    if apart := int((~points["comparable"]).sum()):
        yield (
            f"{apart} of {len(points)} matched points are further apart than half the finer spacing: their ratios are "
            "of two places (comparable is false) and have no causes."
        )
    if pair.face_assumed:
        yield f"Faces of one name are taken for one face, as normals are not known any more ({pair.face_assumed})."
    if swapped := int((points["face"] == "swapped").sum()):
        yield f"Normals are turned at {swapped // 2} of {len(points) // 2} stations: top there is bottom in A."
    if bounds := int((points["basis"] != EXACT).sum()):
        yield f"{bounds} of {len(points)} ratios are one-sided or unknown (basis): a bound stands for a count."
    if endless := int((points["log_life_ratio"].abs() == math.inf).sum()):
        yield f"{endless} points are damaged in one of the results only: their ratio is infinite and has no causes."
    only_a, only_b = (sorted(set(one) - set(other)) for one, other in ((a.passes, b.passes), (b.passes, a.passes)))
    if only_a and only_b:
        yield (
            f"Events are matched by name: {few(only_a)} of A and {few(only_b)} of {b.letter} have no partner. One that "
            "was renamed vanishes and comes in again."
        )
    yield from _by_a_check(pair)
    yield from _about_causes(pair)
    if pair.welds["worst_moved"].any():
        moved = pair.welds.loc[pair.welds["worst_moved"], "weld"].tolist()
        yield f"Another point is the worst in {b.letter} at {len(moved)} weld{'s' * (len(moved) > 1)}: {few(moved)}."


def _by_a_check(pair: Pair) -> Iterator[str]:
    """Verdicts that flip although the toe points of the weld say the same in both: a check beside them decides."""
    flips = pair.welds[pair.welds["flip"] != ""]
    same = flips[(flips["utilisation"] <= 1.0) == (flips["other_utilisation"] <= 1.0)]
    for row in same.itertuples(index=False):
        checks = pair.first.welds.loc[row.weld, "worst_check"], pair.other.welds.loc[row.other_weld, "worst_check"]
        named = listed([str(check) for check in dict.fromkeys(checks) if isinstance(check, str) and check])
        yield f"The verdict of {row.weld} flips by a check beside its toes ({named or 'not named'}), by no life here."


def _about_causes(pair: Pair) -> Iterator[str]:
    """What the causes cannot tell."""
    bare = [one.letter for one in (pair.first, pair.other) if not one.is_diagnosed]
    if bare:
        yield f"Causes go as far as events: no diagnosis of {listed(bare)} (`fatigue diagnose` adds modes)."
    elif len(pair.causes):
        points, told = (_points_with(pair.causes, kinds) for kinds in (WHOLE, (MODE, UNIT_LOAD)))
        if told == 0:
            yield "Causes go as far as events: the diagnoses share no point, or are of other damage."
        elif told < points:
            yield f"Causes go as far as modes at {told} of {points} points: those that both diagnoses tell of."
    if pair.by_shear:
        yield f"Shear decides at {pair.by_shear} points, by a sum that no event has a part of: they have no causes."
    if not pair.every_point:
        yield "Causes are of the worst points of every weld: those of all points would be more than 2 million rows."
    if pair.first.frequency_hz != pair.other.frequency_hz:
        yield "The modes of the two bodies differ and are matched by their numbers: compare their shapes first."


def _points_with(causes: pd.DataFrame, kinds: Sequence[str]) -> int:
    """Number of points that have a cause of some kinds."""
    some = causes[causes["kind"].isin(kinds) & (causes["scope"] == POINT)]
    return len(some[["weld", "part", "order", "surface"]].drop_duplicates())
