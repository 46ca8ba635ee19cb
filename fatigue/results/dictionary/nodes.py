"""Columns of ``nodes.parquet``: the whole mission at every point."""

from fatigue.results.dictionary.column import POINT, Column

NODES = (
    *POINT,
    Column("toe", "flag", "-", "the face carries a weld toe; a face without one never governs"),
    Column("arc_length_mm", "float", "mm", "distance along the part from its first node"),
    Column("x_mm", "float", "mm", "position"),
    Column("y_mm", "float", "mm", "position"),
    Column("z_mm", "float", "mm", "position"),
    Column("thickness_mm", "float", "mm", "thickness of the assessed plate"),
    Column("damage_per_km", "float", "1/km", "Miner sum per km of the mission, rainflow, bending ratio of each cycle"),
    Column("life_km", "float", "km", "damage limit / damage_per_km; infinite where nothing damages"),
    Column("life_years", "float", "a", "life_km / km_per_year of the mission"),
    Column("utilisation", "float", "-", "Miner sum at target_km / damage limit"),
    Column("fulfilled", "flag", "-", "utilisation <= 1"),
    Column(
        "load_factor",
        "float",
        "-",
        "largest factor on all stresses, dead load included, up to which the target is met; infinite where nothing "
        "damages; a lower bound where a bound stands for counting",
    ),
    Column(
        "life_km_dirlik",
        "float",
        "km",
        "life by Dirlik's formula with one bending ratio per event, events with a spectrum, without mean stress and "
        "without sequences; empty where the spectra miss more than 90 % of the damage (dirlik_verdict outside_band)",
    ),
    Column("life_km_tb", "float", "km", "life by Tovo-Benasciutti 2005, likewise; empty where that by Dirlik is"),
    Column("life_km_same_ratio", "float", "km", "rainflow life, likewise"),
    Column("dirlik_ratio", "float", "-", "D_dirlik / D_rainflow at the same bending ratio"),
    Column(
        "dirlik_verdict",
        "text",
        "-",
        "may the frequency domain be trusted here: not_assessed, valid, or the first reason why not (outside_band, "
        "sampling, quasi_static, single_event, non_stationary, harmonic, non_gaussian, bandwidth), of the event with "
        "the largest share of the damage; outside_band too where all spectra together miss too much",
    ),
    Column("max_range_MPa", "float", "MPa", "largest structural stress range of all events and sequences"),
    Column(
        "equivalent_range_2e6_MPa",
        "float",
        "MPa",
        "(sum n S^k / 2e6)^(1/k) over target_km, k the first slope: the constant structural stress range that does the "
        "same in 2e6 cycles on one slope, sequences included; knees, mean stress and scatter of the bending ratio left "
        "out",
    ),
    Column(
        "mean_stress_MPa",
        "float",
        "MPa",
        "time mean of the structural stress in the governing event, constants included; empty where a sequence governs",
    ),
    Column("R_largest_cycle", "float", "-", "minimum / maximum structural stress of the largest cycle of all"),
    Column(
        "damage_factor_if_mean_stress",
        "float",
        "-",
        "damage with the ASME mean-stress factor / without; 1 where it is on, empty on curves in structural stress",
    ),
    Column("shear_ratio", "float", "-", "rms shear stress / rms structural stress in the governing event"),
    Column(
        "damage_factor_if_shear",
        "float",
        "-",
        "damage with shear combined as in ASME VIII-2 5.5.5.3 / without; empty with sequences: what shear adds to a "
        "cycle between two events is not known",
    ),
    Column(
        "governing_event",
        "text",
        "-",
        "event with the largest share of the damage, or the sequence whose cycles across events have it",
    ),
    Column("bending_ratio", "float", "-", "std(sigma_b) / (std(sigma_m) + std(sigma_b)) in the governing event"),
    Column(
        "damage_per_km_transitions",
        "float",
        "1/km",
        "part of damage_per_km from cycles across the events of sequences, less those they replace; may be negative; "
        "empty without sequences",
    ),
    Column(
        "damage_per_km_transitions_bound",
        "float",
        "1/km",
        "what no order of the events with stints_per_1000_km adds more than; not in damage_per_km; empty without them",
    ),
    Column(
        "life_km_raw_end",
        "float",
        "km",
        "life without the end treatment; empty where it is proven to use up a small share of the limit (screening)",
    ),
    Column(
        "shear_required",
        "flag",
        "-",
        "the largest range of the shear is above a third of the largest structural stress range (ASME VIII-2 5.5.5.3); "
        "empty on a face without a toe, where a bound stands for counting and leaves it open, and with shear off",
    ),
    Column(
        "multiaxial_status",
        "text",
        "-",
        "what tells how shear and normal stress together meet the target: settled_fails (the normal stress alone "
        "fails), settled_passes (multiaxial_bound and utilisation_asme are at most 1), fails (the most distant pair of "
        "instants alone does) or counted (the path counter)",
    ),
    Column(
        "multiaxial_bound",
        "float",
        "-",
        "proven upper bound of utilisation_path_range, and so of what any pairing by range or the path counter's "
        "ranges can make of it; not of length and mlp; infinite where the mean-stress factor may apply",
    ),
    Column(
        "utilisation_path_range",
        "float",
        "-",
        "Miner sum of the half cycles of the path of normal stress and shear at target_km / damage limit, by range, "
        "cycles of sequences across events by normal stress included; empty where the path was not counted",
    ),
    Column("utilisation_path_length", "float", "-", "likewise, each range times its path factor"),
    Column(
        "utilisation_path_mlp", "float", "-", "likewise, each range times 1 + alpha path moment; empty without alpha"
    ),
    Column(
        "utilisation_asme",
        "float",
        "-",
        "likewise, the cycles of the normal stress with shear combined as in ASME VIII-2 5.5.5.3; an upper bound where "
        "one stands for counting",
    ),
    Column(
        "path_factor_largest", "float", "-", "length / range of the half cycle with the largest range of all events"
    ),
    Column("path_moment_largest", "float", "-", "path moment of that half cycle: 0 in phase, 1 on a circle"),
    Column(
        "multiaxial_verdict",
        "text",
        "-",
        "passes (all sums at most 1), fails (the sum by range is above 1), model_dependent (that one is not, another "
        "is), settled_passes or settled_fails",
    ),
    Column("at_end", "flag", "-", "inside the treated zone of a weld end, or the end node itself"),
    Column("at_corner", "flag", "-", "at a kink of the weld line above 30 degrees"),
    Column(
        "summed_corner",
        "flag",
        "-",
        "at a kink where the nodal forces of both legs are one sum: the stress there is of neither leg, and unbounded",
    ),
    Column("curve_status", "text", "-", "what the S-N curve of the weld rests on, as in welds.parquet"),
    Column(
        "screened",
        "text",
        "-",
        "empty: counted exactly; else the tier of the proven bound that stands for counting, in some events at least",
    ),
)
