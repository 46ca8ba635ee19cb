"""The command that takes a result folder and lists the load spectra of its points."""

from pathlib import Path

import click

from fatigue.cli.again import write_again
from fatigue.cli.arguments import CASE, FOLDER, as_json, no_lock
from fatigue.cli.early import missing_tables, refuse_all, refuse_missing_result
from fatigue.cli.main import cli
from fatigue.cli.numbers import ABOVE_ZERO
from fatigue.cli.output import print_json, say
from fatigue.cli.progress import narrated

FILE = click.Path(path_type=Path)
WORST = "worst"


@cli.command(short_help="Load spectra of points and of the loads themselves.")
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option(
    "--points",
    default=WORST,
    show_default=True,
    metavar="worst|FILE",
    help="The worst point of every weld, or a table with weld, order, surface (and part); at most 2000 points.",
)
@click.option("--classes", type=click.IntRange(1, 256), default=64, show_default=True, help="Classes of equal width.")
@click.option("--edges", type=FILE, help="Table of edges instead: range_MPa, level_MPa, or one of them.")
@click.option(
    "--exponents", default=None, metavar="M,M,...", help="Of equivalent ranges; default: the curve's first slope."
)
@click.option("--compare", type=FILE, help="Table of range_MPa and count to stand beside the mission.")
@click.option("--compare-km", type=ABOVE_ZERO, help="Distance that the counts of --compare are for [km].")
@click.option("--case", "case_file", type=CASE, help="Case file, if it is not where the result says.")
@click.option("--threads", type=click.IntRange(min=1), help="Worker threads; default: one per processor core.")
@no_lock
@as_json
@click.pass_obj
def spectra(
    options: dict[str, bool],
    folder: Path,
    points: str,
    classes: int,
    edges: Path | None,
    exponents: str | None,
    compare: Path | None,
    compare_km: float | None,
    case_file: Path | None,
    threads: int | None,
    no_lock: bool,
    as_json: bool,
) -> None:
    """List load spectra: cycles by range, mean, reversals and level, equivalent ranges, and those of the coordinates.

    Writes spectrum, range_mean, from_to, level_crossings, equivalent and signals tables into DIR and shows them in its
    report. Cycles are recounted from the input files; counts are per km of the mission.

    \b
    Examples:
      fatigue spectra result
      fatigue spectra result --points points.csv --exponents 3,5 --compare measured.csv --compare-km 1250
    """
    given = None if exponents is None else _numbers(exponents, "--exponents")
    if (compare is None) != (compare_km is None):
        raise click.UsageError("--compare and --compare-km belong together: counts are for a distance.")
    listed = None if points == WORST else Path(points)
    refuse_missing_result(folder, case_file, no_lock=no_lock)
    refuse_all(missing_tables(listed, edges, compare))
    from fatigue.results import LOAD_SPECTRA
    from fatigue.results.outputs import damage_told
    from fatigue.spectra import spectra as run

    with narrated(quiet=options["quiet"]) as progress, damage_told(folder):
        found = run(
            folder,
            points=listed,
            classes=classes,
            edges=edges,
            exponents=given,
            compare=compare,
            compare_km=compare_km,
            case_file=case_file,
            threads=threads,
            no_lock=no_lock,
            progress=progress,
        )
        write_again(folder, LOAD_SPECTRA, case_file=case_file, no_lock=no_lock)
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())


def _numbers(text: str, option: str) -> tuple[float, ...]:
    try:
        values = tuple(float(number) for number in text.split(","))
    except ValueError:
        values = ()
    if not values or not all(0.0 < value < float("inf") for value in values):
        raise click.BadParameter(f"{text!r} is not a list of numbers above 0 such as 3,5", param_hint=option)
    return values
