"""The command for what the channels of a ride say."""

from pathlib import Path

import click

from fatigue.cli.again import write_again
from fatigue.cli.arguments import CASE, FOLDER, as_json, no_lock
from fatigue.cli.early import refuse_missing_result
from fatigue.cli.main import cli
from fatigue.cli.output import print_json, say
from fatigue.cli.progress import narrated


@cli.command(short_help="What channels beside the modes say: hunting, alarm, comfort.")
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option("--case", "case_file", type=CASE, help="Case file, if it is not where the result says.")
@click.option("--threads", type=click.IntRange(min=1), help="Worker threads; default: one per processor core.")
@no_lock
@as_json
@click.pass_obj
def ride(
    options: dict[str, bool], folder: Path, case_file: Path | None, threads: int | None, no_lock: bool, as_json: bool
) -> None:
    """Say what channels beside the modes tell: hunting, what it meets, the alarm, comfort, equipment.

    Channels are [[mission.event.channel]] tables of the case, which may be given after the assessment, and [ride] has
    the rules. Writes flutter, coincidence, alarm, hot_damage, comfort, equipment and running tables into DIR and shows
    them in its report. Damage inside and outside hot stretches is that of the worst point of every weld.

    \b
    Examples:
      fatigue ride result
      fatigue ride result --case case_ride.toml --json
    """
    refuse_missing_result(folder, case_file, no_lock=no_lock)
    from fatigue.results import RIDDEN
    from fatigue.results.outputs import damage_told
    from fatigue.ride.story import ride as run

    with narrated(quiet=options["quiet"]) as progress, damage_told(folder):
        found = run(folder, case_file=case_file, threads=threads, no_lock=no_lock, progress=progress)
        write_again(folder, RIDDEN, case_file=case_file, no_lock=no_lock)
    if as_json:
        print_json(found.as_record())
    else:
        say(found.as_text())
