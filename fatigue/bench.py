"""The bench programme as a story: chosen points of a finished result, blocks that a bench can run, and how many cycles.

The damage that a point shall reach is the one it has at the target mileage, times a factor of its own if it has one. A
cycle of a block makes a range of membrane and bending stress there, by the unit stresses that the result has stored,
and does the damage of this range. How many cycles of which block come closest to all points, and how many reach every
one of them, are two programmes side by side. No records are needed, and no input files.
"""

import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.bench_files import Blocks, read_blocks, read_points
from fatigue.decide.bench_points import (
    BenchPoints,
    Faults,
    points_of_result,
    unit_stress,
    units_of_coordinates,
    worst_wanted,
)
from fatigue.errors import DataError, Problem, given_path, refuse
from fatigue.life.bench import MOST_CYCLES, BlockCycles, Programme, block_cycles, cover, idle, least_squares, unreached
from fatigue.results import BENCHED, adding, finished_result
from fatigue.results.summary import assumptions
from fatigue.shown import visible
from fatigue.stages import stage

log = logging.getLogger(__name__)

METHODS: tuple[Callable[[NDArray[np.float64]], Programme], ...] = (least_squares, cover)
WORST = "worst"
READ = ("nodes", "structural_stress", "welds")
SHOWN = 40  # points in the text


@dataclass(frozen=True, slots=True, eq=False)
class Bench:
    """Programmes for a bench: ``points`` with their targets, ``blocks``, one cycle of each, and the two ``programmes``.

    ``units`` are those of the coordinates; ``assumptions`` what the damage of the result rests on.
    """

    points: BenchPoints
    blocks: Blocks
    units: Mapping[str, str]
    cycles: BlockCycles
    programmes: tuple[Programme, ...]
    target_km: float
    assumptions: str
    warnings: tuple[Problem, ...]

    @property
    def idle(self) -> list[str]:
        """Blocks that do no damage worth counting at any of the points."""
        is_idle = idle(self.cycles.damage / self.points.target[:, None])
        return [name for name, some in zip(self.blocks.name, is_idle.tolist(), strict=True) if some]

    def unused(self, programme: Programme) -> list[str]:
        """Blocks that a programme does not run."""
        return [name for name, n in zip(self.blocks.name, programme.cycles, strict=True) if n == 0.0]

    def as_record(self) -> dict[str, Any]:
        """The programmes for machines."""
        return {
            "target_km": self.target_km,
            "assumptions": self.assumptions,
            "points": [
                {**key, "factor": factor, "target_damage": target}
                for key, factor, target in zip(
                    self.points.key.to_dict("records"), self.points.factor, self.points.target, strict=True
                )
            ],
            "blocks": [
                {"block": name, "ranges": dict(zip(self.blocks.coordinate, ranges.tolist(), strict=True))}
                for name, ranges in zip(self.blocks.name, self.blocks.ranges, strict=True)
            ],
            "damage_per_cycle": self.cycles.damage.tolist(),
            "programmes": [
                {
                    "method": one.method,
                    "cycles": one.cycles.tolist(),
                    "whole_cycles": one.whole_cycles.tolist(),
                    "achieved_over_target": one.achieved.tolist(),
                    "achieved_over_target_whole": one.achieved_whole.tolist(),
                    "norm": one.norm,
                    "tau": one.tau,
                    "unused": self.unused(one),
                }
                for one in self.programmes
            ],
            "idle_blocks": self.idle,
            "warnings": [str(problem) for problem in self.warnings],
        }

    def as_text(self) -> str:
        """The programmes for people."""
        points, blocks = len(self.points), len(self.blocks.name)
        asked = f"{points} point{'s' * (points != 1)}, {blocks} block{'s' * (blocks != 1)}"
        lines = [
            f"Bench programme: {asked}; target: the damage of {self.target_km:g} km",
            self.assumptions,
            "Each block swings about zero (R = -1), all of its loads at the same instants",
        ]
        for one in self.programmes:
            lines += ["", *self._programme_text(one)]
        lines += ["", *self._point_text()]
        if self.idle:
            lines += ["", f"No target is reached by: {_names(self.idle)}"]
        return "\n".join(visible(line) for line in lines)

    def _programme_text(self, one: Programme) -> Iterator[str]:
        said = {
            "least_squares": f"least squares: closest to all targets, norm {one.norm:.4g}",
            "cover": f"cover: every target reached, none exceeded by more than a factor {one.tau:.5g}",
        }[one.method]
        yield f"{said}; achieved {one.achieved.min():.4g} to {one.achieved.max():.4g} of the target"
        width = max(len("block"), *(len(name) for name in self.blocks.name))
        yield f"  {'block':<{width}}  {'cycles':>14}  {'whole':>14}  ranges"
        for name, n, whole, ranges in zip(
            self.blocks.name, one.cycles, one.whole_cycles, self.blocks.ranges, strict=True
        ):
            if n > 0.0:
                yield f"  {name:<{width}}  {n:14.1f}  {whole:14.0f}  {self._ranges_text(ranges)}"
        if unused := self.unused(one):
            yield f"  not used: {_names(unused)}"

    def _ranges_text(self, ranges: NDArray[np.float64]) -> str:
        given = zip(self.blocks.coordinate, ranges, strict=True)
        return ", ".join(f"{name} {x:g} {self.units[name]}".rstrip() for name, x in given if x != 0.0)

    def _point_text(self) -> Iterator[str]:
        yield "Damage over target in whole cycles"
        worst = np.argsort(np.min([one.achieved_whole for one in self.programmes], axis=0), kind="stable")
        yield f"  {'target':>10}  " + "  ".join(f"{one.method:>13}" for one in self.programmes) + "  point"
        for i in np.sort(worst[:SHOWN]):
            of_point = "  ".join(f"{one.achieved_whole[i]:13.4g}" for one in self.programmes)
            yield f"  {self.points.target[i]:10.4g}  {of_point}  {self.points.names[i]}"
        if len(self.points) > SHOWN:
            yield f"  and {len(self.points) - SHOWN} points with more, see bench_points.parquet"


