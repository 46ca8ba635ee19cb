"""The order of events in words, as ``check`` prints it."""

from collections import Counter
from collections.abc import Iterator

from fatigue.life.mission import Plan
from fatigue.shown import shortened, visible


def sequence_texts(plan: Plan) -> Iterator[str]:
    """Order and number of every loop, and the stints of events in an order that is not known."""
    for loop in plan.loops:
        order = " - ".join(_name(plan.passes[event].event) for event in loop.order)
        yield f"{order}, {loop.per_1000_km:g} in 1000 km"
        for event, entries in Counter(loop.order).items():
            one = plan.passes[event]
            stints = f"{entries * loop.per_1000_km:g} stints in 1000 km, {1000.0 * one.passes_per_km:.4g} passes"
            yield f"    {_name(one.event)}: {stints}, {'half' if one.half else 'repeat'}"
    unknown = [one for one in plan.passes if one.stints_per_1000_km is not None]
    if unknown:
        listed = ", ".join(f"{_name(one.event)} {one.stints_per_1000_km:g}" for one in unknown)
        yield f"order unknown, stints in 1000 km: {listed}"


def _name(event: str) -> str:
    return shortened(visible(event))
