"""The command that turns FE results and simulation exports into a folder of neutral files."""

from typing import TYPE_CHECKING, Any

import click

from fatigue.cli.arguments import as_json
from fatigue.cli.early import (
    missing_foreign,
    missing_tables,
    refuse_all,
    refuse_foreign_conversion,
    refuse_unknown_curve,
    refuse_unknown_units,
)
from fatigue.cli.main import cli
from fatigue.cli.options import asking_for
from fatigue.cli.output import print_json, say
from fatigue.cli.progress import narrating
from fatigue.errors import Problem
from fatigue.readers.convert.options import ConvertOptions
from fatigue.shown import visible

if TYPE_CHECKING:
    from fatigue.readers.convert.convert import Conversion
    from fatigue.readers.convert.loads.names import UnitLoad

_COLOUR = {"red": "red", "amber": "yellow", "green": "green"}


@cli.command(short_help="Turn FE results and simulation exports into a first case.")
@asking_for(ConvertOptions, "options")
@as_json
def convert(options: ConvertOptions, as_json: bool) -> None:
    """Turn FE results and simulation exports into a neutral folder with a first case.toml.

    The audit of signs, balance and completeness is printed; a red light stops the conversion. Formats are recognised by
    content.

    \b
    Example:
      fatigue convert --mesh model.bdf --forces run.op2 --coordinates q.csv -o body
      fatigue assess body/case.toml -o result
    """
    _refuse_mistakes(options)
    from fatigue.readers.convert.convert import convert as read_and_write

    done = narrating(read_and_write)(options)
    if as_json:
        print_json(_record(done))
    else:
        _print(done)


def _refuse_mistakes(options: ConvertOptions) -> None:
    """Refuse what can be told before anything is read."""
    welds = options.welds
    foreign = (options.forces, options.mesh, *options.unit_loads, *options.stresses, *options.coordinates)
    refuse_all(missing_foreign(*foreign))
    displacements = (asked.file for asked in options.displacements)
    tables = (welds.register, welds.node_lists, welds.lines, options.columns, options.simulation_modes, *displacements)
    refuse_all(missing_tables(*tables, options.stress_points))
    if options.stresses and options.stress_points is None:
        what = "shell stresses are given, and no points where they are wanted"
        refuse_all([Problem("no_stress_points", "--stresses", what, "Give --stress-points, the table of the points")])
    refuse_unknown_units(force_units=options.force_units, coordinate_units=options.coordinate_units)
    refuse_unknown_curve(options.curve)
    refuse_foreign_conversion(options.out, force=options.force, keep_case=options.keep_case)


def _record(done: "Conversion") -> dict[str, Any]:
    """Tell a conversion to machines."""
    from fatigue.readers.convert.record import load_record
    from fatigue.readers.neutral.register.weld_register import reasons

    return {
        "folder": str(done.folder),
        "files": done.files,
        "modes": done.modes,
        "read_outs": done.read_outs,
        "unit_loads": [load_record(load) for load in done.unit_loads],
        "audit": [
            {"check": r.check, "light": r.light, "value": r.value, "finding": r.finding, "remedy": r.remedy}
            for r in done.audit.rows
        ],
        "welds_assessed": done.assessed,
        "welds_listed": len(done.welds),
        "not_assessed": [{"lines": number, "reason": reason} for number, reason in reasons(done.welds)],
        "remarks": [str(problem) for problem in done.warnings],
    }


def _told(load: "UnitLoad") -> str:
    """Tell a unit load, and what one of it is."""
    subcase = f"the load of subcase {load.case.subcase} of {load.case.source}"
    if not load.is_unit_known:
        return f"{load.name} is {subcase}, as it was run"
    return f"{load.name}: {load.amount:g} {load.unit} is {subcase}"


def _print(done: "Conversion") -> None:
    """Tell a conversion: a line for every check, what is doubtful, the sizes, and where to go on."""
    from fatigue.readers.convert.case_text import register_named
    from fatigue.readers.neutral.register.weld_register import reasons

    for row in done.audit.rows:
        light = click.style(f"{row.light:5}", fg=_COLOUR[row.light])
        value = "" if row.value is None else f" {row.value:.3g}"
        remedy = f" {row.remedy}." if row.remedy and row.light != "green" else ""
        click.echo(light + visible(f"  {row.check}:{value} {row.finding}.{remedy}"))
    for problem in done.warnings:
        say(f"note   {problem}")
    for load in done.unit_loads:
        say(f"unit load {_told(load)}")
    say(f"{done.modes} modes, {done.force_rows} force rows, {done.assessed} of {len(done.welds)} weld lines assessed")
    if done.read_outs:
        say(f"stresses at {done.read_outs} read-outs of stress points")
    for number, reason in reasons(done.welds):
        say(f"{number} weld line{'s' * (number > 1)} not assessed: {visible(reason)}")
    edit = register_named(done.folder / "case.toml")
    say(f"written to {done.folder}: edit case.toml and {edit}, then `fatigue assess` the case")
