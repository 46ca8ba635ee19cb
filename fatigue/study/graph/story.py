"""The analysis graph of some vehicles: where each is stable over speed and conicity, and which root takes it away."""

from collections.abc import Sequence
from pathlib import Path

from threadpoolctl import threadpool_limits

from fatigue.errors import CaseError, Problem, given_path, refuse
from fatigue.files.recorded import refuse_foreign
from fatigue.stages import stage
from fatigue.study.car_body import car_body
from fatigue.study.graph.asked import Asked
from fatigue.study.graph.folder import FILLED, write_graph
from fatigue.study.graph.numbers import graph_numbers
from fatigue.study.graph.stability import Progress
from fatigue.study.graph.summary import Graph
from fatigue.study.graph.vehicle_graph import vehicle_graph
from fatigue.study.graph.vehicles import named_vehicles
from fatigue.vehicle.definition import Car
from fatigue.vehicle.elastic import ElasticBody


def graph(
    files: Sequence[Path | str],
    settings: Sequence[str] = (),
    *,
    asked: Asked | None = None,
    into: Path | str | None = None,
    csv: bool = False,
    force: bool = False,
    progress: Progress | None = None,
) -> Graph:
    """Analysis graph of vehicles, written into a folder where one is given.

    Parameters
    ----------
    files : a ``vehicle.toml`` each
    settings : of the suspension, in which each of them is looked at; none: as it is
    asked : speeds and conicities
    into : folder for tables, page and record; None: nothing is written
    csv : write the tables as CSV as well
    force : overwrite files in it that are not ours

    Raises
    ------
    CaseError : a mistake in a vehicle
    DataError : a damaged car body; files in the way in the folder
    """
    paths = [given_path(file, "files") for file in files]
    if not paths:
        raise CaseError(Problem("argument", "files", "there is no vehicle", "Give a vehicle.toml"))
    asked = Asked() if asked is None else asked
    refuse(CaseError, asked.problems())
    folder = None if into is None else given_path(into, "into")
    vehicles = named_vehicles(paths, settings)
    if folder is not None:
        refuse_foreign(folder, FILLED, force=force, inputs=paths)
    bodies: dict[Car, ElasticBody] = {}
    graphs, numbers = [], {}
    with threadpool_limits(limits=1, user_api="blas"):
        for name, vehicle in vehicles.items():
            if vehicle.car not in bodies:
                stage("car body")
                bodies[vehicle.car] = car_body(vehicle)
            stage("stability of %s", name)
            body = bodies[vehicle.car]
            graphs.append(vehicle_graph(name, vehicle, body, asked, progress))
            numbers[name] = graph_numbers(vehicle, body)
    found = Graph(tuple(graphs), numbers)
    if folder is None:
        return found
    stage("writing tables and page")
    written = write_graph(folder, found, asked, paths, csv=csv)
    return Graph(found.vehicles, found.numbers, tuple(str(folder / name) for name in written))
