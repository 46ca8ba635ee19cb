"""What the name of a channel states: time and its unit, number, frequency and unit of a modal coordinate.

The number of a mode is the last whole number in the name (``q_12``, ``.FLEX.Q12``, ``$B_Car.q(12)``), its unit and its
frequency left out.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from fatigue.readers.units.coordinate_units import parse_unit, states_no_unit

_SECONDS = {
    Fraction(1): "s s. sec sec. secs second seconds sek sek. sekunde sekunden",
    Fraction(1, 1000): "ms msec msec. msecs msek millisec millisecond milliseconds millisekunde millisekunden",
    Fraction(1, 10**6): "us µs μs usec µsec microsec microsecond microseconds mikrosekunde mikrosekunden",
    Fraction(1, 10**9): "ns nsec nanosecond nanoseconds",
    Fraction(60): "min min. mins minute minutes minuten",
    Fraction(3600): "h hr hrs hour hours std std. stunde stunden",
    Fraction(86400): "d day days",
}
TIME_UNITS = {word: seconds for seconds, words in _SECONDS.items() for word in words.split()}
"""Seconds in each unit of time, by its spelling in small letters."""

_TIME = re.compile(
    r"\s*(?:[\w$.]+_(?:time|zeit)|(?:[\w$. ]*[.:]\s*)?"
    r"(?:time[ _]?stamp|time[ _]?axis|zeitstempel|zeitachse|x[_ ]value|tout|temps|tiempo|tempo"
    r"|(?:(?:sim|simulation|elapsed|relative|rel\.|run|total|solution|analysis|output)[ _-]?)?time"
    r"|(?:simulations|simulierte |relative |mess|lauf|rechen|fahr)?zeit|t))"
    r"(?P<rest>(?![a-z]).*)\Z",
    re.IGNORECASE | re.DOTALL,
)
_BRACKETS = re.compile(r"\s*[_ ]*[\[(<{]\s*([^\[\](){}<>]*?)\s*[\])>}]\s*\Z")
_LOOSE = re.compile(r"\s*(?:/|,|;|:|\.|_+|\s+in\s+|\s|-)\s*([^\W\d_]+)_*\s*\Z")
_REPEATED = re.compile(r"[ _.]?\d+\Z")
_NUMBERED = re.compile(r"\s+\d+\s+-\s.*?(?=\[|\Z)")  # "Time  1 - default sample rate [s]"
_SECONDS_NAMED = re.compile(r"(seconds|secs|sekunden|milliseconds|millisekunden)\Z", re.IGNORECASE)
_FREQUENCY = re.compile(
    r"(?:\bf(?:req(?:uency)?)?\s*=?\s*)?(\d+(?:[.,]\d*)?|[.,]\d+)(E[+-]?\d+)?\s*(k|m)?Hz\b", re.IGNORECASE
)
_UNIT_ONE = re.compile(r"\s*[\[(<]\s*1\s*[\])>]\s*\Z")
_SQUARE = re.compile(r"\s*\[([^\]]*[^\W\d_][^\]]*|[-%‰°]|)\]\s*\Z")
_ROUND = re.compile(r"\s*[(<{]\s*([^()]*(?:\([^()]*\)[^()]*)*)\s*[)>}]\s*\Z")
_OTHER = re.compile(r"rad|deg|°|k?N|N\.?m+|[mc]?m/s(?:\^?2|\*\*2|²)?|[kM]?Pa|m?V|%|s|ms|Hz")  # no coordinate has them
_TRAILING = re.compile(r"(?<=\d|\))\s*(?:/|,|:|\.|\s+in\s+|_|\s)\s*(mm|cm|m|km|inch|in|ft|µm|um)\s*\Z")


@dataclass(frozen=True, slots=True)
class Channel:
    """What a name states.

    Attributes
    ----------
    name : as written
    base : the name without unit and frequency
    is_time : whether it is a name of time
    unit : of time or of the coordinate; empty where none is stated
    mode : number of the mode, 0 where none is stated
    frequency, resolution : of the mode and half a unit of its last digit [Hz], NaN where none is stated
    """

    name: str
    base: str
    is_time: bool
    unit: str
    mode: int
    frequency: float
    resolution: float


def channel(name: str) -> Channel:
    """What the name of a channel states."""
    time_unit = time_unit_in(name)
    if time_unit is not None:
        return Channel(name, _time_base(name), True, time_unit, 0, float("nan"), float("nan"))
    frequency, resolution = stated_frequency(name)
    base, unit = _without_unit(_FREQUENCY.sub(" ", name))
    if re.fullmatch(r"\s*[\d.,]+\s*", base):
        mode = int(base) if base.strip().isdecimal() and len(base.strip()) < 10 else 0
    else:
        numbers = re.findall(r"\d{1,9}", base, re.ASCII)
        mode = int(numbers[-1]) if numbers else 0
    return Channel(name, base.strip(), False, unit, mode, frequency, resolution)


def without_unit_one(names: Sequence[str]) -> list[str]:
    """Names without ``[1]`` where it ends all names but time: it is a unit then, as the numbers of modes differ."""
    coordinates = [name for name in names if time_unit_in(name) is None]
    if len(coordinates) > 1 and all(_UNIT_ONE.search(name) for name in coordinates):
        return [_UNIT_ONE.sub("", name) for name in names]
    return list(names)


def _time_base(name: str) -> str:
    """Name of time without its unit."""
    found = _BRACKETS.search(name) or _LOOSE.search(name)
    return name[: found.start()].strip() if found else name.strip()


def time_unit_in(name: str) -> str | None:
    """Unit in a name of time, empty where it states none; None if it is no name of time."""
    bare = name.strip().strip("\"'")
    if _SECONDS_NAMED.match(bare):
        return bare
    found = _TIME.match(bare)
    if found is None:
        return None
    rest = _NUMBERED.sub("", found["rest"])
    if not rest.strip(" _") or _REPEATED.fullmatch(rest):
        return "" if not _REPEATED.fullmatch(rest) or len(name.strip()) > 3 else None  # t_1 may be anything
    if bracketed := _BRACKETS.fullmatch(rest):
        unit = bracketed[1]
        return "" if states_no_unit(unit) else unit
    loose = _LOOSE.fullmatch(rest)
    return loose[1] if loose and loose[1].lower() in TIME_UNITS else None


def unit_of_time(name: str) -> str:
    """Unit in the name of a column that is time by the user's word, as ``now [ms]``; empty where there is none."""
    known = time_unit_in(name)
    if known is not None:
        return known
    for pattern in (_BRACKETS, _LOOSE):
        found = re.search(pattern.pattern, name)
        if found and found[1].lower() in TIME_UNITS:
            return found[1]
    return ""


