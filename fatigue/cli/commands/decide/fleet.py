"""The command for the damage of a fleet."""

from pathlib import Path

import click

from fatigue.cli.arguments import FOLDER, as_json, no_lock
from fatigue.cli.main import cli
from fatigue.cli.output import print_json, print_warnings, say
from fatigue.cli.progress import narrated


@cli.command(short_help="Lives of units that run different distances.")
@click.argument("file", metavar="FLEET", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=FOLDER, metavar="DIR", help="Folder for tables and page, made if not there.")
@click.option("--csv", is_flag=True, help="Write the tables as CSV as well.")
@click.option("--force", is_flag=True, help="Overwrite files in DIR that fatigue fleet did not write.")
@no_lock
@click.option("--exit-zero", is_flag=True, help="Exit 0 although a unit misses target_years.")
@as_json
@click.pass_obj
def fleet(
    options: dict[str, bool],
    file: Path,
    output: Path | None,
    csv: bool,
    force: bool,
    no_lock: bool,
    exit_zero: bool,
    as_json: bool,
) -> None:
    """Sum the damage of units that run different distances under the conditions of several results.

    FLEET is a fleet.toml: conditions, each an event of a result folder, and a table of km per unit, condition and year.
    Prints lives in years by unit, percentiles over the units, and what makes them differ. Nothing is counted again.
    Exit code 1: a unit misses target_years.

    \b
    Examples:
      fatigue fleet fleet.toml
      fatigue fleet fleet.toml -o fleet --csv
    """
    if output is None and (csv or force):
        raise click.UsageError("--csv and --force are about files: name their folder with -o")
    from fatigue.decide.fleet.story import fleet as run

    with narrated(quiet=options["quiet"]):
        found = run(file, into=output, csv=csv, force=force, no_lock=no_lock)
    print_warnings(found.warnings, "--json lists them")
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())
    if not found.fulfilled and not exit_zero:
        raise SystemExit(1)
