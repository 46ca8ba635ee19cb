"""The commands of virtual strain gauges: what they read in the simulation, and a measurement beside it."""

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


@cli.group()
def gauges() -> None:
    """Put virtual strain gauges on the body and see what they read; lay a measurement beside it.

    A gauge is a row of a table: on an element, at a stress point, or as a stand-in at a weld toe.

    \b
    Examples:
      fatigue gauges histories case.toml --gauges gauges.csv -o strains
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
