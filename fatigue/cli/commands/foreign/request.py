"""The command that writes what a solver has to be asked for the forces: a macro, a script, cards."""

from pathlib import Path

import click

from fatigue.cli.early import refuse_existing
from fatigue.cli.main import cli
from fatigue.cli.output import say


@cli.command(short_help="Write the macro, script or cards that ask a solver for forces.")
@click.argument("solver", type=click.Choice(["abaqus", "ansys", "nastran"], case_sensitive=False))
@click.option(
    "-o", "--output", metavar="FILE", type=click.Path(path_type=Path), help="File to write.  [default: print it]"
)
@click.option("--force", is_flag=True, help="Overwrite an existing FILE.")
def request(solver: str, output: Path | None, force: bool) -> None:
    """Write what asks SOLVER for element nodal forces: an APDL macro, a script for Abaqus Python, NASTRAN cards.

    Its first lines say how it is used.

    \b
    Examples:
      fatigue request ansys -o ansys_export.mac
      fatigue request nastran
    """
    from fatigue.example import request_text, write_request

    if output is None:
        say(request_text(solver))
        return
    refuse_existing(output, force=force, what="is there already", remedy="Use --force to overwrite it")
    write_request(solver, output)
    say(output)
