"""The command that checks the program, and recounts results."""

import logging
from pathlib import Path

import click

from fatigue.cli.arguments import CASE, FOLDER, as_json
from fatigue.cli.early import refuse_missing_result
from fatigue.cli.main import cli
from fatigue.cli.output import print_json, say
from fatigue.cli.progress import narrated
from fatigue.errors import DataError
from fatigue.stages import stage

log = logging.getLogger(__name__)


@cli.command(short_help="Check the program, or recount points of a result.")
@click.option(
    "--results", "folder", type=FOLDER, metavar="DIR", help="Recount points of this result from its input files."
)
@click.option(
    "--sample",
    type=click.IntRange(min=1),
    default=20,
    show_default=True,
    help="Points to recount beside each weld's worst.",
)
@click.option("--all", "every", is_flag=True, help="Recount all points.")
@click.option("--case", "case_file", type=CASE, help="Case file, if it is not where the result says.")
@as_json
@click.pass_obj
def verify(
    options: dict[str, bool], folder: Path | None, sample: int, every: bool, case_file: Path | None, as_json: bool
) -> None:
    """Check the installed program against closed forms and golden values, or recount a result independently.

    The recount reads the input files itself, with dense line matrices and the `rainflow` package, and shares no code
    with the assessment. Of very many welds it takes what some ten minutes allow, half of them those with the shortest
    lives, half drawn, and checks of all rows what follows from other rows. The outcome is kept beside the result, in
    recount.json, and `fatigue report DIR` shows it. Exit code 4 when a check fails.

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
    from fatigue.results.outputs import damage_told
    from fatigue.results.provenance import parsed_provenance
    from fatigue.verify.check import VerificationTable
    from fatigue.verify.recount import Recount, keep, recount
    from fatigue.verify.table import verification_table

    with narrated(quiet=options["quiet"]):
        if folder is None:
            stage("computing the known values")
            found: VerificationTable | Recount = verification_table()
        else:
            stage("recounting from the input files")
            with damage_told(folder):
                record = parsed_provenance(folder)
                found = recount(folder, sample=None if every else sample, case_file=case_file)
            try:
                keep(folder, found, record)
            except DataError as error:  # a folder of somebody else can be checked as well
                log.warning("the outcome is not kept beside the result: %s", error)
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())
    if not found.passed:
        raise SystemExit(4)
