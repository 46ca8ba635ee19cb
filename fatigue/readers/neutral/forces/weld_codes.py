"""The welds of all groups, numbered: which group a row of a table of forces belongs to, by the name of its weld."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pyarrow as pa
import pyarrow.types as pt
from numpy.typing import NDArray

from fatigue.files.naming import composed
from fatigue.readers.neutral.column_values import codes_of


@dataclass(frozen=True, slots=True, eq=False)
class WeldCodes:
    """The welds of all groups, numbered group by group.

    ``groups`` are their names, ``code`` the number of each by its name in the file, ``group``, (w,), the group of each
    number. ``skipped`` are welds of the file that nobody asks for.
    """

    groups: tuple[tuple[str, ...], ...]
    code: Mapping[str, int]
    group: NDArray[np.int32]
    skipped: frozenset[str]

    @property
    def are_those_of_the_file(self) -> bool:
        """Whether the file has these welds, under these names, and no others."""
        return not self.skipped and all(name in self.code for group in self.groups for name in group)

    def of(self, welds: pa.ChunkedArray) -> NDArray[np.int32]:
        """Numbers of a column of names, (r,); -1 where there is no such weld, -2 where it is skipped."""
        numbers = [known[place] for known, place in self.coded(welds)]
        return numbers[0] if len(numbers) == 1 else np.concatenate([np.zeros(0, dtype=np.int32), *numbers])

    def among(self, welds: pa.ChunkedArray) -> NDArray[np.int32]:
        """Distinct numbers in a column of names, ascending; below 0 as in ``of``."""
        present = [np.zeros(0, dtype=np.int32)]
        for known, place in self.coded(welds):
            used = np.zeros(known.size, dtype=np.bool_)
            used[place] = True
            present.append(known[used])
        return np.unique(np.concatenate(present))

    def coded(self, welds: pa.ChunkedArray) -> Iterator[tuple[NDArray[np.int32], NDArray[np.integer]]]:
        """Numbers of the distinct names of each chunk, -1 last, and the place of each row's name among them."""
        if not pt.is_dictionary(welds.type):
            welds = welds.cast(pa.string()).dictionary_encode()
        for chunk in welds.chunks:
            names = chunk.dictionary.cast(pa.string()).to_pylist()
            known = np.array([*(self._number(composed(name or "")) for name in names), -1], dtype=np.int32)
            yield known, codes_of(chunk, len(names))

    def _number(self, name: str) -> int:
        return self.code.get(name, -2 if name in self.skipped else -1)


def weld_codes(
    groups: Sequence[Sequence[str]], in_file: Mapping[str, str] | None = None, skipped: Collection[str] = ()
) -> WeldCodes:
    """Give the welds of all groups their numbers; ``in_file`` are the names they have there if these are others."""
    names = [weld for group in groups for weld in group]
    code = {name if in_file is None else in_file[name]: i for i, name in enumerate(names)}
    group = np.repeat(np.arange(len(groups), dtype=np.int32), [len(group) for group in groups])
    return WeldCodes(tuple(map(tuple, groups)), code, group, frozenset(skipped))
