"""Element forces under the gauges of the shipped car body: ``python -m tests.carbody_gauges`` writes their file again.

They are cut from ``tests/data``, from the run that gave the forces of the body: the elements under the gauges of
``gauges.csv`` and those that share an edge with them.
"""

import pandas as pd

from tests.carbody_loads import FOLDER

FORCES = FOLDER.parents[1] / "tests" / "data" / "carbody_element_forces.parquet"
UNDER = (15245, 8813, 8814, 8815, 15360, 2801)  # of the gauges, those that a long grid crosses included


def gauge_forces():
    """Rows of the elements under gauges and beside them."""
    elements = pd.read_parquet(FOLDER / "elements.parquet").set_index("element")[["n1", "n2", "n3", "n4"]]
    corners = {element: set(nodes) for element, *nodes in elements.itertuples()}
    under = [corners[element] for element in UNDER]
    wanted = [element for element, own in corners.items() if any(len(own & nodes) > 1 for nodes in under)]
    forces = pd.read_parquet(FORCES)
    return forces[forces["element"].isin(wanted)].reset_index(drop=True)


if __name__ == "__main__":
    gauge_forces().to_parquet(FOLDER / "gauge_forces.parquet", index=False, compression="zstd")
