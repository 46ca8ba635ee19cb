"""The command that lists the channels of a recording, and writes them as a table that a case reads."""

from pathlib import Path

import click

from fatigue.cli.arguments import as_json
from fatigue.cli.early import missing_foreign, refuse_all
from fatigue.cli.main import cli
from fatigue.cli.output import print_json, say


@cli.command(short_help="List the channels of a recording, or write them as a table.")
@click.argument("file", metavar="FILE", type=click.Path(path_type=Path))
@click.option(
    "-o", "--output", metavar="TABLE", type=click.Path(path_type=Path), help="A .parquet or .csv to write channels to."
)
@click.option("--group", help="Group of channels to write, where the file has several.")
@click.option(
    "--channel",
    "names",
    multiple=True,
    metavar="NAME[=COLUMN]",
    help="Channel to write, under another name if one is given; repeatable.  [default: all of the group]",
)
@click.option("--force", is_flag=True, help="Overwrite an existing TABLE.")
@as_json
def channels(
    file: Path, output: Path | None, group: str | None, names: tuple[str, ...], force: bool, as_json: bool
) -> None:
    """List groups, channels, units and rates of a recording of any format that is read.

    With -o the channels of one group are written as a table, time_s and a column for each, which strain gauges, unit
    loads, rides and histories of a case take. Values stay in their units, which the table states.

    \b
    Examples:
      fatigue channels run.tdms
      fatigue channels run.mf4 -o speed.parquet --channel "v_GPS=speed"
    """
    refuse_all(missing_foreign(file))
    if output is None and (group is not None or names or force):
        raise click.UsageError("--group, --channel and --force say what is written: give -o TABLE")
    if output is None:
        from fatigue.readers.convert.channels.listed import list_channels

        listed = list_channels(file)
        (print_json if as_json else say)(listed.as_record() if as_json else listed.as_text())
        return
    from fatigue.readers.convert.channels.written import write_channels

    written = write_channels(file, output, group=group, channels=names, force=force)
    (print_json if as_json else say)(written.as_record() if as_json else written.as_text())
