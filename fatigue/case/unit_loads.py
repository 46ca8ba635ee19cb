"""Loads beside the modes: a field of nodal forces per unit, and what each event gives of it."""

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from fatigue.case.problems import absent, clash, path_problems
from fatigue.case.table import Table, Text
from fatigue.errors import Problem

WAYS = ("history", "constant", "values")  # in which an event gives a load, one of them
FEWEST_VALUES = 2  # of a static load case
_Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]


class UnitLoad(Table):
    """A load of the body beside its modes: one more coordinate."""

    name: _Name = Field(description="a name of the unit load, unique: a letter, then letters, digits and _")
    unit: Text = Field(description="the unit the forces are for, as in 'kPa'")
    nodal_forces: Text | None = Field(
        default=None, description="the file of nodal forces [N, N mm] per unit, with a column unit_load"
    )
    element_forces: Text | None = Field(
        default=None, description="the file of element nodal forces [N, N mm] per unit, with a column unit_load"
    )
    gauge_forces: Text | None = Field(
        default=None, description="the file of its element forces under strain gauges, where those are nodal forces"
    )
    role: Literal["other", "gravity"] = Field(
        default="other", description="what the load is: 'gravity', which the mean of q may hold already, or 'other'"
    )
    when_missing: Literal["error", "zero"] = Field(
        default="error", description="what an event that does not give the load means: 'error' or 'zero'"
    )
    elements_carry_load: bool = Field(
        default=False, description="whether elements of the assessed side carry the load, so that they do not balance"
    )

    @property
    def forces(self) -> str:
        """The file of its forces."""
        return self.nodal_forces or self.element_forces or ""

    def _contradictions(self) -> Iterator[Problem]:
        files = ("nodal_forces", "element_forces", "gauge_forces")
        yield from path_problems({key: getattr(self, key) for key in files})
        if self.nodal_forces and self.element_forces:
            yield clash("nodal_forces", "nodal_forces and element_forces are both given", "Keep one of them")
        if not self.nodal_forces and not self.element_forces:
            remedy = "Give the file of its forces, of the same form as those of the modes"
            yield absent("nodal_forces", "neither nodal_forces nor element_forces is given", remedy)


class GivenLoad(Table):
    """What one event gives of a unit load."""

    name: _Name = Field(description="the name of a [[body.unit_load]]")
    unit: Text = Field(description="the unit of the values, equal to that of the unit load letter by letter")
    history: Text | None = Field(default=None, description="the file of the load over time (.parquet or .csv)")
    constant: float | None = Field(default=None, description="the constant value of the load")
    values: Annotated[tuple[float, ...], Field(strict=False)] | None = Field(
        default=None, description="a list of the values of a static load case, two or more"
    )
    column: Text | None = Field(default=None, description="the column of the history, by default u_<name>")
    scale: float = Field(default=1.0, description="the factor [-] on the values")
    shift_s: float = Field(default=0.0, description="the time [s] added to the times of the history")
    interpolation: Literal["fourier", "linear"] = Field(
        default="fourier", description="how the load is read between its samples: 'fourier' or 'linear'"
    )

    @property
    def own_column(self) -> str:
        """The column of its history."""
        return self.column or f"u_{self.name}"

    def _contradictions(self) -> Iterator[Problem]:
        yield from path_problems({"history": self.history})
        given = [key for key in WAYS if getattr(self, key) is not None]
        if not given:
            remedy = "Give one of them; without this table the column u_<name> of the event's history is read"
            yield absent("history", f"none of {', '.join(WAYS)} is given", remedy)
        if len(given) > 1:
            yield clash(given[1], f"{' and '.join(given)} are given together", "Keep one of them")
        if self.values is not None and len(self.values) < FEWEST_VALUES:
            what = f"{list(self.values)} has fewer than {FEWEST_VALUES} values"
            yield clash("values", what, "Give the load before and after, or a constant")
        if self.scale == 0.0:
            yield clash("scale", "0 takes the load out", "Give constant = 0.0 instead")
        if self.history is None:
            for key in ("column", "shift_s", "interpolation"):
                if key in self.model_fields_set:
                    yield clash(key, f"{key} is given without a history", "Remove it, or give the history of the load")


class MissionLoad(Table):
    """What every event that does not give a unit load has of it."""

    name: _Name = Field(description="the name of a [[body.unit_load]]")
    unit: Text = Field(description="the unit of the value, equal to that of the unit load letter by letter")
    constant: float = Field(description="the constant value of the load")
