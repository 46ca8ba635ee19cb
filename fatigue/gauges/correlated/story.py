"""Measured beside simulated strain as a story: gauges of a case, channels of records, and a verdict for each of them.

A simulated random track is never the measured one. So by default numbers per km are compared, not histories; only a
record that replays the simulation is aligned with it. Both sides go through the same filter, to the rate of the
simulation. What is flagged in a record cuts it, and is listed.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Case, Event, given_case
from fatigue.errors import CaseError, Problem, given_path, refuse
from fatigue.files.recorded import refuse_foreign
from fatigue.gauges.correlated.asked import Asked, band_of, event_named, exponent_of, km_of_pass
from fatigue.gauges.correlated.compared import How, comparison
from fatigue.gauges.correlated.doubts import doubts
from fatigue.gauges.correlated.folder import FILLED, write_correlation
from fatigue.gauges.correlated.prepared import Treatment
from fatigue.gauges.correlated.summary import Correlation
from fatigue.gauges.gauge_file import Gauge, read_gauges
from fatigue.gauges.measured.calibration_file import (
    Calibration,
    calibration_warnings,
    calibrations_of,
    read_calibrations,
)
from fatigue.gauges.measured.channel_file import ODOMETER, SPEED, Channel, read_channels
from fatigue.gauges.measured.record_files import Record, distances, open_records
from fatigue.gauges.rows import gauge_rows
from fatigue.gauges.simulated import Reading, simulated
from fatigue.pipeline.mission.events import top_mode_hz
from fatigue.pipeline.solve.body import Body, read_body
from fatigue.pipeline.solve.weld_groups import weld_groups
from fatigue.stages import stage

Floats = NDArray[np.float64]

NOTHING_ELSE = Asked()


def correlate(
    case: Case | Path | str,
    gauges: Path | str,
    channels: Path | str,
    records: Sequence[Path | str],
    *,
    event: str,
    into: Path | str | None = None,
    calibration: Path | str | None = None,
    asked: Asked = NOTHING_ELSE,
    csv: bool = False,
    force: bool = False,
    strict: bool = False,
) -> Correlation:
    """Measured beside simulated strain in one event, written into a folder where one is given.

    Parameters
    ----------
    case : the case or its file
    gauges, channels : tables of the gauges, and of the channels that read them
    records : files of ``time_s`` and the columns of the channels, all measured under the conditions of the event
    event : of the mission
    into : folder for tables, page and record; None: nothing is written
    calibration : table of the calibrations; None: all channels are in ue or MPa
    asked : distance, band, alignment, gaps and exponent
    csv : write the tables as CSV as well
    force : overwrite files in the folder that are not ours
    strict : take unknown columns for errors

    Raises
    ------
    CaseError : an event that there is not or that has no distance; settings that make no sense
    DataError : what is wrong with a table, a record or a gauge; no common band; files in the way in the folder
    """
    refuse(CaseError, [*asked.problems(), *_no_records(records, asked)])
    case = given_case(case)
    gauge_file, channel_file = given_path(gauges, "gauges"), given_path(channels, "channels")
    record_files = [given_path(record, "records") for record in records]
    calibration_file = None if calibration is None else given_path(calibration, "calibration")
    inputs = [case.path, gauge_file, channel_file, *record_files, *filter(None, [calibration_file])]
    folder = None if into is None else given_path(into, "into")
    if folder is not None:
        refuse_foreign(folder, FILLED, force=force, inputs=[*inputs, *case.input_files().values()])

    stage("reading gauges, channels and calibrations")
    of_event = event_named(case, event)
    every, warnings = read_gauges(gauge_file, strict=strict)
    listed = read_channels(channel_file, [gauge.name for gauge in every], strict=strict)
    warnings = [*warnings, *listed.warnings]
    known: dict[str, list[Calibration]] = {}
    if calibration_file is not None:
        known, more = read_calibrations(calibration_file, strict=strict)
        warnings = [*warnings, *more]
    calibrations = calibrations_of(listed.strain, known, calibration_file, asked.recorded_at)

    stage("reading the body and simulating its gauges")
    body = read_body(case, strict=strict)
    used = _used(every, listed.strain)
    reading, more = _reading(body, list(used.values()), of_event)
    warnings = [*warnings, *more]
    rate_hz = 1.0 / reading.step
    distance_channels = [listed.reserved[name] for name in (ODOMETER, SPEED) if name in listed.reserved]
    needed = [*listed.strain, *(distance_channels if asked.km is None else [])]
    opened, more = open_records(record_files, needed, rate_hz)
    warnings = [*warnings, *more]
    run = distances(opened, listed.reserved, asked.km)
    durations = [reading.strain.shape[1] * reading.step, *(record.samples * record.step for record in opened)]
    rates = [rate_hz, *(record.rate_hz for record in opened)]
    low, high = band_of(asked, rates, min(durations), top_mode_hz(body))
    k, k_source = exponent_of(asked, case)
    how = How(
        event=event,
        residue=reading.residue,
        km=km_of_pass(case, of_event, durations[0]),
        treatment=Treatment(low, high, rate_hz, asked.bridge, _common_samples(asked, reading, opened)),
        max_lag_s=asked.max_lag_s,
        k=k,
        segment_s=case.spectrum.segment_s,
    )

    stage("comparing %d channels of %d records", len(listed.strain), len(opened))
    row = {name: i for i, name in enumerate(used)}
    found = []
    for channel in listed.strain:
        strain = np.sum([weight * reading.strain[row[name]] for name, weight in channel.terms], axis=0)
        found.append(comparison(channel, calibrations[channel.name], opened, run, strain, how))
    warnings = [*calibration_warnings(calibrations), *doubts(found, used, high), *run.warnings, *warnings]
    result = Correlation(
        title=case.title,
        event=event,
        comparisons=tuple(found),
        band_hz=(low, high),
        rate_hz=rate_hz,
        k=k,
        k_source=k_source,
        distance=run.source,
        km_simulated=how.km,
        is_aligned=asked.max_lag_s is not None,
        warnings=tuple(warnings),
    )
    if folder is not None:
        stage("writing tables and page")
        written = write_correlation(folder, result, inputs, csv=csv)
        result = replace(result, written=tuple(str(folder / name) for name in written))
    return result


def _no_records(records: Sequence[Path | str], asked: Asked) -> Iterator[Problem]:
    if not records or isinstance(records, str):
        yield Problem("argument", "records", "there is no list of records", "Give at least one file")
    elif asked.max_lag_s is not None and len(records) > 1:
        what = f"{len(records)} records cannot all replay one simulation"
        yield Problem("argument", "records", what, "Align one record after the other, or leave out the alignment")


def _used(gauges: Sequence[Gauge], channels: Sequence[Channel]) -> dict[str, Gauge]:
    """Gauges that channels read, by name in the order of their table."""
    names = {name for channel in channels for name, _ in channel.terms}
    return {gauge.name: gauge for gauge in gauges if gauge.name in names}


def _reading(body: Body, gauges: Sequence[Gauge], event: Event) -> tuple[Reading, list[Problem]]:
    """What the gauges read in the event, and the warnings about them."""
    with TemporaryDirectory(prefix="fatigue-gauges-") as scratch:
        rows, warnings = gauge_rows(weld_groups(body, Path(scratch)), gauges)
        return simulated(body, rows, event), warnings


def _common_samples(asked: Asked, reading: Reading, records: Sequence[Record]) -> int | None:
    """Samples that the simulation and the record that replays it have in common; None: there is none."""
    if asked.max_lag_s is None:
        return None
    (record,) = records
    at_rate = -(-record.samples * record.ratio.numerator // record.ratio.denominator)
    return min(int(reading.strain.shape[1]), at_rate)
