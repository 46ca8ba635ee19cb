"""Commands that bring FE and simulation files into the neutral format."""

from pathlib import Path
from typing import Any

import click

from fatigue.cli.arguments import as_json
from fatigue.cli.early import (
    missing_foreign,
    missing_tables,
    refuse_all,
    refuse_bad_modes,
    refuse_existing,
    refuse_foreign_conversion,
    refuse_unknown_curve,
    refuse_unknown_units,
)
from fatigue.cli.main import cli
from fatigue.cli.numbers import ABOVE_ZERO
from fatigue.cli.output import print_json
from fatigue.cli.progress import is_quiet, narrated, narrating
from fatigue.stages import stage

_FILE = click.Path(path_type=Path)
_COLOUR = {"red": "red", "amber": "yellow", "green": "green"}

_sources = [
    click.option("--register", type=_FILE, help="Edited weld register; its status, names and thicknesses win."),
    click.option("--node-lists", type=_FILE, help="CSV weld,order,node with weld lines of your own."),
    click.option(
        "--set", "sets", type=int, multiple=True, help="Id of a node set whose mesh edges are welds; repeatable."
    ),
    click.option(
        "--marker", "markers", multiple=True, help="Card that lies on welds: PLOTEL, CBAR, CBEAM; repeatable."
    ),
    click.option(
        "--detect/--no-detect", default=None, help="Search the mesh for weld lines; default: if nothing is marked."
    ),
    click.option("--candidates", is_flag=True, help="Assess flat changes of property and folds as well."),
]


def weld_sources(command: Any) -> Any:
    """Add the options that say where weld lines come from."""
    for option in reversed(_sources):
        command = option(command)
    return command


