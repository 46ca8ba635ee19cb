"""Every key of ``vehicle.toml``: what it is, where its reference value is from, and what it may be.

Marks of origin: **P** published for another high-speed vehicle (a study with 17 degrees of freedom, Mathematical
Problems in Engineering 2019, 7163732); **S** the source paper; **K** Hertz and Kalker, rounded; **O** of this project,
plausible and invented; **T** of this project, picked among five combinations. None is a property of a real train.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from fatigue.vehicle.definition import SETTINGS


@dataclass(frozen=True, slots=True)
class Range:
    """Numbers between two bounds; a bound that is ``open`` is none of them."""

    low: float = -math.inf
    high: float = math.inf
    low_open: bool = False
    high_open: bool = False

    def holds(self, value: float) -> bool:
        """Whether a number lies in it; NaN and infinity never do."""
        above = value > self.low if self.low_open else value >= self.low
        below = value < self.high if self.high_open else value <= self.high
        return math.isfinite(value) and above and below

    def __str__(self) -> str:
        """The range in words, as in "above 0 and at most 2"."""
        low = f"{'above' if self.low_open else 'at least'} {self.low:g}" if math.isfinite(self.low) else ""
        high = f"{'below' if self.high_open else 'at most'} {self.high:g}" if math.isfinite(self.high) else ""
        return " and ".join(filter(None, (low, high))) or "finite"


ANY = Range()
POSITIVE = Range(0.0, low_open=True)
NOT_NEGATIVE = Range(0.0)
RATIO = Range(0.0, 1.0, low_open=True, high_open=True)
HEAVY = Range(50.0, 1e5)  # kg: what is below is a mass in t
INERT = Range(5.0, 1e7)  # kg m2: likewise
LONG = Range(0.0, 100.0, low_open=True)  # m: what is above is a length in mm
PLACE = Range(-100.0, 100.0)  # m: likewise
HERTZ = Range(0.01, 1000.0)  # what is outside is a period, or in another unit
CREEP = Range(1e5, 1e10)  # N: what is below is a coefficient in kN or MN


@dataclass(frozen=True, slots=True)
class Key:
    """One key: its ``meaning`` (the unit ends its name), ``origin`` of the reference value, and what it may be.

    ``range`` is of numbers, ``choices`` of names; ``none`` is the word that stands for no value, where leaving the key
    out would mean its default.
    """

    meaning: str
    origin: str
    range: Range = ANY
    choices: tuple[str, ...] = ()
    none: str = ""


def _equipment(mass: str) -> dict[str, Key]:
    return {
        "mass_kg": Key("mass", mass, HEAVY),
        "ixx_kg_m2": Key("moment of inertia about the x axis through its centre of mass", "O", INERT),
        "iyy_kg_m2": Key("the same about y", "O", INERT),
        "izz_kg_m2": Key("the same about z", "O", INERT),
        "x_m": Key("place of its centre of mass along the vehicle", "O", PLACE),
        "fe_hz": Key("lateral frequency of its mounts with the car body held still", "S", HERTZ),
        "y_m": Key("place of its centre of mass across", "O", PLACE),
        "z_m": Key("its height above the rail; the mounts take hold at this height", "O", LONG),
        "fx_hz": Key("longitudinal frequency of its mounts, likewise", "O", HERTZ),
        "fz_hz": Key("vertical frequency of its mounts, likewise", "O", HERTZ),
        "damping_ratio": Key("damping ratio of its mounts", "O", RATIO),
    }


KEYS: Mapping[str, Mapping[str, Key]] = {
    "car": {
        "body": Key("'frame', the built-in frame model, or a folder that `fatigue reduce` wrote", "O"),
        "basis": Key("modal basis of the frame body", "S", choices=("weak", "strong", "residual", "full")),
        "keep_hz": Key("modes of the frame body above are left out; 'all' keeps them", "O", POSITIVE, none="all"),
        "cut_hz": Key("modes of the frame body before its reduction are taken up to here", "O", POSITIVE),
        "floor_z_m": Key("height of the origin of the body's own frame above the rail", "O", LONG),
    },
    "converter": _equipment("S"),
    "transformer": _equipment("S") | {"fe_hz": Key("lateral frequency of its mounts, likewise", "O", HERTZ)},
    "bogie": {
        "mass_kg": Key("mass of one frame", "P", HEAVY),
        "ixx_kg_m2": Key("moment of inertia of the frame about the x axis through its centre of mass", "P", INERT),
        "iyy_kg_m2": Key("the same about y", "P", INERT),
        "izz_kg_m2": Key("the same about z", "P", INERT),
        "z_m": Key("height of its centre of mass above the rail", "O", LONG),
        "spacing_m": Key("distance of the bogie centres", "P", LONG),
        "wheelbase_m": Key("distance 2 a of the wheelsets of a bogie; left out: that of the setting", "P", LONG),
    },
    "wheelset": {
        "mass_kg": Key("mass", "P", HEAVY),
        "izz_kg_m2": Key("moment of inertia about z", "P", INERT),
        "z_m": Key("height of its centre above the rail", "P", LONG),
        "radius_m": Key("rolling radius r0", "P", LONG),
        "half_gauge_m": Key("half the lateral distance b of the rolling circles", "P", LONG),
    },
    "suspension": {
        "setting": Key("values for what is left out below", "S", choices=tuple(SETTINGS)),
        "primary_x_N_m": Key("longitudinal stiffness of an axle box; left out: that of the setting", "S", POSITIVE),
        "primary_y_N_m": Key("lateral stiffness of an axle box; left out: that of the setting", "S", POSITIVE),
        "primary_x_Ns_m": Key("longitudinal damping of an axle box", "O", NOT_NEGATIVE),
        "primary_y_Ns_m": Key("lateral damping of an axle box", "O", NOT_NEGATIVE),
        "primary_z_N_m": Key("vertical stiffness of an axle box", "P", POSITIVE),
        "primary_z_Ns_m": Key("vertical damping of an axle box", "O", NOT_NEGATIVE),
        "primary_half_distance_m": Key("half the lateral distance of the axle boxes", "O", LONG),
        "secondary_x_N_m": Key("longitudinal stiffness between car body and bogie, per side", "O", NOT_NEGATIVE),
        "secondary_x_Ns_m": Key("longitudinal damping, per side", "O", NOT_NEGATIVE),
        "secondary_y_N_m": Key("lateral stiffness, per side", "O", NOT_NEGATIVE),
        "secondary_y_Ns_m": Key("lateral damping, per side", "P", NOT_NEGATIVE),
        "secondary_z_N_m": Key("vertical stiffness, per side", "O", POSITIVE),
        "secondary_z_Ns_m": Key("vertical damping, per side", "O", NOT_NEGATIVE),
        "secondary_half_distance_m": Key("half the lateral distance of these springs at the bogie", "P", LONG),
        "secondary_height_m": Key("their height at the bogie above the rail", "O", LONG),
        "anti_roll_Nm_rad": Key("stiffness of the anti-roll bar of a bogie", "O", NOT_NEGATIVE),
        "yaw_damper_N_m": Key("series stiffness of a yaw damper; left out: that of the setting", "T", POSITIVE),
        "yaw_damper_Ns_m": Key("damping of a yaw damper; left out: that of the setting", "T", POSITIVE),
        "yaw_damper_half_distance_m": Key("half the lateral distance of the yaw dampers", "P", LONG),
        "yaw_damper_height_m": Key("their height above the rail", "O", LONG),
    },
    "contact": {
        "state": Key("'sound', or 'worn' in the worn sections of a run", "S", choices=("sound", "worn")),
        "conicity": Key("equivalent conicity lambda", "S", Range(0.0, 2.0, low_open=True)),
        "worn_conicity": Key(
            "conicity lambda0 of worn wheels at small amplitude; left out: that of the setting",
            "O",
            Range(0.0, 5.0, low_open=True),
        ),
        "worn_amplitude_mm": Key("amplitude s0 from which it falls towards lambda", "O", POSITIVE),
        "worn_sections_m": Key("where the contact is worn: a list of pairs [begin, end]", "O", NOT_NEGATIVE),
        "worn_ramp_m": Key("length of the ramp inside either end of a section", "O", POSITIVE),
        "f11_N": Key("longitudinal creep coefficient of a wheel", "K", CREEP),
        "f22_N": Key("lateral creep coefficient of a wheel", "K", CREEP),
        "f23_Nm": Key("lateral and spin creep coefficient of a wheel", "K", NOT_NEGATIVE),
        "load_N": Key("load W of a wheel", "K", NOT_NEGATIVE),
        "contact_angle_rate": Key("contact angle parameter epsilon", "O", NOT_NEGATIVE),
        "flange_clearance_mm": Key("displacement at which the flange meets the rail, in runs", "O", POSITIVE),
        "flange_N_m": Key("stiffness of flange and rail, in runs", "O", NOT_NEGATIVE),
        "saturation_mu": Key("coefficient of friction of creep saturation, in runs; left out: none", "O", POSITIVE),
    },
    "track": {
        "quality": Key("spectrum of ERRI B176", "S", choices=("low", "high")),
        "longest_m": Key("wavelengths above are cut off", "S", POSITIVE),
        "weakened_below_m": Key("shorter wavelengths are weakened, as after grinding", "S", NOT_NEGATIVE),
        "distance_m": Key("length of a run", "S", Range(0.0, 1e6, low_open=True)),
    },
    "run": {
        "speed_km_h": Key("speed", "S", Range(0.0, 1000.0, low_open=True)),
        "seed": Key("seed of the random irregularities", "O", NOT_NEGATIVE),
        "step_s": Key("time step", "O", Range(0.0, 0.01, low_open=True)),
        "dropped_s": Key("beginning of a run that is not judged", "O", NOT_NEGATIVE),
    },
}
OF_SETTING = (
    "suspension.primary_x_N_m",
    "suspension.primary_y_N_m",
    "suspension.yaw_damper_N_m",
    "suspension.yaw_damper_Ns_m",
    "bogie.wheelbase_m",
)
