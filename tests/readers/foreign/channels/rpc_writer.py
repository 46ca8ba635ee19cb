"""RPC III files as their description has them."""

from pathlib import Path

import numpy as np


def write_rpc(
    path: Path, values, *, step=0.01, names=None, units=None, order="<", kind="i2", frame=64, per_group=2, **keys
):
    """Write the channels (c, t) and return what integers made of them; ``keys`` replace or add header records."""
    channels, samples = values.shape
    group = frame * per_group
    frames = -(-samples // frame)
    groups = -(-frames // per_group)
    scale = np.abs(values).max(axis=1) / 32752.0 if kind == "i2" else np.ones(channels)
    scale = np.where(scale > 0, scale, 1.0)
    head = {
        "FORMAT": "BINARY_IEEE_LITTLE_END" if order == "<" else "BINARY_IEEE_BIG_END",
        "NUM_HEADER_BLOCKS": "",
        "NUM_PARAMS": "",
        "FILE_TYPE": "TIME_HISTORY",
        "TIME_TYPE": "RESPONSE",
        "DELTA_T": f"{step:.9e}",
        "CHANNELS": channels,
        "DATE": "01-DEC-2026 10:00:00",
        "REPEATS": 1,
        "DATA_TYPE": "SHORT_INTEGER" if kind == "i2" else "FLOATING_POINT",
        "PTS_PER_FRAME": frame,
        "PTS_PER_GROUP": group,
        "FRAMES": frames,
        "HALF_FRAMES": 0,
        "INT_FULL_SCALE": 32752,
    }
    for k in range(channels):
        head[f"DESC.CHAN_{k + 1}"] = names[k] if names else f"q_{k + 1}"
        head[f"UNITS.CHAN_{k + 1}"] = units[k] if units else "mm"
        head[f"SCALE.CHAN_{k + 1}"] = repr(float(scale[k]))
        head[f"LOWER_LIMIT.CHAN_{k + 1}"] = float(values[k].min())
        head[f"UPPER_LIMIT.CHAN_{k + 1}"] = float(values[k].max())
    head |= keys
    head = {key: value for key, value in head.items() if value is not None}
    blocks = -(-len(head) // 4)
    head = {**head, "NUM_HEADER_BLOCKS": keys.get("NUM_HEADER_BLOCKS", blocks), "NUM_PARAMS": len(head)}
    records = b"".join(
        f"{k}".encode().ljust(32, b"\0") + f"{v}".encode("cp1252").ljust(96, b"\0") for k, v in head.items()
    )
    stored = np.zeros((channels, groups * group), order + kind)
    stored[:, :samples] = np.rint(values / scale[:, None]) if kind == "i2" else values
    data = stored.reshape(channels, groups, group).swapaxes(0, 1).tobytes()
    path.write_bytes(records.ljust(512 * blocks, b"\0") + data)
    return stored[:, : frames * frame] * scale[:, None]
