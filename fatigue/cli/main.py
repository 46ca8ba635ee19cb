"""The group of all commands, what they log, and the exit code of every known failure."""

import logging
import sys
import traceback
from typing import Any

import click

from fatigue import __version__
from fatigue.cli.ends import end_orderly, leave
from fatigue.cli.memory import hold_little, refuse_little_address_space
from fatigue.cli.mishaps import mishap
from fatigue.cli.streams import OUTPUT, prepare_streams, silence
from fatigue.errors import FatigueError
from fatigue.shown import VisibleFormatter, visible
from fatigue.stages import STAGES

EXIT_CODES = """
\b
Exit codes: 0 done; 1 done, but a target is missed; 2 wrong usage;
3 bad case or data; 4 numerical failure or no memory; 130 interrupted.
"""
SECTIONS = {
    "Begin": ("example", "schema", "request", "convert", "welds", "tension-patch", "reduce", "synth"),
    "Assess": ("check", "assess", "show", "report", "verify"),
    "Understand": ("explain", "diagnose", "point", "history", "spectra", "ride", "basis", "shift"),
    "Decide": ("compare", "whatif", "backsolve", "fleet", "bench"),
    "Measure and study": ("channels", "gauges", "study"),
}
GOES_ON, AGAIN = "the same command goes on from here", "give the same command again"


class _Interrupted(Exception):
    """An interrupted command; click would turn the interrupt itself into a line of its own."""

    def __init__(self, cause: KeyboardInterrupt, command: str | None) -> None:
        super().__init__(GOES_ON if command in ("assess", "study") else AGAIN)
        self.cause = cause


class Commands(click.Group):
    """The group of all commands, listed by what they are for; it is interrupted in the words of the program."""

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands section by section, their helps in one column."""
        width = max(map(len, self.commands))
        for title, names in SECTIONS.items():
            with formatter.section(title):
                formatter.write_dl(
                    [(name.ljust(width), self.commands[name].get_short_help_str(formatter.width)) for name in names]
                )

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command that is asked for."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:  # the reader of an encoding that click replaced: its exit code would be 1
            silence(sys.stdout)
        except KeyboardInterrupt as interrupt:
            raise _Interrupted(interrupt, ctx.invoked_subcommand) from interrupt


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]}, epilog=EXIT_CODES)
@click.version_option(__version__, prog_name="fatigue")
@click.option("-q", "--quiet", is_flag=True, help="No progress and no log on stderr; errors only.")
@click.option("-v", "--verbose", is_flag=True, help="Log what is done on stderr, and tracebacks of errors.")
def cli(quiet: bool, verbose: bool) -> None:
    """Weld fatigue life, in km, of a flexible body from a multibody simulation.

    \b
    Examples:
      fatigue example demo                       write the shipped car body to ./demo
      fatigue check demo/case.toml               read and check everything, assess nothing
      fatigue assess demo/case.toml -o result    life of every point of every weld
      fatigue show result --top 20               the worst points
    """
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(VisibleFormatter("%(levelname)s %(message)s"))
    handler.setLevel(logging.ERROR if quiet else logging.INFO if verbose else logging.WARNING)
    handler.addFilter(lambda record: record.name != STAGES)  # told by ``narrated``
    log = logging.getLogger("fatigue")
    log.handlers[:] = [handler]
    log.setLevel(logging.INFO)
    context = click.get_current_context()
    context.obj = {"quiet": quiet, "verbose": verbose}
    refuse_little_address_space(context.invoked_subcommand)


def main() -> None:
    """Run the command line; every known failure is one clear line and its exit code."""
    verbose = bool({"-v", "--verbose"} & set(sys.argv[1:]))
    hold_little()
    prepare_streams()
    end_orderly()
    try:
        cli.main(standalone_mode=False)
    except FatigueError as error:
        _traced(verbose and error.__cause__ is not None)
        for problem in error.problems:
            click.echo(f"error: {problem}", err=True)
        sys.exit(error.exit_code)
    except click.ClickException as error:
        error.show()
        sys.exit(error.exit_code)
    except _Interrupted as error:
        click.echo(f"interrupted: {error}", err=True)
        leave(error.cause)
    except (KeyboardInterrupt, click.exceptions.Abort):
        click.echo(f"interrupted: {AGAIN}", err=True)
        leave(KeyboardInterrupt())
    except Exception as error:
        _traced(verbose)
        refused, code = mishap(error)
        what = f"this should not have happened ({type(error).__name__}: {error}). Run again with -v and report it"
        click.echo(f"error: {visible(str(refused or what))}", err=True)
        if isinstance(error, OSError) and error.filename == OUTPUT:
            silence(sys.stdout)
        sys.exit(code)


def _traced(asked: bool) -> None:
    if asked:
        click.echo(traceback.format_exc(), err=True, nl=False)
