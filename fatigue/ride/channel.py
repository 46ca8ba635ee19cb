"""One channel of one event as it is looked at: its samples on a uniform grid, and where on the track they lie."""

import re
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
    ahead_s : time from the first kept sample of the event to its first sample [s]
    place : the place that channels of several directions share; None: as its name says
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
    place: str | None = None
    ahead_s: float = 0.0

    @property
    def duration(self) -> float:
        """Duration [s]: samples times step."""
        return self.values.size * self.step

    @property
    def is_still(self) -> bool:
        """Whether all samples are equal, as those of a sensor that was not connected."""
        return bool(np.ptp(self.values) == 0.0)

    def km(self, seconds: float) -> float:
        """Distance from the first kept sample of the event to so many seconds behind the first sample [km]."""
        return (self.ahead_s + seconds) * self.km_per_s

    @property
    def position(self) -> str:
        """The place it is at: as given, else its name without a last word that is its direction.

        ``floor mid y``, ``floor_mid_y`` and ``floor mid, y`` are at ``floor mid`` and ``floor_mid``.
        """
        if self.place is not None:
            return self.place
        stem = re.sub(rf"[\s_,.:/-]+{self.direction}$", "", self.name, flags=re.IGNORECASE)
        return stem or self.name
