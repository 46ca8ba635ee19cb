"""What was measured: which channel reads which gauge, how it was calibrated, and its records over their distance."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from fatigue.errors import Problem
from fatigue.gauges.correlated.asked import Asked
from fatigue.gauges.gauge_file import Gauge, read_gauges
from fatigue.gauges.measured.calibration_file import (
    Calibration,
    calibration_warnings,
    calibrations_of,
    read_calibrations,
)
from fatigue.gauges.measured.channel_file import ODOMETER, SPEED, Channel, Channels, read_channels
from fatigue.gauges.measured.record_files import Distances, Record, distances, open_records


@dataclass(frozen=True, slots=True)
class MeasuredFiles:
    """Tables of gauges, channels and calibrations (None: all channels are in ue or MPa), and the records."""

    gauges: Path
    channels: Path
    calibration: Path | None
    records: tuple[Path, ...]

    def __iter__(self) -> Iterator[Path]:
        """All files."""
        yield from (self.gauges, self.channels, *self.records)
        if self.calibration is not None:
            yield self.calibration


@dataclass(frozen=True, slots=True)
class Listed:
    """Tables of a measurement, read and matched.

    Attributes
    ----------
    gauges : that channels read, by name in the order of their table
    channels : of strain and of distance
    calibrations : of every channel of strain by its name, as it was when the records were made
    warnings : about the tables and the calibrations
    """

    gauges: Mapping[str, Gauge]
    channels: Channels
    calibrations: Mapping[str, Calibration]
    warnings: tuple[Problem, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Recorded:
    """Open records, the distance of their samples, and the warnings about both."""

    records: tuple[Record, ...]
    distances: Distances
    warnings: tuple[Problem, ...]


def listed(files: MeasuredFiles, asked: Asked, *, strict: bool) -> Listed:
    """Read the tables of a measurement.

    Raises
    ------
    DataError : what is wrong with one of them, or does not fit another
    """
    gauges, of_gauges = read_gauges(files.gauges, strict=strict)
    channels = read_channels(files.channels, [gauge.name for gauge in gauges], strict=strict)
    known: dict[str, list[Calibration]] = {}
    of_calibrations: list[Problem] = []
    if files.calibration is not None:
        known, of_calibrations = read_calibrations(files.calibration, strict=strict)
    calibrations = calibrations_of(channels.strain, known, files.calibration, asked.recorded_at)
    read = {name for channel in channels.strain for name, _ in channel.terms}
    return Listed(
        {gauge.name: gauge for gauge in gauges if gauge.name in read},
        channels,
        calibrations,
        (*calibration_warnings(calibrations), *of_gauges, *channels.warnings, *of_calibrations),
    )


def recorded(files: MeasuredFiles, channels: Channels, asked: Asked, rate_hz: float) -> Recorded:
    """Open the records, which will be brought to the rate of the simulation.

    Raises
    ------
    DataError : what is wrong with a record; how far they ran is not known
    """
    of_distance: list[Channel] = []
    if asked.km is None:
        of_distance = [channels.reserved[name] for name in (ODOMETER, SPEED) if name in channels.reserved]
    records, warnings = open_records(files.records, [*channels.strain, *of_distance], rate_hz)
    run = distances(records, channels.reserved, asked.km)
    return Recorded(records, run, (*run.warnings, *warnings))
