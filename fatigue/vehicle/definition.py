"""What a vehicle is: the tables and keys of ``vehicle.toml``, with the reference trailer as defaults.

Units SI; speeds in km/h. x forward, y left, z up from rail top, origin at mid vehicle. The origin of every number
stands in the docs page of the vehicle: published for another vehicle, from the source paper, or invented.
"""

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Car:
    """The car body: the built-in frame model, or a folder that ``fatigue reduce`` wrote."""

    body: str = "frame"
    basis: str = "weak"  # of the frame body: weak | strong | residual | full
    keep_hz: float | None = 25.0  # of the frame body: modes above are left out; None keeps all
    cut_hz: float = 60.0  # of the frame body: fixed-interface (weak, strong) or normal (residual) modes up to here
    floor_z_m: float = 1.15  # height of the origin of the body's own frame above rail top


@dataclass(frozen=True, slots=True)
class Equipment:
    """Equipment on four mounts: its rigid body, and the frequencies its mounts have with the body held still."""

    mass_kg: float
    ixx_kg_m2: float
    iyy_kg_m2: float
    izz_kg_m2: float
    x_m: float
    fe_hz: float  # lateral
    y_m: float = 0.0
    z_m: float = 0.75
    fx_hz: float = 12.0
    fz_hz: float = 9.0
    damping_ratio: float = 0.05


def converter() -> Equipment:
    """The traction converter of the reference trailer."""
    return Equipment(6600.0, 2500.0, 9000.0, 10_000.0, x_m=0.0, fe_hz=9.2)


def transformer() -> Equipment:
    """The transformer of the reference trailer."""
    return Equipment(1600.0, 300.0, 700.0, 800.0, x_m=4.375, fe_hz=11.0)


@dataclass(frozen=True, slots=True)
class Bogie:
    """One of two bogie frames."""

    mass_kg: float = 3000.0
    ixx_kg_m2: float = 2106.0
    iyy_kg_m2: float = 2600.0
    izz_kg_m2: float = 2600.0
    z_m: float = 0.55
    spacing_m: float = 17.5
    wheelbase_m: float | None = None  # 2 a; None: of the setting of the suspension


@dataclass(frozen=True, slots=True)
class Wheelset:
    """One of four wheelsets."""

    mass_kg: float = 1900.0
    izz_kg_m2: float = 1029.0
    z_m: float = 0.46
    radius_m: float = 0.46  # r0
    half_gauge_m: float = 0.7465  # b, half the lateral distance of the rolling circles


@dataclass(frozen=True, slots=True)
class Suspension:
    """Springs and dampers. ``None`` takes the value of the ``setting``: hard | mid | soft | long_wheelbase."""

    setting: str = "hard"
    primary_x_N_m: float | None = None
    primary_y_N_m: float | None = None
    primary_x_Ns_m: float = 2e4
    primary_y_Ns_m: float = 1e4
    primary_z_N_m: float = 1.1e6
    primary_z_Ns_m: float = 15e3
    primary_half_distance_m: float = 1.0
    secondary_x_N_m: float = 0.2e6
    secondary_x_Ns_m: float = 0.0
    secondary_y_N_m: float = 0.2e6
    secondary_y_Ns_m: float = 15e3
    secondary_z_N_m: float = 0.3e6
    secondary_z_Ns_m: float = 15e3
    secondary_half_distance_m: float = 1.23
    secondary_height_m: float = 0.95
    anti_roll_Nm_rad: float = 2.0e6
    yaw_damper_N_m: float | None = None
    yaw_damper_Ns_m: float | None = None
    yaw_damper_half_distance_m: float = 1.35
    yaw_damper_height_m: float = 0.55


@dataclass(frozen=True, slots=True)
class Contact:
    """Wheel and rail: linear creep, and what worn treads, flange and saturation add in a run."""

    state: str = "sound"  # sound | worn
    conicity: float = 0.10  # lambda, equivalent
    worn_conicity: float | None = None  # lambda0 at small amplitude; None: of the setting of the suspension
    worn_amplitude_mm: float = 2.0  # s0
    worn_sections_m: tuple[tuple[float, float], ...] = ((1500.0, 2100.0), (3000.0, 3600.0))
    worn_ramp_m: float = 20.0
    f11_N: float = 10e6  # per wheel, as all of these
    f22_N: float = 9e6
    f23_Nm: float = 2e4
    load_N: float = 65e3  # W
    contact_angle_rate: float = 0.05  # eps
    flange_clearance_mm: float = 8.0
    flange_N_m: float = 5e6
    saturation_mu: float | None = None  # None: no saturation


@dataclass(frozen=True, slots=True)
class Track:
    """Irregularities of the rail, ERRI B176."""

    quality: str = "low"  # low | high
    longest_m: float = 100.0
    weakened_below_m: float = 3.0
    distance_m: float = 5000.0


@dataclass(frozen=True, slots=True)
class Run:
    """A ride over the track."""

    speed_km_h: float = 350.0
    seed: int = 1
    step_s: float = 1e-3
    dropped_s: float = 3.0


@dataclass(frozen=True, slots=True)
class Vehicle:
    """The whole of ``vehicle.toml``."""

    car: Car = field(default_factory=Car)
    converter: Equipment = field(default_factory=converter)
    transformer: Equipment = field(default_factory=transformer)
    bogie: Bogie = field(default_factory=Bogie)
    wheelset: Wheelset = field(default_factory=Wheelset)
    suspension: Suspension = field(default_factory=Suspension)
    contact: Contact = field(default_factory=Contact)
    track: Track = field(default_factory=Track)
    run: Run = field(default_factory=Run)


@dataclass(frozen=True, slots=True)
class Setting:
    """What the values left out of suspension, bogie and contact are in a setting."""

    primary_x_N_m: float
    primary_y_N_m: float
    yaw_damper_N_m: float = 16e6
    yaw_damper_Ns_m: float = 1.0e6
    wheelbase_m: float = 2.5
    worn_conicity: float = 1.2


SETTINGS = {
    "hard": Setting(120e6, 12.5e6),
    "mid": Setting(40e6, 8e6, worn_conicity=0.9),
    "soft": Setting(15e6, 6e6, worn_conicity=0.9),
    "long_wheelbase": Setting(120e6, 12.5e6, yaw_damper_N_m=8e6, yaw_damper_Ns_m=0.5e6, wheelbase_m=2.7),
}
