"""The command for reducing a finite element body to a modal basis."""

from pathlib import Path

import click

from fatigue.cli.arguments import FOLDER, as_json, strict
from fatigue.cli.early import missing_tables, refuse_all, refuse_unknown_units
from fatigue.cli.main import cli
from fatigue.cli.numbers import ABOVE_ZERO
from fatigue.cli.output import print_json, print_warnings, say
from fatigue.cli.progress import narrated

FILE = click.Path(path_type=Path)


@cli.command(short_help="Reduce a finite element body to modes and weld forces.")
@click.argument("model", metavar="MODEL", type=FILE)
@click.option(
    "--interface",
    type=FILE,
    metavar="FILE",
    required=True,
    help="Table of points: name, node, side, components, pattern.",
)
@click.option(
    "--basis",
    type=click.Choice(["residual", "strong", "weak", "guyan", "kuhar"]),
    default="residual",
    show_default=True,
    help="residual: normal and residual attachment modes; strong, weak: Craig-Bampton, all or external points.",
)
@click.option("-o", "--output", type=FOLDER, metavar="DIR", required=True, help="Folder to write, made if not there.")
@click.option(
    "--cut-hz",
    type=ABOVE_ZERO,
    default=60.0,
    show_default=True,
    help="Upper end of normal or fixed-interface modes [Hz].",
)
@click.option("--keep-hz", type=ABOVE_ZERO, help="Leave out columns above this frequency [Hz]; default: keep all.")
@click.option("--kuhar-hz", type=ABOVE_ZERO, help="Frequency that the basis kuhar is exact at [Hz].")
@click.option("--properties", type=FILE, metavar="FILE", help="Properties in place of those of MODEL, for a variant.")
@click.option("--welds", type=FOLDER, metavar="DIR", help="Folder of the tables of welds, if they are not in MODEL.")
@click.option("--units", default="mm-t-s", show_default=True, help="Units of K and M: mm-t-s, m-kg-s, in-lbf-s.")
@click.option(
    "--damping",
    type=click.Choice(["rule", "none"]),
    default="rule",
    show_default=True,
    help="rule: 1.5 % below 100 Hz, 10 % up to 1000 Hz, 100 % above; none: no damping in modes.csv.",
)
@click.option("--force", is_flag=True, help="Overwrite files in DIR that fatigue reduce did not write, or were edited.")
@strict
@as_json
@click.pass_obj
def reduce(
    options: dict[str, bool],
    model: Path,
    interface: Path,
    basis: str,
    output: Path,
    cut_hz: float,
    keep_hz: float | None,
    kuhar_hz: float | None,
    properties: Path | None,
    welds: Path | None,
    units: str,
    damping: str,
    force: bool,
    strict: bool,
    as_json: bool,
) -> None:
    """Reduce a finite element body to modes and weld forces: a folder for a simulation and for `fatigue assess`.

    MODEL is a folder with nodes, elements, properties of shells, and welds, weld_nodes, weld_elements; or with K, M and
    dof of any body, which has no weld forces. The points of --interface are where forces enter (external, internal) or
    motion is read (observed).

    \b
    Examples:
      fatigue reduce demo --interface demo/interface.csv -o body
      fatigue reduce demo --interface demo/interface.csv --basis weak --cut-hz 80 -o weak
    """
    refuse_all(missing_tables(interface, properties))
    refuse_unknown_units(units=units)
    from fatigue.reduce.bases import Recipe
    from fatigue.reduce.story import reduce as run

    with narrated(quiet=options["quiet"]):
        done = run(
            model,
            interface,
            output,
            Recipe(basis, cut_hz, keep_hz, kuhar_hz),  # type: ignore[arg-type]
            properties=properties,
            welds=welds,
            units=units,
            damping=damping == "rule",
            force=force,
            strict=strict,
        )
    print_warnings(done.warnings, "--json lists them")
    if as_json:
        print_json({**done.as_record(), "folder": str(done.folder), "files": done.files})
    else:
        say(done.as_text())
