"""Files of the T joint for conversions with static subcases: deck, modes, and subcases with titles of their own."""

import numpy as np

from fatigue.readers.convert.options import ConvertOptions
from tests.readers.op2_writer import PLAIN, Op2Writer, modal_op2, modal_tables
from tests.readers.tee_model import bulk, tee
from tests.readers.unit_loads import unit_loads

TITLES = ("TUNNEL PRESSURE", "Coupler, draft", "1 g vertical")
MODES = tuple(f"q_{mode}" for mode in range(1, 6))


def static_tables(writer, subcases, titles=TITLES):
    """Add displacements and forces of the three unit loads, each under its subtitle, as MSC Nastran writes it."""
    for subcase, case, title in zip(subcases, unit_loads(), titles, strict=True):
        label = "CAR BODY".ljust(128) + title.ljust(128) + f"SUBCASE {subcase}".rjust(115)
        head = writer.identification(1, 1, 0, 8, subcase=subcase, label=label)
        writer.table("OUGV1", [head, writer.shape(case.shape)])
        head = writer.identification(1, 19, 0, 10, subcase=subcase, device=2, label=label)
        writer.table("OGPFB1", [head, writer.forces(case.rows)])
    return writer


def history(path, columns=MODES):
    """Write an event in which column k is k + 1 times a sine."""
    time = np.arange(100) / 100
    rows = [f"{t:.9g}," + ",".join(f"{(k + 1) * np.sin(9 * t):.9g}" for k in range(len(columns))) for t in time]
    path.write_text("\n".join([",".join(["time", *columns]), *rows, ""]))
    return path


def static_files(folder, subcases=(1, 2, 3), columns=MODES, titles=TITLES):
    """Options of a conversion of modes and, in a file of their own, static subcases; and one event."""
    (folder / "tee.bdf").write_text(bulk(tee()))
    (folder / "modes.op2").write_bytes(modal_op2(tee().results, 8))
    (folder / "static.op2").write_bytes(static_tables(Op2Writer(8, dialect=PLAIN), subcases, titles).close())
    return ConvertOptions(
        forces=folder / "modes.op2",
        mesh=folder / "tee.bdf",
        out=folder / "body",
        coordinates=(history(folder / "straight.csv", columns),),
        unit_loads=(folder / "static.op2",),
        interface_modes=(5,),
    )


def both_in_one(folder, subcases=(1, 2, 3)):
    """Write modes and static subcases into one file."""
    writer = static_tables(modal_tables(Op2Writer(8), tee().results), subcases)
    (folder / "both.op2").write_bytes(writer.close())
    return folder / "both.op2"
