"""Columns of what is checked at a weld beside the normal stress at its toe."""

from fatigue.results.dictionary.column import POINT, Column

CHECKS = (
    Column("weld", "text", "-", "weld line; empty for a stress point that belongs to none"),
    Column("part", "int", "-", "straight part of a weld split at its kinks, from 1; empty for a stress point"),
    Column("order", "int", "-", "position along the weld line, as given; empty for a stress point"),
    Column("point", "text", "-", "stress point, or of an interaction or endurance check the point it is at"),
    Column(
        "check",
        "text",
        "-",
        "toe_multiaxial, throat_perp, throat_par, throat_root, hot_spot, nominal, parent, interaction or endurance",
    ),
    Column("side", "text", "-", "side of the plate a weld is on: top or bottom"),
    Column("surface", "text", "-", "surface of the plate or of the throat the stress is at"),
    Column("direction_deg", "float", "deg", "direction of the stress that decides, where directions are searched"),
    Column("component", "text", "-", "what is counted: the stress, or the combination of stresses"),
    Column("curve", "text", "-", "S-N curve or endurance line"),
    Column("curve_status", "text", "-", "what its numbers rest on: verified, cross-checked, user or unverified"),
    Column("edition", "text", "-", "edition of the curve or line"),
    Column("range_max_MPa", "float", "MPa", "largest range of the stress in all events, or between static load cases"),
    Column("damage_per_km", "float", "1/km", "Miner sum per km of the mission; empty where nothing is counted"),
    Column("life_km", "float", "km", "damage limit / damage_per_km; empty where nothing is counted"),
    Column("damage_sum", "float", "-", "Miner sum at target_km"),
    Column("damage_limit", "float", "-", "largest Miner sum allowed"),
    Column("utilisation_damage", "float", "-", "damage_sum / damage_limit"),
    Column(
        "utilisation_stress",
        "float",
        "-",
        "1 / the largest factor on all stresses up to which the target is met; of an endurance check stress / allowed",
    ),
    Column("limit_value", "float", "-", "value of a combination that may not be exceeded, else 1"),
    Column("value", "float", "-", "value of a combination or interaction, which limit_value is for"),
    Column("normal_part", "float", "-", "what the normal stress adds to an interaction: damage sum, of iiw u_sigma^2"),
    Column("shear_part", "float", "-", "what the shear stress adds to an interaction: damage sum, of iiw u_tau^2"),
    Column(
        "R", "float", "-", "stress ratio of the two static load cases; of shear, the larger magnitude is the maximum"
    ),
    Column("amplitude_MPa", "float", "MPa", "stress amplitude between the two static load cases"),
    Column("allowed_amplitude_MPa", "float", "MPa", "amplitude that the endurance line allows at this R"),
    Column(
        "plane_range_MPa",
        "float",
        "MPa",
        "largest distance of two static load cases in the plane of normal stress and sqrt(3) shear; for comparison",
    ),
    Column("fulfilled", "flag", "-", "the check is met; empty where it is not assessed"),
    Column("governing_event", "text", "-", "event with the largest share of the damage, or pair of static load cases"),
    Column("note", "text", "-", "what a reader has to know, and why a check is not assessed"),
)

PATH_CYCLES = (
    *POINT,
    Column("event", "text", "-", "event of the mission"),
    Column("start_s", "float", "s", "file time at which the half cycle begins"),
    Column("end_s", "float", "s", "file time at which it ends; before start_s: it wraps past the end"),
    Column("range_MPa", "float", "MPa", "distance of its ends in the plane of normal stress and sqrt(beta) shear"),
    Column("path_factor", "float", "-", "length of its path / range, at least 1"),
    Column("path_moment", "float", "-", "area moment of its path over that of a half circle"),
    Column("normal_range_MPa", "float", "MPa", "structural stress range between its ends"),
    Column("shear_range_MPa", "float", "MPa", "shear stress range between its ends"),
    Column("bending_ratio", "float", "-", "bending / (membrane + bending) range of the normal stress"),
    Column("shear_bending_ratio", "float", "-", "twist / (in-plane + twist) range of the shear stress"),
    Column(
        "equivalent_range_dS",
        "float",
        "MPa mm^-0.222",
        "combined equivalent range x of its ends, by range (MPa on curves in structural stress)",
    ),
    Column("damage", "float", "-", "0.5 / cycles to failure at this range"),
)

CHECKED: dict[str, tuple[Column, ...]] = {"checks": CHECKS, "path_cycles": PATH_CYCLES}