def bench(folder: Path | str, points: Path | str, blocks: Path | str, *, no_lock: bool = False) -> Bench:
    """Block programmes that do the damage of chosen points of a finished result on a test bench.

    The tables ``bench_blocks``, ``bench_points`` and ``bench_damage`` are written into the folder of the result.

    Parameters
    ----------
    folder : result of an assessment
    points : table of points with ``weld``, ``order`` or ``node``, ``surface``, and optionally ``part`` and ``factor``
        on the target damage; or ``worst``: the worst point of every weld
    blocks : table of blocks with the range of every unit load, ``u_<name>``, its sign the phase, and optionally a name
        in ``block``; ``q_<mode>`` is the range of a modal coordinate
    no_lock : for a file system without locks, see ``fatigue.assess``

    Raises
    ------
    DataError : no finished result in the folder, tables that make no sense, or points that no block reaches
    NumericalError : no programme was found
    """
    folder = given_path(folder, "folder")
    record = finished_result(folder, READ, READ, no_lock=no_lock)
    stage("reading points and blocks")
    units = units_of_coordinates(record)
    asked = read_blocks(given_path(blocks, "blocks"), units)
    is_worst = str(points) == WORST and not Path(points).exists()
    wanted, warnings = (worst_wanted(folder), ()) if is_worst else read_points(given_path(points, "points"))
    if not wanted:
        what = "nothing damages any weld of the result, so that there is no target"
        raise DataError(Problem("bench_no_damage", str(folder), what, "Nothing needs to be tested"))
    chosen = points_of_result(folder, record, wanted)
    cycles = _cycles(folder, chosen, asked)
    share = cycles.damage / chosen.target[:, None]
    refuse(DataError, _not_reached(chosen, asked, share))
    stage("solving for %d points and %d blocks", len(chosen), len(asked.name))
    programmes = tuple(method(share) for method in METHODS)
    found = Bench(
        points=chosen,
        blocks=asked,
        units=units,
        cycles=cycles,
        programmes=programmes,
        target_km=record["mission"]["target_km"],
        assumptions=assumptions(record),
        warnings=(*warnings, *asked.warnings, *mean_stress_warnings(record)),
    )
    with adding(folder, record, BENCHED, no_lock=no_lock) as addition:
        for name, rows in tables_of(found).items():
            with addition.table(name) as table:
                table.write(rows)
        addition.publish()
        log.info("bench programmes for %d points and %d blocks", len(chosen), len(asked.name))
    return found


