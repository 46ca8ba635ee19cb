"""Columns of what channels of a ride say: hunting, coincidence, alarm, comfort, equipment, running behaviour."""

from fatigue.results.dictionary.column import POINT, Column

_EVENT = Column("event", "text", "-", "event of the mission")
_CHANNEL = Column("channel", "text", "-", "channel of the event")

FLUTTER = (
    _EVENT,
    _CHANNEL,
    Column("start_km", "float", "km", "start of the stretch, from the first kept sample; empty if counted by number"),
    Column("end_km", "float", "km", "end of the stretch; empty if counted by number"),
    Column("start_s", "float", "s", "file time at the start of the stretch"),
    Column("end_s", "float", "s", "file time at the end of the stretch"),
    Column("frequency_hz", "float", "Hz", "dominant frequency in the band of hunting: median over the stretch"),
    Column("share", "float", "-", "power within 0.5 Hz of that frequency over the power of the band, median"),
    Column("rms", "float", "-", "rms in the band over the stretch; m/s2 of an acceleration"),
    Column("peak", "float", "-", "largest value in the band over the stretch; m/s2 of an acceleration"),
    Column("hot", "flag", "-", "rms above hot_factor medians and share above hot_share, long enough"),
    Column("reason", "text", "-", "why a number is empty, or what it is to be read with"),
)

FLUTTER_TRACK = (
    _EVENT,
    _CHANNEL,
    Column("time_s", "float", "s", "file time at the middle of a slice of 2 s; there is one every 0.25 s"),
    Column("km", "float", "km", "the same as distance from the first kept sample; empty if counted by number"),
    Column("frequency_hz", "float", "Hz", "dominant frequency in the band of hunting"),
    Column("share", "float", "-", "power within 0.5 Hz of it over the power of the band"),
    Column("rms", "float", "-", "rms in the band; m/s2 of an acceleration"),
    Column("reference_rms", "float", "-", "what the rms is compared with: that of the case, or the median"),
    Column("hot", "flag", "-", "the slice belongs to a hot stretch"),
)

STATIONARITY = (
    _EVENT,
    _CHANNEL,
    Column("segments", "int", "-", "segments whose mean squares are compared; 0 where the test cannot be made"),
    Column("segment_s", "float", "s", "length of a segment: 2 s, or 3 over the bandwidth"),
    Column("bandwidth_hz", "float", "Hz", "statistical bandwidth, (integral of G)^2 over the integral of G^2"),
    Column("dispersion_ratio", "float", "-", "variance of the mean squares over that of a stationary Gaussian record"),
    Column("p", "float", "-", "probability of a ratio at least as large by chance"),
    Column("kurtosis", "float", "-", "fourth moment over the squared variance: 3 of a Gaussian record"),
    Column("crest", "float", "-", "largest absolute value over the rms"),
    Column("expected_crest", "float", "-", "the same to be expected of a Gaussian record"),
    Column(
        "assumptions",
        "text",
        "-",
        "of the frequency domain: hold, violated (p < 0.01, kurtosis > 4 or < 2, crest > 1.3 of the expected one)",
    ),
    Column("reason", "text", "-", "what violates them, or why a number is empty"),
)

COINCIDENCE = (
    _EVENT,
    Column("channel", "text", "-", "channel whose hunting is compared"),
    Column("equipment", "text", "-", "mode of equipment"),
    Column("f_hunt_hz", "float", "Hz", "dominant frequency of the hot stretches, or of the whole event without any"),
    Column("frequency_hz", "float", "Hz", "frequency of the equipment mode"),
    Column("damping_ratio", "float", "-", "damping ratio of the equipment mode"),
    Column("amplification", "float", "-", "dynamic amplification of the equipment mode at f_hunt_hz"),
    Column("within", "text", "-", "where f_hunt_hz, coherence and phase are from: hot stretches or the event"),
    Column("coherence", "float", "-", "mean coherence with the channel of the equipment, f_hunt_hz +- 0.5 Hz"),
    Column("averages", "float", "-", "independent segments of 2 s that it rests on"),
    Column("chance_coherence", "float", "-", "what unrelated channels stay below in 95 of 100 cases at any frequency"),
    Column("coherence_event", "float", "-", "the coherence over the whole event"),
    Column("phase_deg", "float", "deg", "phase of the equipment behind the channel at f_hunt_hz; empty: none"),
    Column("oscillator_phase_deg", "float", "deg", "the same of the mode alone: near 90 at resonance"),
    Column("flag", "text", "-", "red: closer than max(1 Hz, 2 zeta f_e); amber: amplification above 1.5; else green"),
    Column("reason", "text", "-", "why a number is empty"),
)

