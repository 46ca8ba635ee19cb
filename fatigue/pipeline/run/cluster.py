"""The workers of a dask.distributed cluster as an executor, for ``fatigue assess --scheduler``."""

import re
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from fatigue.errors import DataError, NumericalError, Problem
from fatigue.extras import install_command

TIMEOUT_S = 10  # until a scheduler that does not answer is given up
RETRIES = 3  # of a group of welds whose worker was lost


@contextmanager
def cluster_executor(address: str) -> Iterator[Executor]:
    """Connect to the scheduler of a running cluster and give its workers as an executor.

    All workers have to see the input files under the same path. The work of a worker that is lost goes to the others.

    Raises
    ------
    DataError : dask.distributed is not installed, or there is no scheduler at that address, or it has no workers
    NumericalError : workers were lost again and again while the executor was in use
    """
    try:
        from distributed import Client  # noqa: PLC0415 (an extra)
        from distributed.comm.core import CommClosedError  # noqa: PLC0415
        from distributed.scheduler import KilledWorker  # noqa: PLC0415
    except ImportError as error:
        raise DataError(
            Problem(
                "extra",
                "--scheduler",
                "the package distributed is not installed",
                f"Run: {install_command('distributed')}",
            )
        ) from error
    if not re.fullmatch(r"[a-z]+://\S+:\d+", address):
        raise DataError(
            Problem("scheduler", address, "is not the address of a scheduler", "Give one such as tcp://host:8786")
        )
    try:
        client = Client(address, timeout=TIMEOUT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise DataError(
            Problem(
                "scheduler",
                address,
                f"no scheduler answers ({error or type(error).__name__})",
                "Start one with `dask scheduler`, workers with `dask worker ADDRESS`, and give the address it prints",
            )
        ) from error
    with client:
        if not client.scheduler_info()["workers"]:
            raise DataError(
                Problem("scheduler", address, "the cluster has no workers", "Start some with `dask worker ADDRESS`")
            )
        try:
            with client.get_executor(retries=RETRIES) as executor:
                yield executor
        except (KilledWorker, CommClosedError) as error:
            raise NumericalError(
                Problem(
                    "workers_lost",
                    address,
                    f"the cluster lost its workers again and again ({type(error).__name__})",
                    "See their logs, often for want of memory; the same command goes on from here",
                )
            ) from error