@cli.command()
@click.option("--forces", type=_FILE, required=True, help="Grid point forces: OP2, MSC .h5, or punch.")
@click.option("--mesh", type=_FILE, required=True, help="Geometry: BDF, or the same MSC .h5.")
@click.option(
    "--unit-loads",
    type=_FILE,
    multiple=True,
    help="Forces of static unit loads in a file of their own: interface modes; repeatable.",
)
@click.option(
    "--coordinates", type=_FILE, multiple=True, help="Modal coordinates: CSV, text or .mcf; one file per event."
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    required=True,
    metavar="DIR",
    help="Folder to write.",
)
@click.option(
    "--convention",
    type=click.Choice(["on_element", "on_node"]),
    help="Sign of the forces; default: as the audit proves it.",
)
@click.option("--subcase", type=int, help="Subcase, where the force file has several.")
@click.option("--units", default="mm-t-s", show_default=True, help="Unit system of the FE files: mm-t-s, m-kg-s ...")
@click.option("--coordinate-units", default="mm-t-s", show_default=True, help="Unit system of the coordinates.")
@click.option(
    "--normalisation",
    type=click.Choice(["mass", "length"]),
    default="mass",
    show_default=True,
    help="Modes of unit generalised mass or unit displacement.",
)
@click.option(
    "--match",
    type=click.Choice(["id", "frequency", "order"]),
    default="id",
    show_default=True,
    help="How columns of coordinates find their modes.",
)
@click.option("--columns", type=_FILE, help="CSV column,mode: which column belongs to which mode.")
@click.option("--time-column", help="Name of the time column, or its position from 1.")
@click.option(
    "--resample", type=ABOVE_ZERO, metavar="STEP_S", help="Interpolate records with uneven steps onto this step [s]."
)
@click.option("--simulation-modes", type=_FILE, help="CSV mode,frequency_hz,modal_mass of the simulation's modes.")
@click.option(
    "--interface-modes",
    default="",
    help="Residual, constraint or attachment modes, and static subcases that are such, as 31-52.",
)
@click.option("--ignore-modes", default="", help="Modes to leave out on either side, as 1-6.")
@click.option(
    "--displacement",
    "displacements",
    type=(_FILE, int, click.Choice(["x", "y", "z"])),
    multiple=True,
    metavar="FILE NODE x|y|z",
    help="Elastic displacement of an FE node in the simulation (CSV time_s,displacement_mm): compared with the sum of "
    "mode shapes times coordinates; repeatable.",
)
@click.option(
    "--accept", multiple=True, metavar="CHECK", help="Go on although this check of the audit is red; repeatable."
)
@click.option("--curve", default="master-aluminium", show_default=True, help="S-N curve of the first case.toml.")
@click.option("--title", default="", help="Title of the first case.toml.")
@click.option("--speed", type=ABOVE_ZERO, default=100.0, show_default=True, help="Speed of the first case.toml [km/h].")
@click.option(
    "--target-km", type=ABOVE_ZERO, default=1.0e6, show_default=True, help="Target of the first case.toml [km]."
)
@click.option("--force", is_flag=True, help="Overwrite foreign and changed files in DIR.")
@click.option("--keep-case", is_flag=True, help="Keep the case.toml in DIR as it is, edited or not.")
@weld_sources
@as_json
def convert(
    forces: Path,
    mesh: Path,
    unit_loads: tuple[Path, ...],
    coordinates: tuple[Path, ...],
    output: Path,
    convention: Any,
    subcase: int | None,
    units: str,
    coordinate_units: str,
    normalisation: Any,
    match: Any,
    columns: Path | None,
    time_column: str | None,
    resample: float | None,
    simulation_modes: Path | None,
    interface_modes: str,
    ignore_modes: str,
    displacements: tuple[tuple[Path, int, Any], ...],
    accept: tuple[str, ...],
    curve: str,
    title: str,
    speed: float,
    target_km: float,
    force: bool,
    keep_case: bool,
    register: Path | None,
    node_lists: Path | None,
    sets: tuple[int, ...],
    markers: tuple[str, ...],
    detect: bool | None,
    candidates: bool,
    as_json: bool,
) -> None:
    """Turn FE results and simulation exports into a neutral folder with a first case.toml.

    The audit of signs, balance and completeness is printed; a red light stops the conversion. Formats are recognised by
    content.

    \b
    Example:
      fatigue convert --mesh model.bdf --forces run.op2 --coordinates q.csv -o body
      fatigue assess body/case.toml -o result
    """
    refuse_all(missing_foreign(forces, mesh, *unit_loads, *coordinates))
    tables = (register, node_lists, columns, simulation_modes, *(file for file, _, _ in displacements))
    refuse_all(missing_tables(*tables))
    refuse_unknown_units(force_units=units, coordinate_units=coordinate_units)
    for option, modes in (("--interface-modes", interface_modes), ("--ignore-modes", ignore_modes)):
        refuse_bad_modes(option, modes)
    refuse_unknown_curve(curve)
    refuse_foreign_conversion(output, force=force, keep_case=keep_case)
    from fatigue.readers.convert.case_text import register_named
    from fatigue.readers.convert.convert import convert as read_and_write
    from fatigue.readers.convert.displacement.record import Displacement
    from fatigue.readers.convert.modal_basis import mode_list
    from fatigue.readers.convert.options import ConvertOptions
    from fatigue.readers.convert.weld_lines import WeldSources
    from fatigue.readers.neutral.register.weld_register import reasons

    run = narrating(read_and_write)
    done = run(
        ConvertOptions(
            forces=forces,
            mesh=mesh,
            out=output,
            unit_loads=unit_loads,
            coordinates=coordinates,
            convention=convention,
            subcase=subcase,
            force_units=units,
            coordinate_units=coordinate_units,
            normalisation=normalisation,
            interface_modes=mode_list(interface_modes) if interface_modes else (),
            ignore_modes=mode_list(ignore_modes) if ignore_modes else (),
            match=match,
            columns=columns,
            time_column=time_column,
            resample_s=resample,
            simulation_modes=simulation_modes,
            welds=WeldSources(node_lists, sets, markers, detect, candidates, register),
            displacements=tuple(Displacement(*given) for given in displacements),
            accept=accept,
            curve=curve,
            title=title,
            speed_km_h=speed,
            target_km=target_km,
            force=force,
            keep_case=keep_case,
        )
    )
    assessed = [row for row in done.welds if row.status == "assess"]
    if as_json:
        print_json(
            {
                "folder": str(done.folder),
                "files": done.files,
                "modes": done.modes,
                "audit": [
                    {"check": r.check, "light": r.light, "value": r.value, "finding": r.finding, "remedy": r.remedy}
                    for r in done.audit.rows
                ],
                "welds_assessed": len(assessed),
                "welds_listed": len(done.welds),
                "not_assessed": [{"lines": number, "reason": reason} for number, reason in reasons(done.welds)],
                "remarks": [str(problem) for problem in done.remarks],
            }
        )
        return
    for row in done.audit.rows:
        light = click.style(f"{row.light:5}", fg=_COLOUR[row.light])
        value = "" if row.value is None else f" {row.value:.3g}"
        remedy = f" {row.remedy}." if row.remedy and row.light != "green" else ""
        click.echo(f"{light}  {row.check}:{value} {row.finding}.{remedy}")
    for problem in done.remarks:
        click.echo(f"note   {problem}")
    click.echo(
        f"{done.modes} modes, {done.force_rows} force rows, {len(assessed)} of {len(done.welds)} weld lines assessed"
    )
    for number, reason in reasons(done.welds):
        click.echo(f"{number} weld line{'s' * (number > 1)} not assessed: {reason}")
    edit = register_named(done.folder / "case.toml")
    click.echo(f"written to {done.folder}: edit case.toml and {edit}, then `fatigue assess` the case")


