"""Export of an Abaqus output database for fatigue: mesh, thickness, modes, mode shapes, element nodal forces.

Run it where Abaqus is, on the database of a *FREQUENCY step that has asked for NFORC:

    abaqus python abaqus_export.py JOB.odb OUT.txt [WELD_ELEMENTS]

WELD_ELEMENTS is an element set of the assembly or of its instances; without it the forces of all elements that have
them are written. The text is for `fatigue convert --forces OUT.txt --mesh OUT.txt`. Forces are written as Abaqus has
them: NFORC is the force of the element on the node, in global axes. The last frame of each static step with NFORC is
written beside the modes: interface modes, or loads.

Runs under the Python 2.7 and 3 of Abaqus; needs nothing but Abaqus.
"""

from __future__ import print_function

import sys

VERSION = 1
COMPONENTS = ("NFORC1", "NFORC2", "NFORC3", "NFORC4", "NFORC5", "NFORC6")


def number(value):
    """A number as text, in full precision."""
    return "%.9e" % float(value)


def datum(value):
    """The number or vector of a field value; of a database in double precision Abaqus refuses ``data``."""
    if "DOUBLE" in str(getattr(value, "precision", "")):
        return value.dataDouble
    return value.data


def offsets(instances):
    """What is added to the labels of each instance, so that nodes and elements of all are told apart."""
    names = sorted(instances.keys())
    if len(names) == 1:
        return {names[0]: 0}
    largest = 1
    for name in names:
        for some in (instances[name].nodes, instances[name].elements):
            for one in some:
                largest = max(largest, one.label)
    power = 10 ** len(str(largest))
    return dict((name, k * power) for k, name in enumerate(names))


def write_mesh(out, assembly, odb_sections, shift, measured):
    """Nodes, elements by type, sections; returns a warning for each section whose thickness is not known."""
    instances = assembly.instances
    nodes = [(shift[n] + node.label, node.coordinates) for n in sorted(instances.keys()) for node in instances[n].nodes]
    out.write("*nodes 4 %d\n" % len(nodes))
    for label, place in nodes:
        out.write("%d %s\n" % (label, " ".join(number(x) for x in place)))
    sections, of_element, doubts = section_table(assembly, odb_sections, shift, measured)
    out.write("*sections 3 %d\n" % len(sections))
    for k, (thickness, offset, _) in enumerate(sections):
        out.write("%d %s %s\n" % (k + 1, number(thickness), number(offset)))
    layered = [k + 1 for k, row in enumerate(sections) if row[2]]
    if layered:
        out.write("*layered 1 %d\n" % len(layered))
        for k in layered:
            out.write("%d\n" % k)
    by_type = {}
    for name in sorted(instances.keys()):
        for element in instances[name].elements:
            label = shift[name] + element.label
            row = [label, of_element.get(label, 0)] + [shift[name] + n for n in element.connectivity]
            by_type.setdefault((element.type, len(row)), []).append(row)
    for kind, length in sorted(by_type):
        rows = by_type[kind, length]
        out.write("*elements %d %d %s\n" % (length, len(rows), kind))
        for row in rows:
            out.write(" ".join(str(x) for x in row) + "\n")
    return doubts


def section_table(assembly, odb_sections, shift, measured):
    """Sections as (thickness, offset, is layered), the number of the section of each element, and doubts.

    A thickness that varies makes a section of each value that STH tells; unknown ones are written as zero.
    """
    table, number_of, of_element, doubts = [], {}, {}, []
    for name in sorted(assembly.instances.keys()):
        for assigned in assembly.instances[name].sectionAssignments:
            section = odb_sections[assigned.sectionName]
            layup = getattr(section, "layup", None) or ()
            thickness = getattr(section, "thickness", None)
            if thickness is None:
                thickness = sum(layer.thickness for layer in layup)
            if "Solid" in type(section).__name__ or not thickness:
                continue  # solids, which may have a thickness as well, beams, and shells given by their stiffness
            fields = (getattr(section, field, None) for field in ("nodalThicknessField", "thicknessField"))
            varies = any(str(field or "").strip() for field in fields)
            fraction = offset_fraction(assigned)
            if fraction is None:
                doubts.append("section %s has an offset that varies: its thickness is left out" % assigned.sectionName)
            unknown = 0
            for element in plain(assigned.region.elements):
                label = shift[name] + element.label
                own = measured.get(label, 0.0) if varies else thickness
                if fraction is None:
                    own = 0.0
                key = (assigned.sectionName, fraction, own)
                if key not in number_of:
                    table.append((own, -(fraction or 0.0) * own, len(layup) > 1))
                    number_of[key] = len(table)
                of_element[label] = number_of[key]
                unknown += own == 0.0 and fraction is not None
            if unknown:
                doubts.append(
                    "section %s has a thickness that varies: it is unknown at %d elements (no STH, or uneven)"
                    % (assigned.sectionName, unknown)
                )
    return table, of_element, doubts


