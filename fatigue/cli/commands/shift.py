"""The command for life against the frequency or damping of a mode."""

import logging
from pathlib import Path

import click

from fatigue.cli.arguments import CASE, FOLDER, as_json, no_lock
from fatigue.cli.early import refuse_missing_result
from fatigue.cli.known_values import known_values
from fatigue.cli.main import cli
from fatigue.cli.numbers import DAMPED, numbers_of
from fatigue.cli.output import print_json, say
from fatigue.cli.progress import narrated

log = logging.getLogger(__name__)

LARGEST = "largest"


@cli.command(short_help="Life against the frequency or damping of a mode.")
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option(
    "--mode",
    default=LARGEST,
    show_default=True,
    metavar="ID|largest",
    help="Mode to move, by default the one with the largest share of the damage, after `fatigue diagnose`.",
)
@click.option("--to", "to_hz", metavar="A:B:STEP|HZ,...", help="Frequencies to move it to [Hz], ends included.")
@click.option("--to-damping", metavar="A:B:STEP|Z,...", help="Damping ratios to move it to.")
@click.option(
    "--damping", type=DAMPED, help="Damping ratio it was simulated with, if the modes have none.  [default: 0.015]"
)
@click.option("--event", "events", multiple=True, help="Move it in this event only; may be given several times.")
@click.option("--case", "case_file", type=CASE, help="Case file, if it is not where the result says.")
@click.option("--threads", type=click.IntRange(min=1), help="Worker threads; default: one per processor core.")
@no_lock
@as_json
@click.pass_obj
def shift(
    options: dict[str, bool],
    folder: Path,
    mode: str,
    to_hz: str | None,
    to_damping: str | None,
    damping: float | None,
    events: tuple[str, ...],
    case_file: Path | None,
    threads: int | None,
    no_lock: bool,
    as_json: bool,
) -> None:
    """Move the frequency or damping of a mode and say what becomes of the lives: a screening without feedback.

    Its coordinate is filtered with H(f', z') / H(f, z) at constant modal mass, all cycles are counted again, and the
    table shift is written into DIR. The modal force stays as it was simulated.

    \b
    Examples:
      fatigue shift result --mode 7 --to 12:15:0.5
      fatigue shift result --mode 7 --to-damping 0.01,0.02,0.03 --event "worn 350" --json
    """
    wanted = None if mode == LARGEST else _mode(mode)
    frequencies, dampings = numbers_of(to_hz, "--to"), numbers_of(to_damping, "--to-damping")
    if not frequencies and not dampings:
        raise click.UsageError("Say where the mode moves: --to 12:15:0.5, --to-damping 0.01,0.02, or both.")
    if any(value >= 1.0 for value in dampings):
        raise click.BadParameter(f"{to_damping!r} has damping ratios of 1 and more.", param_hint="--to-damping")
    refuse_missing_result(folder, case_file, no_lock=no_lock)
    from fatigue.documents import write_documents
    from fatigue.results import PAGE, is_derived, read_provenance
    from fatigue.results.outputs import damage_told
    from fatigue.shift.story import shift as run

    with narrated(quiet=options["quiet"]) as progress, damage_told(folder):
        found = run(
            folder,
            mode=wanted,
            to_hz=frequencies,
            to_damping=dampings,
            damping=damping,
            events=events,
            case_file=case_file,
            threads=threads,
            no_lock=no_lock,
            progress=progress,
        )
        if is_derived(folder, PAGE, read_provenance(folder)):
            write_documents(folder, [PAGE], case_file=case_file, verification=known_values, force=True, no_lock=no_lock)
        elif (folder / PAGE).exists():
            log.warning("%s was not written by fatigue, or was changed since: it stays as it is", folder / PAGE)
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())


def _mode(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise click.BadParameter(f"{text!r} is no mode id and not 'largest'.", param_hint="--mode") from None
