"""The command for a result under another mission, curve or load."""

from pathlib import Path
from typing import Literal

import click

from fatigue.cli.arguments import CASE, FOLDER, as_json, no_lock
from fatigue.cli.early import refuse_missing_case, refuse_missing_result
from fatigue.cli.main import cli
from fatigue.cli.output import print_json, print_warnings, say
from fatigue.cli.progress import narrated


@cli.command(short_help="A result under another mission, curve or load.")
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option(
    "--set",
    "settings",
    metavar="KEY=VALUE",
    multiple=True,
    help="Key of the case and its value; may be given several times. load=1.1 is a factor on all stresses.",
)
@click.option("--drop", multiple=True, metavar="EVENT", help="Leave an event out; may be given several times.")
@click.option("--case", "case_file", type=CASE, metavar="FILE", help="Another case, instead of --set and --drop.")
@click.option("-o", "--output", type=FOLDER, metavar="FOLDER", help="Folder for tables and page, made if not there.")
@click.option(
    "--recount",
    type=click.Choice(("worst", "all")),
    help="Count points again of which nothing stored says enough: of each weld the worst, or all.",
)
@click.option("--threads", type=click.IntRange(min=1), help="Threads that count again; default: one per core.")
@click.option("--csv", is_flag=True, help="Write the tables as CSV as well.")
@click.option("--force", is_flag=True, help="Overwrite files in FOLDER that fatigue whatif did not write.")
@no_lock
@click.option("--exit-zero", is_flag=True, help="Exit 0 although a weld misses its target.")
@as_json
@click.pass_obj
def whatif(
    options: dict[str, bool],
    folder: Path,
    settings: tuple[str, ...],
    drop: tuple[str, ...],
    case_file: Path | None,
    output: Path | None,
    recount: Literal["worst", "all"] | None,
    threads: int | None,
    csv: bool,
    force: bool,
    no_lock: bool,
    exit_zero: bool,
    as_json: bool,
) -> None:
    """Say what becomes of a finished result under another mission, curve or load, without counting again.

    Every number has its basis: exact, from stored ranges between two bounds, a bound, or recount: no number. A key that
    is no knob is refused. Exit code 1: a weld misses its target.

    \b
    Examples:
      fatigue whatif result --set load=1.1
      fatigue whatif result --set curve.survival=mean --set mission.target_km=2e7 -o whatif
      fatigue whatif result --drop "worn 350" --set 'mission.event."sound 350".share=0.8'
      fatigue whatif result --case body/case_2.toml --recount worst --json
    """
    if output is None and (csv or force):
        raise click.UsageError("--csv and --force are about files: name their folder with -o")
    if not settings and not drop and case_file is None:
        raise click.UsageError("Say what is changed: --set KEY=VALUE, --drop EVENT, or --case FILE.")
    if case_file is not None and (settings or drop):
        raise click.UsageError("--case is a whole case: leave out --set and --drop.")
    refuse_missing_result(folder, no_lock=no_lock)
    if case_file is not None:
        refuse_missing_case(case_file)
    from fatigue.decide.whatif.folder import refuse_foreign, write_whatif
    from fatigue.decide.whatif.story import whatif as run
    from fatigue.results.outputs import damage_told

    with narrated(quiet=options["quiet"]), damage_told(folder):
        if output is not None:
            refuse_foreign(output, folder, case_file, force=force)
        found = run(folder, settings, drop=drop, case_file=case_file, recount=recount, threads=threads, no_lock=no_lock)
        if output is not None:
            found = write_whatif(output, found, folder, csv=csv)
    print_warnings(found.warnings, "--json lists them")
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())
    if not found.fulfilled and not exit_zero:
        raise SystemExit(1)
