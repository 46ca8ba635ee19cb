"""One channel of one event as it is looked at: its samples on a uniform grid, and where on the track they lie."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class ChannelRecord:
    """The kept samples of a channel.

    Attributes
    ----------
    event, name : the event and the channel
    role : bogie, equipment, floor or other
    direction : x, y or z
    is_acceleration : whether its values are [m/s2]; else they have a unit of their own
    values : (n,) samples, scaled
    step : time step [s]
    start : file time of the first sample on the clock of the event's history [s]
    km_per_s : distance per time [km/s]; NaN of an event counted by number
    """

    event: str
    name: str
    role: str
    direction: str
    is_acceleration: bool
    values: NDArray[np.float64]
    step: float
    start: float
    km_per_s: float

    @property
    def duration(self) -> float:
        """Duration [s]: samples times step."""
        return self.values.size * self.step
