"""Sound recordings of every format: three modal coordinates over time, small enough to be damaged everywhere."""

import gc
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import scipy.io

from tests.readers.foreign.adams.test_results_xml import write_results
from tests.readers.foreign.channels.matlab_73_writer import write_matlab_73
from tests.readers.foreign.channels.rpc_writer import write_rpc
from tests.readers.foreign.channels.test_universal import data_set
from tests.readers.foreign.nastran.solution_punch_writer import solution_punch

T = 0.25 + 0.01 * np.arange(24)
Q = np.random.default_rng(6).normal(size=(3, 24))
NAMES = ["q_1", "q_2", "q_3"]


def recordings(folder: Path) -> Iterator[tuple[str, Path, bool]]:
    """Name, file, and whether it is text, of each recording that the packages at hand can write."""
    write_rpc(folder / "whole.rsp", Q, frame=24, per_group=1, names=NAMES)
    yield "rpc of whole numbers", folder / "whole.rsp", False
    write_rpc(folder / "real.rsp", Q, frame=8, per_group=2, kind="f4", order=">", names=NAMES)
    yield "rpc of real numbers", folder / "real.rsp", False
    np.savez(folder / "q.npz", time=T, **dict(zip(NAMES, Q, strict=True)))
    yield "npz", folder / "q.npz", False
    np.save(folder / "q.npy", np.vstack([T, Q]).T)
    yield "npy", folder / "q.npy", False
    scipy.io.savemat(folder / "q5.mat", {"t": T, "q": Q})
    yield "mat 5", folder / "q5.mat", False
    scipy.io.savemat(folder / "q7.mat", {"t": T, "q": Q}, do_compression=True)
    yield "mat 7", folder / "q7.mat", False
    write_matlab_73(folder / "q73.mat", t=T, q=Q)
    yield "mat 7.3", folder / "q73.mat", False
    (folder / "q.pch").write_text(solution_punch(T, Q, (1, 2, 3)))
    yield "solution punch", folder / "q.pch", True
    write_results(folder / "q.res", T, Q, ("Q1", "Q2", "Q3"))
    yield "adams results", folder / "q.res", True
    legend = "".join(f"{letter}: {name}\n" for letter, name in zip("ABCD", ["Time (sec)", *NAMES], strict=True))
    rows = "".join("\t".join(f"{value:.9g}" for value in row) + "\n" for row in np.vstack([T, Q]).T)
    (folder / "q.tab").write_text(legend + "\n" + rows)
    yield "table with a legend", folder / "q.tab", True
    yield from _by_packages(folder)


def _by_packages(folder: Path) -> Iterator[tuple[str, Path, bool]]:
    """Recordings that optional packages write."""
    import asammdf  # noqa: PLC0415 - all these are optional
    import nptdms  # noqa: PLC0415
    import pyuff  # noqa: PLC0415
    import xlsxwriter  # noqa: PLC0415

    with asammdf.MDF(version="4.10") as file:
        signals = [asammdf.Signal(q, T, name=n, unit="mm") for n, q in zip(NAMES, Q, strict=True)]
        file.append(signals, common_timebase=True)
        file.save(folder / "q.mf4", overwrite=True)
    yield "mdf", folder / "q.mf4", False
    timed = {"wf_increment": 0.01, "wf_start_offset": 0.25}
    with nptdms.TdmsWriter(folder / "q.tdms") as writer:
        writer.write_segment([nptdms.ChannelObject("g", n, q, properties=timed) for n, q in zip(NAMES, Q, strict=True)])
    yield "tdms", folder / "q.tdms", False
    for name, binary in (("q.uff", 0), ("qb.uff", 1)):
        sets = [
            data_set(n, q, binary=binary, x=T, abscissa_min=0.25, abscissa_inc=0.01)
            for n, q in zip(NAMES, Q, strict=True)
        ]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            (folder / name).unlink(missing_ok=True)
            pyuff.UFF(str(folder / name)).write_sets(sets, mode="add")
            gc.collect()
        yield f"universal {'binary' * binary or 'text'}", folder / name, not binary
    with xlsxwriter.Workbook(folder / "q.xlsx") as book:
        sheet = book.add_worksheet()
        for column, (name, values) in enumerate(zip(["time", *NAMES], [T, *Q], strict=True)):
            sheet.write(0, column, name)
            for row, value in enumerate(values, 1):
                sheet.write(row, column, value)
    yield "workbook", folder / "q.xlsx", False
