"""What a reader has to know before any verdict: warnings about calibration, samples, alignment and gauges."""

from collections.abc import Iterator, Mapping, Sequence

from fatigue.errors import Problem
from fatigue.gauges.correlated.compared import Comparison
from fatigue.gauges.correlated.flag_rows import DRIFT
from fatigue.gauges.correlated.verdict import FEWEST_KEPT
from fatigue.gauges.gauge_file import TOE, Gauge

SYNCHRONOUS = 0.02  # of the period of the upper end of the band: channels further apart are not one recording


def doubts(comparisons: Sequence[Comparison], gauges: Mapping[str, Gauge], high_hz: float) -> Iterator[Problem]:
    """Warnings about the compared channels, in their order."""
    yield from _stand_in_doubts(comparisons, gauges)
    for one in comparisons:
        where = f"channel '{one.channel.name}'"
        if one.kept_share < FEWEST_KEPT:
            what = f"{one.kept_share:.1%} of the samples are left, less than {FEWEST_KEPT:.0%}: there is no verdict"
            yield Problem(
                "few_samples_kept", where, what, "Look at the flagged places; record again, or bridge short gaps"
            )
        elif not one.km > 0.0:
            what = "the train stands wherever its samples are counted, and every number is per km: there is no verdict"
            yield Problem("stood_still", where, what, "Record while it runs, or give --km")
        drifts = [row for row in one.flags if row.flag == DRIFT]
        if drifts:
            what = f"its level drifts by {max(row.distance_ue for row in drifts):.3g} ue between blocks of 10 s"
            remedy = "Temperature, payload or curves? A lower end of the band takes all of them out; see lost_share"
            yield Problem("channel_drift", where, what, remedy)
        if one.bridged:
            what = f"straight lines stand for {one.bridged} flagged samples, and are counted"
            yield Problem("gaps_bridged", where, what, "Look at these places: a line cuts off whatever was there")
        yield from _alignment_doubts(where, one)
    yield from _lag_doubts(comparisons, high_hz)


def _stand_in_doubts(comparisons: Sequence[Comparison], gauges: Mapping[str, Gauge]) -> Iterator[Problem]:
    names = dict.fromkeys(name for one in comparisons for name, _ in one.channel.terms)
    toes = [name for name in names if gauges[name].kind == TOE]
    if toes:
        what = f"{', '.join(toes[:8])} {'are stand-ins' if len(toes) > 1 else 'is a stand-in'} at a weld toe"
        remedy = "A grid sits beside the toe and sees other strain: give the element or the stress point it sits on"
        yield Problem("stand_in_compared", "gauges", what, remedy, len(toes))


def _alignment_doubts(where: str, one: Comparison) -> Iterator[Problem]:
    at = one.alignment
    if at is None:
        return
    if at.at_end:
        what = f"the largest correlation, {at.correlation:.3g}, is at an end of the search, {at.lag_s:.4g} s"
        yield Problem("lag_at_end", where, what, "Search further by --max-lag, or cut the record nearer to its start")
    elif at.sign_is_open:
        what = f"the correlation is {at.correlation:.3g} at {at.lag_s:.4g} s, and at another lag as large as "
        what += f"{at.rival:.3g} with the other sign"
        yield Problem("sign_open", where, what, "Search within half a period by --max-lag: the sign is not proved")


def _lag_doubts(comparisons: Sequence[Comparison], high_hz: float) -> Iterator[Problem]:
    """Channels of one group whose lags differ."""
    groups: dict[str, list[Comparison]] = {}
    for one in comparisons:
        if one.alignment is not None and one.channel.sync_group and abs(one.alignment.correlation) > 0.7:
            groups.setdefault(one.channel.sync_group, []).append(one)
    for group, members in groups.items():
        lags = {one.channel.name: one.alignment.lag_s for one in members if one.alignment is not None}
        first, last = min(lags, key=lambda name: lags[name]), max(lags, key=lambda name: lags[name])
        if lags[last] - lags[first] > SYNCHRONOUS / high_hz:
            what = f"'{last}' is {1e3 * (lags[last] - lags[first]):.3g} ms later than '{first}', more than "
            what += f"{1e3 * SYNCHRONOUS / high_hz:.3g} ms"
            remedy = (
                "Amplifiers and their anti-aliasing filters differ: correct the delays before channels are combined"
            )
            yield Problem("not_synchronous", f"sync_group '{group}'", what, remedy)
