"""Memory, scratch files and time that follow from the size of a job alone, before anything is prepared.

Memory is what the program holds all the time, and the largest of what it holds in turn: while records are prepared,
while groups of welds are counted and written, while the page is made. The sizes of its blocks are constants of the
program, which are used here; the rest of the constants is measured by ``python -m benchmarks.estimate``.
"""

from dataclasses import dataclass

import numpy as np

from fatigue.life.records.history import LONG_NUMBERS, LONGEST_TRANSFORM
from fatigue.pipeline.count.result import OF_EVENT
from fatigue.pipeline.forecast.shear import path_memory, shear_seconds
from fatigue.pipeline.forecast.size import SCREENED, JobSize
from fatigue.pipeline.forecast.throats import throat_seconds
from fatigue.pipeline.mission.event_load import held_copies
from fatigue.pipeline.mission.events import HELD_BYTES
from fatigue.pipeline.solve.weld_groups import BLOCK

MB = 1e6
IMPORTS = 235.0 * MB  # a process that has assessed next to nothing
PAGE_IMPORTS = 45.0 * MB
DETAIL = 1.5 * MB  # of the page: a weld shown in detail
MOST_DETAILED = 40
STATION_ON_PAGE = 600.0
CYCLE_ON_PAGE = 250.0  # of one weld, read as a table
MOST_CYCLES = 1_000_000  # of all welds that are read so
READ_BLOCK = 40.0 * MB  # of a record, columns or rows of which are read
TRANSFORM = 56.0  # bytes for each sample of a record that is transformed in memory
PAIR_BINS = 480  # of a spectrum of segments twice as long: 8 s up to 60 Hz
STRESS = 160.0  # bytes for each station and mode: five components, as solved and as treated, and what they come from
FORCES = 150.0  # bytes for each station and mode of a block of welds that is read and solved
ROWS_OF_STRESS = 64.0 * MB  # recovered at a time by each thread that counts in double precision
WAITING_ROWS = 200.0  # bytes
MOST_WAITING = 70.0 * MB
CYCLES_LISTED = 100.0  # bytes for each sample of a record whose cycles are listed in memory
LONGEST_LISTED = 1_000_000  # samples of such a record
ROW = {  # bytes of a row of a result
    "nodes": 250.0,
    "damage": 180.0,
    "structural_stress": 90.0,
    "cycle": 60.0,
    "histogram": 9.0,
}
DIAGNOSED, DIAGNOSED_MODE = 130.0, 26.0  # bytes for each sample of a record in memory: alone, for each mode
DIAGNOSED_LONG = 200.0 * MB  # of any record on disk
BINS = 250  # of a histogram with cycles, of both kinds, for each event
BINNED = 30.0 * MB  # by each thread, with the rows of its points
CYCLES_PER_SAMPLE = 1 / 6  # of a record that is sampled twelve times a cycle

# Processor time [s] on a core of 2 to 3 GHz
FIRST = 2.5
PER_STRESS_SAMPLE = {False: (9e-9, 0.4e-9), True: (1.3e-9, 0.03e-9)}  # single precision or not: alone, for each mode
PREPARED = 150e-9  # each sample and mode of a record
PREPARED_LONG = 0.8e-6  # the same, where it is transformed in scratch files
LISTED = 0.5e-6  # each sample of a record whose cycles are listed, at each weld
SECOND_ON_PAGE = 0.19  # each weld


@dataclass(frozen=True, slots=True)
class JobNeeds:
    """What a job takes: memory at its peak, scratch files and result [bytes], processor time [s], and what most of it.

    ``memory_remedy`` and ``disk_remedy`` say what to do where that is too much.
    """

    memory: float
    scratch: float
    result: float
    seconds: float
    memory_remedy: str
    disk_remedy: str

    def as_text(self) -> str:
        """Memory and disk in words."""
        return f"{size_text(self.memory)} of memory, {size_text(self.scratch + self.result)} of disk"


def job_needs(size: JobSize) -> JobNeeds:
    """What a job of a size takes."""
    held, copies = held_records(size), copies_in_memory(size)
    in_turn = max(preparing(size), counting(size), page(size) if size.report else 0.0)
    scratch, result = scratch_files(size), result_tables(size)
    fine = max(size.factors) > 1
    return JobNeeds(
        memory=IMPORTS + held + copies + in_turn,
        scratch=scratch,
        result=result,
        seconds=_seconds(size),
        memory_remedy=f"Set fewer --threads than {size.threads}, or use a machine with more"
        if size.threads > 1
        else "Use a machine with more memory",
        disk_remedy=f"Free some space or give another folder{', or upsample less' if fine else ''}",
    )


def diagnosis_memory(size: JobSize) -> float:
    """Memory of a diagnosis [bytes]: one record, its transform, and the damage of a point laid on its samples."""
    return IMPORTS + max(_diagnosed(size.modes, n) for n in size.counted)


def _diagnosed(modes: int, samples: int) -> float:
    """Memory for the diagnosis of one record; a long one stays on disk."""
    if modes * samples > LONG_NUMBERS or (samples > LONGEST_TRANSFORM and 4 * modes * samples > HELD_BYTES):
        return DIAGNOSED_LONG
    return (DIAGNOSED + DIAGNOSED_MODE * modes) * samples


