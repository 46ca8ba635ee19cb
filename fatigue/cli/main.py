"""The group of all commands, what they log, and the exit code of every known failure."""

import errno
import logging
import sys
from pathlib import Path

import click

from fatigue import __version__
from fatigue.cli.memory import hold_little
from fatigue.errors import FatigueError, Problem
from fatigue.shown import VisibleFormatter, visible
from fatigue.stages import STAGES

EXIT_CODES = """
\b
Exit codes: 0 done; 1 done, but a weld misses its target; 2 wrong usage;
3 bad case or data; 4 numerical failure; 130 interrupted.
"""


@click.group(context_settings={"help_option_names": ["-h", "--help"]}, epilog=EXIT_CODES)
@click.version_option(__version__, prog_name="fatigue")
@click.option("-q", "--quiet", is_flag=True, help="No progress and no log on stderr; errors only.")
@click.option("-v", "--verbose", is_flag=True, help="Log what is done on stderr, and tracebacks of program errors.")
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
    click.get_current_context().obj = {"quiet": quiet, "verbose": verbose}


def _of_the_system(error: OSError) -> Problem:
    """What the operating system refused: a folder that is not there, a name too long, a full disk."""
    place = str(error.filename or "a file")
    reason = error.strerror or str(error)
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return Problem("system", place, f"cannot be written ({reason})", "Make room, and give the same command again")
    if error.errno == errno.ENOENT and error.filename and not Path(place).parent.is_dir():
        return Problem("system", place, f"there is no folder {Path(place).parent}", "Make it, or correct the path")
    remedy = "Correct the path, or give one that you may read and write"
    return Problem("system", place, f"cannot be read or written ({reason})", remedy)


def main() -> None:
    """Run the command line; every known failure is one clear line and its exit code."""
    verbose = bool({"-v", "--verbose"} & set(sys.argv[1:]))
    hold_little()
    try:
        cli.main(standalone_mode=False)
    except FatigueError as error:
        for problem in error.problems:
            click.echo(f"error: {problem}", err=True)
        sys.exit(error.exit_code)
    except click.ClickException as error:
        error.show()
        sys.exit(error.exit_code)
    except (KeyboardInterrupt, click.exceptions.Abort):
        click.echo("interrupted: the same command goes on from here", err=True)
        sys.exit(130)
    except BrokenPipeError:  # the reader of our output went away, as ``| head`` does
        sys.stderr.close()
        sys.exit(0)
    except OSError as error:
        if verbose:
            raise
        click.echo(f"error: {_of_the_system(error)}", err=True)
        sys.exit(3)
    except MemoryError:
        click.echo("error: out of memory: close other programs, or assess fewer welds at once", err=True)
        sys.exit(4)
    except Exception as error:
        if verbose:
            raise
        what = visible(f"{type(error).__name__}: {error}")
        click.echo(f"error: this should not have happened ({what}). Run again with -v and report it", err=True)
        sys.exit(4)
