"""Columns of the stress history of a station of a weld line, at the instants that were counted."""

from fatigue.results.dictionary.column import Column

HISTORY = (
    Column("event", "text", "-", "event of the mission"),
    Column("time_s", "float", "s", "time of the file; of a static load case the number of its value, from 0"),
    Column("membrane_MPa", "float", "MPa", "membrane stress, normal to the weld line"),
    Column("bending_MPa", "float", "MPa", "bending stress of the top face, normal to the weld line"),
    Column("in_plane_shear_MPa", "float", "MPa", "shear stress along the weld line, mean over the thickness"),
    Column("twist_shear_MPa", "float", "MPa", "shear stress along the line from the twisting moment, top face"),
    Column("transverse_shear_MPa", "float", "MPa", "shear stress through the plate, mean over the thickness"),
    Column("structural_top_MPa", "float", "MPa", "structural stress of the top face: membrane + bending"),
    Column("structural_bottom_MPa", "float", "MPa", "structural stress of the bottom face: membrane - bending"),
)

AT_VERTICES = (
    Column("counted_top_MPa", "float", "MPa", "that of the top face, each reversal read at its vertex, as counted"),
    Column(
        "counted_bottom_MPa", "float", "MPa", "that of the bottom face, each reversal read at its vertex, as counted"
    ),
)
"""Beside them where the case has reversals read between samples."""

HISTORIES: dict[str, tuple[Column, ...]] = {"history": (*HISTORY, *AT_VERTICES)}
