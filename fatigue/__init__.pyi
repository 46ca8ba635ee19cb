"""The public names for type checkers; at run time each is imported when it is first asked for."""

from fatigue.case import load_case as load_case
from fatigue.check import check_case as check_case
from fatigue.life.counting.rainflow import rainflow as rainflow
from fatigue.life.curves import catalogue as catalogue
from fatigue.pipeline.solve.model import read_model as read_model
from fatigue.point.result import Result as Result
from fatigue.point.result import open_result as open_result
from fatigue.results import read_provenance as read_provenance
from fatigue.results import read_table as read_table
from fatigue.results.summary import result_summary as result_summary
from fatigue.verify.recount import recount as recount
from fatigue.verify.table import verification_table as verification_table

__version__: str
