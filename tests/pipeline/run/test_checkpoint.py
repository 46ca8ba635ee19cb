"""What a run leaves behind for the next one."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.pipeline.count.result import GroupResult, arrays_of
from fatigue.pipeline.run.checkpoint import Checkpoint, replacing, state_key


def finished(value=1.0):
    """A finished group: two stations under one event."""
    result = GroupResult.empty(1, 2)
    for array in arrays_of(result).values():
        array[...] = value
    return result


def test_a_saved_group_is_read_back_bit_for_bit(tmp_path):
    """Whole groups are reused and counted."""
    with pytest.raises(KeyboardInterrupt), Checkpoint(tmp_path, "key") as state:
        state.save("a", finished(np.pi))
        raise KeyboardInterrupt
    again = Checkpoint(tmp_path, "key").__enter__()
    assert again.load("b") is None
    found, saved = again.load("a"), finished(np.pi)
    assert np.array_equal(found.of_events("damage_per_pass"), saved.of_events("damage_per_pass"))
    assert np.array_equal(found.mission.governing, saved.mission.governing)
    assert np.array_equal(found.mission.life_km_raw_end, saved.mission.life_km_raw_end)
    assert all(np.array_equal(array, arrays_of(found)[name]) for name, array in arrays_of(saved).items())


def test_the_state_goes_after_success_and_when_it_is_empty(tmp_path):
    """Nothing hidden is left without need."""
    with Checkpoint(tmp_path, "key") as state:
        state.save("a", finished())
    assert not list(tmp_path.iterdir())
    with pytest.raises(DataError), Checkpoint(tmp_path, "key"):
        raise DataError
    assert not list(tmp_path.iterdir())


def test_groups_of_other_inputs_are_dropped(tmp_path):
    """Another key finds nothing and cleans up."""
    with pytest.raises(KeyboardInterrupt), Checkpoint(tmp_path, "one") as state:
        state.save("a", finished())
        raise KeyboardInterrupt
    other = Checkpoint(tmp_path, "two").__enter__()
    assert other.load("a") is None
    assert [p.name for p in (tmp_path / ".fatigue-state").iterdir()] == ["two"]


@pytest.mark.parametrize("keep", [0, 10, 300, -1])
def test_a_group_cut_short_is_not_used(tmp_path, keep):
    """Wherever a file ends too early, it is as if it were not there."""
    state = Checkpoint(tmp_path, "key").__enter__()
    state.save("a", finished())
    path = state.folder / "a.npz"
    path.write_bytes(path.read_bytes()[:keep])
    assert state.load("a") is None


def test_a_group_of_which_a_byte_has_changed_is_not_used(tmp_path):
    """Checksums of all arrays are tested."""
    state = Checkpoint(tmp_path, "key").__enter__()
    state.save("a", finished(np.pi))
    path = state.folder / "a.npz"
    whole = path.read_bytes()
    at = whole.index(np.float64(np.pi).tobytes())
    path.write_bytes(whole[:at] + b"\0" + whole[at + 1 :])
    assert state.load("a") is None


def test_a_group_of_another_kind_is_not_used(tmp_path):
    """What numpy writes can be read, but says nothing of these arrays."""
    state = Checkpoint(tmp_path, "key").__enter__()
    np.savez(state.folder / "a.npz", damage=np.zeros(3))
    assert state.load("a") is None


def test_keys_depend_on_content_not_on_order():
    """The same record in another order is the same run."""
    assert state_key({"a": 1, "b": [2]}) == state_key({"b": [2], "a": 1})
    assert state_key({"a": 1}) != state_key({"a": 2})


def test_replacing_is_all_or_nothing(tmp_path):
    """An error while writing leaves the old file and no half one."""
    final = tmp_path / "x"
    final.write_text("old")
    with pytest.raises(ValueError, match="stop"), replacing(final) as unfinished:
        unfinished.write_text("half")
        raise ValueError("stop")
    assert [p.name for p in tmp_path.iterdir()] == ["x"]
    assert final.read_text() == "old"