def _cycles(folder: Path, points: BenchPoints, blocks: Blocks) -> BlockCycles:
    """One cycle of every block at all points, curve by curve."""
    membrane, bending = unit_stress(folder, points, blocks.coordinate)
    names = BlockCycles.__slots__
    arrays = {name: np.empty((len(points), len(blocks.name))) for name in names}
    for curve, rule in points.rules.items():
        at = np.array([name == curve for name in points.curve])
        found = block_cycles(membrane[at], bending[at], points.side[at], points.size[at], blocks.ranges, rule)
        for name in names:
            arrays[name][at] = getattr(found, name)
    return BlockCycles(**arrays)


def _not_reached(points: BenchPoints, blocks: Blocks, share: NDArray[np.float64]) -> Iterator[Problem]:
    """Refusal of points that no block reaches."""
    faults = Faults()
    for i in np.flatnonzero(unreached(share)):
        what = f"no block does damage there that would reach the target within {MOST_CYCLES:g} cycles"
        remedy = "Add a block that loads the point, or leave the point out"
        closest = int(share[i].argmax())
        nearest = f" (block {blocks.name[closest]!r}: {1.0 / share[i, closest]:.2g})" if share[i, closest] > 0.0 else ""
        faults.add("bench_not_reached", what, remedy, points.names[i] + nearest)
    yield from faults.problems()


def mean_stress_warnings(record: Mapping[str, Any]) -> Iterator[Problem]:
    """Warning of targets with a mean-stress factor, which the cycles of the bench do not have."""
    if record["rules"]["mean_stress"] != "none":
        what = "the damage of the result contains the mean-stress factor, a cycle of the bench swings about zero"
        yield Problem(
            "bench_mean_stress", "targets", what, "Run the blocks about zero: in high mean tension they do more damage"
        )


def tables_of(found: Bench) -> dict[str, dict[str, Any]]:
    """Columns of the tables by their names."""
    points, blocks, methods = len(found.points), len(found.blocks.name), [one.method for one in found.programmes]
    repeated = found.points.key.loc[np.repeat(np.arange(points), blocks)].reset_index(drop=True)
    of_methods = found.points.key.loc[np.tile(np.arange(points), len(methods))].reset_index(drop=True)
    return {
        "bench_blocks": {
            "method": np.repeat(methods, blocks).tolist(),
            "block": list(found.blocks.name) * len(methods),
            "cycles": np.concatenate([one.cycles for one in found.programmes]),
            "whole_cycles": np.concatenate([one.whole_cycles for one in found.programmes]),
        },
        "bench_points": {
            "method": np.repeat(methods, points).tolist(),
            **{name: of_methods[name].to_numpy() for name in of_methods},
            "factor": np.tile(found.points.factor, len(methods)),
            "target_damage": np.tile(found.points.target, len(methods)),
            "achieved_over_target": np.concatenate([one.achieved for one in found.programmes]),
            "achieved_over_target_whole": np.concatenate([one.achieved_whole for one in found.programmes]),
        },
        "bench_damage": {
            **{name: repeated[name].to_numpy() for name in repeated},
            "block": list(found.blocks.name) * points,
            "membrane_range_MPa": found.cycles.membrane_range.ravel(),
            "bending_range_MPa": found.cycles.bending_range.ravel(),
            "range_MPa": found.cycles.range.ravel(),
            "bending_ratio": found.cycles.bending_ratio.ravel(),
            "equivalent_range_dS": found.cycles.equivalent_range.ravel(),
            "damage_per_cycle": found.cycles.damage.ravel(),
        },
    }


def _names(names: Sequence[str]) -> str:
    return ", ".join(names[:10]) + (f" and {len(names) - 10} more" if len(names) > 10 else "")
