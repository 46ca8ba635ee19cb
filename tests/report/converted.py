"""Results as `convert`, an edited register and `assess` really write them: welds left out, candidates, bounds."""

import csv
from pathlib import Path

import numpy as np

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.options import ConvertOptions
from tests.readers.op2_writer import modal_op2
from tests.readers.tee_model import bulk, tee

NAME = '<b>"odd"</b> & =1+1; ä'
REASON = "=cmd|' /C calc'!A1 <script>alert(1)</script>, ground flush"
NOTHING_KNOWN = {"weld": NAME, "line": "gone", "status": "candidate"}  # no kind, no nodes, no length, a taken name


def converted(folder: Path) -> Path:
    """Convert the T joint with a history: three welds. Returns the folder of the case."""
    (folder / "tee.bdf").write_text(bulk(tee()))
    (folder / "tee.op2").write_bytes(modal_op2(tee().results, word=8))
    time = np.arange(600) / 50
    noise = np.random.default_rng(5).standard_normal((5, 600))
    rows = [f"{t:.9g}," + ",".join(f"{8e-6 * x:.9g}" for x in noise[:, k]) for k, t in enumerate(time)]
    (folder / "q.csv").write_text("\n".join(["time,q_1,q_2,q_3,q_4,q_5", *rows]) + "\n")
    convert(
        ConvertOptions(
            forces=folder / "tee.op2",
            mesh=folder / "tee.bdf",
            out=folder / "body",
            coordinates=(folder / "q.csv",),
            interface_modes=(5,),
        )
    )
    return folder / "body"


def assessed(folder: Path, changes: list[dict[str, str]], share: float | None = None, name: str = "converted") -> Path:
    """Convert, edit the rows of the register, those beyond the last are new, and assess; returns the result folder."""
    folder = folder / name
    folder.mkdir()
    body = converted(folder)
    register = body / "welds_register.csv"
    with register.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    rows += [dict.fromkeys(rows[0], "") for _ in changes[len(rows) :]]
    for row, change in zip(rows, changes, strict=False):
        row.update(change)
    with register.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    assess(load_case(body / "case.toml"), folder / "result", threads=1, share=share)
    return folder / "result"
