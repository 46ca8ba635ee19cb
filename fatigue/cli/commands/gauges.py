"""The commands of virtual strain gauges: what they read in the simulation, and a measurement beside it."""

from datetime import datetime
from pathlib import Path

import click

from fatigue.cli.arguments import CASE, FOLDER, as_json, strict
from fatigue.cli.early import missing_tables, refuse_all, refuse_missing_case
from fatigue.cli.main import cli
from fatigue.cli.numbers import ABOVE_ZERO
from fatigue.cli.output import print_json, print_warnings, say
from fatigue.cli.progress import narrated

FILE = click.Path(path_type=Path)

gauge_table = click.option(
    "--gauges", "gauge_file", type=FILE, required=True, metavar="FILE", help="Table of the gauges, one row a grid."
)
into = click.option(
    "-o", "--output", type=FOLDER, metavar="DIR", required=True, help="Folder for tables and page, made if not there."
)


@cli.group(short_help="Virtual strain gauges, and measured strain beside them.")
def gauges() -> None:
    """Put virtual strain gauges on the body and see what they read; lay a measurement beside it.

    A gauge is a row of a table: on an element, at a stress point, or as a stand-in at a weld toe.

    \b
    Examples:
      fatigue gauges histories case.toml --gauges gauges.csv -o strains
      fatigue gauges correlate case.toml --gauges gauges.csv --channels channels.csv \\
        --records ride.parquet --km 5.2 --event "worn 350" -o beside
    """


@gauges.command()
@click.argument("case_file", metavar="CASE", type=CASE)
@gauge_table
@into
@click.option("--event", "events", multiple=True, help="This event only; may be given several times.")
@click.option("--counted", is_flag=True, help="Histories at the instants that are counted, not at those of the files.")
@click.option("--exponent", type=ABOVE_ZERO, help="Of the pseudo-damage; default: the first slope of the case's curve.")
@click.option("--threads", type=click.IntRange(min=1), help="Worker threads; default: one per processor core.")
@click.option("--csv", is_flag=True, help="Write the tables as CSV as well.")
@click.option("--force", is_flag=True, help="Overwrite files in DIR that fatigue gauges histories did not write.")
@strict
@as_json
@click.pass_obj
def histories(
    options: dict[str, bool],
    case_file: Path,
    gauge_file: Path,
    output: Path,
    events: tuple[str, ...],
    counted: bool,
    exponent: float | None,
    threads: int | None,
    csv: bool,
    force: bool,
    strict: bool,
    as_json: bool,
) -> None:
    """Write what every gauge reads in every event: strain and stress over time, cycles, how sure the place is.

    Writes tables and the page gauges.html into DIR. Means are never compared with a measurement, which has no zero.

    \b
    Examples:
      fatigue gauges histories case.toml --gauges gauges.csv -o strains
      fatigue gauges histories case.toml --gauges gauges.csv --event "worn 350" -o strains --csv
    """
    refuse_missing_case(case_file)
    refuse_all(missing_tables(gauge_file))
    from fatigue.gauges.histories.story import histories as run

    with narrated(quiet=options["quiet"]) as progress:
        found = run(
            case_file,
            gauge_file,
            into=output,
            events=events,
            counted=counted,
            exponent=exponent,
            threads=threads,
            csv=csv,
            force=force,
            strict=strict,
            progress=progress,
        )
    print_warnings(found.warnings, "--json lists them")
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())


