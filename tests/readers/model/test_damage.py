"""Damaged files of matrices: read, or refused in words, and nothing else."""

import random

import pytest

from fatigue.errors import DataError
from fatigue.flexbody.shell import structure
from fatigue.readers.foreign.nastran.matrices.op4 import read_op4
from fatigue.readers.model.read import read_model
from tests.flexbody.shells import plate
from tests.readers.foreign.nastran.matrices.test_deck import dmig
from tests.readers.foreign.nastran.matrices.test_op4 import op4

TIMES = 60


def sound_files():
    """A stiffness matrix in each layout of OUTPUT4, and both matrices as DMIG with their grids."""
    body = structure(plate(1, 1))
    dofs = list(zip(body.node.tolist(), (body.direction + 1).tolist(), strict=True))
    grids = "".join(f"GRID,{node},,{node}.,{node * node}.,0.\n" for node in range(1, 5))
    K, M = body.K.toarray(), body.M.toarray()
    texts = {
        f"{layout.replace(' ', '_')}.op4": op4(K, 6, layout=layout) for layout in ("dense", "one word", "two words")
    }
    texts |= {
        f"{layout}.pch": dmig("KAAX", K, dofs, layout=layout) + dmig("MAAX", M, dofs, layout=layout) + grids
        for layout in ("large", "free")
    }
    return {name: text.encode() for name, text in texts.items()}


def damaged(sound, drawn):
    """Bytes changed, lost, repeated or cut off, once to five times."""
    data = bytearray(sound)
    for _ in range(drawn.choice((1, 1, 2, 5))):
        at = drawn.randrange(len(data))
        kind = drawn.randrange(4)
        if kind == 0:
            data[at] = drawn.choice(b"0123456789-+. EDx,*\n\x00\xff")
        elif kind == 1:
            del data[at : at + drawn.randrange(1, 40)]
        elif kind == 2:
            data[at:at] = data[at : at + drawn.randrange(1, 80)]
        else:
            del data[max(at, 1) :]
    return bytes(data)


@pytest.mark.parametrize("name", ["dense.op4", "one_word.op4", "two_words.op4", "large.pch", "free.pch"])
def test_damaged_matrices(tmp_path, name):
    """Each message names the file and is one line."""
    sound, drawn, problems = sound_files()[name], random.Random(name), []
    path = tmp_path / name
    for _ in range(TIMES):
        path.write_bytes(damaged(sound, drawn))
        try:
            read_op4(path) if path.suffix == ".op4" else read_model(path)
        except DataError as error:
            problems += error.problems
    assert len(problems) > TIMES // 2
    assert all(name in problem.where and "\n" not in str(problem) for problem in problems)
