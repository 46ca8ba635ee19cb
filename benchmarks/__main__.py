"""Measure everything and print one table: ``python -m benchmarks [part ...]``; beside others: ``ledger``."""

import platform
import sys
from importlib.metadata import version

import numba
import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks import peers, pipeline, processes
from benchmarks.decisions import what_if, what_if_command
from benchmarks.finite_elements import finite_elements
from benchmarks.ledger.command import main as ledger
from benchmarks.panel import large_mesh
from benchmarks.shares import shares
from benchmarks.shear import shear

PARTS = {
    "pipeline": pipeline.against_the_product,
    "processors": processes.processors,
    "growth": pipeline.growth,
    "threads": pipeline.threads,
    "counting": peers.counting,
    "dirlik": peers.dirlik,
    "start-up": processes.start_up,
    "first-run": processes.first_run,
    "memory": processes.memory,
    "shear": shear,
    "shares": shares,
    "finite-elements": finite_elements,
    "large-mesh": large_mesh,
    "what-if": what_if,
    "what-if-command": what_if_command,
}


def main() -> None:
    """Run the parts that are named, or all of them; or the ledger."""
    if sys.argv[1:2] == ["ledger"]:
        ledger(sys.argv[2:])
        return
    unknown = set(sys.argv[1:]) - set(PARTS)
    if unknown:
        raise SystemExit(f"unknown part {', '.join(sorted(unknown))}; there are {', '.join(PARTS)}")
    print(f"Python {platform.python_version()}, numpy {np.__version__}, numba {numba.__version__}, ", end="")
    print(f"scipy {version('scipy')}; {platform.machine()}, {platform.processor() or platform.system()}\n")
    print("| what | measured |\n|---|---|")
    with threadpool_limits(1, user_api="blas"):  # as the program does: threads are outside of BLAS
        for name in sys.argv[1:] or PARTS:
            for what, value in PARTS[name]():
                print(f"| {what} | {value} |", flush=True)


if __name__ == "__main__":
    main()