@cli.command()
@click.argument("mesh", metavar="MODEL", type=_FILE)
@click.option("--units", default="mm-t-s", show_default=True, help="Unit system of the model: mm-t-s, m-kg-s ...")
@click.option(
    "-o", "--output", type=_FILE, help="Register (CSV) to write, to be edited and given back with --register."
)
@click.option("--vtp", type=_FILE, help="Picture of the lines for ParaView.")
@click.option("--only", default="", help="List only lines whose name contains this text.")
@click.option("--force", is_flag=True, help="Overwrite existing files.")
@weld_sources
@as_json
def welds(
    mesh: Path,
    units: str,
    output: Path | None,
    vtp: Path | None,
    only: str,
    force: bool,
    register: Path | None,
    node_lists: Path | None,
    sets: tuple[int, ...],
    markers: tuple[str, ...],
    detect: bool | None,
    candidates: bool,
    as_json: bool,
) -> None:
    """Find the weld lines of a mesh; list them, write the register to edit, and a picture of them.

    \b
    Example:
      fatigue welds model.bdf -o welds_register.csv --vtp lines.vtp
    """
    refuse_all(missing_foreign(mesh))
    refuse_all(missing_tables(register, node_lists))
    refuse_unknown_units(units=units)
    if output != register:
        remedy = "Give it as the register too, or use --force"
        refuse_existing(output, force=force, what="the file exists", remedy=remedy)
    refuse_existing(vtp, force=force, what="is there already", remedy="Use --force to overwrite it")
    from dataclasses import asdict

    from fatigue.errors import DataError, Problem
    from fatigue.readers.convert.weld_lines import WeldSources, list_welds
    from fatigue.report.files.vtp import write_line_picture

    sources = WeldSources(node_lists, sets, markers, detect, candidates, register)
    with narrated(quiet=is_quiet()):
        stage("finding weld lines")
        found = list_welds(mesh, sources, units, output, force)
    rows = [row for row in found.rows if only in row.weld]
    if not rows:
        what = f"none of the {len(found.rows)} weld lines has '{only}' in its name"
        raise DataError(Problem("no_welds", str(mesh), what, f"Give a part of a name, such as {found.rows[0].weld}"))
    if vtp is not None:
        write_line_picture(vtp, [found.cuts[row.line].line for row in rows if row.line in found.cuts], overwrite=force)
    for problem in found.remarks:
        click.echo(f"note: {problem}", err=True)
    if as_json:
        of_the_file = ("number", "others")
        print_json([{k: v for k, v in asdict(row).items() if k not in of_the_file} for row in rows])
        return
    for row in rows:
        reason = f"  {row.reason}" if row.reason else ""
        click.echo(f"{row.status:9} {row.kind:8} {row.nodes:5} nodes {row.length:9.1f} mm  {row.weld}{reason}")


@cli.command("tension-patch")
@click.argument("file", metavar="FILE", type=_FILE)
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
        click.echo(f'force_convention = "{convention_of(read_forces(file, None))}"')
        return
    file.write_text(DECK, encoding="ascii")
    click.echo(f"{file}: run it in your solver, then fatigue tension-patch RESULTS --results")
