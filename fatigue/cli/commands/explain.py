"""The command that tells what the code of a warning or an error means."""

import click

from fatigue.cli.arguments import as_json
from fatigue.cli.main import cli
from fatigue.cli.output import print_json, say


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
