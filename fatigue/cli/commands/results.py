"""Commands that take a result folder: show it, write its documents again, say what makes its damage."""

import logging
from pathlib import Path

import click

from fatigue.cli.arguments import CASE, FOLDER, as_json, no_lock
from fatigue.cli.early import refuse_missing_result
from fatigue.cli.known_values import known_values
from fatigue.cli.main import cli
from fatigue.cli.numbers import ABOVE_ZERO, DAMPING, FROM_ZERO
from fatigue.cli.output import print_json, print_warnings, say
from fatigue.cli.progress import narrated
from fatigue.errors import DataError, refuse

log = logging.getLogger(__name__)


@cli.command(short_help="Print the welds and the worst points of a result.")
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option("--top", type=click.IntRange(min=1), default=10, show_default=True, help="How many points to show.")
@click.option("--weld", "welds", multiple=True, help="Only this weld; may be given several times.")
@as_json
def show(folder: Path, top: int, welds: tuple[str, ...], as_json: bool) -> None:
    """Print the welds and the worst points of a result folder.

    \b
    Examples:
      fatigue show result --top 20
      fatigue show result --weld W1_roof_bracket_neg --json
    """
    refuse_missing_result(folder)
    from fatigue.files.naming import composed
    from fatigue.results.outputs import damage_told
    from fatigue.results.summary import result_summary

    with damage_told(folder):
        found = result_summary(folder, top=top, only=[composed(weld) for weld in welds])
        answer = found.as_record() if as_json else found.as_text()  # what is wrong with a table may be met only here
    if isinstance(answer, str):
        say(answer)
    else:
        print_json(answer)


@cli.command(short_help="Write the report again; PDF, workbook and CSV as well.")
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option("--pdf", is_flag=True, help="Print report.pdf as well, with an installed Chromium, Chrome or Edge.")
@click.option("--xlsx", is_flag=True, help="Write nodes.xlsx as well (package `xlsxwriter`).")
@click.option("--body", is_flag=True, help="Write body.vtp as well, the shells of the case for ParaView.")
@click.option("--csv", is_flag=True, help="Write the tables as CSV as well.")
@click.option("--bom", is_flag=True, help="Begin the CSV files with a byte order mark, by which Excel tells UTF-8.")
@click.option("--case", "case_file", type=CASE, help="Case file, if it is not where the result says.")
@click.option("--force", is_flag=True, help="Overwrite PDF, workbook, body and CSV files that are there already.")
@no_lock
@click.pass_obj
def report(
    options: dict[str, bool],
    folder: Path,
    pdf: bool,
    xlsx: bool,
    body: bool,
    csv: bool,
    bom: bool,
    case_file: Path | None,
    force: bool,
    no_lock: bool,
) -> None:
    """Write report.html and weld_lines.vtp of a result folder again, with what a diagnosis has added.

    Without the case of the result the page lacks mesh, histories and spectra, and says so.

    \b
    Examples:
      fatigue report result --pdf --xlsx
      fatigue report result --csv --bom
      fatigue report result --case body/case.toml
    """
    if bom and not csv:
        raise click.UsageError("--bom is about CSV files: give --csv as well.")
    refuse_missing_result(folder, case_file, no_lock=no_lock)
    from fatigue.documents import AGAIN, CSV, write_documents
    from fatigue.results import BODY, PRINT, WORKBOOK
    from fatigue.results.outputs import damage_told

    wanted = [*AGAIN, *[WORKBOOK] * xlsx, *[BODY] * body, *CSV * csv, *[PRINT] * pdf]
    with narrated(quiet=options["quiet"]), damage_told(folder):
        done = write_documents(
            folder, wanted, case_file=case_file, verification=known_values, force=force, no_lock=no_lock, bom=bom
        )
    for path in done.written:
        say(path)
    refuse(DataError, done.problems)


