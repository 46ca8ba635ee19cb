"""The MYSTRAN solver: a program whose path the environment variable FATIGUE_MYSTRAN gives; nothing is downloaded."""

import os
import subprocess
from pathlib import Path

import pytest

PROGRAM = os.environ.get("FATIGUE_MYSTRAN", "")

needs_mystran = pytest.mark.skipif(
    not os.access(PROGRAM, os.X_OK), reason="no MYSTRAN solver: export FATIGUE_MYSTRAN=$(.ci/mystran FOLDER)"
)


def solve(deck, folder, name):
    """Run a deck; give the input file, which is the mesh, too, and the OP2 file."""
    return solve_text(deck.text(), folder, name)


def solve_text(text, folder, name, stops=False):
    """Run an input file; ``stops``: it must end before its end."""
    mesh = folder / f"{name}.dat"
    mesh.write_text(text, encoding="ascii")
    done = subprocess.run([PROGRAM, mesh.name], cwd=folder, capture_output=True, text=True, timeout=60, check=False)
    listing = mesh.with_suffix(".F06").read_text(errors="replace")
    assert done.returncode == 0, done.stdout[-2000:]
    assert ("MYSTRAN END" in listing) != stops, listing[-2000:]
    return mesh, Path(mesh.with_suffix(".OP2"))


def listed_modes(op2):
    """Frequencies [Hz] by mode as the solver prints them."""
    lines = op2.with_suffix(".F06").read_text(errors="replace").splitlines()
    start = next(k for k, line in enumerate(lines) if "R E A L   E I G E N V A L U E S" in line)
    found = {}
    for line in lines[start + 4 :]:
        words = line.split()
        if len(words) != 7:
            break
        found[int(words[0])] = float(words[4])
    return found
