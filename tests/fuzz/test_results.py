"""A share of the damages of result folders: every command says so, or gives the right answer."""

import random
import shutil

import pytest

from tests.fuzz.results import COMMANDS, KINDS, damaged, sound_result, told

FILES = ("nodes.parquet", "welds.parquet", "provenance.json", "provenance.json.sha256", "exports.json")
SHARE = 12


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """A sound result, and what every command says of it."""
    folder = sound_result(tmp_path_factory.mktemp("sound"))
    copy = shutil.copytree(folder.parent, tmp_path_factory.mktemp("copy") / "copy")
    return folder, {command: run(copy / "result") for command, run in COMMANDS.items()}


def test_no_damage_of_a_result_crashes_or_goes_unseen(sound, tmp_path):
    """One clear line that names the file, exit code 3; or the right answer, where the file is not needed."""
    folder, expected = sound
    rng = random.Random(5)
    bad = []
    for number in range(SHARE):
        file = FILES[number % len(FILES)]
        kind = rng.choice(list(KINDS))
        found = list(told(damaged(folder, file, kind, rng, tmp_path / "d"), file, kind, expected))
        bad += [one for one in found if one.kind not in ("refused", "same", "named")]
    assert bad == []
