"""A study in numbers for its page: converter frequency and contact under two seeds, with records of rides."""

from pathlib import Path

import numpy as np
import pandas as pd

from fatigue.study.claims import read_claims, verdicts
from fatigue.study.page import Studied, Varied
from fatigue.study.quantities import Number, StudyRun, Variant
from fatigue.study.variants.ratios import ratio_rows

SEEDS = (1, 2)
VARIANTS = (
    Variant("base", {"fe": 9.2, "contact": "sound"}),
    Variant("fe=14", {"fe": 14.0, "contact": "sound"}),
    Variant("contact=worn", {"fe": 9.2, "contact": "worn"}),
    Variant("fe=14, contact=worn", {"fe": 14.0, "contact": "worn"}),
)
CLAIMS = (
    {
        "text": "worn wheels shake the converter",
        "paper": "the self-excited vibration of traction converter intersects with the unstable hunting",
        "left": "conv_y_rms[contact=worn]",
        "operator": ">",
        "right": "conv_y_rms",
        "factor": 3,
    },
    {"text": "the hanger lives longer at 14 Hz", "left": "life_km:hanger*[fe=14,contact=worn]", "operator": ">",
     "right": "life_km:hanger*[contact=worn]"},
    {"text": "hunting between 7 and 8 Hz", "left": "f_hunt[contact=worn]", "operator": "between", "right": [7, 8]},
    {"text": "ride index 2.76 against 1.93", "paper": "Wz = 2.76", "undecidable": "the paper gives no data"},
)  # fmt: skip
WELDS = ("hanger 1", "floor seam", "roof <b>bracket</b>")


def numbers(variants=VARIANTS, seeds=SEEDS):
    """Numbers of every variant under every seed."""
    rows = []
    for place, variant in enumerate(variants):
        worn = variant.settings.get("contact") == "worn"
        for seed in seeds:
            rms = (2.3 if worn else 0.28) * (1.0 if place % 2 == 0 else 0.5) * (1 + 0.02 * seed)
            rows.append(Number(variant.name, seed, "conv_y_rms", "", rms, "m/s2"))
            rows.append(Number(variant.name, seed, "f_hunt", "", 7.9 + 0.2 * seed if worn else 4.6, "Hz"))
            for number, weld in enumerate(WELDS):
                life = 3e8 / (200.0 if worn else 1.0) * (1 + number) * (3.0 if place % 2 else 1.0) * (1 + 0.1 * seed)
                rows.append(Number(variant.name, seed, "life_km", weld, np.inf if number == 2 else life, "km"))
    return rows


def write_ride(folder: Path, peak_hz: float, seed: int) -> None:
    """History of a ride without a case: bogie and converter over 20 s."""
    folder.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(seed)
    t = np.arange(20_000) * 1e-3
    bogie = 4.0 * np.sin(2 * np.pi * peak_hz * t) + rng.standard_normal(t.size)
    pd.DataFrame({"time_s": t, "bog_y": bogie, "conv_y": 0.6 * bogie}).to_parquet(folder / "history.parquet")


def studied(folder: Path | None = None, seeds=SEEDS, claims=CLAIMS, variants=VARIANTS, **more) -> Studied:
    """The study; with a folder its rides lie there."""
    found = numbers(variants, seeds)
    runs = [
        StudyRun(v.name, s, (folder or Path()) / str(i), {"": (folder or Path()) / str(i) / f"seed_{s}"}, "done")
        for i, v in enumerate(variants)
        for s in seeds
    ]
    if folder is not None:
        for run in runs:
            write_ride(run.sources[""], 8.0 if "worn" in run.variant else 4.6, run.seed)
    given = {
        "title": "Fluttering",
        "vehicle": "vehicle.toml",
        "case": None,
        "source": "rides of the vehicle",
        "combine": "full",
        "varied": (
            Varied("fe", ("vehicle.converter.fe_hz",), (9.2, 14.0)),
            Varied("contact", ("vehicle.contact.state",), ("sound", "worn")),
        ),
        "seeds": seeds,
        "variants": variants,
        "runs": runs,
        "numbers": found,
        "ratios": ratio_rows(variants, found),
        "verdicts": verdicts(read_claims(claims, seeds), variants, found, seeds),
    }
    return Studied(**(given | more))
