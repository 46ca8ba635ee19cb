"""The command that lays finished results beside each other."""

from pathlib import Path

import click

from fatigue.cli.arguments import FOLDER, as_json, no_lock
from fatigue.cli.early import missing_tables, refuse_all, refuse_missing_result
from fatigue.cli.main import cli
from fatigue.cli.output import print_json, say
from fatigue.cli.progress import narrated


@cli.command(short_help="Lay results beside each other: who gains, who loses, why.")
@click.argument("folders", metavar="A B [C ...]", type=FOLDER, nargs=-1, required=True)
@click.option("-o", "--output", type=FOLDER, metavar="DIR", help="Folder for tables and page, made if not there.")
@click.option(
    "--map",
    "weld_map",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Table weld_a, weld_b (CSV or Parquet) of welds of A that the others name otherwise.",
)
@click.option(
    "--accept-proposed",
    is_flag=True,
    help="Take welds without a common name for one where their lines lie within 5 mm and are equally long.",
)
@click.option("--csv", is_flag=True, help="Write the tables as CSV as well.")
@click.option("--force", is_flag=True, help="Overwrite files in DIR that fatigue compare did not write.")
@no_lock
@as_json
@click.pass_obj
def compare(
    options: dict[str, bool],
    folders: tuple[Path, ...],
    output: Path | None,
    weld_map: Path | None,
    accept_proposed: bool,
    csv: bool,
    force: bool,
    no_lock: bool,
    as_json: bool,
) -> None:
    """Compare finished results with the first: which welds gain or lose life, what makes it, which verdicts flip.

    A is the reference; every other result is laid beside it. The ratio of two lives is split without remainder into
    events (how often, and the damage of a pass) and, where both results have a diagnosis, modes and unit loads. With
    -o, tables and the page compare.html are written into DIR. Flips are told and do not change the exit code.

    \b
    Examples:
      fatigue compare out/14hz out/9hz -o out/compared
      fatigue compare before after -o compared --map renamed.csv --json
    """
    if len(folders) < 2:
        raise click.UsageError("Give at least two result folders: A, then what is compared with it.")
    if output is None and (csv or force):
        raise click.UsageError("--csv and --force are about files: name their folder with -o")
    for folder in folders:
        refuse_missing_result(folder, no_lock=no_lock)
    refuse_all(missing_tables(weld_map))
    from fatigue.decide.compare.story import compare as run
    from fatigue.results.outputs import damage_told

    with narrated(quiet=options["quiet"]), damage_told(folders[0]):
        found = run(
            folders,
            weld_map=weld_map,
            accept_proposed=accept_proposed,
            into=output,
            csv=csv,
            force=force,
            no_lock=no_lock,
        )
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())
