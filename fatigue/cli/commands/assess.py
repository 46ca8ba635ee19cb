"""Commands that take a case: check it, assess it."""

from contextlib import nullcontext
from pathlib import Path
from typing import Literal

import click

from fatigue.cli.arguments import CASE, FOLDER, as_json, no_lock, strict
from fatigue.cli.early import refuse_missing_case
from fatigue.cli.known_values import known_values
from fatigue.cli.main import cli
from fatigue.cli.numbers import SHARE
from fatigue.cli.output import print_json, print_warnings, say
from fatigue.cli.progress import narrated


@cli.command(short_help="Read and check a case and all its files; assess nothing.")
@click.argument("case_file", metavar="CASE", type=CASE)
@strict
@as_json
@click.pass_obj
def check(options: dict[str, bool], case_file: Path, strict: bool, as_json: bool) -> None:
    """Read and check a case and all its files; print sizes and the estimated time.

    \b
    Example:
      fatigue check body/case.toml --strict
    """
    refuse_missing_case(case_file)
    from fatigue.case import check_files, load_case

    case = load_case(case_file)
    check_files(case)
    from fatigue.check import check_case

    with narrated(quiet=options["quiet"]):
        found = check_case(case, strict=strict)
    if as_json:
        print_json(found.as_record())
        return
    say(found.as_text())
    print_warnings(found.warnings, "--json lists them")


@cli.command(short_help="Assess every point of every weld of a case.")
@click.argument("case_file", metavar="CASE", type=CASE)
@click.option(
    "-o", "--output", type=FOLDER, required=True, metavar="DIR", help="Result folder, made if it is not there."
)
@click.option("--threads", type=click.IntRange(min=1), default=None, help="Threads; default: one per processor core.")
@click.option("--exact", is_flag=True, help="Count every point of a large job, also those a bound would settle.")
@click.option(
    "--screen",
    type=SHARE,
    metavar="SHARE",
    help="Do not count points proven to stay below this share of the damage limit.  [default: 0.1 for jobs of more "
    "than 5e9 stress samples, else every point is counted]",
)
@click.option(
    "--likely-worst",
    is_flag=True,
    help="In welds proven to stay below SHARE everywhere, count the point with the largest estimate and do not prove "
    "that no other is worse: about half the time.",
)
@click.option(
    "--histogram",
    type=click.Choice(("worst", "all", "none")),
    default="worst",
    show_default=True,
    help="Points whose ranges go into histogram.parquet: the worst of each weld and those above a tenth of the limit, "
    "all that are counted, or none.",
)
@click.option(
    "--precision",
    type=click.Choice(("auto", "double")),
    default="auto",
    show_default=True,
    help="Of counting: single precision for jobs of more than 3e7 stress samples, within 1e-6 of the damage; or double "
    "for all.",
)
@click.option("--scheduler", metavar="ADDRESS", help="Use the workers of a dask cluster (package `distributed`).")
@click.option(
    "--force", is_flag=True, help="Replace the result of another case, and files in DIR that fatigue did not write."
)
@click.option("--no-report", is_flag=True, help="Tables only; `fatigue report DIR` writes report and picture later.")
@click.option(
    "--require-verified",
    is_flag=True,
    help="Refuse a case that rests on an S-N curve of the status unverified, with exit code 3.",
)
@click.option(
    "--verify",
    "recounts",
    is_flag=True,
    help="Recount points with independent code as `fatigue verify --results` does, and show the outcome in the report.",
)
@no_lock
@click.option("--exit-zero", is_flag=True, help="Exit 0 although a weld misses its target.")
@strict
@as_json
@click.pass_obj
def assess(
    options: dict[str, bool],
    case_file: Path,
    output: Path,
    threads: int | None,
    exact: bool,
    screen: float | None,
    likely_worst: bool,
    histogram: Literal["worst", "all", "none"],
    precision: Literal["auto", "double"],
    scheduler: str | None,
    force: bool,
    no_report: bool,
    require_verified: bool,
    recounts: bool,
    no_lock: bool,
    exit_zero: bool,
    strict: bool,
    as_json: bool,
) -> None:
    """Assess every point of every weld of a case; write tables, ParaView file and report to DIR.

    An interrupted run goes on where it was when the same command is given again. What was derived from an earlier
    result of the same case in DIR (page, PDF, workbook, CSV, diagnosis) is removed; files of your own stay.

    With --verify the exit code is 4 where the recount does not agree; the result is there all the same, and says so.

    \b
    Example:
      fatigue assess body/case.toml -o result
    """
    if exact and (screen is not None or likely_worst):
        raise click.UsageError("--exact counts every point: leave out --screen and --likely-worst")
    refuse_missing_case(case_file)
    from fatigue.case import check_files, load_case
    from fatigue.results import JOURNAL
    from fatigue.results.folder import refuse_foreign

    case = load_case(case_file)
    check_files(case)
    if not (output / JOURNAL).exists():
        own = [case_file, *case.input_files().values()]
        refuse_foreign(output, force=force, case_file=case_file, inputs=own)
    from fatigue.assess import assess as run
    from fatigue.pipeline.run.cluster import cluster_executor
    from fatigue.results.summary import result_summary

    if recounts:
        from fatigue.verify.recount import outcome_of

    workers = cluster_executor(scheduler) if scheduler else nullcontext()
    with narrated(quiet=options["quiet"]) as progress, workers as executor:
        done = run(
            case,
            output,
            threads=threads,
            executor=executor,
            share=0.0 if exact else screen,
            proves_worst=not likely_worst,
            histogram=histogram,
            precision=precision,
            strict=strict,
            require_verified=require_verified,
            force=force,
            report=not no_report,
            no_lock=no_lock,
            recount=outcome_of if recounts else None,
            verification=tuple if no_report else known_values,
            progress=progress,
        )
    print_warnings(done.warnings)
    found = result_summary(output, top=10)
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())
    if done.recount_passed is False:
        raise SystemExit(4)
    if not done.fulfilled and not exit_zero:
        raise SystemExit(1)
