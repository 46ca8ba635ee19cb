"""Commands to use before a conversion: the weld lines of a mesh, and the sign of a solver's forces."""

from pathlib import Path

import click

from fatigue.cli.arguments import as_json
from fatigue.cli.early import missing_foreign, missing_tables, refuse_all, refuse_existing, refuse_unknown_units
from fatigue.cli.main import cli
from fatigue.cli.options import FILE, asking_for
from fatigue.cli.output import print_json, say
from fatigue.cli.progress import is_quiet, narrated
from fatigue.readers.convert.options import WeldSources
from fatigue.shown import visible
from fatigue.stages import stage


@cli.command(short_help="Find the weld lines of a mesh; write the register to edit.")
@click.argument("mesh", metavar="MODEL", type=FILE)
@click.option("--units", default="mm-t-s", show_default=True, help="Unit system of the model: mm-t-s, m-kg-s ...")
@click.option("-o", "--output", type=FILE, help="Register (CSV) to write, to be edited and given back with --register.")
@click.option(
    "--write-lines",
    type=FILE,
    help="Table of the lines as points in space (CSV) to write, for another mesh: --lines; -o has their names then.",
)
@click.option("--vtp", type=FILE, help="Picture of the lines for ParaView.")
@click.option("--only", default="", help="List only lines whose name contains this text.")
@click.option("--force", is_flag=True, help="Overwrite existing files.")
@asking_for(WeldSources, "sources")
@as_json
def welds(
    mesh: Path,
    units: str,
    output: Path | None,
    write_lines: Path | None,
    vtp: Path | None,
    only: str,
    force: bool,
    sources: WeldSources,
    as_json: bool,
) -> None:
    """Find the weld lines of a mesh; list them, write the register to edit, and a picture of them.

    \b
    Examples:
      fatigue welds model.bdf -o welds_register.csv --vtp lines.vtp
      fatigue welds model.bdf --register welds_register.csv --write-lines lines.csv -o by_lines.csv
      fatigue welds finer.bdf --lines lines.csv --register by_lines.csv -o finer_register.csv
    """
    refuse_all(missing_foreign(mesh))
    refuse_all(missing_tables(sources.register, sources.node_lists, sources.lines))
    refuse_unknown_units(units=units)
    if output != sources.register:
        remedy = "Give it as the register too, or use --force"
        refuse_existing(output, force=force, what="the file exists", remedy=remedy)
    refuse_existing(write_lines, force=force, what="is there already", remedy="Use --force to overwrite it")
    refuse_existing(vtp, force=force, what="is there already", remedy="Use --force to overwrite it")
    from dataclasses import asdict

    from fatigue.errors import DataError, Problem
    from fatigue.readers.convert.weld_lines import list_welds

    with narrated(quiet=is_quiet()):
        stage("finding weld lines")
        found = list_welds(mesh, sources, units, output, force, write_lines)
    rows = [row for row in found.rows if only in row.weld]
    if not rows:
        what = f"none of the {len(found.rows)} weld lines has '{only}' in its name"
        raise DataError(Problem("no_welds", str(mesh), what, f"Give a part of a name, such as {found.rows[0].weld}"))
    if vtp is not None:
        from fatigue.report.files.vtp import write_line_picture

        write_line_picture(vtp, [found.cuts[row.line].line for row in rows if row.line in found.cuts], overwrite=force)
    for problem in found.warnings:
        say(f"note: {problem}", err=True)
    if as_json:
        of_the_file = ("number", "others")
        print_json([{k: v for k, v in asdict(row).items() if k not in of_the_file} for row in rows])
        return
    for row in rows:
        reason = f"  {row.reason}" if row.reason else ""
        say(f"{row.status:9} {row.kind:8} {row.nodes:5} nodes {row.length:9.1f} mm  {visible(row.weld + reason)}")


@cli.command("tension-patch", short_help="Find the sign of the forces of a solver.")
@click.argument("file", metavar="FILE", type=FILE)
@click.option("--results", is_flag=True, help="FILE holds the grid point forces of the patch: tell their sign.")
@click.option("--force", is_flag=True, help="Overwrite an existing deck.")
def tension_patch(file: Path, results: bool, force: bool) -> None:
    """Find the sign of a solver's forces: write a one-element tension patch to FILE, run it, and give its results.

    \b
    Examples:
      fatigue tension-patch patch.bdf
      fatigue tension-patch patch.op2 --results
    """
    if results:
        refuse_all(missing_foreign(file))
    else:
        refuse_existing(file, force=force, what="is there already", remedy="Use --force to overwrite it")
    from fatigue.readers.convert.audit.tension_patch import DECK, convention_of
    from fatigue.readers.foreign.read import read_forces

    if results:
        say(f'force_convention = "{convention_of(read_forces(file, None))}"')
        return
    from fatigue.files.whole import replacing

    with replacing(file) as unfinished:
        unfinished.write_text(DECK, encoding="ascii")
    say(f"{file}: run it in your solver, then fatigue tension-patch RESULTS --results")
