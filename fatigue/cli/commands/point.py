"""The command that shows any point of a result as the report shows worst points."""

from pathlib import Path

import click

from fatigue.cli.arguments import CASE, FOLDER, as_json, no_lock
from fatigue.cli.early import refuse_missing_result
from fatigue.cli.main import cli
from fatigue.cli.output import print_json, say
from fatigue.cli.progress import narrated

ENDINGS = (".html", ".png")


@cli.command(short_help="Show any point as the report shows worst points.")
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option("--weld", required=True, help="Weld line.")
@click.option("--order", type=int, help="Position along the line; without it and --node the weld's worst point.")
@click.option("--node", type=int, help="FE node id, instead of --order.")
@click.option("--part", type=int, help="Part of the line, needed only at a corner that two parts share.")
@click.option(
    "--surface",
    type=click.Choice(["top", "bottom"]),
    help="Face of the plate.  [default: the one that decides, of two toes the more utilised]",
)
@click.option("--event", help="Event whose record is shown.  [default: the one that damages most]")
@click.option(
    "-o", "--output", metavar="FILE", type=click.Path(path_type=Path), help="Page (.html) or picture (.png) to write."
)
@click.option("--force", is_flag=True, help="Overwrite an existing file.")
@click.option("--case", "case_file", type=CASE, help="Case file, if it is not where the result says.")
@click.option("--threads", type=click.IntRange(min=1), help="Worker threads; default: one per processor core.")
@no_lock
@as_json
@click.pass_obj
def point(
    options: dict[str, bool],
    folder: Path,
    weld: str,
    order: int | None,
    node: int | None,
    part: int | None,
    surface: str | None,
    event: str | None,
    output: Path | None,
    force: bool,
    case_file: Path | None,
    threads: int | None,
    no_lock: bool,
    as_json: bool,
) -> None:
    """Show any point of a weld as the report shows worst points: history, cycles, S-N, and what makes the damage.

    The point is solved and counted again from the input files, whether the assessment counted it or a bound settled it,
    and compared with its row in the result. A page needs nothing but itself; a picture goes into a mail and wants an
    installed Chromium, Chrome or Edge. Nothing is written into DIR.

    \b
    Examples:
      fatigue point result --weld W2_hanger1_out
      fatigue point result --weld W2_hanger1_out --order 3 --surface bottom -o point.html
      fatigue point result --weld W2_hanger1_out --node 12345 -o point.png
    """
    if output is not None and output.suffix.lower() not in ENDINGS:
        told = f"'{output}' does not end in {' or '.join(ENDINGS)}; a PDF is printed from the page, by any browser."
        raise click.BadParameter(told, param_hint="-o")
    refuse_missing_result(folder, case_file, no_lock=no_lock)
    from fatigue.point.page.story import point as run
    from fatigue.results.outputs import damage_told

    with narrated(quiet=options["quiet"]), damage_told(folder):
        found = run(
            folder,
            weld,
            order=order,
            node=node,
            part=part,
            surface=surface,
            event=event,
            output=output,
            case_file=case_file,
            threads=threads,
            force=force,
            no_lock=no_lock,
        )
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())
