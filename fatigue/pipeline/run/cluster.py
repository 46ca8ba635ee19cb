"""The workers of a dask.distributed cluster as an executor, for ``fatigue assess --scheduler``.

Scheduler and workers of dask run any code that is sent to them, with the rights of who started them. Over ``tcp`` they
take it from whoever reaches their ports; over ``tls`` from those who hold a certificate of the same authority. This
process, in turn, unpacks what comes back with ``pickle``, so it trusts the cluster as the cluster trusts it.
"""

import ipaddress
import logging
import re
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from fatigue.errors import DataError, NumericalError, Problem
from fatigue.files.extras import install_command

log = logging.getLogger(__name__)

TIMEOUT_S = 10  # until a scheduler that does not answer is given up
RETRIES = 3  # of a group of welds whose worker was lost


@contextmanager
def cluster_executor(address: str) -> Iterator[Executor]:
    """Connect to the scheduler of a running cluster and give its workers as an executor.

    All workers have to see the input files under the same path. The work of a worker that is lost goes to the others.
    Certificates for an address that begins with ``tls`` are those of dask's own configuration. A scheduler that can be
    reached from other computers without them is warned of.

    Raises
    ------
    DataError : dask.distributed is not installed, or there is no scheduler at that address, or it has no workers
    NumericalError : workers were lost again and again while the executor was in use
    """
    try:
        from distributed import Client, Security  # noqa: PLC0415 (an extra)
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
    if address.startswith("tls") and Security().get_connection_args("client").get("ssl_context") is None:
        what = "no certificates are known, which an address of this kind asks for"
        remedy = "Name them in the configuration of dask (distributed.comm.tls), see docs/large-models.md"
        raise DataError(Problem("scheduler", address, what, remedy))
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
        if is_open(address) or is_open(str(client.scheduler_info().get("address", ""))):
            log.warning("%s", _open_warning(address))
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


def is_open(address: str) -> bool:
    """Whether what listens at an address takes code of other computers without asking for a certificate."""
    protocol, _, place = address.partition("://")
    host = place.rpartition(":")[0].strip("[]").partition("%")[0]
    if protocol not in ("tcp", "ws", "ucx", "ucxx") or host == "localhost":
        return False
    try:
        return not ipaddress.ip_address(host).is_loopback
    except ValueError:  # the name of a computer
        return True


def _open_warning(address: str) -> Problem:
    return Problem(
        "open_cluster",
        address,
        "the scheduler takes code from whoever reaches its port, without encryption, and runs it as who started it",
        "Use tls:// with certificates, or start scheduler and workers with --host 127.0.0.1, see docs/large-models.md",
    )
