"""A case opened to be counted without a result folder: its records prepared, its points solved, any modes left out."""

import logging
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from fatigue.life.mission import Plan
from fatigue.pipeline.count.group import assess_group
from fatigue.pipeline.count.worst import EQUAL, worst_points
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.events import event_loads
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.run.work import SHARE, screening_of
from fatigue.pipeline.sensitivity.recount import counted_again
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.model import Model, solve_group
from fatigue.pipeline.solve.stations import modal_stress
from fatigue.pipeline.solve.weld_groups import WeldGroups, weld_groups
from fatigue.side_by_side import in_order
from fatigue.stages import stage

log = logging.getLogger(__name__)

Floats = NDArray[np.float64]
Place = tuple[str, int, int]  # weld, part, order

MOST_SAMPLES = 100_000_000  # stress samples of a case of which all points are counted again: some seconds a time
MOST_NUMBERS = 10_000_000  # of modal stress on each face: 160 MB in all
FACES = ("top", "bottom")


@dataclass(frozen=True, slots=True, eq=False)
class OpenCase:
    """A case whose records are read; ``is_small``: all of its points are worth counting more than once."""

    body: Body
    plan: Plan
    loads: tuple[EventLoad, ...]
    groups: WeldGroups
    scratch: Path
    threads: int | None

    @property
    def is_small(self) -> bool:
        """Whether all points of the case are counted again, and not only the worst of every weld."""
        stations = int(self.body.lines.begin[-1])
        samples = sum(load.counted.q.shape[1] for load in self.loads)
        return 2 * stations * samples <= MOST_SAMPLES and stations * len(self.body.coordinates) <= MOST_NUMBERS


@dataclass(frozen=True, slots=True, eq=False)
class CountedGroup:
    """Some stations of a group of welds, their cycles counted with all modes and without some.

    Attributes
    ----------
    welds : names of the welds of the group
    weld : (n,) index into ``welds``, ascending
    part, order, node : (n,) identity of the stations
    xyz : (n, 3) where they are [mm]
    toe : (n, 2) faces that carry a weld toe
    utilisation : (n, 2) with all modes
    without : (v, n, 2) without the modes of each of v choices
    stress : (n, 2, c) modal stress at both faces [MPa per unit modal coordinate]
    """

    welds: tuple[str, ...]
    weld: NDArray[np.int64]
    part: NDArray[np.int64]
    order: NDArray[np.int64]
    node: NDArray[np.int64]
    xyz: Floats
    toe: NDArray[np.bool_]
    utilisation: Floats
    without: Floats
    stress: Floats

    @property
    def first(self) -> NDArray[np.intp]:
        """First station of every weld, and the number of stations behind them."""
        return np.searchsorted(self.weld, np.arange(len(self.welds) + 1))

    def worst(self, utilisation: Floats) -> Iterator[tuple[int, int]]:
        """Station and face of the highest utilisation (n, 2) at the toes of every weld, the first of equals."""
        at_toes = np.where(self.toe, utilisation, -1.0)
        for first, end in pairwise(self.first.tolist()):
            of_weld = at_toes[first:end]
            station, face = divmod(int((of_weld >= EQUAL * of_weld.max()).argmax()), 2)
            yield first + station, face

    def place(self, station: int) -> Place:
        """Identity of a station in every basis of the same welds."""
        return self.welds[self.weld[station]], int(self.part[station]), int(self.order[station])


@contextmanager
def opened(body: Body, threads: int | None = None) -> Iterator[OpenCase]:
    """A case with its records prepared as its assessment would; what memory cannot hold is on disk meanwhile.

    Raises
    ------
    CaseError, DataError : the records are wrong; NumericalError : they are too large
    """
    plan, _ = mission_plan(body, threads)
    with TemporaryDirectory(prefix="fatigue-basis-") as folder, threadpool_limits(limits=1, user_api="blas"):
        scratch = Path(folder)
        groups = weld_groups(body, scratch / "forces")
        stage("preparing the records of the events (%d)", len(plan.passes))
        loads = event_loads(groups, plan, scratch / "histories", threads)
        yield OpenCase(body, plan, loads, groups, scratch, threads)


def counted(
    case: OpenCase, left_out: Sequence[NDArray[np.bool_]] = (), wanted: Collection[Place] = ()
) -> list[CountedGroup]:
    """The welds of a case counted group by group, with all modes and once more without each choice of modes.

    ``left_out`` are masks (m,) of modes. Of a case that is not small only the worst point of every weld, as an
    assessment finds it, and the stations ``wanted`` are counted without modes.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    coordinates = len(case.body.coordinates)
    masks = [np.pad(mask, (0, coordinates - len(mask))) for mask in left_out]  # unit loads are no modes
    screening = None
    if not case.is_small:
        screening = screening_of(SHARE, True, case.loads, case.scratch, case.threads)

    def group(number: int) -> CountedGroup:
        model = solve_group(case.groups, number)
        if case.is_small:
            rows = np.arange(len(model.stations))
        else:
            result = assess_group(model, case.loads, case.plan, screening)
            worst = {point.station for point in worst_points(model.stations, result)}
            rows = np.array(sorted(worst | _stations(model, wanted)), dtype=np.intp)
        return _counted(model, case, rows, masks)

    return in_order(group, range(len(case.groups)), case.threads)


def _stations(model: Model, wanted: Collection[Place]) -> set[int]:
    """Stations of a model at given places."""
    if not wanted:
        return set()
    stations, places = model.stations, set(wanted)
    names = stations.names
    keys = zip(stations.weld.tolist(), stations.part.tolist(), stations.order.tolist(), strict=True)
    return {i for i, (weld, part, order) in enumerate(keys) if (names[weld], part, order) in places}


def _counted(model: Model, case: OpenCase, rows: NDArray[np.intp], masks: Sequence[NDArray[np.bool_]]) -> CountedGroup:
    """Some stations of a solved group of welds, counted."""
    stations = model.stations
    again = partial(_utilisation, model, case, rows)
    membrane, bending = stations.treated.membrane[rows], stations.treated.bending[rows]
    return CountedGroup(
        welds=tuple(stations.names),
        weld=stations.weld[rows],
        part=stations.part[rows],
        order=stations.order[rows],
        node=stations.node[rows],
        xyz=stations.xyz[rows],
        toe=stations.toe[rows],
        utilisation=again(None),
        without=np.stack([again(mask) for mask in masks]) if masks else np.empty((0, len(rows), 2)),
        stress=np.stack([membrane + bending, membrane - bending], axis=1),
    )


def _utilisation(model: Model, case: OpenCase, rows: NDArray[np.intp], left_out: NDArray[np.bool_] | None) -> Floats:
    """Utilisation (n, 2) of some stations, ascending, the stress of the coordinates that are left out set to 0."""
    found = np.empty((len(rows), 2))
    for rated, of_curve in model.by_curve():
        here = np.flatnonzero(np.isin(rows, of_curve))
        if not here.size:
            continue
        stress = modal_stress(model.stations, rows[here], rated)
        if left_out is not None:
            kept = np.where(left_out, 0.0, 1.0)
            stress = replace(stress, membrane=stress.membrane * kept, bending=stress.bending * kept)
        found[here] = counted_again(stress, stress.rule, stress.size, case.loads, rated.plan(case.plan))
    return found
