"""The page of a study: its story with pictures, and its claims with their verdicts.

``studied`` is what it is made of, ``page`` puts it together; ``chosen`` says which variants are drawn beside each
other, ``spectra``, ``lives``, ``maps`` and ``claims_figure`` draw, ``words`` and ``tables`` tell.
"""

from fatigue.study.page.page import study_page
from fatigue.study.page.studied import Studied, Varied

__all__ = ["Studied", "Varied", "study_page"]
