"""The first ``case.toml`` of a converted folder: every line that may be left out is there to be edited."""

import json
import tomllib
from collections.abc import Sequence
from pathlib import Path

from fatigue.readers.convert.options import ConvertOptions
from fatigue.readers.neutral.forces.convention import Convention
from fatigue.readers.neutral.register.weld_register import REGISTER

CASE = "case.toml"

_HEAD = """\
# Written by fatigue convert. Check the lines marked EDIT: the files could not tell them.
title = {title}

[body]
modes = "modes.csv"
welds = "welds.csv"
weld_nodes = "weld_nodes.csv"
{columns}element_forces = "element_forces.parquet"
weld_elements = "weld_elements.csv"
nodes = "nodes.parquet"
elements = "elements.parquet"
register = "welds_register.csv"   # EDIT: which lines are assessed, their names, faces, thickness, curves
{points}force_convention = "{convention}"
ignore_modes = {ignore}
{loads}
[curve]
name = "{curve}"               # EDIT
survival = "mean-2sigma"
thickness_rule = "actual"
extension = "none"
mean_stress = "none"

[counting]
residue = "repeat"
upsample = "auto"              # 20 samples per peak; 1: the samples as they are

[mission]
target_km = {target!r}         # EDIT
km_per_year = {per_year!r}     # EDIT
damage_limit = 1.0
"""

_COLUMNS = """\
weld_columns = "{columns}"
"""

_POINTS = """\
stress_points = "{points}"
modal_stresses = "{stresses}"
"""

_EVENT = """
[[mission.event]]
name = {name}
history = {history}
speed_km_h = {speed!r}         # EDIT
share = {share!r}              # EDIT: share of the mileage; all shares add up to 1
start_s = 0.0                  # EDIT: cut the start-up
"""

_NO_EVENT = """
# No modal coordinates were converted: add an event before you assess.
# [[mission.event]]
# name = "straight track"
# history = "q.parquet"        # time_s and one column q_<mode> for every mode
# speed_km_h = 100.0
# share = 1.0
"""


def case_text(
    options: ConvertOptions,
    convention: Convention,
    ignore_modes: Sequence[int],
    events: Sequence[tuple[str, str]],
    loads: tuple[str, str] = ("", ""),
    points: tuple[str, str] | None = None,
    columns: str | None = None,
) -> str:
    """Text of a case with one event for each (name, file), all with the same share and speed.

    ``loads`` is the text of the unit loads of the body, and what to write of them behind the events; ``points`` are the
    files of stress points and of their modal stresses; ``columns`` is the file of the columns of nodes of solids.
    """
    head = _HEAD.format(
        title=json.dumps(options.title or options.mesh.stem),
        convention=convention,
        ignore=list(ignore_modes),
        loads=loads[0],
        columns="" if columns is None else _COLUMNS.format(columns=columns),
        points="" if points is None else _POINTS.format(points=points[0], stresses=points[1]),
        curve=options.curve,
        target=float(options.target_km),
        per_year=float(options.target_km) / 30,
    )
    if not events:
        return head + _NO_EVENT + loads[1]
    speed, share = float(options.speed_km_h), 1.0 / len(events)
    texts = (
        _EVENT.format(name=json.dumps(name), history=json.dumps(file), speed=speed, share=share)
        for name, file in events
    )
    return head + "".join(texts) + loads[1]


def register_named(case_file: Path) -> str:
    """Name of the register that a case is assessed by; a case that was kept may name another than a new one does."""
    try:
        body = tomllib.loads(case_file.read_text(encoding="utf-8-sig")).get("body", {})
        return str(body.get("register", REGISTER))
    except (OSError, ValueError, AttributeError, RecursionError):  # kept, and not to be read: its check will say so
        return REGISTER
