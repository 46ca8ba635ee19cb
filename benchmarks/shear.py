"""What shear at the toes costs: the same assessment with ``[multiaxial] method`` "report" and "off", in turn.

The synthetic bodies of ``fatigue synth`` have no shear. Here it is added: in-plane and twist shear as large as
``SHEAR`` of the normal stress, other combinations of the modes than these.
"""

import json
import tempfile
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

from benchmarks.timing import Row
from benchmarks.train import run_measured
from fatigue.example import write_example
from fatigue.synth import Size, synthesize

MEDIUM = Size(8200, 60, 1, 160.0, 250.0)  # 40 000 steps
SHEAR = 0.4  # rms of the shear over that of the normal stress
METHODS = ("off", "report")
CURVE = "[curve]"  # before which tables are written


def shear() -> list[Row]:
    """The shipped example, upsampled as by default, and a medium job, its 40 000 samples as they are."""
    rows: list[Row] = []
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        write_example(root / "example")
        medium = synthesize(root / "medium", MEDIUM)
        medium.write_text(medium.read_text().replace(CURVE, "[counting]\nupsample = 1\n" + CURVE))
        with_shear(root / "medium" / "nodal_forces.parquet")
        for name, case in (("example", root / "example" / "case.toml"), ("medium job", medium)):
            rows += _ratios(name, case)
    return rows


def with_shear(path: Path, seed: int = 1) -> None:
    """Give the nodal forces of a synthetic body forces along the welds and twisting moments."""
    table = pq.read_table(path)
    modes = int(np.asarray(table["mode"]).max())
    drawn = np.random.default_rng(seed).normal(size=(2, modes, modes)) * SHEAR / np.sqrt(modes)
    for (given, column), mix in zip((("fy_N", "fx_N"), ("mx_Nmm", "my_Nmm")), drawn, strict=True):
        forces = np.asarray(table[given]).reshape(-1, modes) @ mix
        place = table.column_names.index(column)
        table = table.set_column(place, column, [forces.astype(np.float32).ravel()])
    pq.write_table(table, path)


def _ratios(name: str, case: Path) -> list[Row]:
    """Processor time and peak memory of the methods, and what settled the toe points."""
    text, found = case.read_text(), {}
    for method in (METHODS[-1], *METHODS):  # the first compiles, or loads what was compiled
        asked = case.with_name(f"{method}.toml")
        asked.write_text(text.replace(CURVE, f'[multiaxial]\nmethod = "{method}"\n{CURVE}', 1))
        result = case.parent / f"result-{method}"
        found[method] = run_measured(asked, result, "--threads", "1", "--force")
    record = json.loads((case.parent / "result-report" / "provenance.json").read_text())
    points = record["rules"]["multiaxial"]["toe_points"]
    (off_s, off_MB), (report_s, report_MB) = (found[method] for method in METHODS)
    told = ", ".join(f"{number} {status}" for status, number in points.items())
    return [
        (f"shear in the report / off, {name}, processor time", f"{report_s / off_s:.2f} ({off_s:.1f} s off)"),
        (f"shear in the report - off, {name}, peak memory", f"{report_MB - off_MB:.0f} MB"),
        (f"toe points by what settled their shear, {name}", told),
    ]
