"""The tables of ``case.toml`` as frozen models: every key, its unit, its range, and what must agree with what.

Nothing is converted silently: a text is never taken for a number, and an unknown key is always an error.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, PrivateAttr, field_validator

from fatigue.case.channels import Channel, Ride, no_channel_of_static_loads
from fatigue.case.checks import CHECK_FILES, Checks, Multiaxial
from fatigue.case.curves import Curve, CustomCurve
from fatigue.case.identity.report import Report
from fatigue.case.life_band import LifeBand
from fatigue.case.load_problems import forms_of_forces, loads_of_event, one_gravity
from fatigue.case.order.sequences import Sequence
from fatigue.case.problems import absent, clash, path_problems
from fatigue.case.table import NotNegative, Positive, Table, Text
from fatigue.case.unit_loads import GivenLoad, MissionLoad, UnitLoad
from fatigue.errors import Problem
from fatigue.life.records.history import Residue

BODY_FILES = (
    "modes",
    "welds",
    "weld_nodes",
    "nodal_forces",
    "element_forces",
    "weld_elements",
    "nodes",
    "elements",
    "weld_throats",
    "stress_points",
    "modal_stresses",
    "weld_columns",
)
BASIS_FILES = (
    "participation",
    "mass_matrix",
    "mass_rows",
    "mode_shapes",
    "interface_shapes",
    "flexibility",
)
"""Files that only `fatigue basis` reads: an assessment neither reads nor hashes them."""
GAUGE_FILES = ("gauge_forces", "properties")
"""Files that only `fatigue gauges` reads."""
MASS_FILES = ("mass_matrix", "mass_rows", "mode_shapes")
MeanOfQ = Literal["keep", "remove"]
LARGEST_UPSAMPLE = 64  # peaks come at half the sampling rate at most: 128 samples per peak, of the damage 1e-4 k lost


class Body(Table):
    """The flexible body: files in the neutral format, relative to the case file."""

    modes: Text = Field(description="the file of the modes (.parquet or .csv)")
    welds: Text = Field(description="the file of the welds (.parquet or .csv)")
    weld_nodes: Text = Field(description="the file of the nodes of every weld line (.parquet or .csv)")
    nodal_forces: Text | None = Field(
        default=None, description="the file of modal nodal forces [N, N mm], summed over the assessed plate side"
    )
    element_forces: Text | None = Field(
        default=None, description="the file of modal element nodal forces [N, N mm], one row per element corner"
    )
    weld_elements: Text | None = Field(
        default=None, description="the file of the elements of each weld's assessed side"
    )
    nodes: Text | None = Field(
        default=None,
        description="the file of all nodes [mm], for the balance check, the comparison with the welds and pictures",
    )
    elements: Text | None = Field(
        default=None,
        description="the file of the elements' nodes and thickness, for the comparison with the welds and pictures",
    )
    weld_columns: Text | None = Field(
        default=None,
        description="the file of the nodes through the thickness at each station of welds of solid elements (weld, "
        "order, node), with nodes",
    )
    weld_throats: Text | None = Field(default=None, description="the file of the throats of fillet welds")
    stress_points: Text | None = Field(
        default=None, description="the file of points beside welds and in parent metal, with modal_stresses"
    )
    modal_stresses: Text | None = Field(
        default=None, description="the file of the stress of each mode at the stress points [MPa]"
    )
    participation: Text | None = Field(
        default=None,
        description="the file of the participation factors of the modes (l_x, l_y, l_z [t], l_rx, l_ry, l_rz [t mm]), "
        "rotations about the centre of mass; of the shapes that modal_mass belongs to",
    )
    mass_matrix: Text | None = Field(
        default=None,
        description="instead of participation: the mass matrix [t, t mm, t mm2] (.mtx of Matrix Market or .npz of "
        "scipy.sparse), with mass_rows and mode_shapes",
    )
    mass_rows: Text | None = Field(
        default=None,
        description="the file that says what a row of the mass matrix is (row from 1, node, direction x to rz, held)",
    )
    mode_shapes: Text | None = Field(
        default=None, description="the file of the mode shapes at the nodes of the mass matrix (mode, node, ux_mm ...)"
    )
    total_mass_t: Positive | None = Field(
        default=None, description="the mass [t] of the body, which effective modal masses sum up to, above 0"
    )
    boundary_mass_t: NotNegative | None = Field(
        default=None,
        description="the part [t] of the mass that is lumped on the fixed boundary and moves with no mode, at least 0",
    )
    inertia_t_mm2: Annotated[tuple[Positive, ...], Field(strict=False, min_length=3, max_length=3)] | None = Field(
        default=None, description="a list of the three moments of inertia [t mm2] of the body about its centre of mass"
    )
    interface_shapes: Text | None = Field(
        default=None, description="the file of the mode shapes at loaded points (point, direction, mode, value)"
    )
    flexibility: Text | None = Field(
        default=None, description="the file of a static solution at loaded points (point, direction, value_mm_per_N)"
    )
    gauge_forces: Text | None = Field(
        default=None,
        description="the file of the element forces under strain gauges, as element_forces, which stands for it where "
        "it is left out",
    )
    properties: Text | None = Field(
        default=None,
        description="the file of the materials of the elements by their property (pid, E_MPa, nu, thickness_mm, "
        "bending_thickness_mm), for strain gauges",
    )
    weld_register: Text | None = Field(
        default=None,
        alias="register",  # which is a method of every class that has abstract ones
        description="the weld register (.csv), by default the welds_register.csv beside the welds if there is one",
    )
    force_convention: Literal["on_element", "on_node"] = Field(
        description="the sense of the nodal forces: 'on_element' (K_e u_e) or 'on_node' (the opposite; MSC Nastran, "
        "ANSYS and Abaqus write this one)"
    )
    ignore_modes: Annotated[tuple[int, ...], Field(strict=False)] = Field(
        default=(), description="a list of mode ids left out of the forces and of the histories"
    )
    unit_load: Annotated[tuple[UnitLoad, ...], Field(strict=False)] = Field(
        default=(), description="one [[body.unit_load]] table per load beside the modes"
    )

    def _contradictions(self) -> Iterator[Problem]:
        yield from path_problems({key: getattr(self, key) for key in BODY_FILES})
        if self.nodal_forces and self.element_forces:
            yield clash("nodal_forces", "nodal_forces and element_forces are both given", "Keep one of them")
        if not self.nodal_forces and not self.element_forces:
            remedy = "Give nodal_forces, or element_forces with weld_elements"
            yield absent("nodal_forces", "neither nodal_forces nor element_forces is given", remedy)
        if self.element_forces and not self.weld_elements:
            what = f"the key is missing although element_forces = {self.element_forces!r} is given"
            yield absent("weld_elements", what, "Give the file of the elements of each weld's assessed side")
        if self.weld_elements and not self.element_forces:
            what = f"weld_elements = {self.weld_elements!r} is given without element_forces"
            yield clash("weld_elements", what, "Give element_forces or remove weld_elements")
        if self.elements and not self.nodes:
            what = f"the key is missing although elements = {self.elements!r} is given"
            yield absent("nodes", what, "Give the file of the nodes the elements refer to")
        if (self.stress_points is None) != (self.modal_stresses is None):
            without = "stress_points" if self.stress_points is None else "modal_stresses"
            yield absent(without, "stress_points and modal_stresses need each other", "Give both or neither")
        yield from self._of_masses()
        yield from forms_of_forces(self.unit_load, by_elements=self.element_forces is not None)
        yield from one_gravity(self.unit_load)

    def _of_masses(self) -> Iterator[Problem]:
        """Refusals of keys about the mass of the body that do not fit together."""
        yield from path_problems({key: getattr(self, key) for key in (*BASIS_FILES, *GAUGE_FILES)})
        given = [key for key in MASS_FILES if getattr(self, key) is not None]
        if self.participation and given:
            what = f"participation and {given[0]} are both given: either says what the modes carry"
            yield clash("participation", what, "Keep one of them")
        elif given and len(given) < len(MASS_FILES):
            without = next(key for key in MASS_FILES if key not in given)
            what = f"{', '.join(MASS_FILES)} need each other, and {' and '.join(given)} {_is(given)} given alone"
            yield absent(without, what, f"Give {without} too, or none of them")
        total, lumped = self.total_mass_t, self.boundary_mass_t
        if total is not None and lumped is not None and lumped >= total:
            what = f"{lumped:g} t are not less than total_mass_t = {total:g}"
            yield clash("boundary_mass_t", what, "Give the part of the mass that is on the fixed boundary")


def _is(several: list[str]) -> str:
    return "are" if len(several) > 1 else "is"


class Counting(Table):
    """How cycles are counted."""

    residue: Residue = Field(default="repeat", description="the treatment of the residue: 'repeat' or 'half'")
    upsample: Annotated[int, Field(ge=1, le=LARGEST_UPSAMPLE)] | Literal["auto"] = Field(
        default="auto",
        description=f"the upsampling factor before counting: 1, 2, 4 ... {LARGEST_UPSAMPLE}, or 'auto': of each event, "
        "what gives 20 samples per peak; 1 counts the samples as they are",
    )
    mean_of_q: MeanOfQ = Field(
        default="keep",
        description="the time means of the modal coordinates in means and stress ratios: 'keep' or 'remove'",
    )
    reversals: Literal["samples", "vertex"] = Field(
        default="samples",
        description="where a reversal is read: at its 'samples', or at the 'vertex' of the parabola through three",
    )

    @field_validator("upsample", mode="before")
    @classmethod
    def _power_of_two(cls, value: object) -> object:
        whole = isinstance(value, int) and not isinstance(value, bool)
        if not (value == "auto" or (whole and value > 0 and value & (value - 1) == 0)):  # type: ignore[operator]
            raise ValueError(f"{value!r} is neither a power of 2 nor 'auto'")
        if value != "auto" and value > LARGEST_UPSAMPLE:  # type: ignore[operator]
            raise ValueError(
                f"{value} is above {LARGEST_UPSAMPLE}, with which no record has less than {2 * LARGEST_UPSAMPLE} "
                "samples per peak ('auto' takes what gives 20)"
            )
        return value


class Spectrum(Table):
    """How spectra are estimated: Hann windows, 50 % overlap, constant detrend."""

    segment_s: Positive = Field(default=4.0, description="the length of one segment [s], above 0")
    upper_hz: Positive | None = Field(
        default=None,
        description="the upper frequency [Hz], above 0; left out: 0.4 of the sampling rate or 1.5 x the highest normal "
        "mode, whichever is lower",
    )


class Event(Table):
    """One operating condition: a history that recurs over a share of the mileage, or so many times per 1000 km."""

    name: Text = Field(description="a name of the event, unique in the mission")
    history: Text | None = Field(
        default=None,
        description="the file of the modal coordinates over time (.parquet or .csv); left out: a static load case, "
        "with values of unit loads",
    )
    share: Annotated[float, Field(ge=0, le=1)] | None = Field(
        default=None, description="the share of the mileage [-], 0 to 1; all shares sum to 1"
    )
    speed_km_h: Positive | None = Field(default=None, description="the speed [km/h], above 0")
    length_km: Positive | None = Field(
        default=None, description="the length [km] of the kept part of the history, above 0"
    )
    per_1000_km: NotNegative | None = Field(
        default=None, description="how often the event happens in 1000 km [-], at least 0, instead of a share"
    )
    start_s: NotNegative = Field(
        default=0.0, description="the time [s] cut off at the start of the history, at least 0"
    )
    stress_factor: Positive = Field(default=1.0, description="the factor [-] on all stresses of the event, above 0")
    residue: Residue | None = Field(
        default=None,
        description="the treatment of the residue of this event: 'repeat' or 'half'; left out: that of [counting], "
        "or 'half' for an event counted by number",
    )
    mean_of_q: MeanOfQ | None = Field(
        default=None,
        description="the time means of the modal coordinates of this event: 'keep' or 'remove'; left out: as in "
        "[counting]",
    )
    stints_per_1000_km: NotNegative | None = Field(
        default=None,
        description="how often in 1000 km the event follows on another one [-], in an order that is not known, at "
        "least 0",
    )
    unit_load: Annotated[tuple[GivenLoad, ...], Field(strict=False)] = Field(
        default=(), description="one [[mission.event.unit_load]] table per unit load that the event gives"
    )
    channel: Annotated[tuple[Channel, ...], Field(strict=False)] = Field(
        default=(), description="one [[mission.event.channel]] table per channel that `fatigue ride` looks at"
    )

    @property
    def static_values(self) -> int:
        """How many values a static load case has; 0 of an event with a history."""
        return 0 if self.history else max((len(load.values or ()) for load in self.unit_load), default=0)

    def _contradictions(self) -> Iterator[Problem]:
        yield from path_problems({"history": self.history})
        yield from loads_of_event(self.unit_load, has_history=self.history is not None)
        if self.history is None:
            yield from self._of_a_static_load_case()
        by_share, by_number = self.share is not None, self.per_1000_km is not None
        if by_share and by_number:
            what = f"share = {self.share:g} and per_1000_km = {self.per_1000_km:g} are both given"
            yield clash("share", what, "Keep one of them")
        elif not by_share and not by_number:
            remedy = "Give the share of the mileage, or per_1000_km for an event counted by number"
            yield absent("share", "neither share nor per_1000_km is given", remedy)
        elif by_share and self.speed_km_h is None and self.length_km is None:
            what = f"neither speed_km_h nor length_km is given with share = {self.share:g}"
            yield absent("speed_km_h", what, "Give the speed [km/h] or the length of the kept part [km]")
        for key, value in (("speed_km_h", self.speed_km_h), ("length_km", self.length_km)):
            if by_number and not by_share and value is not None:
                what = f"{value:g} is given for an event counted by number, per_1000_km = {self.per_1000_km:g}"
                yield clash(key, what, "Remove it, or give a share instead of per_1000_km")

    def _of_a_static_load_case(self) -> Iterator[Problem]:
        """Refusals of what an event without history cannot have."""
        if not any(load.values for load in self.unit_load):
            remedy = (
                "Give the file of the modal coordinates over time, or the values of unit loads of a static load case"
            )
            yield absent("history", "the key is missing", remedy)
            return
        if self.share is not None:
            what = f"share = {self.share:g} is given for a static load case, which lasts no time and covers no distance"
            yield clash("share", what, "Give per_1000_km, how often it happens in 1000 km")
        if self.start_s > 0.0:
            what = f"{self.start_s:g} is given for a static load case, which has no start-up"
            yield clash("start_s", what, "Remove it")
        yield from no_channel_of_static_loads(self.channel)


class Mission(Table):
    """What the vehicle does, and how long it has to last."""

    target_km: Positive = Field(description="the target mileage [km], above 0")
    km_per_year: Positive = Field(description="the mileage per year [km], above 0")
    damage_limit: Positive = Field(default=1.0, description="the allowed damage sum [-] at the target mileage, above 0")
    event: Annotated[tuple[Event, ...], Field(strict=False, min_length=1)] = Field(
        description="one [[mission.event]] table per operating condition"
    )
    unit_load: Annotated[tuple[MissionLoad, ...], Field(strict=False)] = Field(
        default=(), description="one [[mission.unit_load]] table per unit load that is constant in the whole mission"
    )
    sequence: Annotated[tuple[Sequence, ...], Field(strict=False)] = Field(
        default=(), description="one [[mission.sequence]] table per known order of events"
    )


class Case(Table):
    """One assessment: body, curve, counting and mission, with the text and the place they came from."""

    title: str = Field(default="Untitled", description="the title of the report")
    body: Body = Field(description="a [body] table")
    curve: Curve = Field(description="a [curve] table")
    curves: dict[str, CustomCurve] = Field(default={}, description="one [curves.<name>] table per curve of your own")
    counting: Counting = Field(default=Counting(), description="a [counting] table")
    spectrum: Spectrum = Field(default=Spectrum(), description="a [spectrum] table")
    multiaxial: Multiaxial = Field(default=Multiaxial(), description="a [multiaxial] table")
    checks: Checks = Field(default=Checks(), description="a [checks] table")
    mission: Mission = Field(description="a [mission] table")
    life_band: LifeBand = Field(default=LifeBand(), description="a [life_band] table")
    ride: Ride = Field(default=Ride(), description="a [ride] table")
    report: Report = Field(default=Report(), description="a [report] table")
    _path: Path = PrivateAttr(Path())
    _text: str = PrivateAttr("")

    def model_post_init(self, context: tuple[Path, str] | None) -> None:
        """Remember the file and its text, where the case comes from one."""
        if context is not None:
            self._path, self._text = context

    @property
    def path(self) -> Path:
        """The case file."""
        return self._path

    @property
    def text(self) -> str:
        """The case file as it was written, comments included."""
        return self._text

    def resolve(self, name: str) -> Path:
        """Path of a file the case names, relative to the folder of the case file."""
        return self._path.parent / name

    def input_files(self) -> dict[str, Path]:
        """Path of every file the case names, by its key: ``body.modes``, ``mission.event[1].history``."""
        body = {f"body.{key}": getattr(self.body, key) for key in BODY_FILES}
        body["body.register"] = self.body.weld_register
        body |= {f"checks.{key}": getattr(self.checks, key) for key in CHECK_FILES}
        for i, load in enumerate(self.body.unit_load, 1):
            body |= {f"body.unit_load[{i}].{key}": getattr(load, key) for key in ("nodal_forces", "element_forces")}
        histories: dict[str, str | None] = {}
        for i, event in enumerate(self.mission.event, 1):
            histories[f"mission.event[{i}].history"] = event.history
            for j, given in enumerate(event.unit_load, 1):
                histories[f"mission.event[{i}].unit_load[{j}].history"] = given.history
        return {key: self.resolve(name) for key, name in (body | histories).items() if name is not None}

    def residue(self, event: Event) -> Residue:
        """Residue rule of an event: its own, else ``half`` where it is counted by number, else as in ``[counting]``."""
        if event.residue is not None:
            return event.residue
        return self.counting.residue if event.per_1000_km is None else "half"

    def mean_of_q(self, event: Event) -> MeanOfQ:
        """What is done with the time means of the modal coordinates of an event: its own rule, else the common one."""
        return self.counting.mean_of_q if event.mean_of_q is None else event.mean_of_q
