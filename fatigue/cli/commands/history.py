"""The command that writes the stress history of any point of a result to a file."""

from pathlib import Path

import click

from fatigue.cli.arguments import CASE, FOLDER, as_json, no_lock
from fatigue.cli.early import refuse_missing_result
from fatigue.cli.main import cli
from fatigue.cli.output import print_json, say
from fatigue.cli.progress import narrated

ENDINGS = (".csv", ".parquet", ".mat")


@cli.command(short_help="Write the stress over time at any point.")
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option("--weld", required=True, help="Weld line.")
@click.option("--order", type=int, help="Position along the line; without it and --node the weld's worst point.")
@click.option("--node", type=int, help="FE node id, instead of --order.")
@click.option("--part", type=int, help="Part of the line, needed only at a corner that two parts share.")
@click.option("--event", help="One event.  [default: all, one above the other]")
@click.option(
    "--instants",
    type=click.Choice(["counted", "file"]),
    default="counted",
    show_default=True,
    help="All that were counted, or the samples of the file only, where the record was upsampled.",
)
@click.option(
    "-o", "--output", required=True, metavar="FILE", type=click.Path(path_type=Path), help="A .csv, .parquet or .mat."
)
@click.option("--force", is_flag=True, help="Overwrite an existing file.")
@click.option("--case", "case_file", type=CASE, help="Case file, if it is not where the result says.")
@no_lock
@as_json
@click.pass_obj
def history(
    options: dict[str, bool],
    folder: Path,
    weld: str,
    order: int | None,
    node: int | None,
    part: int | None,
    event: str | None,
    instants: str,
    output: Path,
    force: bool,
    case_file: Path | None,
    no_lock: bool,
    as_json: bool,
) -> None:
    """Write the stress over time at any point of a weld: membrane, bending, shears and both faces, as counted.

    Recovered from the input files, in MPa over the time of the file in s, stress factors and constants included: the
    range of a face is its max_range_MPa. FILE is a long table with a column event (.csv, .parquet), or for MATLAB a
    struct array history with an element for each event (.mat).

    \b
    Examples:
      fatigue history result --weld W2_hanger1_out -o worst.csv
      fatigue history result --weld W2_hanger1_out --order 3 --event "worn 350" -o order3.parquet
    """
    if output.suffix.lower() not in ENDINGS:
        raise click.BadParameter(f"'{output}' does not end in {', '.join(ENDINGS)}.", param_hint="-o")
    refuse_missing_result(folder, case_file, no_lock=no_lock)
    from fatigue.point.written import write_history
    from fatigue.results.outputs import damage_told

    with narrated(quiet=options["quiet"]), damage_told(folder):
        written = write_history(
            folder,
            weld,
            output,
            order=order,
            node=node,
            part=part,
            event=event,
            instants="file" if instants == "file" else "counted",
            case_file=case_file,
            force=force,
            no_lock=no_lock,
        )
    if as_json:
        print_json(written.as_record())
    else:
        say(written.as_text())
