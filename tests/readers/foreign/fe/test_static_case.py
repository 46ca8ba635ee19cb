"""How decks call their static subcases."""

import pytest

from fatigue.readers.foreign.fe.static_case import Heading, heading


@pytest.mark.parametrize(
    ("texts", "own"),
    [
        (("A  RUN", " TUNNEL PRESSURE ", ""), Heading("A RUN", "TUNNEL PRESSURE", "")),
        ((" MSC.NASTRAN JOB CREATED ON 27-FEB-17 AT 18:03:10", "DEFAULT", "     SUBCASE 1"), Heading()),
        (("", "side wind          SUPERELEMENT 0", "gust     SUBCASE 12"), Heading("", "side wind", "gust")),
        (("THE DEFAULT LOAD", "subcase of a kind", ""), Heading("THE DEFAULT LOAD", "", "")),
        (("MSC.NASTRAN JOBS", "load subcase 3", ""), Heading("MSC.NASTRAN JOBS", "load subcase 3", "")),
    ],
)
def test_what_programs_write_by_themselves_is_no_heading(texts, own):
    """Solvers number the subcase behind its label, preprocessors give titles where the user gives none."""
    assert heading(*texts) == own
