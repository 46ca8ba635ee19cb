"""The analysis graph of one vehicle: its stability map and its lines, and all of them as rows of tables."""

from collections.abc import Iterator
from dataclasses import dataclass

from fatigue.study.graph.asked import Asked
from fatigue.study.graph.line import Line, conicity_line, speed_line
from fatigue.study.graph.stability import Progress, StabilityMap, stability_map
from fatigue.vehicle.assembly import suspended
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.roots import Root


@dataclass(frozen=True, slots=True, eq=False)
class VehicleGraph:
    """Analysis graph of a vehicle by its name.

    ``over_conicity`` are lines at a speed each, that of the run first; ``over_speed`` lines at a conicity each, that of
    the contact first.
    """

    name: str
    vehicle: Vehicle
    map: StabilityMap
    over_conicity: tuple[Line, ...]
    over_speed: tuple[Line, ...]

    @property
    def lines(self) -> tuple[Line, ...]:
        """All lines."""
        return (*self.over_conicity, *self.over_speed)


@dataclass(frozen=True, slots=True)
class RootRow:
    """One root at one place of one line."""

    vehicle: str
    along: str
    speed_km_h: float
    conicity: float
    locus: int
    frequency_hz: float
    damping: float
    mode: str
    group: str
    share: float
    share_car: float
    share_flex: float
    share_conv: float
    share_trafo: float
    share_bogies: float
    share_wheelsets: float
    stable: bool


@dataclass(frozen=True, slots=True)
class CriticalRow:
    """A conicity or a speed at which a vehicle gains or loses stability."""

    vehicle: str
    along: str
    speed_km_h: float
    conicity: float
    change: str
    frequency_hz: float
    damping: float
    mode: str
    group: str
    share: float


@dataclass(frozen=True, slots=True)
class StabilityRow:
    """One point of a stability map."""

    vehicle: str
    speed_km_h: float
    conicity: float
    stable: bool
    frequency_hz: float
    damping: float
    mode: str
    group: str
    share: float


def vehicle_graph(
    name: str, vehicle: Vehicle, body: ElasticBody, asked: Asked, progress: Progress | None = None
) -> VehicleGraph:
    """Analysis graph of a vehicle with this car body.

    Raises
    ------
    CaseError : a setting nobody knows
    DataError : the car body lacks a point where the suspension takes hold
    """
    of = suspended(vehicle, body)
    return VehicleGraph(
        name,
        vehicle,
        stability_map(of, asked.speeds, asked.conicities, progress),
        tuple(conicity_line(of, speed, asked.conicities) for speed in asked.lines_over_conicity(vehicle)),
        tuple(speed_line(of, conicity, asked.speeds) for conicity in asked.lines_over_speed(vehicle)),
    )


def root_rows(of: VehicleGraph) -> Iterator[RootRow]:
    """Every root at every place of every line."""
    for line in of.lines:
        for number, locus in enumerate(line.loci, 1):
            for place, root in enumerate(locus.roots):
                if root is not None:
                    speed, conicity = line.point(place)
                    shares = root.of.shares
                    yield RootRow(
                        of.name,
                        line.along,
                        speed,
                        conicity,
                        number,
                        *_root(root),
                        shares["car"],
                        shares["flex"],
                        shares["conv"],
                        shares["trafo"],
                        shares["bogies"],
                        shares["wheelsets"],
                        root.s.real < 0.0,
                    )


def critical_rows(of: VehicleGraph) -> Iterator[CriticalRow]:
    """Every crossing of every line."""
    for line in of.lines:
        for crossing in line.crossings:
            speed, conicity = line.point_at(crossing.at)
            yield CriticalRow(of.name, line.along, speed, conicity, crossing.change, *_root(crossing.root))


def stability_rows(of: VehicleGraph) -> Iterator[StabilityRow]:
    """Every point of the map."""
    its = of.map
    for i, conicity in enumerate(its.conicities):
        for j, speed in enumerate(its.speeds):
            name = its.of[i][j]
            yield StabilityRow(
                of.name,
                float(speed),
                float(conicity),
                bool(its.stable[i, j]),
                float(its.frequency_hz[i, j]),
                float(its.damping[i, j]),
                name.name,
                name.group,
                name.shares[name.group],
            )


def _root(root: Root) -> tuple[float, float, str, str, float]:
    return root.frequency_hz, root.damping, root.of.name, root.of.group, root.of.shares[root.of.group]
