"""A small study in numbers: converter frequency and contact, four seeds, a channel and two welds."""

from fatigue.study.quantities import Number, Variant

SEEDS = (1, 2, 3, 4)
BASE = Variant("base", {"fe": 9.2, "contact": "sound", "doubled": False})
VARIANTS = (
    BASE,
    Variant("fe=14", {"fe": 14.0, "contact": "sound", "doubled": False}),
    Variant("contact=worn", {"fe": 9.2, "contact": "worn", "doubled": False}),
    Variant("both", {"fe": 14.0, "contact": "worn", "doubled": False}),
)
CONV = {"base": (0.28, 0.27, 0.29, 0.28), "fe=14": (0.25, 0.26, 0.24, 0.25)}
CONV |= {"contact=worn": (2.3, 2.4, 2.5, 2.2), "both": (1.1, 1.0, 1.2, 1.1)}


def numbers() -> list[Number]:
    """Numbers of every variant under every seed."""
    rows = [
        Number(variant, seed, "conv_y_rms", "", value, "m/s2")
        for variant, values in CONV.items()
        for seed, value in zip(SEEDS, values, strict=True)
    ]
    for place, variant in enumerate(VARIANTS, 1):
        for seed in SEEDS:
            rows.append(Number(variant.name, seed, "life_km", "W2_hanger1", 1e6 * place * seed, "km"))
            rows.append(Number(variant.name, seed, "life_km", "W2_hanger2", 3e6 * place / seed, "km"))
            rows.append(Number(variant.name, seed, "alarms/bogie", "", float(place > 2), "-"))
    return rows
