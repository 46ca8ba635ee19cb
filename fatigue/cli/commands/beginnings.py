"""Commands to begin with: the shipped case, one of any size, the schema of case files, and what a code means."""

from pathlib import Path

import click

from fatigue.cli.arguments import FOLDER, as_json
from fatigue.cli.early import refuse_existing
from fatigue.cli.main import cli
from fatigue.cli.numbers import ABOVE_ZERO
from fatigue.cli.output import print_json, say
from fatigue.cli.progress import is_quiet, narrated
from fatigue.stages import stage


@cli.command(short_help="Write the shipped car body, a case in two variants.")
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option("--templates", is_flag=True, help="Instead, tables to fill in from a standard: EN 17149-3, DVS 1608.")
@click.option("--force", is_flag=True, help="Overwrite files of the same names.")
def example(folder: Path, templates: bool, force: bool) -> None:
    """Write the shipped car body, a case in two variants, to DIR.

    \b
    Example:
      fatigue example demo && fatigue assess demo/case.toml -o result
    """
    from fatigue.example import write_example, write_templates

    for file in (write_templates if templates else write_example)(folder, force=force):
        say(file)


@cli.command(short_help="Write a synthetic case of any size.")
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option("--nodes", type=click.IntRange(min=10), default=10_000, show_default=True, help="Weld nodes.")
@click.option("--modes", type=click.IntRange(min=2), default=60, show_default=True, help="Modes.")
@click.option("--events", type=click.IntRange(min=1), default=3, show_default=True, help="Events.")
@click.option("--seconds", type=ABOVE_ZERO, default=60.0, show_default=True, help="Length of a record [s].")
@click.option("--rate", type=ABOVE_ZERO, default=250.0, show_default=True, help="Sampling rate [Hz].")
@click.option("--seed", type=int, default=0, show_default=True, help="Of everything that is drawn.")
@click.option("--force", is_flag=True, help="Overwrite a case that is there already.")
def synth(
    folder: Path, nodes: int, modes: int, events: int, seconds: float, rate: float, seed: int, force: bool
) -> None:
    """Write a synthetic case of any size, with a realistic spread of stress levels, to try or time the program on.

    \b
    Example:
      fatigue synth big --nodes 100000 --modes 100 --events 12
    """
    what, remedy = "is there already", "Give another folder, or --force to overwrite it"
    refuse_existing(folder / "case.toml", force=force, what=what, remedy=remedy)
    from fatigue.synth import Size, synthesize

    with narrated(quiet=is_quiet()):
        stage("writing %d nodes, %d modes and %d events", nodes, modes, events)
        case_file = synthesize(folder, Size(nodes, modes, events, seconds, rate), seed)
    say(case_file)


@cli.command(short_help="Print the JSON Schema of case.toml, for editors.")
def schema() -> None:
    """Print the JSON Schema of case.toml, for editors that complete and check it.

    \b
    Example:
      fatigue schema > case.schema.json
    """
    from fatigue.case import case_schema

    print_json(case_schema())


@cli.command(short_help="What the code of a warning or an error means.")
@click.argument("code", required=False)
@as_json
def explain(code: str | None, as_json: bool) -> None:
    """Tell what CODE of a warning or an error means, why it matters, what to do, and where it arises.

    Codes stand in the report, in `provenance.json` and in the output of --json. Without CODE all are listed.

    \b
    Examples:
      fatigue explain no_interface_mode
      fatigue explain
    """
    from fatigue.explain import all_codes, explanation, near

    pages = all_codes()
    if code is None:
        if as_json:
            print_json([page.as_record() for page in pages.values()])
            return
        kinds = dict.fromkeys(page.kind for page in pages.values())
        for kind in kinds:
            its = [page for page in pages.values() if page.kind == kind]
            say(f"{kind} ({len(its)})")
            for page in its:
                said = page.says or next((place.what or place.remedy for place in page.places), "")
                say(f"  {page.code:<28} {said}"[:118])
        return
    try:
        page = explanation(code)
    except KeyError:
        alike = near(code)
        hint = f"; near it: {', '.join(alike)}" if alike else "; `fatigue explain` lists all codes"
        raise click.UsageError(f"no warning or error has the code {code!r}{hint}") from None
    if as_json:
        print_json(page.as_record())
    else:
        say(page.as_text())
