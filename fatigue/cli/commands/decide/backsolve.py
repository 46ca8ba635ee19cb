"""The command for what just meets the target."""

from pathlib import Path

import click

from fatigue.cli.arguments import CASE, FOLDER, as_json, no_lock
from fatigue.cli.early import refuse_missing_result
from fatigue.cli.main import cli
from fatigue.cli.output import print_json, print_warnings, say
from fatigue.cli.progress import narrated


@cli.command(short_help="What load, curve, mileage, share or thickness is just enough.")
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option(
    "--for",
    "asked",
    required=True,
    metavar="load|curve|km_per_year|share:EVENT|thickness",
    help="What is free: a factor on the load or on the ranges of the curve, the mileage, a share, the plate thickness.",
)
@click.option("--target", metavar="KM|'N years'", help="What has to be reached; default: target_km of the case.")
@click.option("-o", "--output", type=FOLDER, metavar="OUT", help="Folder for table and page, made if not there.")
@click.option("--csv", is_flag=True, help="Write the table as CSV as well.")
@click.option("--force", is_flag=True, help="Overwrite files in OUT that fatigue backsolve did not write.")
@click.option("--case", "case_file", type=CASE, help="Case file, if it is not where the result says.")
@click.option("--threads", type=click.IntRange(min=1), help="Worker threads; default: one per processor core.")
@no_lock
@click.option("--exit-zero", is_flag=True, help="Exit 0 although of a weld nothing meets the target.")
@as_json
@click.pass_obj
def backsolve(
    options: dict[str, bool],
    folder: Path,
    asked: str,
    target: str | None,
    output: Path | None,
    csv: bool,
    force: bool,
    case_file: Path | None,
    threads: int | None,
    no_lock: bool,
    exit_zero: bool,
    as_json: bool,
) -> None:
    """Say what load, curve, mileage, share or plate thickness just meets the target, of every weld and of the body.

    Every answer is put back: the utilisation with it, computed forward, is printed as its distance from 1. Exit code 1:
    of a weld nothing of what was asked for meets the target.

    \b
    Examples:
      fatigue backsolve result --for load
      fatigue backsolve result --for "share:worn 350" --target "30 years"
      fatigue backsolve result --for thickness -o thicker
    """
    if output is None and (csv or force):
        raise click.UsageError("--csv and --force are about files: name their folder with -o")
    refuse_missing_result(folder, case_file, no_lock=no_lock)
    from fatigue.decide.backsolve.story import backsolve as run
    from fatigue.results.outputs import damage_told

    with narrated(quiet=options["quiet"]), damage_told(folder):
        found = run(
            folder,
            asked,
            target=target,
            into=output,
            csv=csv,
            force=force,
            case_file=case_file,
            threads=threads,
            no_lock=no_lock,
        )
    print_warnings(found.warnings, "--json lists them")
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())
    if not found.solved and not exit_zero:
        raise SystemExit(1)
