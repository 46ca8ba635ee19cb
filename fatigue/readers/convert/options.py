"""What a conversion of foreign files is told: every option of ``fatigue convert``, once, in the order of its help."""

from dataclasses import KW_ONLY, dataclass, field
from pathlib import Path
from typing import Annotated, Literal, get_args

from fatigue.errors import CaseError, Problem
from fatigue.readers.convert.loads.names import LoadName
from fatigue.readers.convert.option_fields import Option, take_paths
from fatigue.readers.foreign.formats import COORDINATES, FORCES, MESH, STRESSES, formats_in_help
from fatigue.readers.units.systems import Normalisation

Direction = Literal["x", "y", "z"]
Density = Literal["fine", "quadratic", "coarse"]


@dataclass(frozen=True, slots=True)
class WeldSources:
    """Where weld lines come from; ``detect`` None: the mesh is searched only if nothing is marked."""

    register: Annotated[
        Path | None,
        Option("--register", "Edited weld register; its status, names and thicknesses win.", is_recorded=False),
    ] = None
    node_lists: Annotated[
        Path | None,
        Option("--node-lists", "CSV weld,order,node with weld lines of your own."),
    ] = None
    sets: Annotated[tuple[int, ...], Option("--set", "Id of a node set whose mesh edges are welds; repeatable.")] = ()
    markers: Annotated[
        tuple[str, ...], Option("--marker", "Card that lies on welds: PLOTEL, CBAR, CBEAM; repeatable.")
    ] = ()
    detect: Annotated[
        bool | None,
        Option("--detect/--no-detect", "Search the mesh for weld lines; default: if nothing is marked."),
    ] = None
    candidates: Annotated[bool, Option("--candidates", "Assess flat changes of property and folds as well.")] = False
    lines: Annotated[
        Path | None,
        Option("--lines", "CSV line,point,x_mm,y_mm,z_mm with weld lines as points in space, for any mesh."),
    ] = None

    def __post_init__(self) -> None:
        """Take text for a path."""
        take_paths(self)


@dataclass(frozen=True, slots=True)
class Displacement:
    """File of an elastic displacement over time, the FE node that moves, and the direction in the basic frame."""

    file: Path
    node: int
    direction: Direction

    def __post_init__(self) -> None:
        """Take text for a path.

        Raises
        ------
        CaseError : another direction
        """
        object.__setattr__(self, "file", Path(self.file))
        if self.direction not in get_args(Direction):
            raise CaseError(Problem("direction", "displacement", f"{self.direction!r} is none", "Give x, y or z"))


