"""The commands of a study of a vehicle: its analysis graph, and runs of its variants."""

from pathlib import Path

import click

from fatigue.cli.arguments import CASE, FOLDER, as_json, no_lock
from fatigue.cli.main import cli
from fatigue.cli.output import print_json, print_warnings, say
from fatigue.cli.progress import narrated


@cli.group()
def study() -> None:
    """Study a vehicle: its stability over speed and conicity, and what its variants do to the lives of welds.

    The vehicle is a small linear trailer with worn wheels, described by a vehicle.toml. It is invented; no number of it
    is a property of a real train.
    """


@study.command()
@click.argument("study_file", metavar="STUDY", type=CASE)
@click.option(
    "-o",
    "--output",
    type=FOLDER,
    required=True,
    metavar="DIR",
    help="Folder of runs, tables and page, made if not there.",
)
@click.option(
    "--only",
    multiple=True,
    metavar="VARIANT",
    help="Run this variant only, or those a pattern fits ('contact=worn*'); may be given several times. Of the others "
    "what is finished is used.",
)
@click.option("--threads", type=click.IntRange(min=1), help="Runs at a time; default: one per processor core.")
@click.option("--csv", is_flag=True, help="Write the tables as CSV as well.")
@click.option("--force", is_flag=True, help="Overwrite files in DIR that fatigue study run did not write.")
@click.option("--dry-run", is_flag=True, help="List the runs and what each sets; run nothing, write nothing.")
@no_lock
@as_json
@click.pass_obj
def run(
    options: dict[str, bool],
    study_file: Path,
    output: Path,
    only: tuple[str, ...],
    threads: int | None,
    csv: bool,
    force: bool,
    dry_run: bool,
    no_lock: bool,
    as_json: bool,
) -> None:
    """Run every variant of STUDY (study.toml) under every seed, assess each, and lay their numbers side by side.

    Runs go to DIR/runs, tables of numbers, scatter over the seeds and ratios between variants to DIR. The same command
    goes on where it was interrupted; after a change of the study only what it concerns is run again. A run that fails
    is told at the end, and the others go on.

    \b
    Examples:
      fatigue study run study.toml -o study --dry-run
      fatigue study run study.toml -o study --only "fe=14*" --threads 2
    """
    from fatigue.study.variants.story import listed_study, run_study

    if dry_run:
        with narrated(quiet=options["quiet"]):
            planned = listed_study(study_file, output, only)
        if as_json:
            print_json(planned.as_record())
        else:
            say(planned.as_text())
        return
    with narrated(quiet=options["quiet"]) as progress:
        found = run_study(
            study_file,
            output,
            only=only,
            threads=threads,
            force=force,
            csv=csv,
            no_lock=no_lock,
            progress=progress,
        )
    print_warnings(found.warnings, "study.json lists the kinds")
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())
    for problem in found.failures:
        say(f"error: {problem}", err=True)
    if found.exit_code:
        raise SystemExit(found.exit_code)
