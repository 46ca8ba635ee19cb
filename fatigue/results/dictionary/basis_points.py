"""Columns of what is said of a modal basis at loaded points and at welds, alone and beside another basis."""

from fatigue.results.dictionary.column import POINT, Column

_LOADED = Column("point", "text", "-", "loaded point, as the file of shapes names it")
_DIRECTION = Column("direction", "text", "-", "x, y, z, or rx, ry, rz about them")
_UNIT = Column("unit", "text", "-", "of the flexibilities of this row: mm/N, or 1/(N mm) of a rotation under a moment")
_REASON = Column("reason", "text", "-", "why a number is empty")
_WELD, _PART, _NODE, _ORDER, _SURFACE = POINT

FLEXIBILITY = (
    _LOADED,
    _DIRECTION,
    _UNIT,
    Column("static", "float", "-", "static solution that the case gives"),
    Column("index", "float", "-", "flexibility index of the modes, sum of phi^2 / (m w^2)"),
    Column("ratio", "float", "-", "index over static: 1 is complete, below 1 the basis is too stiff there"),
    Column("normal_share", "float", "-", "part of the index that the normal modes make"),
    Column("interface_share", "float", "-", "part of the index that the interface modes make"),
    Column("enough", "flag", "-", "ratio reaches the rule, which is printed with its source"),
    _REASON,
)

INTERFACE = (
    _LOADED,
    Column("directions", "int", "-", "directions of the point that the file of shapes has"),
    Column("given", "text", "-", "these directions"),
    Column("interface_modes", "int", "-", "modes of the kind interface that move the point in any of them"),
    Column("independent", "int", "-", "independent directions among the motions of these modes (rank)"),
    Column(
        "complete", "flag", "-", "as many independent directions as are given; of all points: less six rigid motions"
    ),
    Column("lost", "text", "-", "directions, or combinations of them, that no interface mode follows"),
    _REASON,
)

TRUNCATION = (
    Column("left_out_of", "text", "-", "modes whose highest were left out: all, normal or interface"),
    Column("share", "float", "-", "part of these modes that was asked for"),
    Column("modes", "int", "-", "modes that were left out"),
    Column("interface_modes", "int", "-", "interface modes among them"),
    Column("from_hz", "float", "Hz", "lowest frequency among them"),
    _WELD,
    _PART,
    _NODE,
    _ORDER,
    _SURFACE,
    Column("utilisation", "float", "-", "of the worst point of the weld, with all modes"),
    Column("utilisation_without", "float", "-", "of the same point without them"),
    Column("life_ratio", "float", "-", "life without over life with all modes, at this point"),
    Column("shortest_life_ratio", "float", "-", "the same of the shortest lives of the weld, at whichever points"),
    Column("moves", "flag", "-", "shortest_life_ratio is beyond what is stated, up or down"),
    _REASON,
)

BASES = (
    _WELD,
    _PART,
    _NODE,
    _ORDER,
    _SURFACE,
    Column("utilisation", "float", "-", "of the worst point of the weld in the first case"),
    Column("other_utilisation", "float", "-", "of the same point in the other case"),
    Column("life_ratio", "float", "-", "life in the other case over life in the first, at this point"),
    Column("shortest_life_ratio", "float", "-", "the same of the shortest lives of the weld, at whichever points"),
    _REASON,
)

BASES_CONTENT = (
    _WELD,
    _PART,
    _NODE,
    _ORDER,
    _SURFACE,
    Column("event", "text", "-", "event, by the name it has in both cases"),
    Column("rms_MPa", "float", "MPa", "root mean square of the structural stress there, its mean removed"),
    Column("other_rms_MPa", "float", "MPa", "the same in the other case"),
    Column("rms_above_MPa", "float", "MPa", "part of rms_MPa above 20 Hz"),
    Column("other_rms_above_MPa", "float", "MPa", "the same in the other case"),
    Column("ratio_above", "float", "-", "other_rms_above_MPa over rms_above_MPa"),
    _REASON,
)

BASES_MODES = (
    Column("mode", "int", "-", "normal mode of the first case"),
    Column("frequency_hz", "float", "Hz", "its frequency"),
    Column("other_mode", "int", "-", "the mode of the other case whose stress at the welds is most alike"),
    Column("other_frequency_hz", "float", "Hz", "its frequency"),
    Column("frequency_ratio", "float", "-", "the other frequency over the first"),
    Column("likeness", "float", "-", "squared cosine between the modal stresses at the welds, 1: the same form (MAC)"),
    _REASON,
)

BASES_FLEXIBILITY = (
    _LOADED,
    _DIRECTION,
    _UNIT,
    Column("index", "float", "-", "flexibility index of the modes of the first case"),
    Column("other_index", "float", "-", "that of the other case"),
    Column("ratio", "float", "-", "the other over the first: below 1 the other basis is stiffer there"),
    Column("static", "float", "-", "static solution that one of the cases gives"),
    _REASON,
)

BASIS_POINTS: dict[str, tuple[Column, ...]] = {
    "flexibility": FLEXIBILITY,
    "interface": INTERFACE,
    "truncation": TRUNCATION,
    "bases": BASES,
    "bases_content": BASES_CONTENT,
    "bases_modes": BASES_MODES,
    "bases_flexibility": BASES_FLEXIBILITY,
}
