"""What free text above a history states: counts, unit of time, sampling, frequencies, normalisation of the modes."""

import re
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.units.channel_names import TIME_UNITS, seconds_per
from fatigue.readers.units.coordinate_units import LENGTHS
from fatigue.readers.units.systems import Normalisation

_NUMBER = r"([+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:E[+-]?\d+)?)"
_COUNT_OF = r"(?:(?:number|no\.?|nr\.?|count)[ _]of[ _]|n(?:um)?[ _]|anzahl[ _](?:der[ _])?|#\s*)"
_COLUMNS = re.compile(
    rf"\W*{_COUNT_OF}?(channels?|signals?|variables?|columns?|modes?|kan[aä]le|spalten|moden)\s*[:=\t;,]?\s*(\d+)\s*\W*\Z",
    re.IGNORECASE,
)
_SAMPLES = re.compile(
    rf"\W*{_COUNT_OF}?(samples|data points|rows|time[ _]steps|abtastwerte|messwerte|zeilen)\s*[:=\t;,]\s*(\d+)\b",
    re.IGNORECASE,
)
_TIME_UNIT = re.compile(
    r"(?:\btime[ _]?units?\b|\bunits? of time\b|\bzeiteinheit\b)\W{0,4}(\w+)"
    r"|(?:^|[^\w\s]\s*)(?:(?:all|the) +)?times?\s*(?:(?:is|are)? *in\s+|[\[(])\s*(\w+)",
    re.IGNORECASE,
)
_RATE = re.compile(
    rf"(?:sampl\w*[ _]?(?:rate|freq\w*)|abtastrate|abtastfrequenz)\s*[:=\t;,]?\s*{_NUMBER}\s*(k?)Hz", re.IGNORECASE
)
_STEP = re.compile(
    rf"(?:\bdelta[ _]?[tx]\b|(?:sampl\w*|output)[ _]?(?:interval|step|period)|abtastintervall)"
    rf"\s*(?:\[(\w+)\])?\s*[:=\t;,]\s*{_NUMBER}\s*([^\W\d]\w*)?",
    re.IGNORECASE,
)
_UNITS = re.compile(r"\W*(?:units?(?: system)?|system of units|einheiten(?:system)?)\s*[:=]\s*(.*)", re.IGNORECASE)
_NORMALISED = re.compile(r"normali[sz]\w*", re.IGNORECASE)

Free = Sequence[tuple[int, str]]


def normalisation_in(path: Path, free: Free) -> Normalisation | None:
    """Normalisation of the modes that a header declares, to unit mass or to unity.

    Raises
    ------
    DataError : two lines that disagree
    """
    found: dict[Normalisation, int] = {}
    for line, text in free:
        if not _NORMALISED.search(text):
            continue
        if re.search(r"\bmass\b|\bmasse\b", text, re.IGNORECASE):
            found["mass"] = line
        if re.search(
            r"\bunity\b|\bmax\w*|\bdisplacement\b|\blength\b|\bunit\b(?! (?:modal )?mass)", text, re.IGNORECASE
        ):
            found.setdefault("length", line)
    if len(found) > 1 and found["mass"] != found["length"]:
        where = f"{path}, lines {found['mass']} and {found['length']}"
        what = "two statements of the header disagree: modes normalised to mass, and to unity"
        raise DataError(Problem("header", where, what, "Correct one of them"))
    return None if len(found) != 1 else next(iter(found))


def stated_time_unit(path: Path, free: Free) -> tuple[int, str] | None:
    """Line and unit of time in free text, as ``Time unit: ms``; a word that is no such unit is refused.

    Raises
    ------
    DataError : a unit that is none of time, two lines that disagree
    """
    found: list[tuple[int, str]] = []
    for line, text in free:
        for match in _TIME_UNIT.finditer(text):
            unit = match[1] or match[2]
            if unit.lower() in TIME_UNITS:
                found.append((line, unit))
            elif match[1]:
                what = f"{unit!r} is no unit of time"
                raise DataError(Problem("time_unit", f"{path}, line {line}", what, "Write s, ms, us, min or h"))
    units = {seconds_per(unit) for _, unit in found}
    if len(units) > 1:
        where = f"{path}, lines {found[0][0]} and {found[-1][0]}"
        what = f"two statements of the header disagree: time in {found[0][1]}, and in {found[-1][1]}"
        raise DataError(Problem("header", where, what, "Correct one of them"))
    return found[0] if found else None


def stated_length(free: Free) -> str:
    """Unit of length in a statement of the units, as ``Units: m, kg, s``; empty where there is none."""
    for _, text in free:
        if found := _UNITS.match(text):
            lengths = {word for word in re.split(r"[\s,;/\-]+", found[1]) if word in LENGTHS}
            if len(lengths) == 1:
                return lengths.pop()
    return ""


def statement_problems(path: Path, free: Free, width: int, time: NDArray[np.float64]) -> list[Problem]:
    """Contradictions of counts and sampling in free text to the table of so many columns and its times (t,) [s]."""
    problems: list[Problem] = []

    def contradicted(line: int, what: str, remedy: str) -> None:
        problems.append(Problem("header", f"{path}, line {line}", what, remedy))

    for line, text in free:
        if found := _COLUMNS.match(text):
            _check_columns(line, found[1].lower(), int(found[2]), width, contradicted)
        if (found := _SAMPLES.match(text)) and int(found[2]) not in (time.size, time.size - 1):
            contradicted(
                line, f"the header states {found[2]} {found[1]}, the table has {time.size} rows", "Export again"
            )
        step = float(np.median(np.diff(time))) if time.size > 1 else 0.0
        if step > 0 and (found := _RATE.search(text)):
            rate = float(found[1].replace(",", ".")) * (1000 if found[2] else 1)
            if abs(rate * step - 1) > 0.01:
                what = f"the header states {rate:g} Hz, the usual step of {step:.6g} s makes {1 / step:.6g} Hz"
                contradicted(line, what, "Correct the header, or the unit of time")
        if step > 0 and (found := _STEP.search(text)):
            factor = seconds_per(found[1] or found[3] or "s")
            value = float(found[2].replace(",", ".")) * float(factor or 1)
            if value > 0 and factor is not None and abs(step / value - 1) > 0.01:
                what = f"the header states a step of {value:.6g} s, the usual step of the table is {step:.6g} s"
                contradicted(line, what, "Correct the header, or the unit of time")
    return problems


def _check_columns(line: int, kind: str, count: int, width: int, contradicted: Callable[[int, str, str], None]) -> None:
    """Compare a count of channels; time may be counted among them or not."""
    modes = kind.startswith("mod")  # of which some may have been left out
    if count < width - 1 or (count > width and not modes):
        what = f"the header states {count} {kind}, the table has time and {width - 1} other columns"
        contradicted(line, what, "Export again, or correct the header")
