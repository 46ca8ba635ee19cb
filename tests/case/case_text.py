"""A case file with all that has no default, and a curve of one's own, to be changed by tests."""

MINIMAL = """
[body]
modes = "modes.csv"
welds = "welds.csv"
weld_nodes = "weld_nodes.csv"
nodal_forces = "nodal_forces.parquet"
force_convention = "on_element"

[curve]
name = "master-aluminium"

[mission]
target_km = 1.2e7
km_per_year = 5e5

[[mission.event]]
name = "tangent"
history = "q_tangent.parquet"
speed_km_h = 350.0
share = 0.75

[[mission.event]]
name = "curve"
history = "q_curve.parquet"
length_km = 3
share = 0.25

[[mission.event]]
name = "load"
history = "q_load.parquet"
per_1000_km = 1.5
"""

OWN_CURVE = """
[curves.mine]
slopes = [3.0, 5.0]
knees_cycles = [1e7]
range_at_2e6_MPa = 40.0
applies = "structural"
source = "a book, edition, clause"
"""
