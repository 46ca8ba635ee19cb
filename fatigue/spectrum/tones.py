"""Bins of a record's spectrum that stand out of their neighbours, as steady tones do."""

import numpy as np
from numpy.typing import NDArray

LINE_OVER_MEDIAN = 20.0  # one bin of noise in a million stands out so far
LINE_BLOCK = 16  # bins of a local median: narrow against resonances, wide against the four bins of a tapered tone


def stands_out_of_neighbours(power: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether each bin, (n, f), is far above the medians of its block and the blocks beside it.

    So the edge of a band is no tone.
    """
    blocks = power.shape[1] // LINE_BLOCK
    if blocks == 0:
        return np.zeros(power.shape, dtype=np.bool_)
    half = LINE_BLOCK // 2
    block = power[:, : blocks * LINE_BLOCK].reshape(-1, blocks, LINE_BLOCK)
    median = np.partition(block, (half - 1, half), axis=2)[:, :, half - 1 : half + 1].mean(axis=2)
    median = np.concatenate([median[:, :1], median, median[:, -1:]], axis=1)
    around = np.maximum(np.maximum(median[:, :-2], median[:, 1:-1]), median[:, 2:])
    # An incomplete last block joins the one before it.
    of_bin = np.minimum(np.arange(power.shape[1]) // LINE_BLOCK, blocks - 1)
    return np.asarray(power > LINE_OVER_MEDIAN * around[:, of_bin])