def plain(elements):
    """Elements of a region; those of an assembly stand in a tuple for each instance."""
    found = []
    for one in elements:
        if hasattr(one, "label"):
            found.append(one)
        else:
            found.extend(one)
    return found


def measured_thickness(odb, shift):
    """Thickness of the elements by the field STH, as far as it varies by no more than 1 % over each of them."""
    for step in odb.steps.values():
        for frame in step.frames:
            if "STH" in frame.fieldOutputs.keys():
                found = {}
                for value in frame.fieldOutputs["STH"].values:
                    label = shift[value.instance.name] + value.elementLabel
                    found.setdefault(label, []).append(float(datum(value)))
                return dict(
                    (label, float("%.6g" % (sum(own) / len(own))))
                    for label, own in found.items()
                    if max(own) <= 1.01 * min(own)
                )
    return {}


def offset_fraction(assigned):
    """From the mid-surface to the reference surface, as a share of the thickness along the normal; None: by a field."""
    kind = str(getattr(assigned, "offsetType", "MIDDLE_SURFACE"))
    if "TOP" in kind:
        return 0.5
    if "BOTTOM" in kind:
        return -0.5
    if "FIELD" in kind:
        return None
    if "SINGLE" in kind:
        return float(getattr(assigned, "offset", 0.0))
    return 0.0


def write_shape(out, frame, shift):
    """Displacements and rotations of all nodes."""
    rows = {}
    for name, first in (("U", 0), ("UR", 3)):
        if name not in frame.fieldOutputs.keys():
            continue
        for value in frame.fieldOutputs[name].values:
            if value.instance is None:
                continue  # reference points of the assembly
            row = rows.setdefault(shift[value.instance.name] + value.nodeLabel, [0.0] * 6)
            for k, component in enumerate(datum(value)):
                row[first + k] = component
    out.write("*shape 7 %d\n" % len(rows))
    for label in sorted(rows):
        out.write("%d %s\n" % (label, " ".join(number(x) for x in rows[label])))


def write_forces(out, frame, shift, wanted):
    """Element nodal forces and moments; returns the number of rows."""
    rows = {}
    for k, name in enumerate(COMPONENTS):
        if name not in frame.fieldOutputs.keys():
            continue
        for value in frame.fieldOutputs[name].values:
            if value.instance is None:
                continue  # springs and couplings of the assembly
            element = shift[value.instance.name] + value.elementLabel
            if wanted is not None and element not in wanted:
                continue
            node = shift[value.instance.name] + value.nodeLabel
            rows.setdefault((element, node), [0.0] * 6)[k] = datum(value)
    out.write("*forces 8 %d\n" % len(rows))
    for element, node in sorted(rows):
        out.write("%d %d %s\n" % (element, node, " ".join(number(x) for x in rows[element, node])))
    return len(rows)


def generalised_masses(step):
    """Generalised mass by mode number, from the history output GM; empty where there is none."""
    for region in step.historyRegions.values():
        if "GM" in region.historyOutputs.keys():
            return dict((int(float(mode) + 0.5), float(mass)) for mode, mass in region.historyOutputs["GM"].data)
    return {}


