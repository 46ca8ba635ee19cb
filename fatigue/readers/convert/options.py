"""What a conversion of foreign files is told: the files, and how they are to be understood."""

from dataclasses import dataclass, field
from pathlib import Path

from fatigue.errors import given_path
from fatigue.readers.convert.displacement.record import Displacement
from fatigue.readers.convert.weld_lines import WeldSources
from fatigue.readers.foreign.histories.foreign_history import Match
from fatigue.readers.neutral.forces.convention import Convention
from fatigue.readers.units.systems import Normalisation


@dataclass(frozen=True, slots=True)
class ConvertOptions:
    """What to convert, and how the foreign files are to be understood.

    Attributes
    ----------
    forces, mesh : grid point forces and geometry; an MSC .h5 holds both
    out : folder to write
    unit_loads : grid point forces of static subcases in files of their own; each is an interface mode
    coordinates : modal coordinates, one file for each event
    convention : sign of the forces; None: as the audit proves it
    subcase : which one, where the force file has several
    force_units, coordinate_units : unit systems of the FE files and of the coordinates
    normalisation : whether modes have unit generalised mass or unit displacement (for the conversion of units)
    interface_modes : modes that are residual, constraint or attachment modes; static subcases among them are read, too
    ignore_modes : modes to leave out on either side
    match : how columns find their modes
    columns : table of the columns ``column, mode``
    time_column, resample_s : name of the time column; step to interpolate onto
    simulation_modes : table ``mode, frequency_hz, modal_mass`` of the simulation's modes, to compare and scale
    welds : where weld lines come from
    displacements : elastic displacements of the simulation, to be compared with shapes times coordinates
    accept : audit checks whose red light is accepted
    curve, title, speed_km_h, target_km : for the first case.toml
    force : overwrite foreign and changed files
    keep_case : leave a case.toml in the folder as it is
    """

    forces: Path
    mesh: Path
    out: Path
    unit_loads: tuple[Path, ...] = ()
    coordinates: tuple[Path, ...] = ()
    convention: Convention | None = None
    subcase: int | None = None
    force_units: str = "mm-t-s"
    coordinate_units: str = "mm-t-s"
    normalisation: Normalisation = "mass"
    interface_modes: tuple[int, ...] = ()
    ignore_modes: tuple[int, ...] = ()
    match: Match = "id"
    columns: Path | None = None
    time_column: str | None = None
    resample_s: float | None = None
    simulation_modes: Path | None = None
    welds: WeldSources = field(default_factory=WeldSources)
    displacements: tuple[Displacement, ...] = ()
    accept: tuple[str, ...] = ()
    curve: str = "master-aluminium"
    title: str = ""
    speed_km_h: float = 100.0
    target_km: float = 1.0e6
    force: bool = False
    keep_case: bool = False

    def __post_init__(self) -> None:
        """Take text for a path, and one file for a tuple of one."""
        for name in ("forces", "mesh", "out", "columns", "simulation_modes"):
            given = getattr(self, name)
            if given is not None or name in ("forces", "mesh", "out"):
                object.__setattr__(self, name, given_path(given, name))
        for name in ("coordinates", "unit_loads"):
            given = getattr(self, name)
            files = given if isinstance(given, tuple | list) else (given,)
            object.__setattr__(self, name, tuple(given_path(file, name) for file in files))
