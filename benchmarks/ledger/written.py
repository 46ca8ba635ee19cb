"""The ledger as a page of the docs and as a table of numbers."""

import csv
import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields
from typing import Any

from benchmarks.ledger.signals import KINDS
from benchmarks.ledger.story import Entry
from benchmarks.ledger.ways import COUNTING, NOT_ASKED, SLOPE, SPECTRAL

COMMAND = "python -m benchmarks ledger -o docs/ledger.md"

_HEAD = f"""# Ledger: speed, memory and accuracy beside other packages

[README](../README.md) · [large models](large-models.md) · [how it works](how-it-works.md)

Ours and every package of rainflow counting or of spectral methods that can be installed, on the same signals. A
program writes this page; make it anew, on your machine and in a checkout, with

```bash
pip install "FLife>=2.3" "fatpack>=0.7.8" "pylife>=2.1" "pyyeti>=1.4"
{COMMAND}
```

`-o FILE.csv` has all digits. Each way runs in a process of its own, warm, on one thread: time is the best of
several rounds, memory the peak above what was resident before the first round, the signals themselves not counted.
Every package is used in the fastest way that its documentation tells; what that leaves out or rounds is said below
the tables.

Accuracy is against a plain stack of the standard in double precision that shares no code with anybody. "cycles" and
"sum" are the number of cycles and the sum of n S^{SLOPE:g} over those of the reference, minus one. "range" is the
largest deviation of any range of the sorted lists over the largest range, or that of the largest range where a way
tells no others. A reference has the residue of the way that is compared with it: `half` counts what does not close
as half cycles (ASTM E1049-85, 5.4.4), `repeat` closes all cycles of a block that recurs.
"""

_SPECTRAL_HEAD = """## Damage from spectra

Flat bands, 9 to 11 Hz and 1 to 40 Hz, at 1024 levels; from densities at 2049 frequencies to damage per second. "damage"
is the largest deviation from the formula with the exact moments of the band; it is the quadrature of the moments.
"""


def page(entries: Sequence[Entry], facts: Mapping[str, Any]) -> str:
    """The page of the docs."""
    parts = [_HEAD, "Measured on: " + ", ".join(f"{name} {value}" for name, value in facts.items()) + ".\n"]
    versions = {e.package: e.version for e in entries if e.version}
    parts.append("Versions: " + ", ".join(f"{name} {number}" for name, number in versions.items()) + ".\n")
    for kind, known in KINDS.items():
        rows = [e for e in entries if e.task == "counting" and e.kind == kind]
        if rows:
            parts.append(f"## Counting, {kind}: {known.what}\n")
            parts.append(_counting(rows))
    parts.append("What the ways do:\n")
    parts.append("\n".join(f"- {way.name}: {way.remark}." for way in COUNTING if way.remark) + "\n")
    parts.append(_SPECTRAL_HEAD)
    parts.append(_spectral([e for e in entries if e.task == "spectral"]))
    parts.append("\n".join(f"- {way.name}: {way.remark}." for way in SPECTRAL if way.remark) + "\n")
    parts.append("\n".join(f"- {package}: {why}." for package, why in NOT_ASKED.items()) + "\n")
    return "\n".join(parts)


def _counting(rows: Sequence[Entry]) -> str:
    """Table of one kind of signal; times beside that of the first way."""
    lines = [
        "| way | residue | type | wall, ns per sample | CPU, ns per sample | memory, MB | cycles | sum | range |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for e in rows:
        what = f"| {e.way} | `{e.residue}` | {e.precision} "
        if e.missing:
            lines.append(f"{what}| {e.missing} | | | | | |")
            continue
        accuracy = " | ".join(map(_deviation, (e.cycles, e.power_sum, e.largest)))
        lines.append(f"{what}| {_time(e.wall_ns)} | {_time(e.cpu_ns)} | {_memory(e.memory_MB)} | {accuracy} |")
    return "\n".join(lines) + "\n"


def _spectral(rows: Sequence[Entry]) -> str:
    lines = [
        "| band | way | wall, us per spectrum | CPU, us per spectrum | memory, MB | damage |",
        "|---|---|---|---|---|---|",
    ]
    for e in rows:
        if e.missing:
            lines.append(f"| {e.kind} | {e.way} | {e.missing} | | | |")
            continue
        times = f"{_time(1e-3 * e.wall_ns)} | {_time(1e-3 * e.cpu_ns)} | {_memory(e.memory_MB)}"
        lines.append(f"| {e.kind} | {e.way} | {times} | {_deviation(e.power_sum)} |")
    return "\n".join(lines) + "\n"


def _time(number: float) -> str:
    return f"{number:.0f}" if number >= 100 else f"{number:.3g}"


def _memory(number: float) -> str:
    return f"{max(number, 0.0):.0f}"


def _deviation(number: float) -> str:
    """A deviation, or that it is not told; what is smaller than rounding of the sum is 0."""
    if math.isnan(number):
        return "-"
    return "0" if abs(number) < 1e-14 else f"{number:.1e}"


def table(entries: Sequence[Entry], facts: Mapping[str, Any]) -> str:
    """All rows and digits as CSV; what was measured on stands in each row."""
    text = io.StringIO()
    names = [field.name for field in fields(Entry)]
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*names, *facts])
    for entry in entries:
        of_entry = asdict(entry)
        writer.writerow([*(of_entry[name] for name in names), *facts.values()])
    return text.getvalue()