ALARM = (
    _EVENT,
    _CHANNEL,
    Column("alarms", "int", "-", "how often the alarm would have gone off"),
    Column("peak_m_s2", "float", "m/s2", "largest half-cycle peak in the band of the alarm"),
    Column("first_alarm_s", "float", "s", "file time at which it goes off first; empty: never"),
    Column("longest_run", "float", "-", "most cycles in a row that reach the threshold"),
    Column("threshold_m_s2", "float", "m/s2", "threshold of the rule"),
    Column("cycles", "int", "-", "cycles in a row of the rule"),
    Column("hot_km_share", "float", "-", "share of the event that lies in hot stretches of the channel"),
    Column("damage_share_inside_hot", "float", "-", "of the event's damage at its worst weld: share there"),
    Column("told", "text", "-", "whether the alarm tells the damage: yes, missed, nothing_to_tell, no_hot_stretch"),
    Column("reason", "text", "-", "why a number is empty, or what it is to be read with"),
)

HOT_DAMAGE = (
    *POINT,
    _EVENT,
    _CHANNEL,
    Column("damage_per_km", "float", "1/km", "damage of the event per km of the mission"),
    Column("damage_per_km_inside", "float", "1/km", "of it, in hot stretches of the channel"),
    Column("share_inside", "float", "-", "the same over the damage of the event"),
    Column("length_share_inside", "float", "-", "share of the event's length in hot stretches"),
    Column("intensity", "float", "-", "damage per length inside over that outside; empty where nothing is outside"),
)

COMFORT = (
    _EVENT,
    Column("channel", "text", "-", "channel of the floor, or the place whose directions are taken together"),
    Column("direction", "text", "-", "x, y or z; xyz: all three"),
    Column("index", "text", "-", "sperling_wz, sperling_wz_ride_quality, en12299_rms_p95 [m/s2], en12299_n_mv"),
    Column("form", "text", "-", "filter or line of Sperling's index; weighting by EN 12299"),
    Column("band_hz", "text", "Hz", "band of frequencies that counts"),
    Column("block_s", "float", "s", "length of a block; empty where the record is taken whole"),
    Column("value", "float", "-", "the index: of the record, or the mean over its blocks or sections of 5 min"),
    Column("highest", "float", "-", "the index of the worst block or section; empty where the record is taken whole"),
    Column("short_record", "flag", "-", "the record is shorter than the index asks for"),
    Column("edition", "text", "-", "where the index is from, its edition, and whether its constants are recalled"),
    Column("reason", "text", "-", "why a number is empty, or what it is to be read with"),
)

EQUIPMENT = (
    _EVENT,
    _CHANNEL,
    Column("direction", "text", "-", "x along the track, y transverse or z vertical"),
    Column("class", "text", "-", "category and class of the table of limits; empty: none is given"),
    Column("edition", "text", "-", "edition of the table, whether it is superseded, and its status"),
    Column("band_hz", "text", "Hz", "band that the mass of the equipment leaves, as far as the record goes"),
    Column("rms_m_s2", "float", "m/s2", "rms in the band"),
    Column("limit_m_s2", "float", "m/s2", "functional rms of the table, over the whole of its spectrum"),
    Column("band_limit_m_s2", "float", "m/s2", "rms that the functional spectrum of the table has in the band"),
    Column("asd_ratio", "float", "-", "largest ratio of the spectral density to that of the table, in third octaves"),
    Column("asd_ratio_hz", "float", "Hz", "centre of the third octave of the largest ratio"),
    Column("peak_m_s2", "float", "m/s2", "largest deviation from the mean of the record"),
    Column("long_life_rms_m_s2", "float", "m/s2", "rms of the simulated long life of the table"),
    Column("peak_ratio", "float", "-", "peak over three times the rms of the long life"),
    Column("shock_m_s2", "float", "m/s2", "peak of the shock pulse of the table"),
    Column("reason", "text", "-", "why a number is empty, or what it is to be read with"),
)

RUNNING = (
    _EVENT,
    _CHANNEL,
    Column("direction", "text", "-", "x along the track, y lateral or z vertical"),
    Column("quantity", "text", "-", "body_percentile, body_rms, instability_frequency, sliding_rms, bogie_peak"),
    Column("band_hz", "text", "Hz", "band of frequencies that counts"),
    Column("value", "float", "-", "its value: the largest of all sections or windows"),
    Column("unit", "text", "-", "its unit"),
    Column("mean", "float", "-", "mean over the sections or windows"),
    Column("sections", "int", "-", "how many sections or windows there are"),
    Column("length_m", "float", "m", "length of a section or window"),
    Column("limit", "float", "-", "its limit, recalled; empty: none"),
    Column("edition", "text", "-", "where the limit is from, its edition and its status"),
    Column("reason", "text", "-", "why a number is empty, or what it is to be read with"),
)

RIDDEN: dict[str, tuple[Column, ...]] = {
    "flutter": FLUTTER,
    "flutter_track": FLUTTER_TRACK,
    "stationarity": STATIONARITY,
    "coincidence": COINCIDENCE,
    "alarm": ALARM,
    "hot_damage": HOT_DAMAGE,
    "comfort": COMFORT,
    "equipment": EQUIPMENT,
    "running": RUNNING,
}
