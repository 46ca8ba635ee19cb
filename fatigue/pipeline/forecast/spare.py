"""What the machine has: memory that is available, and free disk."""

import shutil
from collections.abc import Iterator
from pathlib import Path

from fatigue.errors import Problem
from fatigue.pipeline.forecast.needs import JobNeeds, size_text

_GROUP = Path("/sys/fs/cgroup")  # of a container, version 2


def spare_memory() -> float | None:
    """Memory that this process may still take [bytes]; None where the system does not say."""
    found = [*_available(), *_left_in_container(), *_address_space()]
    return min(found, default=None)


def spare_disk(folder: Path) -> float | None:
    """Free disk of a folder that may not be there yet [bytes]; None where the system does not say."""
    there = next((path for path in (folder.absolute(), *folder.absolute().parents) if path.is_dir()), None)
    try:
        return None if there is None else float(shutil.disk_usage(there).free)
    except OSError:
        return None


def shortage_warnings(needs: JobNeeds, folder: Path) -> Iterator[Problem]:
    """Warnings of a job that needs more memory than is available, or more disk than is free where ``folder`` is."""
    yield from memory_warnings("the assessment", needs.memory, needs.memory_remedy)
    disk = spare_disk(folder)
    if disk is not None and needs.scratch + needs.result > disk:
        yield Problem(
            "disk_short",
            str(folder),
            f"scratch files take about {size_text(needs.scratch)} and the result {size_text(needs.result)}, "
            f"{size_text(disk)} are free",
            needs.disk_remedy,
        )


def memory_warnings(what: str, needed: float, remedy: str) -> Iterator[Problem]:
    """Warning of something that needs more memory [bytes] than is available."""
    memory = spare_memory()
    if memory is not None and needed > memory:
        said = f"{what} takes about {size_text(needed)} of memory, {size_text(memory)} are available"
        yield Problem("memory_short", "this machine", said, remedy)


def _available() -> Iterator[float]:
    """Memory that can be had without swapping."""
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
    except (OSError, UnicodeDecodeError):
        return
    yield from (1024.0 * float(line.split()[1]) for line in lines if line.startswith("MemAvailable:"))


def _left_in_container() -> Iterator[float]:
    """Memory left below the limit of a container."""
    try:
        limit, used, stat = (
            (_GROUP / f"memory.{name}").read_text(encoding="ascii") for name in ("max", "current", "stat")
        )
        cache = [line.split()[1] for line in stat.splitlines() if line.startswith("file ")]  # the kernel takes it back
        if limit.strip() != "max":
            yield float(limit) - float(used) + float(cache[0])
    except (OSError, ValueError, IndexError):
        return


def _address_space() -> Iterator[float]:
    """Address space left below a limit that a user or a queue has set."""
    try:
        import resource  # noqa: PLC0415 - not on every system

        limit, _ = resource.getrlimit(resource.RLIMIT_AS)
        if limit != resource.RLIM_INFINITY:
            used = float(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * resource.getpagesize()
            yield max(0.0, limit - used)
    except (ImportError, OSError, ValueError):
        return
