"""A small study: the small case, a command that simulates its one event in a moment, two frequencies, two seeds."""

import sys
from pathlib import Path

from tests.small_case import small_case

SIMULATION = '''\
"""A simulation of tests: noise whose size follows a frequency and whose shape follows a seed."""
import json, random, sys
size, seed = 90.0 / float(sys.argv[1]), int(sys.argv[2])
draw = random.Random(seed)
q = [0.0, 0.0, 0.0]
with open("noise.csv", "w") as file:
    print("time_s,q_1,q_2,q_7", file=file)
    for step in range(800):
        q = [0.8 * old + draw.gauss(0.0, 1.0) for old in q]
        print(f"{step * 0.005:.3f},{size * q[0]!r},{size * q[1]!r},{size * q[2]!r}", file=file)
with open("numbers.json", "w") as file:
    json.dump({"size": {"value": size, "unit": "mm"}, "drawn": draw.random()}, file)
'''

STUDY = """\
title = "small study"
seeds = [1, 2]

[base]
case = "body/case.toml"

[source]
command = "{python} {{study}}/simulate.py {{fe}} {{seed}}"

[[vary]]
key = "own.fe"
values = [9.0, 18.0]
"""


def small_study(folder: Path, more: str = "", **changes: str) -> Path:
    """Write the study with what it needs into a folder; ``changes`` replace texts of its file."""
    case = small_case(1.0)
    case.histories = {"noise": case.histories["noise"]}
    case.events = [{"name": "noise", "history": "noise", "speed_km_h": 360.0, "share": 1.0}]
    case.write(folder / "body")
    (folder / "body" / "noise.csv").unlink()
    (folder / "simulate.py").write_text(SIMULATION)
    return written(folder, more, **changes)


def written(folder: Path, more: str = "", **changes: str) -> Path:
    """Write the file of the study alone."""
    text = STUDY.format(python=Path(sys.executable).as_posix()) + more
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    path = folder / "study.toml"
    path.write_text(text)
    return path


def without_case(folder: Path, command: str, more: str = "") -> Path:
    """Write a study of a command alone, which leaves numbers and no histories."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "vehicle.toml").write_text("")
    path = folder / "study.toml"
    path.write_text(
        f'[base]\nvehicle = "vehicle.toml"\n[source]\ncommand = {command!r}\n'
        f'[[vary]]\nkey = "vehicle.converter.fe_hz"\nvalues = [9.2, 14.0]\n{more}'
    )
    return path
