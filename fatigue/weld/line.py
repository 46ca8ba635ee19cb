"""A weld line as it is given, node by node, and many of them in a stack.

A body has thousands of lines of a few dozen nodes, so whatever is computed by node or by edge takes one line or a stack
of them.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import wraps
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

Vectors = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class WeldLine:
    """One weld line, or one straight part of a line split at its kinks.

    Attributes
    ----------
    weld, part : name of the weld; number of the part, from 1
    order, node : (n,) position along the weld and node id
    xyz : (n, 3) coordinates [mm]
    thickness : (n,) thickness of the assessed plate [mm]
    normal : (n, 3) normal of the assessed plate on its top side, any length
    outward : (n, 3) any vector from the assessed plate across the line
    edge_mid : (n,) mid-side node of a parabolic edge
    closed : whether the last node is joined to the first, which is not repeated
    end_length : length of the end treatment [mm]; None: the plate thickness; 0: none
    corner_start, corner_end : whether the part begins or ends at a kink of the weld instead of a weld end
    kept : what has been computed of the line, see ``once``
    """

    weld: str
    part: int
    order: NDArray[np.int64]
    node: NDArray[np.int64]
    xyz: Vectors
    thickness: NDArray[np.float64]
    normal: Vectors
    outward: Vectors
    edge_mid: NDArray[np.bool_]
    closed: bool
    end_length: float | None
    corner_start: bool = False
    corner_end: bool = False
    kept: dict[str, Any] = field(default_factory=dict, init=False, repr=False)

    @property
    def begin(self) -> NDArray[np.int64]:
        """Position of the first node, and the number of nodes."""
        return np.array([0, self.node.size])


@dataclass(frozen=True, slots=True, eq=False)
class LineStack:
    """Weld lines laid one after another, k lines with n nodes in all; single lines are cut out when asked for.

    Attributes
    ----------
    weld, part : (k,) name of the weld and number of the part
    closed, corner_start, corner_end : (k,) as in ``WeldLine``
    end_length : (k,) length of the end treatment [mm]; NaN: the plate thickness; 0: none
    begin : (k + 1,) position of each line's first node in the stack, and n
    order, node, xyz, thickness, normal, outward, edge_mid : as in ``WeldLine``, of all nodes
    kept : what has been computed of the lines, see ``once``
    """

    weld: tuple[str, ...]
    part: NDArray[np.int64]
    closed: NDArray[np.bool_]
    end_length: NDArray[np.float64]
    corner_start: NDArray[np.bool_]
    corner_end: NDArray[np.bool_]
    begin: NDArray[np.int64]
    order: NDArray[np.int64]
    node: NDArray[np.int64]
    xyz: Vectors
    thickness: NDArray[np.float64]
    normal: Vectors
    outward: Vectors
    edge_mid: NDArray[np.bool_]
    kept: dict[str, Any] = field(default_factory=dict, init=False, repr=False)

    def __len__(self) -> int:
        """Number of lines."""
        return len(self.weld)

    def __getitem__(self, number: int) -> WeldLine:
        """One line of the stack, a view of its nodes."""
        nodes = slice(int(self.begin[number]), int(self.begin[number + 1]))
        length_given = float(self.end_length[number])
        return WeldLine(
            weld=self.weld[number],
            part=int(self.part[number]),
            **{name: getattr(self, name)[nodes] for name in NODE_COLUMNS},
            closed=bool(self.closed[number]),
            end_length=None if np.isnan(length_given) else length_given,
            corner_start=bool(self.corner_start[number]),
            corner_end=bool(self.corner_end[number]),
        )

    def __iter__(self) -> Iterator[WeldLine]:
        """One line of the stack after the other."""
        return (self[number] for number in range(len(self)))

    def lines(self, some: slice) -> "LineStack":
        """Some neighbouring lines, a view of their nodes."""
        first, end, _ = some.indices(len(self))
        nodes = slice(int(self.begin[first]), int(self.begin[end]))
        return LineStack(
            **{name: getattr(self, name)[some] for name in LINE_COLUMNS},
            begin=self.begin[first : end + 1] - self.begin[first],
            **{name: getattr(self, name)[nodes] for name in NODE_COLUMNS},
        )


Lines: TypeAlias = WeldLine | LineStack
NODE_COLUMNS = ("order", "node", "xyz", "thickness", "normal", "outward", "edge_mid")
LINE_COLUMNS = ("weld", "part", "closed", "end_length", "corner_start", "corner_end")
Computed = TypeVar("Computed")


def once(compute: Callable[[Lines], Computed]) -> Callable[[Lines], Computed]:
    """Function that computes the same at the first call and keeps it with the line: half of the rest is made from it.

    What such a function returns must not be changed.
    """

    @wraps(compute)
    def kept(line: Lines) -> Computed:
        if compute.__name__ not in line.kept:
            line.kept[compute.__name__] = compute(line)
        found: Computed = line.kept[compute.__name__]
        return found

    return kept


def stacked(lines: Sequence[WeldLine]) -> LineStack:
    """Lines laid one after another."""
    return LineStack(
        weld=tuple(line.weld for line in lines),
        part=np.array([line.part for line in lines]),
        closed=np.array([line.closed for line in lines]),
        end_length=np.array([np.nan if line.end_length is None else line.end_length for line in lines]),
        corner_start=np.array([line.corner_start for line in lines]),
        corner_end=np.array([line.corner_end for line in lines]),
        begin=np.cumsum([0, *(line.node.size for line in lines)]),
        **{name: np.concatenate([getattr(line, name) for line in lines]) for name in NODE_COLUMNS},
    )


def line_of_node(line: Lines) -> NDArray[np.int64]:
    """Which line of the stack each node belongs to, (n,)."""
    return np.repeat(np.arange(line.begin.size - 1), np.diff(line.begin))


def neighbours(line: Lines) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Positions of the nodes before and after each node, (n,) each; closed and open lines wrap alike."""
    n = line.node.size
    before, after = np.arange(-1, n - 1), np.arange(1, n + 1)
    before[line.begin[:-1]], after[line.begin[1:] - 1] = line.begin[1:] - 1, line.begin[:-1]
    return before, after


def is_closed(line: Lines) -> NDArray[np.bool_]:
    """Whether each line of the stack is closed, (k,)."""
    return np.atleast_1d(line.closed)


def end_lengths(line: Lines) -> NDArray[np.float64]:
    """Length of the end treatment given for each line of the stack, (k,) [mm]; NaN: the plate thickness."""
    if isinstance(line, WeldLine):
        return np.array([np.nan if line.end_length is None else line.end_length])
    return line.end_length