@cli.command(short_help="What makes the damage: event, mode, band, place; and levers.")
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option("--case", "case_file", type=CASE, help="Case file, if it is not where the result says.")
@click.option(
    "--share-of-limit",
    type=FROM_ZERO,
    default=0.1,
    show_default=True,
    help="Utilisation from which points are shared out, when not all can be.",
)
@click.option(
    "--edges", default=None, metavar="HZ,HZ,...", help="Edges between frequency bands [Hz]; default: third octaves."
)
@click.option("--bin-km", type=ABOVE_ZERO, default=0.1, show_default=True, help="Length of a piece of track [km].")
@click.option(
    "--damping",
    type=DAMPING,
    metavar="RATIO",
    help="Damping ratio of modes whose table has none, for instance 0.015; without it no half-power band is known.",
)
@no_lock
@as_json
@click.pass_obj
def diagnose(
    options: dict[str, bool],
    folder: Path,
    case_file: Path | None,
    share_of_limit: float,
    edges: str | None,
    bin_km: float,
    damping: float | None,
    no_lock: bool,
    as_json: bool,
) -> None:
    """Say what makes the damage of a result: event, mode, frequency band, piece of track; and what would help.

    Says as well which modes swing, which follow their loads, and which resonance to watch where. Writes attribution,
    track, diagnosis, levers, resonance, weld_resonance and watch tables into DIR and shows them in its report. Of a
    large result: worst points of welds and points above --share-of-limit, of very many those with the shortest lives.

    \b
    Examples:
      fatigue diagnose result
      fatigue diagnose result --damping 0.015
    """
    edges_hz = None if edges is None else _hertz(edges, "--edges")
    refuse_missing_result(folder, case_file, no_lock=no_lock)
    from fatigue.diagnose import diagnose as run
    from fatigue.documents import write_documents
    from fatigue.results import PAGE, is_derived, read_provenance
    from fatigue.results.outputs import damage_told

    with narrated(quiet=options["quiet"]) as progress, damage_told(folder):
        found = run(
            folder,
            case_file=case_file,
            share_of_limit=share_of_limit,
            edges_hz=edges_hz,
            bin_km=bin_km,
            damping=damping,
            no_lock=no_lock,
            progress=progress,
        )
        if is_derived(folder, PAGE, read_provenance(folder)):
            write_documents(folder, [PAGE], case_file=case_file, verification=known_values, no_lock=no_lock)
        elif (folder / PAGE).exists():
            log.warning("%s was not written by fatigue, or was changed since: it stays as it is", folder / PAGE)
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())


@cli.command(short_help="Block programme for a test bench with the same damage.")
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option(
    "--points",
    required=True,
    metavar="FILE",
    help="Points to reproduce (.csv or .parquet): weld, order or node, surface, and factor on the target; or worst: "
    "the worst point of every weld.",
)
@click.option(
    "--blocks",
    type=click.Path(path_type=Path),
    required=True,
    metavar="FILE",
    help="Blocks of the bench, one a row: the range of each unit load in a column u_NAME, opposite signs in "
    "counter-phase, and a name in the column block.",
)
@no_lock
@as_json
@click.pass_obj
def bench(options: dict[str, bool], folder: Path, points: str, blocks: Path, no_lock: bool, as_json: bool) -> None:
    """Find how many cycles of which blocks do the damage of a result on a test bench.

    Prints two programmes, one closest to all targets and one that reaches every target, and writes them into DIR as
    bench_blocks, bench_points and bench_damage tables; `fatigue report DIR --csv` writes these as CSV as well.

    \b
    Example:
      fatigue bench result --points gauges.csv --blocks blocks.csv
    """
    refuse_missing_result(folder, no_lock=no_lock)
    from fatigue.bench import bench as run
    from fatigue.results.outputs import damage_told

    with narrated(quiet=options["quiet"]), damage_told(folder):
        found = run(folder, points, blocks, no_lock=no_lock)
    print_warnings(found.warnings)
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())


def _hertz(text: str, option: str) -> tuple[float, ...]:
    try:
        return tuple(float(number) for number in text.split(","))
    except ValueError:
        raise click.BadParameter(f"{text!r} is not a list of numbers such as 5,10,20", param_hint=option) from None
