"""Loops in machine code: what they give does not depend on who has compiled them, or on how many threads."""

import os
import subprocess
import sys

from threadpoolctl import threadpool_info, threadpool_limits

import fatigue.compiled  # noqa: F401 - loads the BLAS of compiled code

SCRIPT = """
import hashlib, sys
from pathlib import Path
import fatigue.pipeline.mission.events
from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.synth import Size, synthesize

folder = Path(sys.argv[1])
case = load_case(synthesize(folder / "case", Size(nodes=240, modes=12, events=2, seconds=8.0, rate=500.0), seed=3))
for kernel, samples in (("single", 0.0), ("double", 1e12)):
    fatigue.pipeline.mission.events.DOUBLE_PRECISION_SAMPLES = samples
    assess(case, folder / kernel, share=0.1, threads=1, report=False)
    for table in ("nodes", "damage", "cycles", "structural_stress", "welds"):
        print(kernel, table, hashlib.sha256((folder / kernel / f"{table}.parquet").read_bytes()).hexdigest())
"""


def test_the_process_that_compiles_writes_the_same_bytes_as_those_after_it(tmp_path):
    """Counting in single and in double precision, with bounds; the second process reads compiled code from disk."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "machine-code")}
    first, second = (
        subprocess.run(
            [sys.executable, "-c", SCRIPT, str(tmp_path / name)],
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for name in ("first", "second")
    )
    assert len(first.splitlines()) == 10
    assert first == second


def test_limits_of_threads_reach_the_blas_of_compiled_code():
    """It is loaded before anybody sets a limit."""
    with threadpool_limits(limits=1, user_api="blas"):
        libraries = {library["filepath"]: library["num_threads"] for library in threadpool_info()}
    assert any("scipy" in path for path in libraries)
    assert set(libraries.values()) == {1}
