"""One event in every format: converted, assessed, and the same life at every point, to the digits of the format."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import scipy.io

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.options import ConvertOptions
from tests.readers.foreign.adams.test_results_xml import write_results
from tests.readers.foreign.channels.matlab_73_writer import write_matlab_73
from tests.readers.foreign.channels.rpc_writer import write_rpc
from tests.readers.foreign.nastran.solution_punch_writer import solution_punch
from tests.readers.op2_writer import modal_op2
from tests.readers.tee_model import bulk, tee

STEP, START = 1 / 128, 2.0
T = START + STEP * np.arange(512)
Q = np.cumsum(np.random.default_rng(2).normal(size=(5, 512)), axis=1) - 16.0
NAMES = [f"q_{k}" for k in range(1, 6)]


def csv(path):
    """As the shortest text that gives each number back."""
    pd.DataFrame({"time": T, **dict(zip(NAMES, Q, strict=True))}).to_csv(path, index=False)


def universal(path, binary=0):
    """One data set for each channel."""
    pytest.importorskip("pyuff", reason="the package pyuff is not installed")
    from tests.readers.foreign.channels.test_universal import data_set, write  # noqa: PLC0415 - needs the package

    timed = {"x": T, "abscissa_min": START, "abscissa_inc": STEP, "binary": binary}
    write(path, [data_set(name, q, **timed) for name, q in zip(NAMES, Q, strict=True)])


def mdf(path, version="4.10"):
    """One group."""
    asammdf = pytest.importorskip("asammdf", reason="the package asammdf is not installed")
    with asammdf.MDF(version=version) as file:
        signals = [asammdf.Signal(q, T, name=name, unit="mm") for name, q in zip(NAMES, Q, strict=True)]
        file.append(signals, common_timebase=True)
        file.save(path, overwrite=True)


def tdms(path):
    """Increment and start offset."""
    nptdms = pytest.importorskip("nptdms", reason="the package nptdms is not installed")
    timed = {"wf_increment": STEP, "wf_start_offset": START, "unit_string": "mm"}
    with nptdms.TdmsWriter(path) as file:
        file.write_segment(
            [nptdms.ChannelObject("g", name, q, properties=timed) for name, q in zip(NAMES, Q, strict=True)]
        )


def excel(path):
    """A sheet with a title, names, and units."""
    xlsxwriter = pytest.importorskip("xlsxwriter", reason="the package xlsxwriter is not installed")
    pytest.importorskip("python_calamine", reason="the package python_calamine is not installed")
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("run 7")
        sheet.write(0, 0, "Run 7")
        for row, cells in enumerate([["time", *NAMES], ["s", *["mm"] * 5], *np.column_stack([T, Q.T]).tolist()], 2):
            sheet.write_row(row, 0, cells)


def simpack(path):
    """Structures in structures, as SIMPACK exports them."""
    channels = {name: {"values": q, "unit": "mm"} for name, q in zip(NAMES, Q, strict=True)}
    scipy.io.savemat(path, {"timeInt": {"time": {"values": T, "unit": "s"}, "flexState": {"car": channels}}})


WRITERS = {
    "a.uff": (universal, 1e-6),
    "b.uff": (lambda path: universal(path, binary=1), 1e-6),
    "a.mf4": (mdf, 1e-6),
    "a.mdf": (lambda path: mdf(path, "3.30"), 1e-6),
    "a.tdms": (tdms, 1e-6),
    "real.rsp": (lambda path: write_rpc(path, Q, step=STEP, names=NAMES, kind="f4"), 1e-6),
    "whole.rsp": (lambda path: write_rpc(path, Q, step=STEP, names=NAMES, kind="i2", order=">"), 1e-3),
    "a.mat": (lambda path: scipy.io.savemat(path, {"t": T, "q": Q}), 1e-6),
    "a73.mat": (lambda path: write_matlab_73(path, t=T, q=Q), 1e-6),
    "simpack.mat": (simpack, 1e-6),
    "a.xlsx": (excel, 1e-6),
    "a.npy": (lambda path: np.save(path, np.column_stack([T, Q.T])), 1e-6),
    "a.npz": (lambda path: np.savez(path, time=T, **dict(zip(NAMES, Q, strict=True))), 1e-6),
    "a.res": (lambda path: write_results(path, T, Q, ("Q1", "Q2", "Q3", "Q4", "Q5")), 1e-6),
    "a.pch": (lambda path: path.write_text(solution_punch(T, Q, (1, 2, 3, 4, 5))), 1e-5),
}
"""Writers, and how far lives may be from those of the text: 16 bits, and the six digits of a punch file, show."""


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    """The T joint, its deck and forces."""
    folder = tmp_path_factory.mktemp("model")
    (folder / "tee.bdf").write_text(bulk(tee()))
    (folder / "tee.op2").write_bytes(modal_op2(tee().results, word=8))
    return ConvertOptions(
        forces=folder / "tee.op2", mesh=folder / "tee.bdf", out=folder / "body", interface_modes=(5,), coordinates=()
    )


def lives(model, recording, folder):
    """Lives of all points under the event of a recording."""
    convert(replace(model, coordinates=(recording,), out=folder / "body"))
    case = folder / "body" / "case.toml"
    case.write_text(case.read_text().replace('upsample = "auto"', "upsample = 1"))
    assess(load_case(case), folder / "result")
    return pd.read_parquet(folder / "result" / "nodes.parquet").life_km.to_numpy()


@pytest.fixture(scope="module")
def of_text(model, tmp_path_factory):
    """Lives of the event as text."""
    folder = tmp_path_factory.mktemp("text")
    csv(folder / "a.csv")
    found = lives(model, folder / "a.csv", folder)
    assert np.isfinite(found).sum() > 10
    return found


@pytest.mark.parametrize("name", WRITERS)
def test_lives_are_those_of_the_text(model, of_text, tmp_path, name):
    """Point by point."""
    write, tolerance = WRITERS[name]
    write(tmp_path / name)
    found = lives(model, tmp_path / name, tmp_path)
    np.testing.assert_allclose(found, of_text, rtol=tolerance)
