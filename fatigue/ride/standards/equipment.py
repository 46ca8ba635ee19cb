"""Rows of the vibration of equipment beside the table of limits, which is the shipped one or a file of your own."""

import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fatigue.case import Case
from fatigue.case.channels import Equipment, Ride
from fatigue.errors import CaseError, DataError, Problem, refuse
from fatigue.files.mishaps import refusal
from fatigue.files.naming import missing_file
from fatigue.ride.bands import heard
from fatigue.ride.channel import ChannelRecord
from fatigue.ride.standards.reasons import joined, tells_nothing, too_short, written
from fatigue.vibration.standards.environment import (
    PEAK_OF_RMS,
    DensityShape,
    VibrationClass,
    VibrationTable,
    band_rms,
    density_ratios,
)
from fatigue.vibration.standards.environment_file import shipped_table, vibration_table


@dataclass(frozen=True, slots=True)
class EquipmentRow:
    """Vibration of one channel of one event beside one class; fields are those of the table."""

    event: str
    channel: str
    direction: str
    vibration_class: str
    edition: str
    band_hz: str
    rms_m_s2: float
    limit_m_s2: float
    band_limit_m_s2: float
    asd_ratio: float
    asd_ratio_hz: float
    peak_m_s2: float
    long_life_rms_m_s2: float
    peak_ratio: float
    shock_m_s2: float
    reason: str


def limits_of(case: Case) -> VibrationTable:
    """Table of limits that a case asks for, which has all classes that the case gives.

    Raises
    ------
    DataError : a file that is not there or cannot be read, and all that is wrong in it
    CaseError : classes that the table does not have
    """
    own = case.ride.vibration_table
    table = read_vibration_table(None if own is None else case.resolve(own))
    problems = unknown_classes(case.ride, table)
    refuse(CaseError, (replace(problem, where=f"{case.path.name}: {problem.where}") for problem in problems))
    return table


def read_vibration_table(path: Path | None) -> VibrationTable:
    """Table of limits from a file of your own (TOML); the shipped one if there is none.

    Raises
    ------
    DataError : a file that is not there or cannot be read, and all that is wrong in it
    """
    if path is None:
        return shipped_table()
    try:
        data = tomllib.loads(path.read_bytes().decode("utf-8-sig"))
    except (FileNotFoundError, IsADirectoryError):
        raise DataError(missing_file(path, wanted="a .toml file")) from None
    except OSError as error:
        raise DataError(refusal(error, path)) from None
    except UnicodeDecodeError:
        raise DataError(Problem("not_utf8", str(path), "it is not UTF-8 text", "Save it as UTF-8")) from None
    except tomllib.TOMLDecodeError as error:
        raise DataError(Problem("toml_syntax", str(path), f"not valid TOML: {error}", "Correct the line")) from None
    return vibration_table(data, str(path))


def equipment_rows(records: Sequence[ChannelRecord], ride: Ride, table: VibrationTable) -> list[EquipmentRow]:
    """Vibration of every channel with the role ``equipment``, and of those that a ``[[ride.equipment]]`` names.

    Raises
    ------
    CaseError : a class that the table does not have
    """
    refuse(CaseError, unknown_classes(ride, table))
    rows: list[EquipmentRow] = []
    for record in records:
        given = [equipment for equipment in ride.equipment if equipment.channel == record.name]
        rows += [_row(record, equipment, table) for equipment in given]
        if not given and record.role == "equipment":
            rows.append(_row(record, None, table))
    return rows


def unknown_classes(ride: Ride, table: VibrationTable) -> Iterator[Problem]:
    """Refusals of classes that the table of limits does not have."""
    for number, equipment in enumerate(ride.equipment, 1):
        if equipment.vibration_class not in table.classes:
            what = f"there is no class {equipment.vibration_class!r} in the table of {table.edition!r}"
            remedy = f"Give one of {', '.join(table.classes)}, or a table of your own ([ride] vibration_table)"
            yield Problem("unknown_class", f"ride.equipment[{number}].class ({equipment.channel!r})", what, remedy)


def _row(record: ChannelRecord, equipment: Equipment | None, table: VibrationTable) -> EquipmentRow:
    category = None if equipment is None else table.classes[equipment.vibration_class]
    whys = [unfit := tells_nothing(record)]
    if category is None:
        whys.append("no [[ride.equipment]] gives it a class")
    peak = float(np.abs(record.values - record.values.mean()).max()) if record.is_acceleration else np.nan
    limit = _of(category and category.functional_rms, record.direction)
    long_life = _of(category and category.long_life_rms, record.direction)
    shock = _of(category and category.shock, record.direction)
    rms = band_limit = ratio = ratio_hz = np.nan
    band = None
    if category is not None and equipment is not None and not unfit:
        if category.shape is None:
            whys.append("the table has no spectrum of this class, and so no band for its rms")
        else:
            band, about = heard(category.shape.band(equipment.mass_kg), record)
            if equipment.mass_kg is None:
                whys.append(f"no mass_kg: the band of a piece up to {category.shape.light_kg:g} kg")
            whys += [about, short := "" if band is None else too_short(record, band[0])]
            if band is not None and not short:
                rms = band_rms(record.values, record.step, band)
                band_limit, ratio, ratio_hz, about = _beside_density(record, category, category.shape, band)
                whys.append(about)
        whys.append(_not_in_table(category, record.direction))
    return EquipmentRow(
        event=record.event,
        channel=record.name,
        direction=record.direction,
        vibration_class="" if category is None else category.name,
        edition="" if category is None else f"{table.edition}; {table.status}",
        band_hz=written(band),
        rms_m_s2=rms,
        limit_m_s2=limit,
        band_limit_m_s2=band_limit,
        asd_ratio=ratio,
        asd_ratio_hz=ratio_hz,
        peak_m_s2=peak,
        long_life_rms_m_s2=long_life,
        peak_ratio=peak / (PEAK_OF_RMS * long_life),
        shock_m_s2=shock,
        reason=joined(whys),
    )


def _beside_density(
    record: ChannelRecord, category: VibrationClass, shape: DensityShape, band: tuple[float, float]
) -> tuple[float, float, float, str]:
    """Rms of the table's density in a band, largest ratio of densities, where it is [Hz], and what is said of them."""
    level = category.functional_asd.get(record.direction)
    if level is None:
        return np.nan, np.nan, np.nan, ""
    centres, ratios, coarse = density_ratios(record.values, record.step, shape, level, band)
    about = ""
    if coarse.size:
        about = f"{record.duration:.4g} s resolve no third octave up to {coarse[-1]:.3g} Hz"
    of_table = float(np.sqrt(level * shape.integral(*band)))
    if not np.isfinite(ratios).any():
        return of_table, np.nan, np.nan, about
    worst = int(np.nanargmax(ratios))
    return of_table, float(ratios[worst]), float(centres[worst]), about


def _not_in_table(category: VibrationClass, direction: str) -> str:
    """What the table does not hold for a direction, in words."""
    held = {
        "functional rms": category.functional_rms,
        "spectral density": category.functional_asd,
        "long-life rms": category.long_life_rms,
        "shock": category.shock,
    }
    missing = [name for name, levels in held.items() if direction not in levels]
    return f"not in the table: {', '.join(missing)}" if missing else ""


def _of(levels: object, direction: str) -> float:
    return float(levels.get(direction, np.nan)) if isinstance(levels, dict) else np.nan
