"""What newer work adds to the medium job: unit loads, sequences, shear paths, histograms, each beside the job without.

The medium job has 8200 stations, both faces, 60 modes and 40 000 steps, 6.6e8 stress samples. Its case is written here,
so that anybody can measure: in one event, and for sequences in two of half the length.
"""

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from benchmarks.shear import CURVE, MEDIUM, with_shear
from benchmarks.timing import Row
from benchmarks.train import run_measured
from fatigue.synth import Size, synthesize

ROUNDS = 3
HALVES = Size(MEDIUM.nodes, MEDIUM.modes, 2, MEDIUM.seconds / 2, MEDIUM.rate)
PLAIN = ("--histogram", "none")
OFF = '[multiaxial]\nmethod = "off"\n'
REPORT = '[multiaxial]\nmethod = "report"\n'
COUNTING = "[counting]\nupsample = 1\n"
LOADS = """
[[body.unit_load]]
name = "pressure"
unit = "kPa"
nodal_forces = "unit_loads.parquet"
[[body.unit_load]]
name = "gravity"
unit = "g"
nodal_forces = "unit_loads.parquet"
[[mission.unit_load]]
name = "gravity"
unit = "g"
constant = 1.0
"""
OF_EVENT = """
[[mission.event.unit_load]]
name = "pressure"
unit = "kPa"
history = "pressure.parquet"
"""
SEQUENCE = """
[[mission.sequence]]
order = ["event 1", "event 2"]
per_1000_km = 1.5
"""


@dataclass(frozen=True, slots=True)
class Job:
    """A case to assess: which synthetic body, what stands before the curve and behind the mission, and the options."""

    events: int
    before: str = OFF
    behind: str = ""
    of_event: str = ""
    options: tuple[str, ...] = PLAIN


JOBS = {
    "one event": Job(1),
    "two events": Job(2),
    "histograms": Job(1, options=("--histogram", "worst")),
    "histograms of all points": Job(1, options=("--histogram", "all")),
    "unit loads": Job(1, behind=LOADS, of_event=OF_EVENT),
    "shear paths": Job(1, before=REPORT),
    "sequences": Job(2, behind=SEQUENCE),
    "all": Job(2, REPORT, LOADS + SEQUENCE, OF_EVENT, ("--histogram", "worst")),
}
WITHOUT = {1: "one event", 2: "two events"}


def shares() -> list[Row]:
    """Processor time over that of the same job without, best of some rounds by turns, and what is added."""
    with tempfile.TemporaryDirectory() as folder:
        cases = {name: written(Path(folder), name, job) for name, job in JOBS.items()}
        best, peak = dict.fromkeys(JOBS, float("inf")), dict.fromkeys(JOBS, 0.0)
        for number in range(ROUNDS + 1):  # the first compiles, or loads what was compiled
            for name, job in JOBS.items():
                options = (*job.options, "--threads", "1", "--force")
                cpu, memory = run_measured(cases[name], Path(folder) / f"result {name}", *options)
                if number > 0:
                    best[name], peak[name] = min(best[name], cpu), max(peak[name], memory)
    return told(best, peak)


def told(best: Mapping[str, float], peak: Mapping[str, float]) -> list[Row]:
    """Rows of the table, from times [s] and peaks [MB] by job."""
    rows = [(f"medium job, {name}", f"{best[name]:.1f} s, peak {peak[name]:.0f} MB") for name in WITHOUT.values()]
    for name, job in JOBS.items():
        if name in WITHOUT.values():
            continue
        without = WITHOUT[job.events]
        ratio, more = best[name] / best[without], peak[name] - peak[without]
        added = f"{ratio:.2f} ({best[name] - best[without]:+.1f} s, {more:+.0f} MB)"
        rows.append((f"medium job with {name} / without", added))
    return rows


def written(folder: Path, name: str, job: Job, sizes: Mapping[int, Size] | None = None) -> Path:
    """Case of a job; its body is written once for all jobs of as many events."""
    size = (sizes or {1: MEDIUM, 2: HALVES})[job.events]
    body = folder / f"{job.events}"
    if not body.is_dir():
        synthesize(body, size)
        with_shear(body / "nodal_forces.parquet")
        write_loads(body, size)
    text = (body / "case.toml").read_text()
    text = text.replace(CURVE, COUNTING + job.before + CURVE, 1)
    if job.of_event:
        head, *events = text.split("[[mission.event]]")
        text = "[[mission.event]]".join([head, *(event.rstrip("\n") + "\n" + job.of_event for event in events)])
    case = body / f"{name}.toml"
    case.write_text(text + job.behind)
    return case


def write_loads(body: Path, size: Size, seed: int = 2) -> None:
    """Forces of two unit loads, as those of two modes are, and the history of one, at the instants of the events."""
    table = pq.read_table(body / "nodal_forces.parquet")
    parts = []
    for mode, name in ((1, "pressure"), (2, "gravity")):
        some = table.filter(pc.equal(table["mode"], mode))
        place = some.column_names.index("mode")
        parts.append(some.set_column(place, "unit_load", [pa.array([name] * len(some))]))
    pq.write_table(pa.concat_tables(parts), body / "unit_loads.parquet")
    samples = round(size.seconds * size.rate)
    time = np.asarray(pq.read_table(body / "q_1.parquet")["time_s"])[:samples]
    walk = np.cumsum(np.random.default_rng(seed).normal(size=samples))
    pq.write_table(pa.table({"time_s": time, "u_pressure": 0.01 * walk}), body / "pressure.parquet")
