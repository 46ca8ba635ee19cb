"""The figures of the report as functions of tables, for notebooks too: ``.plotly()`` of each is a plotly figure.

They take the tables of a result folder as ``pandas.read_parquet`` or ``fatigue.read_table`` reads them, or a
part of their rows.
"""

from fatigue.report.figures.cycles import exceedance, rainflow_matrices, sn_with_spectrum
from fatigue.report.figures.domains import (
    damage_by_method,
    drawn_points,
    ranges_by_method,
    ratio_histogram,
    time_against_frequency,
)
from fatigue.report.figures.drawn import Figure
from fatigue.report.figures.lines import along_weld
from fatigue.report.figures.load_spectra import class_matrices, crossings_by_level, spectrum_exceedance
from fatigue.report.figures.overview import damage_by_event, shares, weld_lives, weld_strips
from fatigue.report.figures.records import cycles_close_by, stress_history, stress_spectrum
from fatigue.report.figures.ride import damage_in_hot_stretches, hunting_along_event
from fatigue.report.figures.scene import BodyOutline, body_outline, line_rows, projections, scene, worst_faces
from fatigue.report.figures.shear import shear_path
from fatigue.report.figures.shift import life_against_setting
from fatigue.report.figures.style import CONFIG, TEMPLATE, event_colours
from fatigue.report.figures.why import bands_of_welds, damage_by_band, damage_on_track

__all__ = [
    "CONFIG",
    "TEMPLATE",
    "BodyOutline",
    "Figure",
    "along_weld",
    "bands_of_welds",
    "body_outline",
    "class_matrices",
    "crossings_by_level",
    "cycles_close_by",
    "damage_by_band",
    "damage_by_event",
    "damage_by_method",
    "damage_in_hot_stretches",
    "damage_on_track",
    "drawn_points",
    "event_colours",
    "exceedance",
    "hunting_along_event",
    "life_against_setting",
    "line_rows",
    "projections",
    "rainflow_matrices",
    "ranges_by_method",
    "ratio_histogram",
    "scene",
    "shares",
    "shear_path",
    "sn_with_spectrum",
    "spectrum_exceedance",
    "stress_history",
    "stress_spectrum",
    "time_against_frequency",
    "weld_lives",
    "weld_strips",
    "worst_faces",
]
