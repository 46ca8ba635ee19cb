"""The command line: parse, call, print. Heavy imports stay inside the commands, so that ``--help`` is quick."""

import errno
import json
import logging
import sys
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import click

from fatigue import __version__
from fatigue.cli.early import refuse_missing_case, refuse_missing_result
from fatigue.cli.memory import hold_little
from fatigue.cli.numbers import ABOVE_ZERO, FROM_ZERO, SHARE
from fatigue.cli.progress import narrated
from fatigue.errors import DataError, FatigueError, Problem, refuse
from fatigue.stages import STAGES, stage

log = logging.getLogger("fatigue")

EXIT_CODES = """
\b
Exit codes: 0 done; 1 done, but a weld misses its target; 2 wrong usage;
3 bad case or data; 4 numerical failure; 130 interrupted.
"""

_CASE = click.Path(path_type=Path)
_FOLDER = click.Path(path_type=Path, file_okay=False)

as_json = click.option(
    "--json", "as_json", is_flag=True, help="Print JSON for machines (null: infinite or not available)."
)
strict = click.option("--strict", is_flag=True, help="Take unknown columns in the tables for errors.")


@click.group(context_settings={"help_option_names": ["-h", "--help"]}, epilog=EXIT_CODES)
@click.version_option(__version__, prog_name="fatigue")
@click.option("-q", "--quiet", is_flag=True, help="No progress and no log on stderr; errors only.")
@click.option("-v", "--verbose", is_flag=True, help="Log what is done on stderr, and tracebacks of program errors.")
def cli(quiet: bool, verbose: bool) -> None:
    """Weld fatigue life, in km, of a flexible body from a multibody simulation.

    \b
    Examples:
      fatigue example demo                       write the shipped car body to ./demo
      fatigue check demo/case.toml               read and check everything, assess nothing
      fatigue assess demo/case.toml -o result    life of every point of every weld
      fatigue show result --top 20               the worst points
    """
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(logging.Formatter("%(levelname)s %(message)s"))
    handler.setLevel(logging.ERROR if quiet else logging.INFO if verbose else logging.WARNING)
    handler.addFilter(lambda record: record.name != STAGES)  # told by `narrated`
    log.handlers[:] = [handler]
    log.setLevel(logging.INFO)
    click.get_current_context().obj = {"quiet": quiet, "verbose": verbose}


@cli.command()
@click.argument("case_file", metavar="CASE", type=_CASE)
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
    click.echo(found.as_text())
    _print_warnings(found.warnings, "--json lists them")