@dataclass(frozen=True, slots=True)
class ConvertOptions:
    """What to convert, and how the foreign files are to be understood: every field is what the help of its option says.

    Static subcases named among ``interface_modes`` are read besides the modes; ``ignore_modes`` may be modes of either
    side; ``convention`` None is the one that the audit proves.
    """

    forces: Annotated[Path, Option("--forces", f"Grid point forces: {formats_in_help(FORCES, ', or ')}.")]
    mesh: Annotated[Path, Option("--mesh", f"Geometry: {formats_in_help(MESH, ', or ')}.")]
    unit_loads: Annotated[
        tuple[Path, ...],
        Option("--unit-loads", "Forces of static subcases in a file of their own; repeatable."),
    ] = field(default=(), kw_only=True)
    coordinates: Annotated[
        tuple[Path, ...],
        Option("--coordinates", f"Modal coordinates: {formats_in_help(COORDINATES)}; one file per event."),
    ] = field(default=(), kw_only=True)
    stress_points: Annotated[
        Path | None,
        Option("--stress-points", "Table of stress points: writes the modal stresses of a case there."),
    ] = field(default=None, kw_only=True)
    stresses: Annotated[
        tuple[Path, ...],
        Option(
            "--stresses",
            f"Shell stresses at the stress points: {formats_in_help(STRESSES, ', or ')}; repeatable; default: the "
            "files of forces.",
        ),
    ] = field(default=(), kw_only=True)
    read_outs: Annotated[
        Density,
        Option("--read-outs", "Where stress is read before a hot spot, by the mesh there."),
    ] = field(default="fine", kw_only=True)
    out: Annotated[
        Path, Option("--output", "Folder to write.", short="-o", metavar="DIR", is_folder=True, is_recorded=False)
    ]
    _: KW_ONLY
    convention: Annotated[
        Literal["on_element", "on_node"] | None,
        Option("--convention", "Sign of the forces; default: as the audit proves it."),
    ] = None
    subcase: Annotated[int | None, Option("--subcase", "Subcase, where the force file has several.")] = None
    force_units: Annotated[str, Option("--units", "Unit system of the FE files: mm-t-s, m-kg-s ...")] = "mm-t-s"
    coordinate_units: Annotated[str, Option("--coordinate-units", "Unit system of the coordinates.")] = "mm-t-s"
    normalisation: Annotated[
        Normalisation, Option("--normalisation", "Modes of unit generalised mass or unit displacement.")
    ] = "mass"
    match: Annotated[
        Literal["id", "frequency", "order"], Option("--match", "How columns of coordinates find their modes.")
    ] = "id"
    columns: Annotated[Path | None, Option("--columns", "CSV column,mode: which column belongs to which mode.")] = None
    time_column: Annotated[
        str | None,
        Option("--time-column", "Name of the time column, or its position from 1."),
    ] = None
    resample_s: Annotated[
        float | None,
        Option("--resample", "Interpolate records with uneven steps onto this step [s].", metavar="STEP_S"),
    ] = None
    simulation_modes: Annotated[
        Path | None, Option("--simulation-modes", "CSV mode,frequency_hz,modal_mass of the simulation's modes.")
    ] = None
    interface_modes: Annotated[
        tuple[int, ...],
        Option(
            "--interface-modes",
            "Residual, constraint or attachment modes, and static subcases that are such, as 31-52.",
            is_list=True,
        ),
    ] = ()
    static_subcases: Annotated[
        Literal["unit_loads", "interface_modes", "leave_out"] | None,
        Option(
            "--static-subcases",
            "What static subcases are that --interface-modes does not name; default: interface modes where the "
            "coordinates have a column for them, else unit loads.",
        ),
    ] = None
    unit_load_names: Annotated[
        tuple[LoadName, ...],
        Option(
            "--unit-load-name",
            "A subcase is so much of this load, as 1001 tunnel_pressure 5 kPa; repeatable. Else its name is made of "
            "its subtitle, label or title, and 1 is the load as it was run.",
            metavar="SUBCASE NAME AMOUNT UNIT",
        ),
    ] = ()
    ignore_modes: Annotated[
        tuple[int, ...], Option("--ignore-modes", "Modes to leave out on either side, as 1-6.", is_list=True)
    ] = ()
    displacements: Annotated[
        tuple[Displacement, ...],
        Option(
            "--displacement",
            "Elastic displacement of an FE node in the simulation (CSV time_s,displacement_mm): compared with the sum "
            "of mode shapes times coordinates; repeatable.",
            metavar="FILE NODE x|y|z",
        ),
    ] = ()
    accept: Annotated[
        tuple[str, ...],
        Option("--accept", "Go on although this check of the audit is red; repeatable.", metavar="CHECK"),
    ] = ()
    curve: Annotated[str, Option("--curve", "S-N curve of the first case.toml.")] = "master-aluminium"
    title: Annotated[str, Option("--title", "Title of the first case.toml.")] = ""
    speed_km_h: Annotated[float, Option("--speed", "Speed of the first case.toml [km/h].")] = 100.0
    target_km: Annotated[float, Option("--target-km", "Target of the first case.toml [km].")] = 1.0e6
    force: Annotated[bool, Option("--force", "Overwrite foreign and changed files in DIR.", is_recorded=False)] = False
    keep_case: Annotated[
        bool, Option("--keep-case", "Keep the case.toml in DIR as it is, edited or not.", is_recorded=False)
    ] = False
    welds: WeldSources = field(default_factory=WeldSources)

    def __post_init__(self) -> None:
        """Take text for a path, and one file for a tuple of one."""
        take_paths(self)
