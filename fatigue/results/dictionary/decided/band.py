"""Columns of ``band.parquet``: the life of a point as a band, and the survival of its line of weld."""

from fatigue.results.dictionary.column import POINT, Column

BAND = (
    *POINT,
    Column("life_km", "float", "km", "the life that was assessed, on the curve at its survival level"),
    Column(
        "se_load",
        "float",
        "-",
        "relative standard error of the damage from one record to the next, from 30 pieces of the records",
    ),
    Column("dof", "float", "-", "degrees of freedom of it: 5 of one event, more where several share the damage"),
    Column("life_km_load_low", "float", "km", "lower end of the 90 % band of life_km by the load alone"),
    Column("life_km_load_high", "float", "km", "upper end of the same band"),
    Column(
        "life_km_p50", "float", "km", "median life: mean curve, median damage sum; empty on a curve without scatter"
    ),
    Column("life_km_p90", "float", "km", "life that 90 % reach, by the scatter of load, S-N curve and damage sum"),
    Column("life_km_p97_7", "float", "km", "life that 97.725 % reach; life_km if the S-N curve alone scattered"),
    Column("life_km_p99", "float", "km", "life that 99 % reach"),
    Column(
        "band_reason",
        "text",
        "-",
        "why there is no band: screened, no_damage, shear, short_record, single_pass, across_events; non_stationary: "
        "there is one, and it is at least this wide; empty: there is one",
    ),
    Column("sigma_ln_N", "float", "-", "standard deviation of ln N of the S-N curve; empty: the curve has no scatter"),
    Column(
        "line_survival_at_target",
        "float",
        "-",
        "probability that the whole line of weld on this face survives the target, the same in all its rows; empty "
        "without reference_length_mm and dependence",
    ),
    Column("line_life_km_p50", "float", "km", "life that half of all such lines reach"),
    Column(
        "line_reason",
        "text",
        "-",
        "why there is no survival of the line: not_asked, no_toe, no_scatter, histograms, or the band_reason of its "
        "worst point",
    ),
)
