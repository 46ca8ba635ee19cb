"""The result folder: data dictionary, tables, records, and what is printed of them.

``columns`` says what every column is; ``tables`` writes and reads whole tables, ``rows`` some of their rows,
``weld_table`` the welds. ``provenance`` is what a result rests on, ``outputs`` whether its files are as they were
written, ``origin`` leads back to its case, ``belonging`` tells what is of one result and ``adding`` puts tables and
documents beside it. ``folder`` guards what is in the folder, ``lock`` lets one run at a time write there,
``publish`` puts a finished result there; ``summary`` is what the command line prints of it.
"""

from fatigue.results.adding import Addition, adding, enlist, finished_result, relist
from fatigue.results.belonging import (
    BODY,
    CSV_TABLES,
    DOCUMENTS,
    LIST,
    PAGE,
    PICTURE,
    PRINT,
    RECOUNT,
    WORKBOOK,
    is_derived,
    listed,
    listed_of,
    marked,
    refuse_foreign,
    refuse_mixed,
    strangers,
    write_list,
)
from fatigue.results.columns import (
    ASSESSED,
    ATTRIBUTION,
    CYCLES,
    DAMAGE,
    DIAGNOSED,
    DIAGNOSIS,
    HISTOGRAM,
    LEVERS,
    OPTIONAL,
    STRUCTURAL_STRESS,
    TABLES,
    TRACK,
)
from fatigue.results.dictionary.bench import BENCHED
from fatigue.results.dictionary.column import Column
from fatigue.results.dictionary.load_spectra import LOAD_SPECTRA
from fatigue.results.dictionary.nodes import NODES
from fatigue.results.dictionary.resonance import FORMED
from fatigue.results.dictionary.ride import RIDDEN
from fatigue.results.dictionary.shift import SHIFTED
from fatigue.results.dictionary.welds import WELDS
from fatigue.results.json_records import json_ready, write_json
from fatigue.results.origin import (
    case_of,
    changed_inputs,
    is_assessed_case,
    is_same_case,
    named_case,
    new_inputs,
    way_to_case,
)
from fatigue.results.outputs import recorded
from fatigue.results.provenance import (
    JOURNAL,
    AddedKey,
    input_register,
    read_provenance,
    refuse_another,
    software_versions,
    upsampling_factors,
    write_provenance,
)
from fatigue.results.rows import (
    number_groups,
    read_codes,
    read_rows,
    row_count,
    row_groups,
    rows_of_welds,
    worst_toes,
)
from fatigue.results.tables import TableWriter, coded, read_table, result_tables, schema, table_writer
from fatigue.results.weld_table import assessed, not_assessed, read_welds

__all__ = [
    "ASSESSED",
    "ATTRIBUTION",
    "BENCHED",
    "BODY",
    "CSV_TABLES",
    "CYCLES",
    "DAMAGE",
    "DIAGNOSED",
    "DIAGNOSIS",
    "DOCUMENTS",
    "FORMED",
    "HISTOGRAM",
    "JOURNAL",
    "LEVERS",
    "LIST",
    "LOAD_SPECTRA",
    "NODES",
    "OPTIONAL",
    "PAGE",
    "PICTURE",
    "PRINT",
    "RECOUNT",
    "RIDDEN",
    "SHIFTED",
    "STRUCTURAL_STRESS",
    "TABLES",
    "TRACK",
    "WELDS",
    "WORKBOOK",
    "AddedKey",
    "Addition",
    "Column",
    "TableWriter",
    "adding",
    "assessed",
    "case_of",
    "changed_inputs",
    "coded",
    "enlist",
    "finished_result",
    "input_register",
    "is_assessed_case",
    "is_derived",
    "is_same_case",
    "json_ready",
    "listed",
    "listed_of",
    "marked",
    "named_case",
    "new_inputs",
    "not_assessed",
    "number_groups",
    "read_codes",
    "read_provenance",
    "read_rows",
    "read_table",
    "read_welds",
    "recorded",
    "refuse_another",
    "refuse_foreign",
    "refuse_mixed",
    "relist",
    "result_tables",
    "row_count",
    "row_groups",
    "rows_of_welds",
    "schema",
    "software_versions",
    "strangers",
    "table_writer",
    "upsampling_factors",
    "way_to_case",
    "worst_toes",
    "write_json",
    "write_list",
    "write_provenance",
]
