"""Why a record has no number beside a standard, and how bands and reasons are written in its row."""

from collections.abc import Iterable

from fatigue.ride.channel import ChannelRecord


def written(band: tuple[float, ...] | None) -> str:
    """Band as a text, as in ``0.5-40``; empty for none."""
    return "" if band is None else f"{band[0]:.3g}-{band[1]:.3g}"


def joined(reasons: Iterable[str]) -> str:
    """Reasons in one text; empty ones are left out."""
    return "; ".join(reason for reason in reasons if reason)


def too_short(record: ChannelRecord, low: float) -> str:
    """Why a record tells nothing of a band from ``low`` [Hz] on: it has no period of it; empty: it has."""
    if record.duration * low >= 1 - 1e-9:
        return ""
    return f"the record of {record.duration:.4g} s is shorter than a period of {low:g} Hz"


def tells_nothing(record: ChannelRecord) -> str:
    """Why limits and indices of accelerations mean nothing to a channel; empty: they do."""
    if not record.is_acceleration:
        return "its unit is '-': it is no acceleration"
    return "the channel does not vary" if record.is_still else ""