@gauges.command()
@click.argument("case_file", metavar="CASE", type=CASE)
@click.argument("more_records", metavar="", type=FILE, nargs=-1)
@gauge_table
@click.option("--channels", "channel_file", type=FILE, required=True, metavar="FILE", help="Table of the channels.")
@click.option(
    "--records",
    "records",
    type=FILE,
    multiple=True,
    required=True,
    metavar="FILE...",
    help="Measured records, CSV or Parquet: time_s and the columns of the channels. Further ones follow it.",
)
@click.option("--event", required=True, metavar="NAME", help="Event of the mission they were measured under.")
@into
@click.option("--calibration", type=FILE, metavar="FILE", help="Table of the calibrations; without it, units are ue.")
@click.option("--recorded-at", metavar="TIME", help="When, with its zone, where a channel has several calibrations.")
@click.option("--km", type=ABOVE_ZERO, help="Distance of all records together, instead of an odometer or a speed.")
@click.option("--band", metavar="LO:HI", help="Band of both sides [Hz].  [default: 0 to min(0.4 fs, 1.5 highest mode)]")
@click.option(
    "--align",
    type=click.Choice(["none", "lag"]),
    default="none",
    show_default=True,
    help="lag: the one record replays the simulation; its sign and lag are found.",
)
@click.option("--max-lag", type=ABOVE_ZERO, default=1.0, show_default=True, help="Largest lag of --align lag [s].")
@click.option(
    "--bridge",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    metavar="N",
    help="Put a straight line over gaps of at most N flagged samples, and count it.",
)
@click.option("--exponent", type=ABOVE_ZERO, metavar="K", help="Of the pseudo-damage.  [default: of the case's curve]")
@click.option("--csv", is_flag=True, help="Write the tables as CSV as well.")
@click.option("--force", is_flag=True, help="Overwrite files in DIR that fatigue gauges correlate did not write.")
@strict
@as_json
@click.pass_obj
def correlate(
    options: dict[str, bool],
    case_file: Path,
    more_records: tuple[Path, ...],
    gauge_file: Path,
    channel_file: Path,
    records: tuple[Path, ...],
    event: str,
    output: Path,
    calibration: Path | None,
    recorded_at: str | None,
    km: float | None,
    band: str | None,
    align: str,
    max_lag: float,
    bridge: int,
    exponent: float | None,
    csv: bool,
    force: bool,
    strict: bool,
    as_json: bool,
) -> None:
    """Lay measured strain beside the simulated one: damage ratio, spectra, exceedance, and a verdict for every gauge.

    Statistics per km are compared, in one band, at one rate. Samples that are missing, stuck, clipped or spikes cut the
    record and are listed. Writes tables and the page correlation.html into DIR. Exit code 1: a gauge is poor, its
    sign is wrong, or none could be judged.

    \b
    Examples:
      fatigue gauges correlate case.toml --gauges gauges.csv --channels channels.csv \\
        --records ride_1.parquet ride_2.parquet --km 5.2 --event "worn 350" -o beside
      fatigue gauges correlate case.toml --gauges gauges.csv --channels channels.csv \\
        --calibration calibration.csv --records rig.csv --km 2.8 --align lag --event "worn 350" -o rig
    """
    low, high = _band(band)
    files = (*records, *more_records)
    if any(path.suffix == ".toml" for path in files):
        raise click.UsageError("CASE stands first: fatigue gauges correlate CASE --records FILE FILE ...")
    refuse_missing_case(case_file)
    refuse_all(missing_tables(gauge_file, channel_file, calibration, *files))
    from fatigue.gauges.correlated.asked import Asked
    from fatigue.gauges.correlated.story import correlate as run

    asked = Asked(
        km=km,
        recorded_at=_time(recorded_at),
        low_hz=low,
        high_hz=high,
        max_lag_s=max_lag if align == "lag" else None,
        bridge=bridge,
        exponent=exponent,
    )
    with narrated(quiet=options["quiet"]):
        found = run(
            case_file,
            gauge_file,
            channel_file,
            files,
            event=event,
            into=output,
            calibration=calibration,
            asked=asked,
            csv=csv,
            force=force,
            strict=strict,
        )
    print_warnings(found.warnings, "--json lists them")
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())
    if not found.agrees:
        raise SystemExit(1)


def _band(text: str | None) -> tuple[float | None, float | None]:
    """Ends of a band, None where they are left out."""
    if text is None:
        return None, None
    low, _, high = text.partition(":")
    try:
        ends = [float(end) if end.strip() else None for end in (low, high)]
    except ValueError:
        ends = []
    if ":" not in text or not ends or any(end is not None and not 0.0 <= end < float("inf") for end in ends):
        raise click.BadParameter(f"{text!r} is no band such as 0.5:60, in Hz", param_hint="--band")
    return ends[0], ends[1]


def _time(text: str | None) -> datetime | None:
    if text is None:
        return None
    try:
        found = datetime.fromisoformat(text)
    except ValueError:
        found = None
    if found is None or found.tzinfo is None:
        what = f"{text!r} is no time with its zone, such as 2026-05-04T10:00:00+02:00"
        raise click.BadParameter(what, param_hint="--recorded-at")
    return found
