"""The command for whether the modal basis of a case is complete enough."""

from pathlib import Path

import click

from fatigue.cli.arguments import CASE, FOLDER, as_json, strict
from fatigue.cli.early import refuse_missing_case
from fatigue.cli.main import cli
from fatigue.cli.numbers import ABOVE_ZERO, DAMPED
from fatigue.cli.output import print_json, print_warnings, say
from fatigue.cli.progress import narrated


@cli.command(short_help="Is the modal basis complete enough for these welds?")
@click.argument("case_file", metavar="CASE", type=CASE)
@click.argument("other_case", metavar="[OTHER_CASE]", type=CASE, required=False)
@click.option("-o", "--output", type=FOLDER, metavar="DIR", help="Folder for tables and page, made if not there.")
@click.option(
    "--band-hz",
    type=ABOVE_ZERO,
    help="Upper end of the band that has to be complete; default: upper_hz of the case, else its highest normal mode.",
)
@click.option(
    "--damping", type=DAMPED, help="Damping ratio of modes that have none, for the dynamic mass: 0.015 is 1.5 %."
)
@click.option(
    "--no-damage",
    is_flag=True,
    help="Do not count damage without the highest modes, which takes as long as an assessment or longer.",
)
@click.option("--csv", is_flag=True, help="Write the tables as CSV as well.")
@click.option("--force", is_flag=True, help="Overwrite files in DIR that fatigue basis did not write.")
@strict
@as_json
@click.pass_obj
def basis(
    options: dict[str, bool],
    case_file: Path,
    other_case: Path | None,
    output: Path | None,
    band_hz: float | None,
    damping: float | None,
    no_damage: bool,
    csv: bool,
    force: bool,
    strict: bool,
    as_json: bool,
) -> None:
    """Say whether the modal basis of a case is complete enough for its welds; compare it with that of OTHER_CASE.

    Prints what can be had of effective mass, dynamic mass, flexibility at loaded points and damage without the highest
    modes, and why the rest cannot. With -o, tables and the page basis.html are written into DIR.

    \b
    Examples:
      fatigue basis body/case.toml
      fatigue basis strong.toml weak.toml -o basis --damping 0.015
    """
    if output is None and (csv or force):
        raise click.UsageError("--csv and --force are about files: name their folder with -o")
    refuse_missing_case(case_file)
    if other_case is not None:
        refuse_missing_case(other_case)
    from fatigue.basis.story import basis as run

    with narrated(quiet=options["quiet"]):
        found = run(
            case_file,
            other_case,
            into=output,
            force=force,
            csv=csv,
            band_hz=band_hz,
            damping=damping,
            damage=not no_damage,
            strict=strict,
        )
    print_warnings(found.warnings, "--json lists them")
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())
