"""Loops in machine code: what they give does not depend on who has compiled them, or on how many threads."""

import os
import subprocess
import sys
import time

import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from fatigue.compiled import last_written, remove_stale  # the module loads the BLAS of compiled code

SCRIPT = """
import hashlib, sys
from pathlib import Path
import fatigue.pipeline.mission.precision
from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.synth import Size, synthesize

folder = Path(sys.argv[1])
case = load_case(synthesize(folder / "case", Size(nodes=240, modes=12, events=2, seconds=8.0, rate=500.0), seed=3))
for kernel, samples in (("single", 0.0), ("double", 1e12)):
    fatigue.pipeline.mission.precision.SINGLE_FROM = samples
    assess(case, folder / kernel, share=0.1, threads=1, report=False)
    for table in ("nodes", "damage", "cycles", "histogram", "structural_stress", "welds"):
        print(kernel, table, hashlib.sha256((folder / kernel / f"{table}.parquet").read_bytes()).hexdigest())
"""

SUMS = """
import hashlib
import numpy as np
from fatigue.life.bounds.forms import FormPair, part_forms
from fatigue.life.bounds.screening import _of_modal_stresses
from fatigue.life.bounds.weld_sums import combined, room_for_histories, sums_in_time
from fatigue.life.counting.block import BlockStress
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.single.count import count_single
from fatigue.life.counting.single.kernels.power import add_up
from fatigue.life.counting.single.prepare import single_record
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.rule import CycleRule
from fatigue.weld.edge_type import _dots

rng = np.random.default_rng(7)
n, m, t = 50, 13, 2011
q, (S_m, S_b) = rng.normal(size=(m, t)), rng.normal(size=(2, n, m))
record = CountedRecord(q, "repeat", single_record(q))
rule = CycleRule(damage_law(catalogue()["master-steel"], "mean-2sigma", "none", 1e7), uses_bending_ratio=True)
count = count_single(BlockStress(S_m, S_b, np.ones(n), np.zeros((n, 2))), record, rule)
welds = combined([rng.normal(size=(h, m)) for h in (3, 5)], [rng.normal(size=(30, h)) for h in (3, 5)])
dots = np.empty((3, n))
_dots(S_m, np.roll(np.arange(n), 1), np.roll(np.arange(n), -1), dots)
sums = {
    "count": [count.damage, count.power_sum],
    "weld sums": sums_in_time(welds, record.single.q, t, room_for_histories(8), recurs=True),
    "forms": [part_forms(S_m, S_b, FormPair(rng.normal(size=(m, m)), rng.random((m, 2)), np.ones(m), np.ones(2)))],
    "sizes": [_of_modal_stresses(S_m, S_b, rng.random((4, m)))],
    "dots": [dots],
}
for precision in (np.float32, np.float64):
    power, damage = rng.lognormal(size=(2, 1024)).astype(precision)
    sums[f"add_up {precision.__name__}"] = [np.array(add_up(power, damage, k)) for k in range(1000)]
for name, found in sums.items():
    print(name, hashlib.sha256(b"".join(np.asarray(a).tobytes() for a in found)).hexdigest())
"""


@pytest.mark.parametrize(("script", "lines"), [(SCRIPT, 12), (SUMS, 7)], ids=["tables", "sums"])
@pytest.mark.slow
def test_the_process_that_compiles_writes_the_same_bytes_as_those_after_it(tmp_path, script, lines):
    """Tables of both counters, with bounds; sums one by one; the second process reads compiled code from disk."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "machine-code")}
    first, second = (
        subprocess.run(
            [sys.executable, "-c", script, str(tmp_path / name)],
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for name in ("first", "second")
    )
    assert len(first.splitlines()) == lines
    assert first == second


def test_limits_of_threads_reach_the_blas_of_compiled_code():
    """It is loaded before anybody sets a limit."""
    with threadpool_limits(limits=1, user_api="blas"):
        pools = [library for library in threadpool_info() if library["user_api"] == "blas"]  # scipy has one for files
    libraries = {library["filepath"]: library["num_threads"] for library in pools}
    assert any("scipy" in path for path in libraries)
    assert set(libraries.values()) == {1}


@pytest.fixture
def room(tmp_path):
    """A room of two source files, an hour old, with machine code of half an hour ago."""
    (tmp_path / "inner" / "__pycache__").mkdir(parents=True)
    names = ("rule.py", "inner/loops.py", "inner/__pycache__/loops.add-3.py311.nbi")
    for name, age in zip(names, (3600, 3600, 1800), strict=True):
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (time.time() - age,) * 2)
    return tmp_path


@pytest.mark.parametrize(
    ("changed", "age_s", "stays"),
    [
        (None, 0, True),
        ("rule.py", 60, False),  # called by the loops: numba alone would not notice
        ("inner/loops.py", 60, False),
        ("rule.py", -600, True),  # a clock that is wrong must not cost a compilation at every start
    ],
)
def test_machine_code_older_than_a_source_file_is_removed(room, changed, age_s, stays):
    """Also where the file that has changed is another one than that of the loop."""
    if changed:
        os.utime(room / changed, (time.time() - age_s,) * 2)
    remove_stale(room / "inner" / "__pycache__", last_written([room]))
    assert (room / "inner" / "__pycache__" / "loops.add-3.py311.nbi").exists() == stays


@pytest.mark.slow
def test_a_changed_formula_is_compiled_anew(tmp_path):
    """Two files, the loop in one and what it calls in the other: machine code on disk follows the other one, too."""
    (tmp_path / "called.py").write_text("def factor(x):\n    return 2.0 * x\n")
    (tmp_path / "loop.py").write_text(
        "from pathlib import Path\n"
        "from fatigue.compiled import compiled, last_written, remove_stale\n"
        "here = Path(__file__).parent\n"
        "remove_stale(here / '__pycache__', last_written([here]))\n"
        "from called import factor\n"
        "factor = compiled()(factor)\n"
        "@compiled()\ndef run(x):\n    return factor(x)\n"
        "print(run(1.0))\n"
    )
    environment = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    found = []
    for text in (None, None, "def factor(x):\n    return 3.0 * x\n"):
        if text:
            time.sleep(0.05)
            (tmp_path / "called.py").write_text(text)
        command = [sys.executable, "-B", str(tmp_path / "loop.py")]
        found.append(
            subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.strip()
        )
    assert found == ["2.0", "2.0", "3.0"]
