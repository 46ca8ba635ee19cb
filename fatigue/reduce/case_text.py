"""The first ``case.toml`` of a reduced body: what only the user knows is there to be filled in."""

import json
from collections.abc import Collection

CASE = "case.toml"

_TEXT = """\
# Written by fatigue reduce. Check the lines marked EDIT, and add the histories of your simulation below.
title = {title}

[body]
modes = "modes.csv"
welds = "{welds}"
weld_nodes = "{weld_nodes}"
nodal_forces = "nodal_forces.parquet"
force_convention = "on_element"
nodes = "nodes.parquet"        # for pictures
elements = "elements.parquet"
interface_shapes = "interface_shapes.csv"   # for fatigue basis
flexibility = "flexibility.csv"

[curve]
name = "{curve}"               # EDIT
survival = "mean-2sigma"
thickness_rule = "actual"
extension = "none"
mean_stress = "none"

[counting]
residue = "repeat"
upsample = "auto"              # 20 samples per peak; 1: the samples as they are

[mission]
target_km = 1.0e7              # EDIT
km_per_year = 5.0e5            # EDIT
damage_limit = 1.0

# EDIT: one event for each history of modal coordinates. A coordinate q of 1 is one of the shapes of modes.csv, which
# have a modal mass of 1 t in mm, t, s; of shapes with a modal mass of 1 kg in m, kg, s it is sqrt(1000) times theirs.
# [[mission.event]]
# name = "straight track"
# history = "q.parquet"        # time_s and one column q_<mode> for every mode
# speed_km_h = 100.0
# share = 1.0
# start_s = 0.0                # cut the start-up
"""

ALUMINIUM = 1.2e5  # MPa: the stiffest E of a body that is taken for one of aluminium


def case_text(title: str, weld_files: Collection[str], stiffest: float) -> str:
    """Text of a case without events; ``weld_files`` are those of welds and weld_nodes, ``stiffest`` E is in MPa."""
    welds, weld_nodes = weld_files
    curve = "master-aluminium" if stiffest < ALUMINIUM else "master-steel"
    return _TEXT.format(title=json.dumps(title), welds=welds, weld_nodes=weld_nodes, curve=curve)