def seconds_per(unit: str) -> Fraction | None:
    """Seconds in a unit of time; None if it is none."""
    return TIME_UNITS.get(unit.strip().lower())


def stated_frequency(text: str) -> tuple[float, float]:
    """Frequency in a text and half a unit of its last digit [Hz]; NaN where there is none."""
    found = _FREQUENCY.search(text)
    if found is None:
        return float("nan"), float("nan")
    scale = {"k": 1e3, "m": 1e-3}.get((found[3] or "").lower(), 1.0)
    value, half = written(found[1].replace(",", ".") + (found[2] or ""))
    return value * scale, half * scale


def written(number: str) -> tuple[float, float]:
    """Value of a number and half a unit of its last written digit."""
    mantissa, _, exponent = number.upper().replace("D", "E").partition("E")
    decimals = len(mantissa.partition(".")[2])
    return float(f"{mantissa}E{exponent or 0}"), float(f"5E{int(exponent or 0) - decimals - 1}")


def _without_unit(name: str) -> tuple[str, str]:
    """Name without the unit at its end, and the unit."""
    if found := _SQUARE.search(name):
        return name[: found.start()], "" if states_no_unit(found[1]) else found[1].strip()
    if (
        (found := _ROUND.search(name))
        and not found[1].isdecimal()
        and (states_no_unit(found[1]) or _OTHER.fullmatch(found[1]) or parse_unit(found[1]) is not None)
    ):
        return name[: found.start()], "" if states_no_unit(found[1]) else found[1].strip()
    if found := _TRAILING.search(name):
        return name[: found.start()], found[1]
    return name, ""
