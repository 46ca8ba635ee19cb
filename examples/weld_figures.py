"""Figures of a result outside the report, as in a notebook: run it with a result folder, or copy it cell by cell.

fatigue example demo && fatigue assess demo/case.toml -o result
python examples/weld_figures.py result
"""

import sys
from pathlib import Path

import pandas as pd

from fatigue.report import figures

# %% The tables of a result are plain Parquet files.
result = Path(sys.argv[1] if len(sys.argv) > 1 else "result")
nodes = pd.read_parquet(result / "nodes.parquet")
welds = pd.read_parquet(result / "welds.parquet").sort_values("utilisation", ascending=False)
cycles = pd.read_parquet(result / "cycles.parquet")
damage = pd.read_parquet(result / "damage.parquet")
target_km = 1.2e7

# %% Which welds miss the target?
lives = figures.weld_lives(welds, target_km)

# %% The worst weld, unrolled.
worst = welds.iloc[0]
along = figures.along_weld(nodes[nodes["weld"] == worst["weld"]], target_km)

# %% How often does its worst point see which stress range in one pass of each event?
of_worst = cycles[cycles["weld"] == worst["weld"]]
ranges = figures.exceedance(of_worst, dict.fromkeys(of_worst["event"].unique(), 1.0))

# %% May the frequency domain be trusted? Kurtosis of the governing event colours the points.
key = ["weld", "part", "order", "surface"]
governing = damage.rename(columns={"event": "governing_event"})[[*key, "governing_event", "kurtosis"]]
domains = figures.time_against_frequency(nodes.merge(governing, on=[*key, "governing_event"], how="left"))

# %% A notebook shows a figure by its name; here each goes to a page. The configuration keeps plotly from uploading.
for name, figure in {"lives": lives, "along": along, "ranges": ranges, "domains": domains}.items():
    figure.plotly().write_html(result / f"figure_{name}.html", config=figures.CONFIG, include_plotlyjs="directory")
