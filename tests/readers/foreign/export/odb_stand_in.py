"""The objects of an Abaqus output database that the export script looks at, made of a model of the tests."""

from types import SimpleNamespace as Is

import numpy as np


def instance(name, xyz, quads, first=1, kind="S4R"):
    """An instance with its nodes and shells."""
    nodes = [Is(label=k + first, coordinates=tuple(place)) for k, place in enumerate(xyz)]
    elements = [
        Is(label=k + first, type=kind, connectivity=tuple(int(n) + first for n in quad), instanceName=name)
        for k, quad in enumerate(quads)
    ]
    return Is(name=name, nodes=nodes, elements=elements, sectionAssignments=[])


def assign(own, section, elements, **offset):
    """Give some elements of an instance a section."""
    region = Is(elements=[own.elements[k] for k in elements])
    own.sectionAssignments.append(Is(sectionName=section, region=region, **offset))


def frame(own, shape, force, quads, *, mode=None, frequency=0.0, first=1):
    """A frame with displacements (n, 6), and forces (e, 4, 6) of the elements on the nodes."""
    outputs = {}
    for name, part in (("U", slice(0, 3)), ("UR", slice(3, 6))):
        outputs[name] = Is(
            values=[Is(instance=own, nodeLabel=k + first, data=tuple(row[part])) for k, row in enumerate(shape)]
        )
    for c in range(6):
        values = [
            Is(instance=own, elementLabel=e + first, nodeLabel=int(n) + first, data=float(force[e, k, c]))
            for e, quad in enumerate(quads)
            for k, n in enumerate(quad)
        ]
        outputs[f"NFORC{c + 1}"] = Is(values=values)
    return Is(mode=mode, frequency=frequency, fieldOutputs=outputs)


def database(instances, sections, steps, sets=None):
    """An open database."""
    assembly = Is(instances={one.name: one for one in instances}, elementSets=sets or {})
    return Is(rootAssembly=assembly, sections=sections, steps={step.name: step for step in steps})


def frequency_step(frames, masses=None, name="modes"):
    """A *FREQUENCY step, with its base frame and the history of generalised masses."""
    outputs = {} if masses is None else {"GM": Is(data=[(k + 1.0, m) for k, m in enumerate(masses)])}
    base = Is(mode=None, frequency=None, fieldOutputs={})
    return Is(name=name, frames=[base, *frames], historyRegions={"Assembly": Is(historyOutputs=outputs)})


def static_step(own_frame, name="pressure"):
    """A static perturbation step."""
    return Is(name=name, frames=[own_frame], historyRegions={})


def tee_database(case, *, masses=True, **static):
    """Database of the T joint of the tests: its modes, and static steps by name as (shape, force)."""
    quads = case.model.quads
    own = instance("TEE-1", case.model.xyz, quads)
    thick = np.flatnonzero(case.model.thickness == 8.0)
    assign(own, "base", thick)
    assign(own, "upright", np.setdiff1d(np.arange(len(quads)), thick))
    frames = [
        frame(own, u, -f, quads, mode=k + 1, frequency=hz)
        for k, (u, f, hz) in enumerate(zip(case.shape, case.element_force, case.frequency, strict=True))
    ]
    steps = [frequency_step(frames, np.ones(len(frames)) if masses else None)]
    steps += [static_step(frame(own, u, -f, quads), name) for name, (u, f) in static.items()]
    return database([own], {"base": Is(thickness=8.0), "upright": Is(thickness=6.0)}, steps)
