"""Text and archive as ANSYS writes them: the formats of the macro's *VWRITE, and blocks of CDWRITE."""

import numpy as np


def e22(value: float) -> str:
    """E22.13E3 of Fortran: a mantissa below one, three digits of exponent."""
    if value == 0:
        return f"{'0.0000000000000E+000':>22}"
    mantissa, exponent = f"{value:.12e}".split("e")
    sign, digits = ("-" if mantissa[0] == "-" else ""), mantissa.lstrip("-").replace(".", "")
    power = int(exponent) + 1
    return f"{sign}0.{digits}E{'+' if power >= 0 else '-'}{abs(power):03d}".rjust(22)


def f12(number: int) -> str:
    """F12.0 of Fortran."""
    return f"{number}.".rjust(12)


def macro_text(elements, modes) -> str:
    """Text of the macro: rows (id, nodes) by routine; modes (number, frequency, nodes, shape, rows, force)."""
    lines = ["fatigue export 1 ANSYS"]
    for routine, rows in elements.items():
        lines.append(f"*elements {2 + len(rows[0][1])} {f12(len(rows))}{str(routine) + '.':>8}")
        lines += ["".join(map(f12, (element, 0, *nodes))) for element, nodes in rows]
    for number, frequency, nodes, shape, rows, force in modes:
        lines += ["*mode 3 1", f12(number) + e22(frequency) + e22(1.0), f"*shape 7 {f12(len(nodes))}"]
        lines += [f12(n) + "".join(map(e22, row)) for n, row in zip(nodes, shape, strict=True)]
        lines.append(f"*forces 8 {f12(len(rows))}")
        lines += [f12(e) + f12(n) + "".join(map(e22, f)) for (e, n), f in zip(rows, force, strict=True)]
    return "\n".join([*lines, "*end", ""])


def tee_text(case) -> str:
    """Text of the T joint; rows of forces in another order of elements than the mesh, as ANSYS has it."""
    quads = case.model.quads + 1
    order = np.random.default_rng(3).permutation(len(quads))
    rows = [(int(e) + 1, int(n)) for e in order for n in quads[e]]
    nodes = range(1, len(case.model.xyz) + 1)
    force = -case.element_force[:, order].reshape(len(case.frequency), -1, 6)
    modes = [
        (k + 1, float(case.frequency[k]), nodes, case.shape[k], rows, force[k]) for k in range(len(case.frequency))
    ]
    return macro_text({181: [(k + 1, row.tolist()) for k, row in enumerate(quads)]}, modes)


def archive(xyz, rows, types, data, components=()) -> str:
    """Archive of CDWRITE; ``rows`` are (type, real, section, id, nodes), ``data`` lines of sections and constants."""
    lines = ["/COM,ANSYS RELEASE 2023 R2           BUILD 23.2      UP20230627       10:00:00", "/PREP7", "/NOPR"]
    lines += [f"ET,{kind:9d},{routine}" for kind, routine in types.items()]
    lines += [f"NBLOCK,6,SOLID,{len(xyz):10d},{len(xyz):10d}", "(3i9,6e21.13e3)"]
    lines += [
        f"{k:9d}{0:9d}{0:9d}" + "".join(f"{x:21.13E}".replace("E+", "E+0").replace("E-", "E-0")[-21:] for x in place)
        for k, place in enumerate(np.asarray(xyz).tolist(), start=1)
    ]
    lines += ["N,R5.3,LOC,       -1,", f"EBLOCK,19,SOLID,{len(rows):10d},{len(rows):10d}", "(19i10)"]
    for kind, real, section, element, nodes in rows:
        head = (1, kind, real, section, 0, 0, 0, 0, len(nodes), 0, element)
        words = [f"{n:10d}" for n in (*head, *nodes)]
        lines += ["".join(words[:19]), *(["".join(words[19:])] if words[19:] else [])]
    lines.append("        -1")
    for name, ids in components:
        lines += [f"CMBLOCK,{name:8s},NODE,{len(ids):8d}  ! users node component definition", "(8i10)"]
        lines += ["".join(f"{n:10d}" for n in ids[k : k + 8]) for k in range(0, len(ids), 8)]
    return "\n".join([*lines, *data, "/GO", "FINISH", ""])


TEE_SECTIONS = (
    "SECTYPE,       1,SHELL,    ,base",
    "SECOFFSET,MID",
    "SECBLOCK,   1",
    "   8.000000000    ,       1,   0.000000000    ,   3",
    "SECTYPE,       2,SHELL,    ,upright",
    "SECDATA,6.0,1,0.0,3",
)


def tee_archive(case) -> str:
    """Archive of the T joint."""
    rows = [
        (1, 1, 1 if t == 8 else 2, k, [n + 1 for n in quad])
        for k, (quad, t) in enumerate(zip(case.model.quads.tolist(), case.model.thickness, strict=True), start=1)
    ]
    return archive(case.model.xyz, rows, {1: 181}, TEE_SECTIONS, [("WELD", [1, -5, 9])])
