"""Loads beside the modes: a field of nodal forces per unit, and what each event gives of it."""

from typing import Annotated, Literal

from pydantic import Field

from fatigue.case.table import Table, Text

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
    role: Literal["other", "gravity"] = Field(
        default="other", description="what the load is: 'gravity', which the mean of q may hold already, or 'other'"
    )
    when_missing: Literal["error", "zero"] = Field(
        default="error", description="what an event that does not give the load means: 'error' or 'zero'"
    )
    elements_carry_load: bool = Field(
        default=False, description="whether elements of the assessed side carry the load, so that they do not balance"
    )


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


class MissionLoad(Table):
    """What every event that does not give a unit load has of it."""

    name: _Name = Field(description="the name of a [[body.unit_load]]")
    unit: Text = Field(description="the unit of the value, equal to that of the unit load letter by letter")
    constant: float = Field(description="the constant value of the load")