def held_records(size: JobSize) -> float:
    """Records that are held in memory: the shortest ones, up to a limit for all of them."""
    of_events = [size.modes * n * (8 * f if f > 1 else 4) for n, f in zip(size.samples, size.factors, strict=True)]
    sizes = np.sort(np.array(of_events, dtype=np.float64))
    return 2.0 * float(sizes[np.cumsum(sizes) <= HELD_BYTES].sum())  # in double precision, if the file is


def copies_in_memory(size: JobSize) -> float:
    """Copies of the records in single precision, for counting or for bounds."""
    if not (size.is_single or size.is_screened):
        return 0.0
    held = held_copies(size.modes, size.samples, size.counted)
    return sum(4.0 * size.modes * n for n, holds in zip(size.counted, held, strict=True) if holds)


def preparing(size: JobSize) -> float:
    """Memory of the threads that read and transform records."""
    longest = max(size.counted)
    transform = TRANSFORM * min(longest, LONGEST_TRANSFORM)
    pairs = 8.0 * PAIR_BINS * size.modes * (size.modes + 1) / 2
    return min(size.threads, len(size.samples)) * (transform + min(READ_BLOCK, 24.0 * max(size.samples)) + 2.0 * pairs)


def counting(size: JobSize) -> float:
    """Memory of the threads that solve, count and write groups of welds."""
    forces = FORCES * min(BLOCK, size.group) * size.modes
    results = 8.0 * len(size.samples) * (len(OF_EVENT) + 1) * 2 * size.group
    longest = max(size.counted)
    histories = min(ROWS_OF_STRESS, 32.0 * size.group * longest)
    of_thread = STRESS * size.group * size.modes + forces + 3.0 * results + (0.0 if size.is_single else histories)
    paths = path_memory(size.shear, size.counted, size.threads)
    rows = size.stations * (2 + 2 * len(size.samples) + size.modes)
    listed = min(ROWS_OF_STRESS, 256.0 * longest) + CYCLES_LISTED * min(longest, LONGEST_LISTED)
    busy = min(size.threads, -(-size.stations // size.group))
    binned = size.threads * BINNED if size.histograms else 0.0
    return busy * of_thread + min(MOST_WAITING, WAITING_ROWS * rows) + max(listed, binned, paths)


def page(size: JobSize) -> float:
    """Memory of the page."""
    welds = min(size.welds, MOST_DETAILED)
    cycles = CYCLES_PER_SAMPLE * sum(size.samples)
    listed = CYCLE_ON_PAGE * (cycles if size.welds * cycles < MOST_CYCLES else 100_000)
    return PAGE_IMPORTS + DETAIL * welds + STATION_ON_PAGE * min(size.stations, 100_000) + listed


def scratch_files(size: JobSize) -> float:
    """Bytes of scratch files."""
    given = 8.0 * size.modes * sum(size.samples)
    fine = sum(8.0 * size.modes * n for n, factor in zip(size.counted, size.factors, strict=True) if factor > 1)
    single = size.is_single or size.is_screened
    held = held_copies(size.modes, size.samples, size.counted)
    copies = sum(4.0 * size.modes * n for n, holds in zip(size.counted, held, strict=True) if not holds and single)
    longest = max(size.samples) if max(size.counted) > LONGEST_TRANSFORM else 0
    transforms = 32.0 * longest * min(size.threads, len(size.samples))
    return (given if given > HELD_BYTES else 0.0) + fine + copies + transforms


def result_tables(size: JobSize) -> float:
    """Bytes of the tables of the result."""
    events = len(size.samples)
    rows = 2 * size.stations * (ROW["nodes"] + events * ROW["damage"])
    rows += size.stations * size.modes * ROW["structural_stress"]
    rows += size.histograms * events * BINS * ROW["histogram"]
    listed = size.welds * (0.05 if size.is_large else 1.0)
    return rows + ROW["cycle"] * CYCLES_PER_SAMPLE * sum(size.samples) * listed


def _seconds(size: JobSize) -> float:
    """A first guess of the processor time."""
    alone, each = PER_STRESS_SAMPLE[size.is_single]
    per_sample = (alone + each * size.modes) * (SCREENED if size.is_screened else 1.0)
    counted = 2.0 * size.stations * sum(size.counted) * per_sample
    prepared = sum(size.modes * n * (PREPARED_LONG if n > LONGEST_TRANSFORM else PREPARED) for n in size.counted)
    listed = LISTED * sum(size.counted) * size.welds * (0.05 if size.is_large else 1.0)
    exact, each = PER_STRESS_SAMPLE[False]
    binned = 2.0 * size.histograms * sum(size.counted) * (exact + each * size.modes)
    shown = SECOND_ON_PAGE * min(size.welds, MOST_DETAILED) if size.report else 0.0
    shear = shear_seconds(size.shear, size.welds, size.stations, size.modes, size.counted, screened=size.is_screened)
    throats = throat_seconds(size.throats, sum(size.counted))
    return FIRST + counted + prepared + listed + binned + shear + throats + shown


def size_text(size: float) -> str:
    """Bytes in words.

    >>> size_text(3.2e8), size_text(2.08e10)
    ('320 MB', '20.8 GB')
    """
    return f"{size / 1e6:.0f} MB" if size < 1e9 else f"{size / 1e9:.3g} GB"
