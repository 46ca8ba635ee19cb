"""What the channels of a ride meet, set off and amount to: coincidence, alarm, comfort, equipment, running."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import pandas as pd

from fatigue.report.sections.cells import Cell, Heading, PageTable, integer, num, percent, text
from fatigue.report.sections.ride.read import ShownRide
from fatigue.report.wording import NOT_AVAILABLE, whole

MOST_ROWS = 100
WHOLE = "whole record"

TOLD: dict[str, str] = {
    "yes": "goes off, and hot stretches hold more of the damage than of the length",
    "missed": "tells nothing, and hot stretches hold more of the damage than of the length",
    "nothing_to_tell": "nothing to tell: hot stretches hold no more of the damage than of the length",
    "no_hot_stretch": "no hot stretch",
}
INDICES: dict[str, str] = {
    "sperling_wz": "Sperling Wz",
    "sperling_wz_ride_quality": "Sperling Wz, ride quality of the vehicle",
    "en12299_rms_p95": "EN 12299, 95th percentile of rms [m/s²]",
    "en12299_n_mv": "EN 12299, N_MV",
}
QUANTITIES: dict[str, str] = {
    "body_percentile": "body, percentile",
    "body_rms": "body, rms",
    "instability_frequency": "frequency of instability",
    "sliding_rms": "bogie, sliding rms",
    "bogie_peak": "bogie, peak",
}
_FLAGS = {
    "red": Cell("✕ red", 2.0, mark="missed"),
    "amber": Cell("! amber", 1.0, mark="doubt"),
    "green": Cell("green", 0.0),
}

Row = Any
Column = tuple[Heading, Callable[[Row], Cell]]


@dataclass(frozen=True, slots=True)
class Part:
    """One part of a ride: its name, its table, the note that all rows share, and how many rows are left out.

    ``table`` is None where the channels give it no rows. A shared note is said once and not in every row.
    """

    name: str
    table: PageTable | None
    note: str
    left_out: int


def ride_tables(ride: ShownRide) -> Iterator[Part]:
    """Every part of the ride, in the order of the page."""
    for name, columns in _COLUMNS.items():
        yield _part(name, ride.tables[name], columns)
    yield _part("channels", pd.DataFrame(ride.said.get("channels", [])), _CHANNELS)


def _part(name: str, rows: pd.DataFrame, columns: tuple[Column, ...]) -> Part:
    shown = rows.head(MOST_ROWS).to_dict("records")
    if not shown:
        return Part(name, None, "", 0)
    notes = {_note(row).text for row in shown} if _NOTE in columns else set()
    shared = len(notes) == 1 and len(shown) > 1
    kept = tuple(column for column in columns if not (shared and column is _NOTE))
    cells = tuple(tuple(cell(row) for _, cell in kept) for row in shown)
    table = PageTable(f"ride-{name}", tuple(heading for heading, _ in kept), cells)
    note = notes.pop() if shared else ""
    return Part(name, table, "" if note == NOT_AVAILABLE else note, max(0, len(rows) - MOST_ROWS))


def _words(heading: str, name: str, meanings: Mapping[str, str] | None = None) -> Column:
    """Column of texts, of names of a table written out."""
    if meanings is None:
        return Heading(heading, numeric=False), lambda row: text(row[name])
    return Heading(heading, numeric=False), lambda row: text(_meaning(row[name], meanings))


def _meaning(value: Any, meanings: Mapping[str, str]) -> Any:
    return meanings.get(value, value.replace("_", " ")) if isinstance(value, str) else value


def _number(heading: str, unit: str, name: str) -> Column:
    return Heading(heading, unit), lambda row: num(row[name])


def _given(heading: str, unit: str, name: str) -> Column:
    """Column of numbers as the case gives them, without digits it does not have."""
    return Heading(heading, unit), lambda row: Cell(f"{row[name]:g}", float(row[name]))


def _share(heading: str, name: str) -> Column:
    return Heading(heading, "%"), lambda row: percent(row[name])


def _note(row: Row) -> Cell:
    """Why a number is empty or what it is to be read with, a short record first."""
    short = row.get("short_record")
    reason = row["reason"]
    said = ["short record" if not pd.isna(short) and short else "", reason if isinstance(reason, str) else ""]
    return text("; ".join(filter(None, said)))


def _within(row: Row) -> Cell:
    return text({"hot": "hot stretches", "event": "the event"}.get(row["within"], row["within"]))


def _flag(row: Row) -> Cell:
    """The flag as a word and a sign, not as a colour alone."""
    return _FLAGS.get(row["flag"], text(row["flag"]))


def _coherence(row: Row) -> Cell:
    """Coherence, and beside it what unrelated channels reach by chance."""
    cell = num(row["coherence"])
    return (
        cell
        if pd.isna(row["coherence"])
        else Cell(f"{cell.text} (chance {num(row['chance_coherence']).text})", cell.value)
    )


def _rule(row: Row) -> Cell:
    return text(f"{int(row['cycles'])} cycles at {row['threshold_m_s2']:g} m/s²")


def _sections(row: Row) -> Cell:
    """How many sections, and how long each is."""
    number_of = int(row["sections"])
    length = "" if pd.isna(row["length_m"]) else f" of {row['length_m']:g} m"
    return Cell(f"{whole(number_of)}{length}", float(number_of)) if number_of else num(None)


def _block(row: Row) -> Cell:
    return text(WHOLE) if pd.isna(row["block_s"]) else Cell(f"{row['block_s']:g} s", float(row["block_s"]))


def _rate(row: Row) -> Cell:
    step = row.get("step_s")
    return num(None if pd.isna(step) or not step else 1.0 / step)


_EVENT, _CHANNEL, _DIRECTION = _words("event", "event"), _words("channel", "channel"), _words("direction", "direction")
_NOTE: Column = (Heading("note", numeric=False), _note)
_EDITION = _words("edition and status", "edition")

_COLUMNS: dict[str, tuple[Column, ...]] = {
    "coincidence": (
        _EVENT,
        _CHANNEL,
        _words("mode of equipment", "equipment"),
        (Heading("flag", numeric=False), _flag),
        _number("hunting", "Hz", "f_hunt_hz"),
        _given("mode", "Hz", "frequency_hz"),
        _given("damping ratio", "-", "damping_ratio"),
        _number("amplification", "-", "amplification"),
        (Heading("hunting within", numeric=False), _within),
        (Heading("coherence", "-"), _coherence),
        _number("phase", "deg", "phase_deg"),
        _number("phase of the mode alone", "deg", "oscillator_phase_deg"),
        _NOTE,
    ),
    "alarm": (
        _EVENT,
        _CHANNEL,
        (Heading("alarms"), lambda row: integer(row["alarms"])),
        (Heading("rule", numeric=False), _rule),
        _number("longest run", "cycles", "longest_run"),
        _number("largest peak", "m/s²", "peak_m_s2"),
        _number("first at", "s", "first_alarm_s"),
        _share("hot, of the length", "hot_km_share"),
        _share("hot, of the damage", "damage_share_inside_hot"),
        _words("what the alarm tells of the damage", "told", TOLD),
        _NOTE,
    ),
    "comfort": (
        _EVENT,
        _CHANNEL,
        _DIRECTION,
        _words("index", "index", INDICES),
        _words("form", "form"),
        _words("band [Hz]", "band_hz"),
        (Heading("block", numeric=False), _block),
        _number("value", "-", "value"),
        _number("worst block", "-", "highest"),
        _NOTE,
        _EDITION,
    ),
    "equipment": (
        _EVENT,
        _CHANNEL,
        _DIRECTION,
        _words("class", "class"),
        _EDITION,
        _words("band [Hz]", "band_hz"),
        _number("rms", "m/s²", "rms_m_s2"),
        _number("table, in the band", "m/s²", "band_limit_m_s2"),
        _number("table, whole spectrum", "m/s²", "limit_m_s2"),
        _number("density over the table's", "-", "asd_ratio"),
        _number("at", "Hz", "asd_ratio_hz"),
        _number("peak", "m/s²", "peak_m_s2"),
        _number("over 3 rms of the long life", "-", "peak_ratio"),
        _number("shock of the table", "m/s²", "shock_m_s2"),
        _NOTE,
    ),
    "running": (
        _EVENT,
        _CHANNEL,
        _DIRECTION,
        _words("quantity", "quantity", QUANTITIES),
        _words("band [Hz]", "band_hz"),
        _number("largest", "-", "value"),
        _words("unit", "unit"),
        _number("mean", "-", "mean"),
        (Heading("sections"), _sections),
        _number("limit", "-", "limit"),
        _EDITION,
        _NOTE,
    ),
    "stationarity": (
        _EVENT,
        _CHANNEL,
        (Heading("segments"), lambda row: integer(row["segments"])),
        _number("dispersion of mean squares", "-", "dispersion_ratio"),
        _number("p", "-", "p"),
        _number("kurtosis", "-", "kurtosis"),
        _number("crest", "-", "crest"),
        _number("crest of a Gaussian record", "-", "expected_crest"),
        _words("assumptions", "assumptions"),
        _NOTE,
    ),
}
_CHANNELS: tuple[Column, ...] = (
    _EVENT,
    _words("channel", "name"),
    _words("role", "role"),
    _DIRECTION,
    _words("column", "column"),
    _words("unit", "unit"),
    _given("scale", "-", "scale"),
    _number("shift", "s", "shift_s"),
    (Heading("samples"), lambda row: integer(row["samples"], grouped=True)),
    (Heading("rate", "Hz"), _rate),
    _words("file", "file"),
    (Heading("SHA-256", numeric=False), lambda row: Cell(str(row["sha256"]), mark="hash")),
)
