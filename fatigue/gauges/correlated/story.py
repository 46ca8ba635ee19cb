"""Measured beside simulated strain as a story: gauges of a case, channels of records, and a verdict for each of them.

A simulated random track is never the measured one. So by default numbers per km are compared, not histories; only a
record that replays the simulation is aligned with it. Both sides go through the same filter, to the rate of the
simulation. What is flagged in a record cuts it, and is listed.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from fatigue.case import Case, Event, given_case
from fatigue.errors import CaseError, Problem, given_path, refuse
from fatigue.files.recorded import refuse_foreign
from fatigue.gauges.case_files import case_files, input_hashes
from fatigue.gauges.correlated.asked import Asked, band_of, event_named, km_of_pass
from fatigue.gauges.correlated.compared import How, comparison
from fatigue.gauges.correlated.doubts import doubts
from fatigue.gauges.correlated.folder import FILLED, write_correlation
from fatigue.gauges.correlated.measurement import MeasuredFiles, listed, recorded
from fatigue.gauges.correlated.prepared import Treatment
from fatigue.gauges.correlated.summary import Correlation
from fatigue.gauges.exponent import exponent_of
from fatigue.gauges.gauge_file import Gauge
from fatigue.gauges.instrument import bridge
from fatigue.gauges.measured.record_files import Record
from fatigue.gauges.rows import gauge_rows
from fatigue.gauges.simulated import Reading, simulated
from fatigue.pipeline.mission.events import top_mode_hz
from fatigue.pipeline.solve.body import Body, read_body
from fatigue.pipeline.solve.weld_groups import weld_groups
from fatigue.stages import stage

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
    files = MeasuredFiles(
        given_path(gauges, "gauges"),
        given_path(channels, "channels"),
        None if calibration is None else given_path(calibration, "calibration"),
        tuple(given_path(record, "records") for record in records),
    )
    folder = None if into is None else given_path(into, "into")
    if folder is not None:
        refuse_foreign(folder, FILLED, force=force, inputs=[*case_files(case), *files])

    stage("reading gauges, channels and calibrations")
    of_event = event_named(case, event)
    tables = listed(files, asked, strict=strict)
    stage("reading the body and simulating its gauges")
    body = read_body(case, strict=strict)
    reading, of_rows = _reading(body, list(tables.gauges.values()), of_event)
    stage("opening the records (%d)", len(files.records))
    measured = recorded(files, tables.channels, asked, 1.0 / reading.step)

    how = _how(body, of_event, asked, reading, measured.records)
    stage("comparing %d channels", len(tables.channels.strain))
    found = []
    for channel in tables.channels.strain:
        simulated_strain = bridge(reading.strain, tuple(tables.gauges), channel.terms)
        calibrated = tables.calibrations[channel.name]
        found.append(comparison(channel, calibrated, measured.records, measured.distances, simulated_strain, how))
    told = doubts(found, tables.gauges, how.treatment.high_hz)
    result = Correlation(
        title=case.title,
        event=event,
        comparisons=tuple(found),
        band_hz=how.band_hz,
        rate_hz=how.treatment.rate_hz,
        k=how.k,
        k_source=how.k_source,
        distance=measured.distances.source,
        km_simulated=how.km,
        is_aligned=how.max_lag_s is not None,
        warnings=(*tables.warnings, *told, *measured.warnings, *of_rows),
    )
    if folder is not None:
        stage("writing tables and page")
        written = write_correlation(folder, result, input_hashes(case, files), csv=csv)
        result = replace(result, written=tuple(str(folder / name) for name in written))
    return result


def _no_records(records: Sequence[Path | str], asked: Asked) -> Iterator[Problem]:
    if not records or isinstance(records, str):
        yield Problem("argument", "records", "there is no list of records", "Give at least one file")
    elif asked.max_lag_s is not None and len(records) > 1:
        what = f"{len(records)} records cannot all replay one simulation"
        yield Problem("argument", "records", what, "Align one record after the other, or leave out the alignment")


def _reading(body: Body, gauges: Sequence[Gauge], event: Event) -> tuple[Reading, list[Problem]]:
    """What the gauges read in the event, and the warnings about them."""
    with TemporaryDirectory(prefix="fatigue-gauges-") as scratch:
        rows, warnings = gauge_rows(weld_groups(body, Path(scratch)), gauges)
        return simulated(body, rows, event), warnings


def _how(body: Body, event: Event, asked: Asked, reading: Reading, records: Sequence[Record]) -> How:
    """How all channels are compared: what the case, the records and the caller say together."""
    samples, rate_hz = int(reading.strain.shape[1]), 1.0 / reading.step
    lasting = samples * reading.step
    rates = [rate_hz, *(record.rate_hz for record in records)]
    shortest = min(lasting, *(record.samples * record.step for record in records))
    low, high = band_of(asked, rates, shortest, top_mode_hz(body))
    k, k_source = exponent_of(body.case, asked.exponent)
    common = None if asked.max_lag_s is None else min(samples, *(record.samples_at_ratio for record in records))
    return How(
        event=event.name,
        residue=reading.residue,
        km=km_of_pass(body.case, event, lasting),
        treatment=Treatment(low, high, rate_hz, asked.bridge, common),
        max_lag_s=asked.max_lag_s,
        k=k,
        k_source=k_source,
        segment_s=body.case.spectrum.segment_s,
    )