@cli.command()
@click.argument("case_file", metavar="CASE", type=_CASE)
@click.option(
    "-o", "--output", type=_FOLDER, required=True, metavar="DIR", help="Result folder, made if it is not there."
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
@click.option("--scheduler", metavar="ADDRESS", help="Use the workers of a dask cluster (package `distributed`).")
@click.option(
    "--force", is_flag=True, help="Replace the result of another case, and files in DIR that fatigue did not write."
)
@click.option("--no-report", is_flag=True, help="Tables only; `fatigue report DIR` writes report and picture later.")
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
    scheduler: str | None,
    force: bool,
    no_report: bool,
    exit_zero: bool,
    strict: bool,
    as_json: bool,
) -> None:
    """Assess every point of every weld of a case; write tables, ParaView file and report to DIR.

    An interrupted run goes on where it was when the same command is given again. What was derived from an earlier
    result of the same case in DIR (page, PDF, workbook, CSV, diagnosis) is removed; files of your own stay.

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

    workers = cluster_executor(scheduler) if scheduler else nullcontext()
    with narrated(quiet=options["quiet"]) as progress, workers as executor:
        done = run(
            case,
            output,
            threads=threads,
            executor=executor,
            share=0.0 if exact else screen,
            proves_worst=not likely_worst,
            strict=strict,
            force=force,
            report=not no_report,
            verification=tuple if no_report else _verification,
            progress=progress,
        )
    _print_warnings(done.warnings)
    found = result_summary(output, top=10)
    if as_json:
        print_json(found.as_record())
    else:
        click.echo(found.as_text())
    if not done.fulfilled and not exit_zero:
        raise SystemExit(1)


@cli.command()
@click.argument("folder", metavar="DIR", type=_FOLDER)
@click.option("--top", type=click.IntRange(min=1), default=10, show_default=True, help="How many points to show.")
@click.option("--weld", "welds", multiple=True, help="Only this weld; may be given several times.")
@as_json
def show(folder: Path, top: int, welds: tuple[str, ...], as_json: bool) -> None:
    """Print the welds and the worst points of a result folder.

    \b
    Examples:
      fatigue show result --top 20
      fatigue show result --weld W1_roof_bracket_neg --json
    """
    refuse_missing_result(folder)
    from fatigue.naming import composed
    from fatigue.results.summary import result_summary

    found = result_summary(folder, top=top, only=[composed(weld) for weld in welds])
    if as_json:
        print_json(found.as_record())
    else:
        click.echo(found.as_text())


@cli.command()
@click.argument("folder", metavar="DIR", type=_FOLDER)
@click.option("--pdf", is_flag=True, help="Print report.pdf as well, with an installed Chromium, Chrome or Edge.")
@click.option("--xlsx", is_flag=True, help="Write nodes.xlsx as well (package `xlsxwriter`).")
@click.option("--csv", is_flag=True, help="Write the tables as CSV as well.")
@click.option("--case", "case_file", type=_CASE, help="Case file, if it is not where the result says.")
@click.option("--force", is_flag=True, help="Overwrite PDF, workbook and CSV files that are there already.")
@click.pass_obj
def report(
    options: dict[str, bool], folder: Path, pdf: bool, xlsx: bool, csv: bool, case_file: Path | None, force: bool
) -> None:
    """Write report.html and weld_lines.vtp of a result folder again, with what a diagnosis has added.

    Without the case of the result the page lacks mesh, histories and spectra, and says so.

    \b
    Examples:
      fatigue report result --pdf --xlsx
      fatigue report result --case body/case.toml
    """
    refuse_missing_result(folder, case_file)
    from fatigue.documents import AGAIN, CSV, write_documents
    from fatigue.results import PRINT, WORKBOOK

    wanted = [*AGAIN, *[WORKBOOK] * xlsx, *CSV * csv, *[PRINT] * pdf]
    with narrated(quiet=options["quiet"]):
        done = write_documents(folder, wanted, case_file=case_file, verification=_verification, force=force)
    for path in done.written:
        click.echo(path)
    refuse(DataError, done.problems)


@cli.command()
@click.argument("folder", metavar="DIR", type=_FOLDER)
@click.option("--case", "case_file", type=_CASE, help="Case file, if it is not where the result says.")
@click.option(
    "--share-of-limit",
    type=FROM_ZERO,
    default=0.1,
    show_default=True,
    help="Utilisation from which points are shared out, when not all can be.",
)
@click.option(
    "--edges", default=None, metavar="HZ,HZ,...", help="Edges between frequency bands [Hz]; default: third octaves."
)
@click.option("--bin-km", type=ABOVE_ZERO, default=0.1, show_default=True, help="Length of a piece of track [km].")
@as_json
@click.pass_obj
def diagnose(
    options: dict[str, bool],
    folder: Path,
    case_file: Path | None,
    share_of_limit: float,
    edges: str | None,
    bin_km: float,
    as_json: bool,
) -> None:
    """Say what makes the damage of a result: event, mode, frequency band, piece of track; and what would help.

    Writes attribution, track, diagnosis and levers tables into DIR and shows them in its report. Of a large result:
    worst points of welds and points above --share-of-limit, of very many those with the shortest lives.

    \b
    Example:
      fatigue diagnose result
    """
    edges_hz = None if edges is None else _numbers(edges, "--edges")
    refuse_missing_result(folder, case_file)
    from fatigue.diagnose import diagnose as run
    from fatigue.documents import write_documents
    from fatigue.results import PAGE, is_derived, read_provenance

    with narrated(quiet=options["quiet"]) as progress:
        found = run(
            folder,
            case_file=case_file,
            share_of_limit=share_of_limit,
            edges_hz=edges_hz,
            bin_km=bin_km,
            progress=progress,
        )
        if is_derived(folder, PAGE, read_provenance(folder)):
            write_documents(folder, [PAGE], case_file=case_file, verification=_verification)
        elif (folder / PAGE).exists():
            log.warning("%s was not written by fatigue, or was changed since: it stays as it is", folder / PAGE)
    if as_json:
        print_json(found.as_record())
    else:
        click.echo(found.as_text())


@cli.command()
@click.option(
    "--results", "folder", type=_FOLDER, metavar="DIR", help="Recount points of this result from its input files."
)
@click.option(
    "--sample",
    type=click.IntRange(min=1),
    default=20,
    show_default=True,
    help="Points to recount beside each weld's worst.",
)
@click.option("--all", "every", is_flag=True, help="Recount all points.")
@click.option("--case", "case_file", type=_CASE, help="Case file, if it is not where the result says.")
@as_json
@click.pass_obj
def verify(
    options: dict[str, bool], folder: Path | None, sample: int, every: bool, case_file: Path | None, as_json: bool
) -> None:
    """Check the installed program against closed forms and golden values, or recount a result independently.

    The recount reads the input files itself, with dense line matrices and the `rainflow` package, and shares no code
    with the assessment. Of very many welds it takes what some ten minutes allow, half of them those with the shortest
    lives, half drawn, and checks of all rows what follows from other rows. Exit code 4 when a check fails.

    \b
    Examples:
      fatigue verify
      fatigue verify --results result --all
    """
    if folder is not None:
        refuse_missing_result(folder, case_file)
    elif case_file is not None:
        raise click.UsageError("--case names the case of a result: give --results DIR as well")
    elif every:
        raise click.UsageError("--all recounts the points of a result: give --results DIR as well")
    from fatigue.verify.check import VerificationTable
    from fatigue.verify.recount import Recount, recount
    from fatigue.verify.table import verification_table

    with narrated(quiet=options["quiet"]):
        if folder is None:
            stage("computing the known values")
            found: VerificationTable | Recount = verification_table()
        else:
            stage("recounting from the input files")
            found = recount(folder, sample=None if every else sample, case_file=case_file)
    if as_json:
        print_json(found.as_record())
    else:
        click.echo(found.as_text())
    if not found.passed:
        raise SystemExit(4)


def _verification() -> Sequence[Mapping[str, Any]]:
    """Compute the known values that the report shows beside what they should be."""
    from fatigue.verify.table import verification_table

    stage("computing the known values")
    checks: Sequence[Mapping[str, Any]] = verification_table().as_record()["checks"]
    return checks


def _numbers(text: str, option: str) -> tuple[float, ...]:
    try:
        return tuple(float(number) for number in text.split(","))
    except ValueError:
        raise click.BadParameter(f"{text!r} is not a list of numbers such as 5,10,20", param_hint=option) from None


def print_json(record: Any) -> None:
    """Print a record as JSON; infinite and missing numbers become null."""
    from fatigue.results import json_ready

    click.echo(json.dumps(json_ready(record), indent=2, ensure_ascii=False, allow_nan=False))


def _print_warnings(problems: tuple[Problem, ...], others_are: str = "see provenance.json") -> None:
    """Log the first warning of each kind, and how many more there are and where."""
    kinds: dict[str, list[Problem]] = {}
    for problem in problems:
        kinds.setdefault(problem.code, []).append(problem)
    for same in kinds.values():
        others = sum(problem.count for problem in same) - 1
        more = f" (and {others} more of this kind, {others_are})" if others else ""
        log.warning("%s%s", same[0], more)


def _of_the_system(error: OSError) -> Problem:
    """Say what the operating system refused: a folder that is not there, a name too long, a full disk."""
    place = str(error.filename or "a file")
    reason = error.strerror or str(error)
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return Problem("system", place, f"cannot be written ({reason})", "Make room, and give the same command again")
    if error.errno == errno.ENOENT and error.filename and not Path(place).parent.is_dir():
        return Problem("system", place, f"there is no folder {Path(place).parent}", "Make it, or correct the path")
    remedy = "Correct the path, or give one that you may read and write"
    return Problem("system", place, f"cannot be read or written ({reason})", remedy)


def main() -> None:
    """Run the command line; every known failure is one clear line and its exit code."""
    verbose = bool({"-v", "--verbose"} & set(sys.argv[1:]))
    hold_little()
    try:
        cli.main(standalone_mode=False)
    except FatigueError as error:
        for problem in error.problems:
            click.echo(f"error: {problem}", err=True)
        sys.exit(error.exit_code)
    except click.ClickException as error:
        error.show()
        sys.exit(error.exit_code)
    except (KeyboardInterrupt, click.exceptions.Abort):
        click.echo("interrupted: the same command goes on from here", err=True)
        sys.exit(130)
    except BrokenPipeError:  # the reader of our output went away, as `| head` does
        sys.stderr.close()
        sys.exit(0)
    except OSError as error:
        if verbose:
            raise
        click.echo(f"error: {_of_the_system(error)}", err=True)
        sys.exit(3)
    except MemoryError:
        click.echo("error: out of memory: close other programs, or assess fewer welds at once", err=True)
        sys.exit(4)
    except Exception as error:
        if verbose:
            raise
        click.echo(
            f"error: this should not have happened ({type(error).__name__}: {error}). Run again with -v and report it",
            err=True,
        )
        sys.exit(4)