def wanted_elements(assembly, name, shift):
    """Labels of the elements of a set, None for all."""
    if not name:
        return None
    found, sets = set(), {}
    for key in assembly.elementSets.keys():
        sets.setdefault(key.upper(), []).append((None, assembly.elementSets[key]))
    for own in assembly.instances.keys():
        of_instance = getattr(assembly.instances[own], "elementSets", {})
        for key in of_instance.keys():
            sets.setdefault(key.upper(), []).append((own, of_instance[key]))
    if name.upper() not in sets:
        sys.exit("there is no element set %s; sets: %s" % (name, ", ".join(sorted(sets))))
    for own, some in sets[name.upper()]:
        for element in plain(some.elements):
            found.add(shift[own or element.instanceName] + element.label)
    return found


def is_frequency(frame):
    """Whether a frame is a mode of vibration."""
    return getattr(frame, "mode", None) is not None and int(frame.mode or 0) > 0


def other_modes(step):
    """Whether the frames of a step are modes of something else: buckling, or complex modes."""
    procedure = str(getattr(step, "procedure", "")).upper()
    return "BUCKL" in procedure or "COMPLEX" in procedure


def write_steps(out, odb, shift, wanted):
    """Modes of the last frequency step, and static steps; returns messages."""
    told, modal, others = [], [], []
    for step in odb.steps.values():
        if other_modes(step):
            others.append(step)
            told.append("step %s has no real modes of vibration and is left out" % step.name)
        elif any(is_frequency(frame) for frame in step.frames):
            modal.append(step)
    if not modal:
        sys.exit("no step has modes: run a *FREQUENCY step with *ELEMENT OUTPUT NFORC")
    if len(modal) > 1:
        told.append("%d frequency steps: the modes of the last, %s, are written" % (len(modal), modal[-1].name))
    masses = generalised_masses(modal[-1])
    modes = [frame for frame in modal[-1].frames if is_frequency(frame)]
    for frame in modes:
        mass = masses.get(int(frame.mode), float("nan"))
        out.write("*mode 3 1\n%d %s %s\n" % (frame.mode, number(frame.frequency), number(mass)))
        write_shape(out, frame, shift)
        if not write_forces(out, frame, shift, wanted):
            sys.exit("mode %d has no NFORC: request *ELEMENT OUTPUT with NFORC for the weld elements" % frame.mode)
    if not all(int(frame.mode) in masses for frame in modes):
        told.append("no generalised masses (GM): they count where modes are not normalised to mass")
    static = 0
    for step in odb.steps.values():
        if step in modal or step in others or not len(step.frames):
            continue
        frame = step.frames[-1]
        if "NFORC1" not in frame.fieldOutputs.keys():
            told.append("step %s has no NFORC and is left out" % step.name)
            continue
        static += 1
        out.write("*static 1 1 %s\n%d\n" % (step.name, 1000 + static))
        write_shape(out, frame, shift)
        write_forces(out, frame, shift, wanted)
        told.append("step %s is static case %d" % (step.name, 1000 + static))
    return told


def export(odb, path, set_name=None, version=""):
    """Write the text of an open database; returns what is to be told."""
    assembly = odb.rootAssembly
    shift = offsets(assembly.instances)
    with open(path, "w") as out:
        out.write("fatigue export %d Abaqus %s\n" % (VERSION, version))
        told = write_mesh(out, assembly, odb.sections, shift, measured_thickness(odb, shift))
        told += write_steps(out, odb, shift, wanted_elements(assembly, set_name, shift))
        out.write("*end\n")
    for name in sorted(shift):
        if shift[name]:
            told.append("labels of the instance %s are shifted by %d" % (name, shift[name]))
    return told


def main(arguments):
    """Open the database and write the text."""
    if len(arguments) not in (2, 3):
        sys.exit("abaqus python abaqus_export.py JOB.odb OUT.txt [WELD_ELEMENTS]")
    from odbAccess import openOdb

    odb = openOdb(arguments[0], readOnly=True)
    version = str(odb.jobData.version) if getattr(odb, "jobData", None) else ""
    for line in export(odb, arguments[1], arguments[2] if len(arguments) > 2 else None, version):
        print("note: " + line)
    odb.close()


if __name__ == "__main__":
    main(sys.argv[1:])
