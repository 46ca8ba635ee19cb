"""The commands of a study of a vehicle: its analysis graph, and runs of its variants."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import click

from fatigue.cli.arguments import CASE, FOLDER, as_json, no_lock
from fatigue.cli.main import cli
from fatigue.cli.numbers import ABOVE_ZERO, numbers_of
from fatigue.cli.output import print_json, print_warnings, say
from fatigue.cli.progress import narrated
from fatigue.errors import Problem

Numbers: TypeAlias = tuple[float, ...]

SETTINGS = ("hard", "mid", "soft", "long_wheelbase")


@cli.group(short_help="Study a vehicle: its stability, and variants side by side.")
def study() -> None:
    """Study a vehicle: its stability over speed and conicity, and what its variants do to the lives of welds.

    The vehicle is a small linear trailer with worn wheels, described by a vehicle.toml. It is invented; no number of it
    is a property of a real train.

    \b
    Examples:
      fatigue study graph vehicle.toml -o graph
      fatigue study run study.toml -o study
    """


@study.command()
@click.argument("vehicles", metavar="VEHICLE...", type=CASE, nargs=-1, required=True)
@click.option("-o", "--output", type=FOLDER, metavar="DIR", help="Folder for tables and page, made if not there.")
@click.option(
    "--setting",
    "settings",
    type=click.Choice(SETTINGS),
    multiple=True,
    help="Setting of the suspension instead of that of the file; several are laid side by side.",
)
@click.option(
    "--speeds", metavar="A:B[:STEP]|V,...", help="Speeds of the map [km/h].  [default: 60:700 in steps of 10]"
)
@click.option(
    "--conicities",
    metavar="A:B[:STEP]|C,...",
    help="Conicities of the map; without STEP 60 at even ratios.  [default: 0.01:1.2]",
)
@click.option(
    "--at-speed",
    "at_speeds",
    type=ABOVE_ZERO,
    multiple=True,
    help="Speed [km/h] at which roots are followed over conicity, beside that of the run; may be given several times."
    "  [default: 350, 380, 420]",
)
@click.option(
    "--at-conicity",
    "at_conicities",
    type=ABOVE_ZERO,
    multiple=True,
    help="Conicity at which roots are followed over speed, beside that of the contact; may be given several times."
    "  [default: 0.03, 0.06, 0.1, 0.3, 0.5, 0.7]",
)
@click.option("--csv", is_flag=True, help="Write the tables as CSV as well.")
@click.option("--force", is_flag=True, help="Overwrite files in DIR that fatigue study graph did not write.")
@as_json
@click.pass_obj
def graph(
    options: dict[str, bool],
    vehicles: tuple[Path, ...],
    output: Path | None,
    settings: tuple[str, ...],
    speeds: str | None,
    conicities: str | None,
    at_speeds: tuple[float, ...],
    at_conicities: tuple[float, ...],
    csv: bool,
    force: bool,
    as_json: bool,
) -> None:
    """Draw the analysis graph: where a vehicle is stable over speed and conicity, and which root takes it away.

    Roots are followed over conicity and over speed and named by the body that moves. Prints stable ranges with the
    frequency of the root that changes at their ends; with -o, the tables roots, critical and stability and the page
    graph.html are written into DIR. Several vehicles, or settings of one, are laid side by side.

    \b
    Examples:
      fatigue study graph vehicle.toml -o graph
      fatigue study graph vehicle.toml --setting hard --setting soft --setting long_wheelbase -o graph
    """
    if output is None and (csv or force):
        raise click.UsageError("--csv and --force are about files: name their folder with -o")
    of_map = _range(speeds, "--speeds"), _range(conicities, "--conicities")
    from fatigue.study.graph.story import graph as run

    with narrated(quiet=options["quiet"]) as progress:
        found = run(
            vehicles,
            settings,
            asked=_asked(*of_map, at_speeds, at_conicities),
            into=output,
            csv=csv,
            force=force,
            progress=progress,
        )
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())


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
    for line in failures_told(found.failures):
        say(f"error: {line}", err=True)
    if found.exit_code:
        raise SystemExit(found.exit_code)


def failures_told(failures: Sequence[Problem]) -> Iterator[str]:
    """Failures of runs; those that say the same are one line with their count, for study.json has each."""
    alike: dict[tuple[str, str], list[Problem]] = {}
    for problem in failures:
        alike.setdefault((problem.code, problem.what), []).append(problem)
    for first, *others in alike.values():
        more = f" (and {len(others)} more for the same reason, see study.json)"
        yield f"{first}{more if others else ''}"


def _range(text: str | None, option: str) -> Numbers:
    """Values of an option, ascending; the two ends where they have no step."""
    ends = text.split(":") if text is not None else []
    values = numbers_of(",".join(ends) if len(ends) == 2 else text, option)
    if values and (len(values) < 2 or list(values) != sorted(set(values))):
        raise click.BadParameter(f"{text!r} is no range: give two values or more that ascend.", param_hint=option)
    return values


def _asked(speeds: Numbers, conicities: Numbers, at_speeds: Numbers, at_conicities: Numbers) -> Any:
    """What is asked of the graph; what is empty has its default."""
    from fatigue.study.graph.asked import Asked, conicities_of, speeds_of

    usual = Asked()
    return Asked(
        speeds_of(speeds) if speeds else usual.speeds,
        conicities_of(conicities) if conicities else usual.conicities,
        at_speeds or usual.at_speeds,
        at_conicities or usual.at_conicities,
    )
